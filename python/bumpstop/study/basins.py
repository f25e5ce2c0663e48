"""Basins of attraction: which steady motion a run ends on, over many starts.

Each run keeps its stroboscopic section, one point of displacement and velocity a period, at its
end. A motion that comes back after a number of periods is periodic, and two that have the same
points, whichever comes first, are on the same attractor.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray, count, positive
from bumpstop.errors import InputError
from bumpstop.study.outputs import Output

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["SECTION", "Attractor", "Basins", "Classes", "classified"]

SECTION = ("section_displacement", "section_velocity")
"""Outputs that hold the sections."""

RETURNS = 0.1
"""A motion comes back within this part of the tolerance: two that have come back so far from
where they will settle, from both sides, are still the same."""
MOST_ATTRACTORS = 1000


@dataclass(frozen=True, kw_only=True)
class Basins:
    """How the attractors that runs end on are told apart.

    Parameters
    ----------
    node, dof
        Whose displacement and velocity make the sections.
    period
        Of the load, in s: the sections are made once in it.
    most
        Largest number of periods after which a motion may come back; the last ``2 most``
        periods of each run are looked at.
    tolerance
        Points of sections that are nearer than this to each other, relative to the largest
        displacement and velocity of all sections, are the same.

    Raises
    ------
    InputError
        If a number cannot be used.
    """

    node: str
    dof: str
    period: float
    most: int = 8
    tolerance: float = 1e-3

    def __post_init__(self) -> None:
        positive("period", self.period)
        count("most", self.most)
        positive("tolerance", self.tolerance)

    def outputs(self, duration: float) -> dict[str, Output]:
        """Return what runs of a duration in s must keep.

        Raises
        ------
        InputError
            If they are too short.
        """
        last = int(np.floor(duration / self.period + 1e-9))
        first = last - 2 * self.most
        if first < 0:
            what = f"needs twice as many periods, and the run has {last}"
            raise InputError(what, key="most", value=self.most, hint="make run.duration longer")
        times = (np.arange(first, last + 1) * self.period).clip(0.0, duration).tolist()
        displacement, velocity = SECTION
        return {
            displacement: Output(
                quantity="displacement", node=self.node, dof=self.dof, times=times
            ),
            velocity: Output(quantity="velocity", node=self.node, dof=self.dof, times=times),
        }

    @property
    def record(self) -> dict[str, Any]:
        """What it is, for a study to be known again by."""
        return asdict(self)


class Attractor(NamedTuple):
    """A steady motion that runs have ended on."""

    periods: int
    """After how many periods it comes back."""
    runs: int
    """How many runs have ended on it."""
    displacement: FloatArray
    """Its section in m, a point a period."""
    velocity: FloatArray
    """The same in m/s."""


class Classes(NamedTuple):
    """Which attractor each run has ended on."""

    numbers: NDArray[np.int64]
    """From 1, the one of most runs; 0 where a run came back to no point of its section."""
    attractors: tuple[Attractor, ...]


def classified(basins: Basins, displacement: FloatArray, velocity: FloatArray) -> Classes:
    """Return the attractors of runs.

    Parameters
    ----------
    basins
        How they are told apart.
    displacement, velocity
        Sections of all runs, (run, point); NaN where a run failed.

    Raises
    ------
    InputError
        If there are more attractors than anybody wants: the tolerance is too fine, or the runs
        are too short to settle.
    """
    points = np.stack([_scaled(displacement), _scaled(velocity)], axis=-1)
    periods = _periods(basins, points)
    found: list[tuple[int, NDArray[np.int64]]] = []
    for number in np.unique(periods[periods > 0]).tolist():
        left = np.flatnonzero(periods == number)
        for members in _alike(points[:, -number:], left, basins.tolerance):
            found.append((number, members))
            if len(found) > MOST_ATTRACTORS:
                hint = "make the runs longer, or the tolerance larger"
                what = f"more than {MOST_ATTRACTORS} attractors are found"
                raise InputError(what, key="basins.tolerance", value=basins.tolerance, hint=hint)
    found.sort(key=lambda each: (-len(each[1]), each[0], each[1][0]))
    numbers = np.zeros(len(points), dtype=np.int64)
    attractors = []
    for number, (back, members) in enumerate(found, start=1):
        numbers[members] = number
        one = members[0]
        section = (displacement[one, -back:].copy(), velocity[one, -back:].copy())
        attractors.append(Attractor(back, len(members), *section))
    return Classes(numbers, tuple(attractors))


def _scaled(values: FloatArray) -> FloatArray:
    """Return values relative to the largest."""
    largest = np.nanmax(np.abs(values), initial=0.0)
    return values / largest if largest > 0.0 else values


def _periods(basins: Basins, points: FloatArray) -> NDArray[np.int64]:
    """Return after how many periods each run comes back; 0 where it does not."""
    apart = [
        np.abs(points[:, number:] - points[:, :-number]).max(axis=(1, 2))
        for number in range(1, basins.most + 1)
    ]
    periods = np.zeros(len(points), dtype=np.int64)
    for number in range(1, basins.most + 1):
        # NaN is never small: runs that failed come back to nothing.
        back = (apart[number - 1] <= RETURNS * basins.tolerance) & (periods == 0)
        # What still spirals in may be nearer after three turns than after one.
        for part in (part for part in range(1, number + 1) if number % part == 0):
            periods[back & (periods == 0) & (apart[part - 1] <= basins.tolerance)] = part
    return periods


def _alike(
    points: FloatArray, runs: NDArray[np.int64], tolerance: float
) -> Iterator[NDArray[np.int64]]:
    """Yield the runs that have the same points, (run, point, 2), in whichever order of time."""
    while len(runs):
        first = points[runs[0]]
        shifted = [np.roll(first, shift, axis=0) for shift in range(len(first))]
        apart = [np.abs(points[runs] - each).max(axis=(1, 2)) for each in shifted]
        same = np.min(apart, axis=0) <= tolerance
        yield runs[same]
        runs = runs[~same]
