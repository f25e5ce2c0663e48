"""Poincaré sections of a run, bifurcation data, and whether a motion is periodic."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, count, finite, not_negative, one_of, positive
from bumpstop.errors import InputError
from bumpstop.modal.full import FullModel
from bumpstop.post.impacts import impacts_of
from bumpstop.post.of_run import check_run, of_run
from bumpstop.quantities import dof_units
from bumpstop.structure.dofs import DOFS

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from bumpstop.response import Response

__all__ = ["Periodicity", "bifurcation", "impact_section", "periodicity", "stroboscopic_section"]

MOST_STROBES = 10_000_000
"""Instants of a section at most."""


@of_run
def stroboscopic_section(
    response: Response,
    node: str,
    dof: str,
    period: float,
    *,
    phase: float = 0.0,
    start: float = 0.0,
) -> xr.Dataset:
    """Return displacement and velocity of a node once in each period.

    Parameters
    ----------
    response
        The run.
    node, dof
        Whose motion.
    period
        In s, mostly that of the load.
    phase
        When in the period, as a part of it.
    start
        Instants before it, in s, are left out: the transient.

    Returns
    -------
    xarray.Dataset
        ``displacement`` and ``velocity`` over ``time``; SI units.

    Raises
    ------
    InputError
        If the run has no such node, or no such instant.
    """
    import xarray as xr

    times = _strobes(response, period, phase, start)
    found = {}
    for quantity in ("displacement", "velocity"):
        attributes = {
            "units": dof_units(quantity, one_of("dof", dof, DOFS)),
            "long_name": f"{quantity} of {node} along {dof}",
        }
        values = response.sample(quantity, node, dof, times=times)
        found[quantity] = ("time", values, attributes | {"drawn": "points"})
    where = {"time": ("time", times, {"units": "s", "long_name": "time"})}
    return xr.Dataset(found, coords=where, attrs={"period": period, "phase": phase})


@of_run
def impact_section(
    response: Response, stop: str, *, period: float | None = None, start: float = 0.0
) -> pd.DataFrame:
    """Return the Poincaré section at the closings of a stop.

    Parameters
    ----------
    response
        The run.
    stop
        Name of the stop.
    period
        Of the load, in s; the phases of the closings in it are told where it is given.
    start
        Closings before it, in s, are left out.

    Returns
    -------
    pandas.DataFrame
        ``time`` in s, ``closing_speed`` in m/s, and ``phase`` as a part of the period.

    Raises
    ------
    InputError
        If there is no such stop, or the period is not positive.
    """
    import pandas as pd

    contacts = impacts_of(response, response.stop_index(stop))
    late = contacts["start"] >= not_negative("start", start)
    columns = {"time": contacts["start"][late], "closing_speed": contacts["closing_speed"][late]}
    if period is not None:
        columns["phase"] = np.mod(columns["time"] / positive("period", period), 1.0)
    table = pd.DataFrame(columns)
    table.attrs["units"] = {"time": "s", "closing_speed": "m/s", "phase": "1"}
    return table


def bifurcation(
    runs: Mapping[float, Response] | Iterable[tuple[float, Response]],
    section: Callable[[Response], object],
    *,
    parameter: str = "parameter",
    units: str = "1",
) -> pd.DataFrame:
    """Return the points of a section of each run, for a bifurcation diagram.

    Parameters
    ----------
    runs
        A response for each value of a parameter; an iterator keeps one run at a time.
    section
        What is looked at in each: a function of a response that returns numbers, such as one
        that takes the column of a section.
    parameter, units
        Name and unit of the parameter.

    Returns
    -------
    pandas.DataFrame
        Columns ``parameter`` (by its name) and ``value``, a row a point.

    Raises
    ------
    InputError
        If ``runs`` has no pairs of a finite value and a response, or ``section`` returns anything
        but numbers.

    Examples
    --------
    >>> import bumpstop as bs
    >>> def run(gap):
    ...     basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    ...     wall = bs.RigidStop("wall", node="P", normal=(1, 0, 0), gap=gap, restitution=1.0)
    ...     thrown = bs.ModalState(velocity=[-1.0])
    ...     return bs.simulate(bs.Problem(basis, laws=[wall], initial=thrown, duration=0.5))
    >>> runs = ((gap, run(gap)) for gap in (0.0, 0.1))
    >>> speeds = lambda response: bs.impact_section(response, "wall").closing_speed
    >>> bs.bifurcation(runs, speeds, parameter="gap").round(3)
       gap  value
    0  0.0  1.000
    1  0.1  0.778
    """
    import pandas as pd

    values: list[float] = []
    points: list[FloatArray] = []
    for value, response in _pairs(runs):
        check_run(response)
        found = _numbers(section(response))
        values += [finite(parameter, value)] * len(found)
        points.append(found)
    table = pd.DataFrame({parameter: values, "value": np.concatenate([np.empty(0), *points])})
    table.attrs["units"] = {parameter: units}
    return table


def _numbers(found: object) -> FloatArray:
    """Return what a section found, (point,)."""
    try:
        numbers = np.asarray(found, dtype=np.float64)
    except (TypeError, ValueError) as error:
        what = "must return numbers"
        raise InputError(what, key="section", value=found) from error
    return np.atleast_1d(numbers).ravel()


def _pairs(
    runs: Mapping[float, Response] | Iterable[tuple[float, Response]],
) -> Iterator[tuple[float, Response]]:
    """Yield the value of each run, and the run."""
    if not isinstance(runs, Iterable):
        what = "must be responses by the value of a parameter, or pairs of both"
        raise InputError(what, key="runs", value=runs)
    for pair in runs.items() if isinstance(runs, Mapping) else runs:
        if not isinstance(pair, Sequence) or len(pair) != 2:
            raise InputError("must be pairs of a value and a response", key="runs", value=pair)
        yield pair


@dataclass(frozen=True)
class Periodicity:
    """Whether a motion repeats itself; see `periodicity`.

    Attributes
    ----------
    multiple
        After how many periods it does; None where it does not within those looked at.
    distance
        How far states so many periods apart are from each other at most, relative to the size
        of the motion; the least of all multiples looked at where there is none.
    """

    multiple: int | None
    distance: float

    def __bool__(self) -> bool:
        return self.multiple is not None


@of_run
def periodicity(
    response: Response,
    period: float,
    *,
    start: float = 0.0,
    most: int = 16,
    tolerance: float = 1e-6,
) -> Periodicity:
    """Return after how many periods of the load a motion repeats itself.

    States, all modal displacements times their frequencies and all modal velocities, are
    compared once a period from ``start`` to the end of the run, at least over twice as many
    periods as the motion is said to repeat after. Of a full model, which has no modes, they are
    compared by the energy of their difference.

    Parameters
    ----------
    response
        The run.
    period
        Of the load, in s.
    start
        In s; the transient before it is left out.
    most
        Largest multiple of the period to look at.
    tolerance
        Largest distance of states, relative to the largest state.

    Raises
    ------
    InputError
        If fewer than two periods lie after the start, a number cannot be used, or the run of a
        full model has not kept the motion of all dofs.
    """
    times = _strobes(response, period, 0.0, start)
    if len(times) < 3:
        key, value = ("start", start) if start > 0.0 else ("period", period)
        what = "must leave two periods before the end of the run"
        raise InputError(what, key=key, value=value)
    states, largest = _states(response, times), _largest(response)
    size = largest(states)
    least = np.inf
    for multiple in range(1, min(count("most", most), (len(times) - 1) // 2) + 1):
        distance = largest(states[multiple:] - states[:-multiple])
        distance = distance / size if size else 0.0
        least = min(least, distance)
        if distance <= not_negative("tolerance", tolerance):
            return Periodicity(multiple, distance)
    return Periodicity(None, least)


def _states(response: Response, times: FloatArray) -> FloatArray:
    """Return states, (time, 2 N): of modes in units of velocity, a rigid one at 1 rad/s."""
    basis = response.problem.basis
    if response.kept is not None:
        what = "needs the motion of all dofs, of which the run has kept a few"
        hint = "run a shorter time, or with longer steps"
        raise InputError(what, key="response", hint=hint)
    omega = np.ones(len(basis.omega2)) if basis.unreduced else np.sqrt(np.abs(basis.omega2))
    scale = np.where(omega > 0.0, omega, 1.0)
    return np.hstack([response.motion(0, times) * scale, response.motion(1, times)])


def _largest(response: Response) -> Callable[[FloatArray], float]:
    """Return what tells the largest of some states, or of their differences.

    Of modes it is the largest number; of a full model the root of twice the energy, where rigid
    motions count as if held at 1 rad/s.
    """
    basis = response.problem.basis
    if not isinstance(basis, FullModel):
        return lambda states: float(np.abs(states).max())
    mass, _, stiffness = basis.matrices

    def largest(states: FloatArray) -> float:
        displacement, velocity = (each.T for each in np.split(states, 2, axis=1))
        energies = displacement * (stiffness @ displacement + mass @ displacement)
        energies += velocity * (mass @ velocity)
        return float(np.sqrt(energies.sum(axis=0).max()))

    return largest


def _strobes(response: Response, period: float, phase: float, start: float) -> FloatArray:
    step, shift = positive("period", period), finite("phase", phase) % 1.0
    duration = response.problem.duration
    if duration / step > MOST_STROBES:
        what = f"leaves more than {MOST_STROBES:,} instants"
        raise InputError(what, key="period", value=period)
    first = int(np.ceil(not_negative("start", start) / step - shift - 1e-9))
    last = int(np.floor(duration / step - shift + 1e-9))
    if last < first:
        raise InputError("leaves no instant before the end of the run", key="start", value=start)
    times = (np.arange(first, last + 1, dtype=np.float64) + shift) * step
    inside: FloatArray = times.clip(0.0, duration)
    return inside
