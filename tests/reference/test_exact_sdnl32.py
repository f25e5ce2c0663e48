"""The exact method on SDNL32, from modal data and through the whole chain."""

import numpy as np
import pytest

import bumpstop as bs

from ..hinged_beam import SWING, end_stop, hinged_modes
from . import sdnl32
from .comparison import core_events
from .precise import PreciseSolution

STIFFNESSES = tuple(sdnl32.EXACT)


@pytest.mark.parametrize("stiffness", STIFFNESSES)
def test_from_modal_data_to_rounding(stiffness: float) -> None:
    problem = sdnl32.clean(stiffness)
    solution, history = PreciseSolution(problem), problem.solve()
    times = np.linspace(0.0, sdnl32.DURATION, 101)
    for derivative, expected in enumerate(solution.motion(times)):
        found = history.motion(times, derivative)
        assert found == pytest.approx(expected, abs=1e-13 * np.abs(expected).max())
    assert [e[1:] for e in core_events(history)] == [e[1:] for e in solution.events]
    assert core_events(history)[0][0] == pytest.approx(solution.events[0][0], abs=1e-15)


@pytest.mark.parametrize("stiffness", STIFFNESSES)
def test_the_stop_sees_what_the_oracle_sees(stiffness: float) -> None:
    problem = sdnl32.clean(stiffness)
    times = np.linspace(0.0, sdnl32.DURATION, 101)
    distance, force = PreciseSolution(problem).contact(times)
    found_distance, _, found_force = problem.solve().law_motion(0, times)
    assert found_distance == pytest.approx(distance, abs=1e-13 * np.abs(distance).max())
    assert found_force == pytest.approx(force, abs=1e-13 * np.abs(force).max())


def whole_chain(stiffness: float) -> bs.Problem:
    """Return the published problem as a user states it."""
    return bs.Problem(
        hinged_modes(),
        laws=[end_stop(stiffness)],
        initial=SWING,
        duration=sdnl32.DURATION,
        sample=1e-5,
    )


@pytest.mark.parametrize("stiffness", STIFFNESSES)
def test_from_elements_to_tip(stiffness: float) -> None:
    reference = sdnl32.clean(stiffness)
    solution = PreciseSolution(reference)
    response = bs.simulate(whole_chain(stiffness), method="exact")
    tip = response.sample("displacement", "B", "dy", times=sdnl32.TIMES)
    oracle = solution.motion(sdnl32.TIMES)[0] @ reference.row
    scale = np.abs(oracle).max()
    assert tip == pytest.approx(oracle, abs=1e-9 * scale)
    assert tip == pytest.approx(np.array(sdnl32.EXACT[stiffness]), abs=1e-9 * scale)
    assert response.events["time"].iloc[0] == pytest.approx(solution.events[0][0], abs=1e-10)
