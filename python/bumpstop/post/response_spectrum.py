"""Response spectra: what an oscillator of each frequency would make of an acceleration.

Between its samples the acceleration is linear, and the oscillator is followed exactly: N. C. Nigam
and P. C. Jennings, Bulletin of the Seismological Society of America 59 (1969) 909-922; the same
recurrence as the ramp-invariant filter of D. O. Smallwood, Shock and Vibration Bulletin 51
(1981) 279-287.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray, finite, one_of, samples, series
from bumpstop.errors import InputError

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

__all__ = ["oscillator", "response_spectrum"]

Complexes: TypeAlias = NDArray[np.complex128]

QUANTITIES = {
    "pseudo_acceleration": ("m/s^2", "largest -ω² times relative displacement"),
    "pseudo_velocity": ("m/s", "largest ω times relative displacement"),
    "relative_displacement": ("m", "largest relative displacement"),
    "relative_velocity": ("m/s", "largest relative velocity"),
    "absolute_acceleration": ("m/s^2", "largest absolute acceleration"),
}
SIDES = ("both", "positive", "negative")
STEPS_A_PERIOD = 60
"""Instants a period of the oscillator at least: the peak between them errs by 3e-7."""
MOST_STEPS = 30_000_000
"""Of an oscillator, at most."""


def response_spectrum(
    acceleration: xr.DataArray,
    frequency: ArrayLike,
    damping: ArrayLike = 0.05,
    *,
    quantity: str = "pseudo_acceleration",
    side: str = "both",
    after: bool = True,
) -> xr.DataArray:
    """Return the response spectrum of an acceleration: a shock, an earthquake, a floor.

    The oscillator z'' + 2 xi w z' + w2 z = -a(t) starts at rest.

    Parameters
    ----------
    acceleration
        That of the oscillator's base, over ``time`` in s, which may be uneven; linear between
        its instants. For a floor that itself moves with a base, the absolute one.
    frequency
        Natural frequencies in Hz, (F,).
    damping
        Ratio of critical damping, from 0 to below 1: one number gives a curve, a list (D,), of one
        number too, a curve for each.
    quantity
        ``"pseudo_acceleration"``, ``"pseudo_velocity"``, ``"relative_displacement"``,
        ``"relative_velocity"`` or ``"absolute_acceleration"``.
    side
        ``"both"``: the largest magnitude; ``"positive"``, ``"negative"``: the largest excursion
        of the quantity to one side. The pseudo-acceleration is -w2 z, the absolute one of an
        oscillator without damper, so that both name the same side: that to which its spring pushes
        it.
    after
        Whether the free vibration after the end of the acceleration counts.

    Returns
    -------
    xarray.DataArray
        Over ``frequency`` in Hz, (F,), with the damping in its ``attrs``; for a list of dampings
        over ``damping`` and ``frequency``, (D, F).

    Raises
    ------
    InputError
        If the acceleration is not over ascending times, or a value cannot be used.

    Examples
    --------
    A step of 1 m/s2 moves an undamped oscillator by twice its static deflection.

    >>> import xarray as xr
    >>> step = xr.DataArray([1.0, 1.0], coords={"time": [0.0, 2.0]}, dims="time")
    >>> print(f"{response_spectrum(step, [5.0], 0.0).values[0]:.6f}")
    2.000000
    """
    import xarray as xr

    times, values = _checked(acceleration)
    hertz = np.array(series("frequency", frequency))
    if (hertz <= 0.0).any():
        raise InputError("must be positive", key="frequency", value=float(hertz.min()))
    _check_length(times, float(hertz.max()))
    ratios = _ratios(damping)
    units, words = QUANTITIES[one_of("quantity", quantity, tuple(QUANTITIES))]
    one_of("side", side, SIDES)
    found = [
        [_largest(times, values, f, ratio, quantity, side, after) for f in hertz]
        for ratio in ratios.ravel().tolist()
    ]
    about = {"units": units, "long_name": words, "side": side}
    spectra = xr.DataArray(
        found,
        dims=("damping", "frequency"),
        coords={
            "damping": ("damping", ratios.ravel(), {"units": "1", "long_name": "damping ratio"}),
            "frequency": ("frequency", hertz, {"units": "Hz", "long_name": "frequency"}),
        },
        name=quantity,
        attrs=about,
    )
    if ratios.ndim:
        return spectra
    return spectra.isel(damping=0, drop=True).assign_attrs(damping=ratios.item())


def _ratios(damping: ArrayLike) -> FloatArray:
    """Return ratios of critical damping, () for one number and (D,) for a list."""
    given: Any = damping
    single = np.ndim(given) == 0
    ratios = np.array(finite("damping", given) if single else series("damping", given))
    outside = ~((ratios >= 0.0) & (ratios < 1.0))
    if outside.any():
        what = "must be from 0 to below 1"
        raise InputError(what, key="damping", value=float(ratios[outside].flat[0]))
    return ratios


class Motion(NamedTuple):
    """The motion of an oscillator relative to its base."""

    times: FloatArray
    base: FloatArray
    """Acceleration of the base."""
    displacement: FloatArray
    velocity: FloatArray


def oscillator(times: FloatArray, base: FloatArray, frequency: float, damping: float) -> Motion:
    """Return the motion of an oscillator under a piecewise-linear acceleration of its base.

    With the pole p = w (-xi + i sqrt(1 - xi2)) the motion is z = Im(y) / Im(p), where
    y' = p y - a: over a step h with a linear from a0 to a1,
    y1 = e^(ph) y0 - h (a0 phi1(ph) + (a1 - a0) phi2(ph)).

    Parameters
    ----------
    times
        In s, ascending, (n,).
    base
        Acceleration of the base at these times in m/s2, (n,).
    frequency, damping
        Natural frequency in Hz, ratio of critical damping below 1.
    """
    omega = 2.0 * math.pi * frequency
    pole = omega * complex(-damping, math.sqrt(1.0 - damping**2))
    step = np.diff(times)
    factor, one, two = _phi(np.asarray(pole * step, dtype=np.complex128))
    drive = -step * (base[:-1] * one + np.diff(base) * two)
    state = np.zeros(len(times), dtype=complex)
    if len(step) and np.ptp(step) <= 1e-9 * step.mean():
        from scipy.signal import lfilter

        state[1:] = lfilter([1.0], [1.0, -factor.mean()], drive)
    else:
        for k, (turn, push) in enumerate(zip(factor.tolist(), drive.tolist(), strict=True)):
            state[k + 1] = turn * state[k] + push
    rate = pole * state
    displacement = state.imag / pole.imag
    return Motion(times, base, displacement, rate.imag / pole.imag)


def _largest(
    times: FloatArray,
    base: FloatArray,
    frequency: float,
    damping: float,
    quantity: str,
    side: str,
    after: bool,
) -> float:
    longest = 1.0 / (STEPS_A_PERIOD * frequency)
    omega = 2.0 * math.pi * frequency
    shaken = oscillator(*_refined(times, base, longest), frequency, damping)
    high = low = 0.0
    for motion in (shaken, _free(shaken, frequency, damping)) if after else (shaken,):
        values, rates = _read(motion, quantity, omega, damping)
        high = max(high, _extreme(motion.times, values, rates))
        low = max(low, _extreme(motion.times, -values, -rates))
    return {"both": max(high, low), "positive": high, "negative": low}[side]


def _free(motion: Motion, frequency: float, damping: float) -> Motion:
    """Return the free vibration after a motion, for a period: there it has its extremes."""
    omega = 2.0 * math.pi * frequency
    pole = omega * complex(-damping, math.sqrt(1.0 - damping**2))
    across = motion.displacement[-1] * pole.imag
    state = complex((motion.velocity[-1] * pole.imag - pole.real * across) / pole.imag, across)
    since = np.linspace(0.0, 1.0 / frequency, STEPS_A_PERIOD + 1)
    states = state * np.exp(pole * since)
    at_rest = np.zeros(len(since))
    rates = (pole * states).imag / pole.imag
    return Motion(motion.times[-1] + since, at_rest, states.imag / pole.imag, rates)


def _read(
    motion: Motion, quantity: str, omega: float, damping: float
) -> tuple[FloatArray, FloatArray]:
    """Return a quantity and its rate in time."""
    z, v = motion.displacement, motion.velocity
    a = -motion.base - 2.0 * damping * omega * v - omega**2 * z
    match quantity:
        case "relative_velocity":
            return v, a
        case "absolute_acceleration":
            total = -2.0 * damping * omega * v - omega**2 * z
            return total, -2.0 * damping * omega * a - omega**2 * v
        case "pseudo_acceleration":
            return -(omega**2) * z, -(omega**2) * v
        case "pseudo_velocity":
            return omega * z, omega * v
    return z, v


def _extreme(times: FloatArray, values: FloatArray, rates: FloatArray) -> float:
    """Return the largest value, also between instants, by cubics through values and rates."""
    highest = max(float(values.max()), 0.0)
    step = np.diff(times)
    top = np.flatnonzero((rates[:-1] > 0.0) & (rates[1:] < 0.0) & (step > 0.0))
    if not len(top):
        return highest
    h, y0, y1 = step[top], values[top], values[top + 1]
    d0, d1 = rates[top] * h, rates[top + 1] * h
    # The derivative d0 + 2 b x + 3 c x2 falls through zero once in (0, 1).
    b, c = 3.0 * (y1 - y0) - 2.0 * d0 - d1, 2.0 * (y0 - y1) + d0 + d1
    root = np.sqrt(np.maximum(b * b - 3.0 * c * d0, 0.0))
    x = np.clip(d0 / (root - b), 0.0, 1.0)
    return max(highest, float((y0 + x * (d0 + x * (b + x * c))).max()))


def _refined(times: FloatArray, base: FloatArray, longest: float) -> tuple[FloatArray, FloatArray]:
    """Return the same straight lines with steps no longer than some time."""
    parts = np.maximum(np.ceil(np.diff(times) / longest).astype(int), 1)
    if parts.max(initial=1) == 1:
        return times, base
    owner = np.repeat(np.arange(len(parts)), parts)
    within = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
    share = within / parts[owner]
    fine = [
        np.append(lines[:-1][owner] + share * np.diff(lines)[owner], lines[-1])
        for lines in (times, base)
    ]
    return fine[0], fine[1]


def _phi(z: Complexes) -> tuple[Complexes, Complexes, Complexes]:
    """Return e^z, (e^z - 1) / z and (e^z - 1 - z) / z2; by series where z is small."""
    small = np.abs(z) < 0.5
    safe = np.where(small, 1.0, z)
    whole = np.exp(z)
    one = (np.exp(safe) - 1.0) / safe
    two = (one - 1.0) / safe
    series_two = np.zeros_like(z)
    for n in range(18, 1, -1):
        series_two = series_two * z + 1.0 / math.factorial(n)
    series_one = 1.0 + z * series_two
    return whole, np.where(small, series_one, one), np.where(small, series_two, two)


def _check_length(times: FloatArray, highest: float) -> None:
    """Refuse oscillators that swing more often than memory has room for."""
    most = MOST_STEPS / STEPS_A_PERIOD
    if (times[-1] - times[0]) * highest > most:
        what = f"must be at most {most / (times[-1] - times[0]):.3g} Hz over a time so long"
        raise InputError(what, key="frequency", value=highest)


def _checked(acceleration: xr.DataArray) -> tuple[FloatArray, FloatArray]:
    if getattr(acceleration, "dims", None) != ("time",) or "time" not in acceleration.coords:
        hint = "such as response.acceleration(node, dof)"
        raise InputError("must be labelled, over time", key="acceleration", hint=hint)
    if acceleration.size < 2:
        raise InputError("must be over time, of two instants or more", key="acceleration")
    times = samples("acceleration.time", acceleration["time"].values)
    values = samples("acceleration", acceleration.values)
    if not (np.diff(times) >= 0.0).all() or not np.isfinite(values).all():
        raise InputError("must be finite, over ascending times", key="acceleration")
    return times, values
