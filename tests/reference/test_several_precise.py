"""The exact method with several stops against fifty digits, over fifty events."""

import pytest

from .several.precise import PreciseSeveral
from .several.random_problems import random_several
from .several.verdict import LARGEST_GROWTH, compare

EVENTS = 50


@pytest.mark.parametrize("seed", [1, 13, 14, 17, 19, 21])
def test_states_after_fifty_events(seed: int) -> None:
    problem = random_several(seed)
    judge = PreciseSeveral(problem, EVENTS, LARGEST_GROWTH)
    verdict = compare(problem, judge)
    assert len(judge.events) >= 20
    assert verdict.difference is None
    assert verdict.excess < 1.0
