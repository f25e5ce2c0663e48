"""Several stops, each on modes of its own, against each structure alone at fifty digits."""

import pytest

from .problem import StopProblem
from .random_problems import random_problem
from .several.agreement import agreement
from .several.blocks import BlockSolution, side_by_side

UNDECIDABLE = 1e-11


def check(problems: list[StopProblem]) -> None:
    """Hold structures solved as one against each alone."""
    oracle = BlockSolution(problems)
    assert oracle.margin > UNDECIDABLE, "choose other seeds: one grazes"
    result = agreement(side_by_side(problems), oracle)
    assert result.same_events
    assert result.event_error < 1e-11
    assert result.state_error < 1e-10
    assert result.energy_residual < 1e-11


@pytest.mark.parametrize("first", [0, 16, 28, 36, 60, 80, 104])
def test_structures_that_do_not_touch_each_other(first: int) -> None:
    check([random_problem(seed) for seed in range(first, first + 4)])


@pytest.mark.parametrize("seed", [18, 36, 84])
def test_equal_structures(seed: int) -> None:
    check([random_problem(seed)] * 3)
