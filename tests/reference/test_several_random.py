"""The exact method with several stops on random problems: no event missed, none invented."""

import pytest

from .several.coupled import random_coupled
from .several.grazing import random_grazing
from .several.problem import SeveralStops
from .several.random_problems import random_several
from .several.verdict import compare


def check(problem: SeveralStops) -> None:
    """Hold the core against the judge."""
    verdict = compare(problem)
    assert verdict.difference is None or verdict.undecidable
    assert verdict.excess < 1.0
    assert verdict.energy < 1e-9


@pytest.mark.parametrize("seed", range(1000, 1060))
def test_random_problem_of_several_stops(seed: int) -> None:
    check(random_several(seed))


@pytest.mark.parametrize("seed", [2, 3, 4, 6, 7, 10, 14, 17, 21, 22])
def test_random_problem_of_coupled_modes(seed: int) -> None:
    check(random_coupled(seed))


@pytest.mark.parametrize("seed", [0, 1, 2, 4, 5, 6, 7, 8, 9, 10])
def test_random_problem_of_a_stop_only_just_touched(seed: int) -> None:
    check(random_grazing(seed))
