"""Structures among several stops, and free vibrations that touch one stop only briefly."""

import numpy as np

from tests.reference.problem import Array
from tests.reference.several.problem import SeveralStops, Stop

FUNDAMENTAL = 10.0  # Hz
DAMPING_RATIO = 0.01
STOP_STIFFNESS = 1e5
PERIODS = 3.0
CLEARANCE = 0.3  # of the free motion
BRIEF_MODES = 6
BRIEF_SECONDS = 5.0


def line(
    modes: int, stops: int, *, damping_ratio: float = DAMPING_RATIO, periods: float = PERIODS
) -> SeveralStops:
    """Return a taut line with stops at about equal distances, in turn on either side.

    Its frequencies lie as densely as those of frames and pipework, nearly evenly.
    """
    rng = np.random.default_rng(4)
    number = np.arange(1, modes + 1)
    omega = 2 * np.pi * FUNDAMENTAL * (number + rng.uniform(-0.1, 0.1, modes))
    places = np.arange(1, stops + 1) / (stops + 1) + rng.uniform(-0.02, 0.02, stops)
    shapes = np.sqrt(2) * np.sin(np.pi * np.outer(places, number))
    velocity = np.where(number <= 6, rng.normal(size=modes), 0.0)
    problem = SeveralStops(
        omega2=omega**2,
        damping=2 * damping_ratio * omega,
        stops=(),
        duration=periods / FUNDAMENTAL,
        displacement=np.zeros(modes),
        velocity=velocity,
    )
    rows = shapes * np.where(np.arange(stops) % 2 == 0, 1.0, -1.0)[:, None]
    times = np.linspace(0.0, 1.0 / FUNDAMENTAL, 1000)
    reach = np.abs(free_motion(problem, times) @ rows.T).max(axis=0)
    placed = zip(rows, CLEARANCE * reach, strict=True)
    return problem.but(stops=tuple(Stop(row, float(gap), STOP_STIFFNESS) for row, gap in placed))


def bundle(tubes: int, modes: int) -> SeveralStops:
    """Return equal lines side by side, each with a stop of its own and a start of its own."""
    one = line(modes, 1)
    stop = one.stops[0]
    speeds: Array = np.random.default_rng(5).uniform(0.7, 1.3, tubes)
    rows = np.kron(np.eye(tubes), stop.row)
    return SeveralStops(
        omega2=np.tile(one.omega2, tubes),
        damping=np.tile(one.damping, tubes),
        stops=tuple(Stop(row, stop.gap, stop.stiffness) for row in rows),
        duration=one.duration,
        displacement=np.zeros(tubes * modes),
        velocity=np.outer(speeds, one.velocity).ravel(),
    )


def free_motion(problem: SeveralStops, times: Array) -> Array:
    """Return what velocities at the start make of underdamped modes, (time, mode)."""
    decay = problem.damping / 2
    rates = np.sqrt(problem.omega2 - decay**2)
    motion: Array = (
        np.exp(-np.outer(times, decay)) * np.sin(np.outer(times, rates)) * problem.velocity / rates
    )
    return motion


def brief_touch(depth: float, seed: int) -> SeveralStops:
    """Return six free modes whose deepest swing of a run goes a relative depth into a stop."""
    rng = np.random.default_rng(seed)
    while True:
        omega = 2 * np.pi * rng.uniform(1.0, 10.0, BRIEF_MODES)
        row = rng.normal(size=BRIEF_MODES)
        problem = SeveralStops(
            omega2=omega**2,
            damping=2 * 1e-3 * omega,
            stops=(),
            duration=BRIEF_SECONDS,
            displacement=np.zeros(BRIEF_MODES),
            velocity=rng.normal(size=BRIEF_MODES),
        )
        times = np.linspace(0.0, BRIEF_SECONDS, 100_001)
        path = free_motion(problem, times) @ row
        deepest = int(np.argmin(path))
        if 0 < deepest < path.size - 1:  # it turns there, and is not cut off by the run's end
            break
    # A parabola through the deepest sample and its neighbours is right to 1e-9 of the swing.
    left, middle, right = path[deepest - 1 : deepest + 2]
    lowest = middle - (right - left) ** 2 / (8 * (left - 2 * middle + right))
    gap = -lowest - depth * np.abs(path).max()
    stiffness = 1e2 * np.median(omega) ** 2
    return problem.but(stops=(Stop(row, float(gap), float(stiffness)),))
