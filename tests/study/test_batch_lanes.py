"""Batches eight runs at a time: against single runs, and against fifty digits."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

import bumpstop as bs
from bumpstop.arguments import FloatArray
from tests.hinged_beam import SWING, hinged_modes
from tests.reference.precise import PreciseSolution
from tests.reference.problem import StopProblem

RUNS = 4000
TIMES = np.linspace(0.0, 0.02, 13)
KEPT = {
    "tip": bs.Output(quantity="displacement", node="B", dof="dy", times=TIMES.tolist()),
    "speed": bs.Output(quantity="velocity", node="B", dof="dy", times=TIMES.tolist()),
    "force": bs.Output(quantity="stop_force", stop="spring", times=TIMES.tolist()),
    "first": bs.Output(quantity="impact_start", stop="spring", impact=1),
    "end": bs.Output(quantity="impact_end", stop="spring", statistic="last"),
    "closing": bs.Output(quantity="closing_speed", stop="spring", statistic="maximum"),
    "largest": bs.Output(quantity="largest_force", stop="spring"),
    "peak": bs.Output(quantity="peak_force", stop="spring", impact=1),
    "when": bs.Output(quantity="peak_time", stop="spring", impact=1),
    "impacts": bs.Output(quantity="impacts"),
    "events": bs.Output(quantity="events"),
}
COUNTS = ("impacts", "events")


def beam(force: float = 0.0) -> bs.Problem:
    """Return the hinged beam of SDNL32, pushed at its tip perhaps."""
    loads = [bs.NodalForce("push", node="B", force=(0, force, 0))] if force else []
    stop = bs.Stop("spring", node="B", normal=(0, 1, 0), stiffness=18e3)
    return bs.Problem(hinged_modes(), laws=[stop], loads=loads, initial=SWING, duration=0.02)


def drawn(runs: int = RUNS) -> dict[str, FloatArray]:
    rng = np.random.default_rng(32)
    gap = np.where(rng.random(runs) < 0.3, 0.0, rng.uniform(-1e-4, 3e-3, runs))
    return {
        "stops.spring.stiffness": np.exp(rng.uniform(np.log(3e3), np.log(1e6), runs)),
        "stops.spring.gap": gap,
        "initial.velocity": rng.uniform(-0.5, 1.5, runs),
    }


@pytest.mark.parametrize("force", [0.0, -30.0])
def test_lanes_agree_with_single_runs_and_no_event_differs(force: float) -> None:
    problem, varied = beam(force), drawn()
    single, lanes = (bs.batch(problem, varied, KEPT, lanes=each) for each in (False, True))
    for key in KEPT:
        one, other = single[key].values, lanes[key].values
        if key in COUNTS:
            assert np.array_equal(one, other)
            continue
        size = np.nanmax(np.abs(one))
        np.testing.assert_allclose(other, one, rtol=0, atol=1e-13 * size)
    assert not np.array_equal(single.tip, lanes.tip)  # they were made in another way
    assert np.unique(lanes.events).size > 3


def test_lanes_against_fifty_digits() -> None:
    problem, varied = beam(), drawn()
    found = bs.batch(problem, varied, KEPT).tip.values
    basis = problem.basis
    assert problem.initial is not None
    _, velocity = problem.initial.modal_state(basis)
    for run in range(6):
        exact = StopProblem(
            omega2=basis.omega2,
            damping=basis.damping,
            row=basis.row("B", "dy"),
            stiffness=float(varied["stops.spring.stiffness"][run]),
            gap=float(varied["stops.spring.gap"][run]),
            velocity=float(varied["initial.velocity"][run]) * velocity,
            duration=0.02,
        )
        tip = PreciseSolution(exact).motion(TIMES)[0] @ exact.row
        assert found[run] == pytest.approx(tip, rel=0, abs=1e-13 * np.abs(tip).max())


def test_the_largest_force_is_that_of_the_response() -> None:
    problem, varied = beam(-30.0), drawn(40)
    force = KEPT["largest"]
    found = bs.batch(problem, varied, {"largest": force})
    assert problem.initial is not None
    _, velocity = problem.initial.modal_state(problem.basis)
    for run in range(40):
        stiffness, gap, scale = (float(values[run]) for values in varied.values())
        start = bs.ModalState(velocity=scale * velocity)
        stop = bs.Stop("spring", node="B", normal=(0, 1, 0), stiffness=stiffness, gap=gap)
        response = bs.simulate(replace(problem, laws=[stop], initial=start), method="exact")
        expected = force.value(response)
        assert found.largest[run] == pytest.approx(expected, rel=1e-13, abs=1e-10, nan_ok=True)


def test_no_bit_depends_on_the_runs_beside() -> None:
    problem, varied = beam(), drawn()

    def kept(chosen: slice | NDArray[np.int_], workers: int) -> FloatArray:
        part = {key: np.ascontiguousarray(values[chosen]) for key, values in varied.items()}
        found = bs.batch(problem, part, KEPT, workers=workers)
        return np.column_stack([found[key].values.reshape(len(found.run), -1) for key in KEPT])

    whole = kept(slice(None), 1)
    order = np.random.default_rng(1).permutation(RUNS)
    assert np.array_equal(kept(order, 2), whole[order], equal_nan=True)
    assert np.array_equal(kept(slice(1000, 2003), 3), whole[1000:2003], equal_nan=True)
    assert np.array_equal(kept(slice(77, 78), 1), whole[77:78], equal_nan=True)


def test_what_lanes_do_not_read_is_read_from_single_runs() -> None:
    kept = {"impulse": bs.Output(quantity="impulse", stop="spring", statistic="maximum")}
    varied = drawn(50)
    single, lanes = (bs.batch(beam(), varied, kept, lanes=each) for each in (False, True))
    assert np.array_equal(single.impulse, lanes.impulse, equal_nan=True)


def test_a_failed_run_fails_alone() -> None:
    varied = drawn(20)
    varied["stops.spring.stiffness"][3] = -1.0
    varied["stops.spring.gap"][9] = np.nan
    varied["initial.velocity"][12] = np.inf
    found = bs.batch(beam(), varied, KEPT)
    assert np.flatnonzero(found.failed).tolist() == [3, 9, 12]
    assert np.flatnonzero(np.isnan(found.tip).any("tip_time")).tolist() == [3, 9, 12]
