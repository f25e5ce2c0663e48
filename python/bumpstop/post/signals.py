"""Spectra and envelopes of sampled signals, by SciPy, with units and names."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.arguments import FloatArray, finite, one_of, positive, samples
from bumpstop.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    import xarray as xr

    from bumpstop.post.streams import Stream

__all__ = [
    "amplitude_spectrum",
    "envelope",
    "power_spectral_density",
    "spectrogram",
    "uniform_step",
]

EVEN = 1e-6
"""How much steps of time may differ, relative to their mean: the rounding of files."""
DETREND = ("none", "constant", "linear")


def uniform_step(signal: xr.DataArray) -> float:
    """Return the step in s of a signal over ``time``.

    Raises
    ------
    InputError
        If the signal is not of finite numbers over time alone, or its instants are not evenly
        spaced.
    """
    if getattr(signal, "dims", None) != ("time",) or "time" not in signal.coords:
        hint = "such as response.velocity(node, dof)"
        raise InputError("must be a labelled signal over time", key="signal", hint=hint)
    if signal.size < 2:
        what = "must be of two instants or more"
        raise InputError(what, key="signal", value=f"{signal.size} instants")
    if not np.isfinite(samples("signal", signal.values)).all():
        raise InputError("must be finite", key="signal")
    steps = np.diff(samples("signal.time", signal["time"].values))
    mean = float(steps.mean())
    if mean <= 0.0 or float(np.abs(steps - mean).max()) > EVEN * mean:
        hint = "take response.at(np.arange(n) * step)"
        raise InputError("must be sampled evenly in time", key="signal", hint=hint)
    return mean


def amplitude_spectrum(
    signal: xr.DataArray, *, window: str = "boxcar", detrend: str = "none"
) -> xr.DataArray:
    """Return the one-sided amplitude spectrum of a signal.

    A sine of amplitude A whose periods fill the signal gives a line of height A; with another
    window too, whose mean is taken out.

    Parameters
    ----------
    signal
        Over ``time``, evenly sampled.
    window
        A window of `scipy.signal.get_window`.
    detrend
        ``"none"``, ``"constant"`` or ``"linear"``: what is taken off first.

    Returns
    -------
    xarray.DataArray
        Amplitudes over ``frequency`` in Hz, in the signal's unit, with the coordinate ``phase``
        in rad, that of a cosine at the first instant.

    Raises
    ------
    InputError
        If the signal is not evenly sampled, or a word is unknown.

    Examples
    --------
    >>> import xarray as xr
    >>> times = np.arange(100) * 0.01
    >>> wave = xr.DataArray(3.0 * np.cos(2 * np.pi * 5.0 * times), coords={"time": times})
    >>> float(amplitude_spectrum(wave).sel(frequency=5.0).round(12))
    3.0
    """
    import scipy.fft

    step, values = uniform_step(signal), _detrended(signal, detrend)
    weights = window_weights(window, len(values))
    lines = scipy.fft.rfft(values * weights) / weights.sum()
    lines[1:] *= 2.0
    if len(values) % 2 == 0:
        lines[-1] *= 0.5
    return _over_frequency(
        np.abs(lines),
        scipy.fft.rfftfreq(len(values), step),
        signal,
        "amplitude",
        _units(signal),
        phase=("frequency", np.angle(lines), {"units": "rad"}),
    )


def power_spectral_density(
    signal: xr.DataArray | Stream,
    *,
    segment: float | None = None,
    overlap: float = 0.5,
    window: str = "hann",
    detrend: str = "constant",
) -> xr.DataArray:
    """Return the one-sided power spectral density of a signal by Welch's method.

    Its integral over frequency is the mean square of the signal (P. D. Welch, IEEE Transactions
    on Audio and Electroacoustics 15 (1967) 70-73; `scipy.signal.welch`).

    Parameters
    ----------
    signal
        Over ``time``, evenly sampled; or a `Stream`, which takes the memory of a few segments.
    segment
        Length of the segments that are averaged, in s; an eighth of the signal where left out.
    overlap
        Part of a segment that the next one shares, from 0 to below 1.
    window
        A window of `scipy.signal.get_window`.
    detrend
        ``"none"``, ``"constant"`` or ``"linear"``: what is taken off each segment.

    Returns
    -------
    xarray.DataArray
        Over ``frequency`` in Hz, in the signal's unit squared per Hz.

    Raises
    ------
    InputError
        If the signal is not evenly sampled, or a value cannot be used.
    """
    from bumpstop.post.streams import Stream
    from bumpstop.post.welch import Welch

    step = signal.step if isinstance(signal, Stream) else uniform_step(signal)
    length = segment_samples(segment, len(signal), step)
    average = Welch(
        window=window_weights(window, length),
        hop=length - _overlap(overlap, length),
        detrend=_scipy_detrend(detrend),
    )
    for values in _blocks_of(signal, length):
        average.add(values)
    units = _density_units(signal)
    name = "power spectral density"
    return _over_frequency(average.density(step), average.frequencies(step), signal, name, units)


def spectrogram(
    signal: xr.DataArray, *, segment: float, overlap: float = 0.75, window: str = "hann"
) -> xr.DataArray:
    """Return the power spectral density of a signal as it changes in time.

    Squared Fourier transforms of windowed segments (`scipy.signal.spectrogram`), one-sided.

    Parameters
    ----------
    signal
        Over ``time``, evenly sampled.
    segment
        Length of the segments in s.
    overlap
        Part of a segment that the next one shares, from 0 to below 1.
    window
        A window of `scipy.signal.get_window`.

    Returns
    -------
    xarray.DataArray
        Over ``frequency`` in Hz and ``time`` in s, the middle of each segment, in the signal's
        unit squared per Hz; segments lie within the signal.

    Raises
    ------
    InputError
        If the signal is not evenly sampled, or a value cannot be used.
    """
    import scipy.signal
    import xarray as xr

    step = uniform_step(signal)
    length = segment_samples(segment, signal.size, step)
    frequency, times, density = scipy.signal.spectrogram(
        np.asarray(signal.values, dtype=np.float64),
        fs=1.0 / step,
        window=window_weights(window, length),
        nperseg=length,
        noverlap=_overlap(overlap, length),
        detrend=False,
    )
    origin = float(signal["time"].values[0])
    return xr.DataArray(
        density,
        dims=("frequency", "time"),
        coords={
            "frequency": ("frequency", frequency, _HERTZ),
            "time": ("time", times + origin, {"units": "s", "long_name": "time"}),
        },
        name="power spectral density",
        attrs={
            "units": _density_units(signal),
            "long_name": f"power spectral density of {_words(signal)}",
        },
    )


def envelope(signal: xr.DataArray) -> xr.DataArray:
    """Return the envelope of a signal: the magnitude of its analytic signal.

    The mean is left out of the transform and not added again (`scipy.signal.hilbert`).

    Raises
    ------
    InputError
        If the signal is not evenly sampled.
    """
    import scipy.signal

    uniform_step(signal)
    values = np.asarray(signal.values, dtype=np.float64)
    found = signal.copy(data=np.abs(scipy.signal.hilbert(values - values.mean())))
    found.name = "envelope"
    found.attrs["long_name"] = f"envelope of {_words(signal)}"
    return found


def _blocks_of(signal: xr.DataArray | Stream, least: int) -> Iterator[FloatArray]:
    """Yield the samples of a signal in blocks, of so many samples at least."""
    from bumpstop.post.streams import BLOCK, Stream

    if isinstance(signal, Stream):
        for _, values in signal.blocks(max(BLOCK, least)):
            yield values
    else:
        yield np.asarray(signal.values, dtype=np.float64)


_HERTZ = {"units": "Hz", "long_name": "frequency"}


def _over_frequency(
    values: FloatArray,
    frequency: FloatArray,
    signal: xr.DataArray | Stream,
    name: str,
    units: str,
    **coordinates: Any,
) -> xr.DataArray:
    import xarray as xr

    return xr.DataArray(
        values,
        dims="frequency",
        coords={"frequency": ("frequency", frequency, _HERTZ)} | coordinates,
        name=name,
        attrs={"units": units, "long_name": f"{name} of {_words(signal)}"},
    )


def _words(signal: xr.DataArray | Stream) -> str:
    from bumpstop.post.streams import Stream

    if isinstance(signal, Stream):
        return signal.words
    return str(signal.attrs.get("long_name", signal.name or "the signal"))


def _units(signal: xr.DataArray | Stream) -> str:
    from bumpstop.post.streams import Stream

    if isinstance(signal, Stream):
        return signal.units
    return str(signal.attrs.get("units", "1"))


def _density_units(signal: xr.DataArray | Stream) -> str:
    units = _units(signal)
    return "1/Hz" if units == "1" else f"({units})^2/Hz"


def _detrended(signal: xr.DataArray, detrend: str) -> FloatArray:
    import scipy.signal

    values = np.asarray(signal.values, dtype=np.float64)
    kind = _scipy_detrend(detrend)
    found: FloatArray = values if kind is False else scipy.signal.detrend(values, type=kind)
    return found


def _scipy_detrend(detrend: str) -> Any:
    return False if one_of("detrend", detrend, DETREND) == "none" else detrend


def window_weights(window: str, length: int) -> FloatArray:
    import scipy.signal

    try:
        weights: FloatArray = scipy.signal.get_window(window, length)
    except ValueError as error:
        hint = "such as hann, flattop or boxcar"
        raise InputError("is no window of SciPy", key="window", value=window, hint=hint) from error
    return weights


def segment_samples(segment: float | None, samples: int, step: float) -> int:
    """Return the length of a segment in samples."""
    if segment is None:
        return max(samples // 8, 2)
    length = round(positive("segment", segment) / step)
    if not 2 <= length <= samples:
        what = f"must be between two steps and the signal's {samples * step:g} s"
        raise InputError(what, key="segment", value=segment)
    return length


def _overlap(overlap: float, length: int) -> int:
    part = finite("overlap", overlap)
    if not 0.0 <= part < 1.0:
        raise InputError("must be from 0 to below 1", key="overlap", value=overlap)
    return min(round(part * length), length - 1)
