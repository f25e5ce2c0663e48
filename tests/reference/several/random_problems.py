"""Seeded random problems of several stops that visit what is special.

Rigid, equal, uncoupled and critical modes; stops that face each other, that stand between two
points, that are mirrored so that they switch together, and starts at rest on them.
"""

from dataclasses import dataclass

import numpy as np

from ..problem import Array
from ..random_problems import frequencies, ratios
from .problem import SeveralStops, Stop

LARGEST_ANGLE = 600.0  # fastest rate times duration
MOST_STOPS = 5


@dataclass(frozen=True)
class _Modes:
    omega: Array
    damping: Array
    reference: float

    @property
    def count(self) -> int:
        return self.omega.size


def modes_of(rng: np.random.Generator) -> _Modes:
    """Return one to twelve modes."""
    count = int(rng.integers(1, 13))
    omega = frequencies(rng, count)
    reference = float(np.median(omega[omega > 0])) if omega.any() else 10.0
    damping = 2 * ratios(rng, count) * omega
    if omega[0] == 0.0 and rng.random() < 0.3:
        # Rigid modes with drag; rigid modes of different drag are refused under a push.
        damping[omega == 0.0] = reference * 10 ** rng.uniform(-2, 0)
    return _Modes(omega, damping, reference)


def random_row(rng: np.random.Generator, modes: int) -> Array:
    """Return the row of a point, or of the distance between two."""
    row = rng.normal(size=modes)
    if rng.random() < 0.2:
        row = row - rng.normal(size=modes)
    if rng.random() < 0.2:
        row[rng.integers(modes)] = 0.0
    if not row.any():
        row[0] = 1.0
    return row


def random_gap(rng: np.random.Generator, row: Array, reference: float) -> float:
    """Return a gap that is touched, a preload or none."""
    reach = float(np.abs(row).sum()) / reference
    kind = rng.choice([0.0, 1.0, 1.0, 1.0, -1.0])
    return reach * float(kind) * 10 ** float(rng.uniform(-3, -0.5))


def random_stop(rng: np.random.Generator, row: Array, modes: _Modes) -> Stop:
    """Return a stop on a row, from soft to stiff, with a damper or without."""
    norm = float(row @ row)
    stiffness = modes.reference**2 / norm * 10 ** float(rng.uniform(-2, 3))
    if rng.random() < 0.1:
        stiffness *= 1e4
    rate = np.sqrt(stiffness * norm + modes.omega.max() ** 2) + modes.damping.max()
    damping = 0.0
    if rng.random() < 0.3:
        damping = float(stiffness / rate * 10 ** rng.uniform(-3, 0.5))
    return Stop(row, random_gap(rng, row, modes.reference), float(stiffness), damping)


def random_stops(rng: np.random.Generator, modes: _Modes) -> tuple[Stop, ...]:
    """Return one to five stops, some facing each other."""
    stops: list[Stop] = []
    for _ in range(int(rng.integers(1, MOST_STOPS + 1))):
        if stops and rng.random() < 0.3:
            other = stops[-1]
            gap = abs(other.gap) if rng.random() < 0.5 else abs(other.gap) * rng.uniform(0.5, 2)
            stiffness = other.stiffness if rng.random() < 0.5 else 3 * other.stiffness
            stops.append(Stop(-other.row, float(gap), stiffness, other.damping))
        else:
            row = random_row(rng, modes.count)
            stops.append(random_stop(rng, row, modes))
    return tuple(stops)


def mirrored(rng: np.random.Generator, stops: tuple[Stop, ...]) -> tuple[Stop, ...]:
    """Put each of two stops also where the odd modes move the other way."""
    signs = np.where(np.arange(stops[0].row.size) % 2 == 0, 1.0, -1.0)
    return tuple(
        Stop(row, stop.gap, stop.stiffness, stop.damping)
        for stop in stops[: int(rng.integers(1, 3))]
        for row in (stop.row, signs * stop.row)
    )


def duration_of(rng: np.random.Generator, modes: _Modes, stops: tuple[Stop, ...]) -> float:
    """Return some periods of the slowest mode, but not too many of the fastest."""
    stiffness = sum(stop.stiffness * float(stop.row @ stop.row) for stop in stops)
    damping = sum(stop.damping * float(stop.row @ stop.row) for stop in stops)
    rate = np.sqrt(stiffness + modes.omega.max() ** 2) + modes.damping.max() + damping
    slow = modes.omega[modes.omega > 0]
    slowest = float(slow.min()) if slow.size else modes.reference
    periods = float(rng.uniform(2, 10)) * 2 * np.pi / slowest
    return min(periods, LARGEST_ANGLE / float(rate))


def random_several(seed: int) -> SeveralStops:
    """Return one problem of 1 to 12 modes and 1 to 5 stops under a constant force."""
    rng = np.random.default_rng(seed)
    modes = modes_of(rng)
    stops = random_stops(rng, modes)
    force = np.zeros(modes.count)
    for stop in stops:
        if rng.random() < 0.3:
            force -= stop.row * modes.reference * 10 ** rng.uniform(-2, 0.5)
    if rng.random() < 0.2:
        force += rng.normal(size=modes.count) * modes.reference
    displacement = np.zeros(modes.count)
    if rng.random() < 0.5:
        displacement = rng.normal(size=modes.count) / modes.reference * 10 ** rng.uniform(-3, 0)
    velocity = rng.normal(size=modes.count) * float(rng.random() > 0.05)
    if modes.count > 1 and rng.random() < 0.15:
        stops = mirrored(rng, stops)
        for motion in (force, displacement, velocity):
            motion[1::2] = 0.0
    return SeveralStops(
        omega2=modes.omega**2,
        damping=modes.damping,
        stops=stops,
        duration=duration_of(rng, modes, stops),
        displacement=displacement,
        velocity=velocity,
        force=force,
    )
