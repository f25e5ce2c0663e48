"""Sliding phases that are unstable: growth, certificate and bound against matrix exponentials.

Sliding makes the stiffness unsymmetric; with mu = 1 two modes may then couple to one motion that
grows and one that decays (mode coupling, flutter).
"""

import numpy as np
import pytest

from .problem import Array
from .several.flow import Flow
from .several.laws.friction_stop import SLIP, FrictionStop
from .several.laws.stop import Stop
from .several.problem import SeveralStops
from .several.scan import ScanSolution
from .several.verdict import EPSILON

FRICTION, PRELOAD, SPEED = 1.0, 1e-3, 500.0
GROWTH = 5.0  # in exponents, over a run


def belt(seed: int) -> tuple[SeveralStops, float]:
    """Return modes that are pressed on a fast belt, and the growth rate while it slides on."""
    rng = np.random.default_rng([seed, 9])
    modes = int(rng.integers(2, 6))
    omega = np.sort(rng.uniform(500.0, 1500.0, modes))
    normal, tangent = rng.normal(size=(2, modes))
    stiffness = float(10 ** rng.uniform(5.5, 6.2)) / float(normal @ normal)
    damping = 2 * float(10 ** rng.uniform(-4, -2)) * omega
    law = FrictionStop(
        Stop(np.append(normal, 0.0), -PRELOAD, stiffness),
        np.append(tangent, 1.0),
        FRICTION,
        FRICTION,
        1e3 * stiffness,
    )
    pull = np.outer(normal - FRICTION * tangent, normal) * stiffness
    held = stiffness * PRELOAD * (normal - FRICTION * tangent)
    rest = np.linalg.solve(np.diag(omega**2) + pull, held)
    nudge = 1e-4 * np.linalg.norm(rest) * rng.normal(size=modes)
    problem = SeveralStops(
        omega2=np.append(omega**2, 0.0),
        damping=np.append(damping, 0.0),
        stops=(),
        others=(law,),
        duration=1.0,
        displacement=np.append(rest + nudge, 0.0),
        velocity=np.append(np.zeros(modes), SPEED),
    )
    flow = Flow.of(ScanSolution(problem.but(duration=1e-6)).layout, (SLIP[1],))
    rate = float(np.linalg.eigvals(flow.matrix).real.max())
    return problem.but(duration=GROWTH / max(rate, 1.0)), rate


UNSTABLE = [seed for seed in range(60) if belt(seed)[1] > 60.0]


def test_many_sliding_phases_are_unstable() -> None:
    assert len(UNSTABLE) > 10


def spread(problem: SeveralStops, motion: Array) -> Array:
    """Return how far the modes but the belt are from their middle, over time."""
    away = motion[:, :-1] - motion[:, :-1].mean(axis=0)
    size: Array = np.linalg.norm(away * np.sqrt(problem.omega2[:-1]), axis=1)
    return size


@pytest.mark.parametrize("seed", UNSTABLE[:10])
def test_a_growing_phase_is_that_of_the_matrix_exponential(seed: int) -> None:
    problem, rate = belt(seed)
    history = problem.solve()
    judge = ScanSolution(problem)
    assert set(history.events()["after"]) <= {SLIP[1]}
    times = np.linspace(0.0, problem.duration, 400)
    wanted, found = judge.motion(times)[0], history.motion(times, 0)
    # The belt runs far, and its rounding is felt by the others, but no more than that.
    allowed = (
        1e-11 * np.abs(wanted[:, :-1]).max() + 4 * EPSILON * np.exp(GROWTH) * np.abs(wanted).max()
    )
    assert np.abs(found - wanted)[:, :-1].max() < allowed
    bound = history.motion_error
    assert bound is not None
    assert np.abs((found - wanted) @ problem.others[0].coordinates[0][0]).max() <= bound
    assert np.isfinite(bound)
    assert history.energy_residual() < 1e-11
    # The last third grows by its exponent.
    late = spread(problem, found[266:])
    tops = [late[:67].max(), late[67:].max()]
    assert tops[1] > tops[0] or rate * problem.duration < 3


@pytest.mark.parametrize("seed", UNSTABLE[:5])
def test_a_stop_that_the_growing_motion_reaches_is_found(seed: int) -> None:
    problem, _ = belt(seed)
    judge = ScanSolution(problem)
    row = np.append(np.random.default_rng(seed).normal(size=problem.omega2.size - 1), 0.0)
    times = np.linspace(0.0, problem.duration, 4000)
    path = judge.motion(times)[0] @ row
    # Reached in the last tenth only.
    level = path[:3600].min() - 0.05 * float(np.ptp(path[:3600]))
    stopped = problem.but(stops=(Stop(row, -level, 1.0),))
    judge, history = ScanSolution(stopped), stopped.solve()
    expected = [event.time for event in judge.events if event.stop == 0]
    events = history.events()
    found = [t for t, law in zip(events["time"], events["law"], strict=True) if law == 0]
    # The instant of a touch that is nearly a graze is that much less certain than its place.
    assert found == pytest.approx(expected, rel=1e-7)
    assert len(found) > 0 or path[3600:].min() > level
