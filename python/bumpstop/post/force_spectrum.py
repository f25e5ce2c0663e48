"""The Fourier transform of a stop's force, of its blows too."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, finite, not_negative, series
from bumpstop.errors import InputError
from bumpstop.post.blows import blows_of
from bumpstop.post.contacts import integrals_of, loaded_spans
from bumpstop.post.of_run import of_run
from bumpstop.post.spans import spans_within

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

    from bumpstop.response import Response

__all__ = ["force_spectrum"]


@of_run
def force_spectrum(
    response: Response,
    stop: str,
    frequency: ArrayLike,
    *,
    start: float = 0.0,
    end: float | None = None,
) -> xr.DataArray:
    """Return the Fourier transform of a stop's normal force over the run, or a part of it.

    F(f) = integral of F(t) exp(-2 pi i f t) dt, taken of the solution itself and not of samples.
    A blow on a rigid stop, an impulse p at the instant t_j, is p exp(-2 pi i f t_j) in it, as a
    Dirac function is (R. N. Bracewell, The Fourier Transform and Its Applications, chapter 5):
    what samples of the force cannot tell. At f = 0 it is the whole impulse.

    Parameters
    ----------
    response
        The run.
    stop
        Name of the stop.
    frequency
        In Hz, (F,).
    start, end
        The time looked at, in s; all of the run where left out. A blow at its end is not in it,
        but at the end of the run.

    Returns
    -------
    xarray.DataArray
        Complex, over ``frequency``, in N s. Its magnitude squared over the time looked at is the
        periodogram in N2/Hz, two-sided. Blows alone leave it as high at high frequencies as at
        low ones: the mean square of such a force is infinite.

    Raises
    ------
    InputError
        If there is no such stop, or a number cannot be used.

    Examples
    --------
    A ball is thrown back by a wall, and the blow is as loud at all frequencies.

    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("P", "dx"): [1.0]})
    >>> wall = bs.RigidStop("wall", node="P", normal=(1, 0, 0), gap=0.5, restitution=1.0)
    >>> thrown = bs.ModalState(velocity=[-2.0])
    >>> run = bs.simulate(bs.Problem(basis, laws=[wall], initial=thrown, duration=1.0))
    >>> abs(bs.force_spectrum(run, "wall", [0.0, 10.0, 1e4])).round(9).values.tolist()
    [4.0, 4.0, 4.0]
    """
    import xarray as xr

    law = response.stop_index(stop)
    hertz = np.array(series("frequency", frequency))
    first, last = _span(response, start, end)
    spans = spans_within(loaded_spans(response, stop, 0.0), first, last)

    def waves(turns: float, times: FloatArray) -> FloatArray:
        force = response.history.law_motion(law, times)[2]
        phase = turns * times
        return np.stack([force * np.cos(phase), -force * np.sin(phase)], axis=1)

    blows = blows_of(response, law)
    inside = (blows.times >= first) & (blows.times < last)
    inside |= (blows.times == last) & (last == response.problem.duration)
    found = np.zeros(len(hertz), dtype=complex)
    for number, turns in enumerate((2.0 * np.pi * hertz).tolist()):
        cosine, sine = integrals_of(response, spans, partial(waves, turns)).sum(axis=0)
        sudden = blows.impulses[inside] @ np.exp(-1j * turns * blows.times[inside])
        found[number] = complex(cosine, sine) + sudden
    return xr.DataArray(
        found,
        dims="frequency",
        coords={"frequency": ("frequency", hertz, {"units": "Hz", "long_name": "frequency"})},
        name="force_spectrum",
        attrs={"units": "N s", "long_name": "Fourier transform of the force", "stop": stop},
    )


def _span(response: Response, start: float, end: float | None) -> tuple[float, float]:
    """Return the time looked at."""
    duration = response.problem.duration
    first = not_negative("start", start)
    last = duration if end is None else finite("end", end)
    if not first < last <= duration:
        what = f"must lie after the start, {first:g} s, and within the run of {duration:g} s"
        raise InputError(what, key="end", value=last)
    return first, last
