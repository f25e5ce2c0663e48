"""Continuation: up and down across a resonance that a stop bends."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs

FREQUENCY, DURATION = "loads.shaker.harmonics.0.frequency", "run.duration"
PERIODS = 80

CASE = Path(__file__).parents[2] / "docs" / "studies" / "swing" / "case.toml"


@pytest.fixture
def case() -> bs.Case:
    return bs.load_case(CASE)


def swings(case: bs.Case, frequencies: np.ndarray) -> np.ndarray:
    """Return the largest displacement in the last periods of each run."""
    found = []
    along = {DURATION: PERIODS / frequencies}
    for value, response in bs.continuation(case, FREQUENCY, frequencies, along=along):
        duration = response.problem.duration
        late = np.linspace(duration - 3.0 / value, duration, 600)
        found.append(np.abs(response.sample("displacement", "P", "dx", times=late)).max())
    return np.array(found)


def test_up_and_down_end_on_different_branches(case: bs.Case) -> None:
    frequencies = np.round(np.arange(1.0, 2.0001, 0.05), 10)
    up = swings(case, frequencies)
    down = swings(case, frequencies[::-1])[::-1]
    # Far from the bent resonance there is one motion.
    assert up[-1] == pytest.approx(down[-1], rel=0.01)
    # Within, the sweep up keeps the impacting motion, and the one down that without impacts,
    # whose amplitude is that of the linear oscillator.
    apart = up > 1.5 * down
    assert apart.any()
    ratio = frequencies[apart]
    linear = 1.0 / (2 * np.pi) ** 2 / np.sqrt((1 - ratio**2) ** 2 + (0.06 * ratio) ** 2)
    assert down[apart] == pytest.approx(linear, rel=0.02)
    assert (linear < 0.05).all()
    assert (up[apart] > 0.05).all()


def test_each_run_starts_where_the_last_one_ended(case: bs.Case) -> None:
    gaps = bs.Range(0.02, 0.01, 3)
    runs = [response for _, response in bs.continuation(case, "stops.wall.gap", gaps)]
    for before, after in pairwise(runs):
        for order in (0, 1):
            end = before.motion(order, [before.problem.duration])
            assert after.motion(order, [0.0]) == pytest.approx(end, rel=1e-14)
    assert [run.problem.laws[0].gap for run in runs] == [0.02, 0.015, 0.01]  # type: ignore[attr-defined]


def test_what_cannot_go_on(case: bs.Case) -> None:
    with pytest.raises(bs.InputError, match="changes the modes"):
        list(bs.continuation(case, "masses.mass.mass", [1.0, 2.0]))
    with pytest.raises(bs.InputError, match="has 1 values, and"):
        bs.continuation(case, FREQUENCY, [1.0, 2.0], along={DURATION: [1.0]})
    with pytest.raises(bs.InputError, match="did you mean 'wall'"):
        bs.continuation(case, "stops.wal.gap", [1.0])
    with pytest.raises(bs.InputError, match="is what changes already"):
        bs.continuation(case, FREQUENCY, [1.0, 2.0], along={FREQUENCY: [1.0, 2.0]})
