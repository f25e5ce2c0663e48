"""The exact method with several stops on random problems: no event missed, none invented."""

import pytest

from .several.random_problems import random_several
from .several.verdict import compare


@pytest.mark.parametrize("seed", range(1000, 1060))
def test_random_problem_of_several_stops(seed: int) -> None:
    verdict = compare(random_several(seed))
    assert verdict.difference is None or verdict.undecidable
    assert verdict.excess < 1.0
