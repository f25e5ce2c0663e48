"""The judge of several stops against closed forms, the one-stop oracle and itself."""

from itertools import pairwise

import numpy as np
import pytest

from .precise import PreciseSolution
from .problem import Array, StopProblem
from .random_problems import random_problem
from .several.loads import Harmonic, Polynomial, Table
from .several.problem import SeveralStops, Stop
from .several.random_problems import random_several
from .several.scan import ScanSolution

ONE = np.ones(1)
TIMES: Array = np.linspace(0.0, 1.0, 11)


def mass(**changes: object) -> SeveralStops:
    """Return a free unit mass at rest."""
    return SeveralStops(0 * ONE, 0 * ONE, (), 1.0, 0 * ONE, 0 * ONE).but(**changes)


def test_a_mass_between_two_walls() -> None:
    # Half a period of 10 ms at each wall, flights of 0.2 m at 2 m/s between them.
    stiffness = (np.pi / 0.01) ** 2
    walls = (Stop(ONE, 0.1, stiffness), Stop(-ONE, 0.1, stiffness))
    solution = ScanSolution(mass(stops=walls, velocity=2 * ONE))
    expected, time = [], 0.05
    for impact in range(9):
        expected += [(time, 1 - impact % 2), (time + 0.01, 1 - impact % 2)]
        time += 0.11
    assert [event.stop for event in solution.events] == [stop for _, stop in expected]
    assert [event.time for event in solution.events] == pytest.approx(
        [time for time, _ in expected], abs=2e-13
    )


def as_several(problem: StopProblem) -> SeveralStops:
    """Return the same problem for the judge of several stops."""
    stop = Stop(problem.row, problem.gap, problem.stiffness, problem.stop_damping)
    return SeveralStops(
        omega2=problem.omega2,
        damping=problem.damping,
        stops=(stop,),
        duration=problem.duration,
        displacement=problem.displacement,
        velocity=problem.velocity,
        force=problem.force,
    )


@pytest.mark.parametrize("seed", range(8))
def test_one_stop_is_as_the_fifty_digits_say(seed: int) -> None:
    problem = random_problem(seed)
    precise, judge = PreciseSolution(problem), ScanSolution(as_several(problem), 1e6)
    expected = [event for event in precise.events if event[0] < judge.end]
    found = [(event.time, event.before, event.after) for event in judge.events]
    assert [event[1:] for event in expected] == [event[1:] for event in found]
    times = np.linspace(0.0, judge.end, 9)
    tolerance = 1e-12 + 2e-14 * judge.growth
    for left, right in zip(precise.motion(times), judge.motion(times), strict=True):
        assert left == pytest.approx(right, abs=tolerance * np.abs(left).max())


@pytest.mark.parametrize("seed", [5, 17, 29, 41])
def test_the_step_of_the_scan_does_not_matter(seed: int) -> None:
    judge = ScanSolution(random_several(seed), 1e4)
    other = ScanSolution(random_several(seed).but(duration=judge.end), per_period=157)
    times = np.linspace(0.0, judge.end, 30)
    for left, right in zip(judge.motion(times), other.motion(times), strict=True):
        assert left == pytest.approx(right, abs=1e-9 * np.abs(left).max())


@pytest.mark.parametrize("seed", [5, 41])
def test_no_neighbour_goes_further_away_than_the_growth_says(seed: int) -> None:
    problem = random_several(seed)
    judge = ScanSolution(problem, 1e4)
    n, end, tiny = problem.omega2.size, np.array([judge.end]), 1e-8
    size = np.repeat(judge.sizes, n)
    here = np.concatenate(judge.motion(end), axis=1)[0]
    squares = 0.0
    for nudge in tiny * np.diag(size):
        neighbour = ScanSolution(
            problem.but(
                duration=judge.end,
                displacement=problem.displacement + nudge[:n],
                velocity=problem.velocity + nudge[n:],
            )
        )
        there = np.concatenate(neighbour.motion(end), axis=1)[0]
        squares += float(np.sum(((there - here) / size / tiny) ** 2))
    assert squares <= judge.growth**2 * 1.001
    assert judge.growth**2 <= squares * 4 * len(judge.anchors) ** 2


LOADS = {
    "polynomial": Polynomial(ONE, (1.0, -2.0, 3.0)),
    "harmonic": Harmonic(ONE, 3.0, 0.4),
    "table": Table(ONE, np.array([0.0, 0.35, 1.0]), np.array([0.0, 0.35, -0.3])),
}


def second_integral(kind: str, t: Array) -> Array:
    """Return what vanishes at t = 0 with its rate and has the load as its second derivative."""
    integrals: dict[str, Array] = {
        "polynomial": t**2 / 2 - t**3 / 3 + t**4 / 4,
        "harmonic": (np.cos(0.4) - 3 * t * np.sin(0.4) - np.cos(3 * t + 0.4)) / 9,
        "table": t**3 / 6 - np.maximum(t - 0.35, 0.0) ** 3 / 3,
    }
    return integrals[kind]


@pytest.mark.parametrize("kind", LOADS)
def test_a_free_mass_integrates_its_load_twice(kind: str) -> None:
    found = ScanSolution(mass(loads=(LOADS[kind],))).motion(TIMES)[0][:, 0]
    assert found == pytest.approx(second_integral(kind, TIMES), abs=1e-15)


@pytest.mark.parametrize("kind", LOADS)
def test_an_oscillator_convolves_its_load(kind: str) -> None:
    # x = g - omega int sin(omega (t - s)) g(s) ds with g the second integral of the load.
    omega = 7.0
    problem = mass(omega2=omega**2 * ONE, loads=(LOADS[kind],))
    found = ScanSolution(problem).motion(TIMES)[0][:, 0]
    nodes, weights = np.polynomial.legendre.leggauss(40)
    for time, value in zip(TIMES, found, strict=True):
        total = float(second_integral(kind, time))
        for left, right in pairwise((0.0, min(0.35, time), time)):
            s = left + (right - left) * (nodes + 1) / 2
            kernel = omega * np.sin(omega * (time - s)) * second_integral(kind, s)
            total -= float(weights @ kernel) * (right - left) / 2
        assert value == pytest.approx(total, abs=1e-14)


def test_undamped_resonance_grows_with_time() -> None:
    problem = mass(omega2=49.0 * ONE, loads=(Harmonic(ONE, 7.0),))
    found = ScanSolution(problem).motion(TIMES)[0][:, 0]
    assert found == pytest.approx(TIMES * np.sin(7 * TIMES) / 14, abs=1e-15)
