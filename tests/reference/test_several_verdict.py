"""The verdict itself: what is missed, false or inexact is found, and rounding is not blamed."""

from dataclasses import replace

import numpy as np
import pytest

from .several import verdict as judgement
from .several.problem import SeveralStops, Stop
from .several.random_problems import random_several
from .several.scan import Event, ScanSolution
from .several.verdict import LARGEST_GROWTH, compare, first_difference

SEED = 2


@pytest.fixture(scope="module")
def problem() -> SeveralStops:
    return random_several(SEED)


@pytest.fixture
def judge(problem: SeveralStops) -> ScanSolution:
    return ScanSolution(problem, LARGEST_GROWTH)


def test_a_contact_that_the_core_does_not_have_is_missed(
    problem: SeveralStops, judge: ScanSolution
) -> None:
    last = max(event.time for event in judge.events)
    stop = judge.events[-1].stop
    left = judge.end - last
    judge.events += [
        Event(last + 0.4 * left, stop, judge.events[-1].after, "closed"),
        Event(last + 0.6 * left, stop, "closed", "open"),
    ]
    verdict = compare(problem, judge)
    assert verdict.difference is not None
    assert verdict.difference.missed
    assert verdict.difference.time == pytest.approx(last + 0.4 * left)


def test_a_contact_that_only_the_core_has_is_false(
    problem: SeveralStops, judge: ScanSolution
) -> None:
    gone = judge.events[-1].stop
    removed = [n for n, event in enumerate(judge.events) if event.stop == gone][-2:]
    expected = judge.events[removed[0]].time
    judge.events = [event for n, event in enumerate(judge.events) if n not in removed]
    verdict = compare(problem, judge)
    assert verdict.difference is not None
    assert not verdict.difference.missed
    assert not verdict.undecidable
    assert verdict.difference.time == pytest.approx(expected)


def test_a_gap_that_is_slightly_wrong_is_seen(problem: SeveralStops) -> None:
    judge = ScanSolution(problem, LARGEST_GROWTH)
    assert compare(problem, judge).excess < 0.01
    stop = problem.stops[judge.events[0].stop]
    wrong = problem.but(
        stops=tuple(
            replace(s, gap=s.gap + 1e-8 * judge.sizes[0]) if s is stop else s for s in problem.stops
        )
    )
    assert compare(wrong, judge).excess > 1.0


def test_switches_that_undo_each_other_at_once_are_none() -> None:
    touched = [Event(0.5, 0, "open", "closed"), Event(0.5 + 1e-14, 0, "closed", "open")]
    assert first_difference([], touched, 1, 1.0) is None
    assert first_difference(touched[:1], touched[:1], 1, 1.0) is None


def barely_touching(depth: float) -> SeveralStops:
    """Return a mode that meets a stop once, by ``depth`` of the sizes its distance is made of."""
    reach = 0.5 / np.pi
    return SeveralStops(
        omega2=np.array([4 * np.pi**2]),
        damping=np.zeros(1),
        stops=(Stop(np.ones(1), reach * (1 - 2 * depth), 1e3, 0.0),),
        duration=1.0,
        displacement=np.zeros(1),
        velocity=np.ones(1),
        force=np.zeros(1),
    )


@pytest.mark.parametrize("depth", [1e-12, 1e-9])
def test_a_touch_of_a_trillionth_that_is_left_out_is_missed(
    depth: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = barely_touching(depth)
    verdict = compare(problem)
    assert verdict.events == 2
    assert verdict.difference is None
    monkeypatch.setattr(judgement, "core_events", lambda _: [])
    verdict = compare(problem)
    assert verdict.difference is not None
    assert verdict.difference.missed
    assert not verdict.undecidable


def test_an_opening_at_rest_on_the_gap_is_decided_by_rounding() -> None:
    # Both stops let go of a motion that damping has brought to rest, at 1e-12 of where it started.
    verdict = compare(random_several(24484))
    assert verdict.difference is None or verdict.undecidable


def test_a_displaced_event_away_from_the_gap_is_not_excused(
    problem: SeveralStops, judge: ScanSolution
) -> None:
    moved = judge.events[-1]
    later = moved.time + 0.3 * (judge.end - moved.time)
    judge.events[-1] = replace(moved, time=later)
    verdict = compare(problem, judge)
    assert verdict.difference is not None
    assert not verdict.undecidable
