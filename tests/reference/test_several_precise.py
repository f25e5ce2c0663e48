"""Fifty digits: against the judge by matrix exponentials, and the exact method against them."""

import numpy as np
import pytest

from .several.forced import random_forced
from .several.multilinear import random_multilinear
from .several.precise import PreciseSeveral
from .several.problem import SeveralStops, Stop
from .several.random_problems import random_several
from .several.rubbing import random_rubbing
from .several.scan import ScanSolution
from .several.verdict import EPSILON, LARGEST_GROWTH, by_stop, compare, inner

EVENTS = 50


PROBLEMS = {
    **{f"stops-{seed}": random_several(seed) for seed in (1, 13, 14, 17, 19, 21)},
    **{f"friction-{seed}": random_rubbing(seed) for seed in (1, 13, 14, 17)},
    **{f"springs-{seed}": random_multilinear(seed) for seed in (1, 14, 17)},
}


@pytest.mark.parametrize("problem", PROBLEMS.values(), ids=PROBLEMS)
def test_states_after_fifty_events(problem: SeveralStops) -> None:
    judge = PreciseSeveral(problem, EVENTS, LARGEST_GROWTH)
    verdict = compare(problem, judge)
    assert len(judge.events) >= 20
    assert verdict.difference is None
    assert verdict.excess < 1.0


def string_between_stops(modes: int = 200) -> SeveralStops:
    """Return the modes of a string that is struck, and hits three stops one after the other."""
    number = np.arange(1, modes + 1)
    omega = 2.0 * np.pi * np.linspace(10.0, 300.0, modes)
    places, gaps = (0.4, 0.52, 0.58), (1e-5, 2e-5, 3e-5)
    stops = zip(places, gaps, (2e5, 1e6, 5e4), (0.0, 30.0, 5.0), strict=True)
    return SeveralStops(
        omega2=omega**2,
        damping=0.02 * omega,
        stops=tuple(Stop(np.sin(np.pi * at * number), *rest) for at, *rest in stops),
        duration=8e-3,
        displacement=np.zeros(modes),
        velocity=-0.1 * np.sin(np.pi * 0.47 * number) * np.exp(-((number / 60.0) ** 2)),
    )


def test_hundreds_of_modes_among_several_stops() -> None:
    problem = string_between_stops()
    judge = PreciseSeveral(problem, EVENTS, LARGEST_GROWTH)
    verdict = compare(problem, judge)
    assert len(judge.events) == 13
    assert {event.stop for event in judge.events} == {0, 1, 2}
    assert verdict.difference is None
    assert verdict.error < 1e-12


@pytest.mark.parametrize("seed", [3, 6, 13, 16, 17, 23])
def test_the_judges_agree_under_forces_in_time(seed: int) -> None:
    problem = random_forced(seed)
    precise = PreciseSeveral(problem, EVENTS, LARGEST_GROWTH)
    scan = ScanSolution(problem, LARGEST_GROWTH)
    expected, found = inner(precise.events, precise), inner(scan.events, precise)
    for stop in range(len(problem.stops)):
        left, right = (by_stop(events, stop, 1e-12 * precise.end) for events in (expected, found))
        assert [(e.before, e.after) for e in left] == [(e.before, e.after) for e in right]
    times = np.linspace(0.0, precise.end, 25)
    allowed = 1e-12 + 20 * EPSILON * scan.growth
    for wanted, given in zip(precise.motion(times), scan.motion(times), strict=True):
        assert given == pytest.approx(wanted, abs=allowed * np.abs(wanted).max())
