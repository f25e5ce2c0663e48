"""Batches: against closed forms, and to the bit against runs one by one."""

import math
import tracemalloc
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from numpy.typing import NDArray

import bumpstop as bs
from bumpstop.arguments import FloatArray
from bumpstop.study.evaluation import Evaluator
from tests.study.bouncing import written

SPEED, MASS, GAP = 3.0, 2.0, 0.25
KEPT = {
    "place": bs.Output(quantity="displacement", node="P", dof="dx", times=[0.01, 0.2]),
    "speed": bs.Output(quantity="velocity", node="P", dof="dx", statistic="last"),
    "gap": bs.Output(quantity="gap", stop="wall", times=[0.1]),
    "push": bs.Output(quantity="stop_force", stop="wall", times=[0.09, 0.1]),
    "highest": bs.Output(quantity="displacement", node="P", dof="dx", statistic="maximum"),
    "lowest": bs.Output(quantity="gap", stop="wall", statistic="minimum"),
    "fastest": bs.Output(quantity="velocity", node="P", dof="dx", statistic="peak"),
    "hardest": bs.Output(quantity="stop_force", stop="wall", statistic="maximum"),
    "force": bs.Output(quantity="peak_force", stop="wall", statistic="maximum"),
    "largest": bs.Output(quantity="largest_force", stop="wall"),
    "first": bs.Output(quantity="impact_start", stop="wall", impact=1),
    "seventh": bs.Output(quantity="impact_end", stop="wall", impact=7),
    "impulse": bs.Output(quantity="impulse", stop="wall", statistic="last"),
    "weakest": bs.Output(quantity="closing_speed", stop="wall", statistic="minimum"),
    "impacts": bs.Output(quantity="impacts"),
    "stored": bs.Output(quantity="energy", term="stored", times=[0.1]),
    "residual": bs.Output(quantity="energy_residual"),
    "error": bs.Output(quantity="motion_error"),
    "events": bs.Output(quantity="events"),
}


def ball() -> bs.Problem:
    """Return a mass that flies against a spring."""
    shape = 1.0 / math.sqrt(MASS)
    basis = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dx"): [shape]})
    wall = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=GAP, stiffness=100.0)
    start = bs.ModalState(velocity=[SPEED / shape])
    return bs.Problem(basis, laws=[wall], initial=start, duration=2.0)


def beam() -> bs.Problem:
    """Return two modes between two stops, pushed by a load."""
    basis = bs.ModalBasis.from_modes(
        frequency=[3.0, 7.5], damping=[0.01, 0.02], shapes={("P", "dx"): [1.0, 0.4]}
    )
    return bs.Problem(
        basis,
        laws=[
            bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=2e4),
            bs.Stop("other", node="P", normal=(1, 0, 0), gap=2e-3, stiffness=1e4, damping=3.0),
        ],
        loads=[
            bs.NodalForce("weight", node="P", force=(0.4, 0, 0)),
            bs.NodalForce("shaker", node="P", force=(1, 0, 0), time=bs.Harmonic(4.0, sine=2.0)),
        ],
        initial=bs.ModalState(displacement=[1e-4, 0.0], velocity=[0.2, 0.05]),
        duration=0.4,
    )


def test_a_ball_on_a_spring_against_closed_forms() -> None:
    stiffness = np.geomspace(50.0, 1e6, 40)
    gap = np.linspace(0.0, 0.5, 40)
    scale = np.linspace(0.5, 2.0, 40)
    varied = {
        "stops.wall.stiffness": stiffness,
        "stops.wall.gap": gap,
        "initial.velocity": scale,
    }
    found = bs.batch(ball(), varied, KEPT)
    speed, rate = scale * SPEED, np.sqrt(stiffness / MASS)
    assert found.force.values == pytest.approx(speed * MASS * rate, rel=1e-12)
    assert np.array_equal(found.largest, found.force)
    assert found.lowest.values == pytest.approx(-speed / rate, rel=1e-12)
    assert found.highest.values == pytest.approx(gap + speed / rate, rel=1e-12)
    assert found.fastest.values == pytest.approx(speed, rel=1e-12)
    assert found["first"].values == pytest.approx(gap / speed, rel=1e-12, abs=1e-15)
    assert found.impulse.values == pytest.approx(2.0 * MASS * speed, rel=1e-12)
    assert found.speed.values == pytest.approx(-speed, rel=1e-11)
    assert (found.impacts == 1).all()
    assert found.seventh.isnull().all()
    assert found.force.attrs["units"] == "N"
    assert found["stops.wall.gap"].values.tolist() == gap.tolist()


def one_by_one(problem: bs.Problem, varied: Mapping[str, FloatArray], run: int) -> bs.Problem:
    """Return the problem of one run."""
    laws = []
    for law in problem.laws:
        numbers = {
            number: float(varied[key][run])
            for number in ("gap", "stiffness", "damping")
            if (key := f"stops.{law.name}.{number}") in varied
        }
        assert isinstance(law, bs.Stop)
        laws.append(replace(law, **cast(Any, numbers)))
    return replace(problem, laws=laws)


def test_each_run_has_the_bits_of_one_made_by_itself() -> None:
    rng, problem, runs = np.random.default_rng(5), beam(), 60
    varied = {
        "stops.wall.stiffness": rng.uniform(1e3, 1e5, runs),
        "stops.wall.gap": rng.uniform(-1e-4, 2e-3, runs),
        "stops.other.damping": rng.uniform(0.0, 10.0, runs),
    }
    found = bs.batch(problem, varied, KEPT)
    for run in range(runs):
        response = bs.simulate(one_by_one(problem, varied, run), method="exact")
        for key, output in KEPT.items():
            assert np.array_equal(found[key][run], output.value(response), equal_nan=True), key


def test_loads_and_starts_are_scaled() -> None:
    problem, factors = beam(), np.array([0.5, 1.0, 3.0])
    kept = {"place": bs.Output(quantity="displacement", node="P", dof="dx", times=[0.02])}
    walls = {f"stops.{name}.gap": np.full(3, 10.0) for name in ("wall", "other")}
    # Without contact the motion is linear.
    keys = ("initial.displacement", "initial.velocity", "loads")
    together = bs.batch(problem, walls | dict.fromkeys(keys, factors), kept).place.values[:, 0]
    assert together == pytest.approx(factors * together[1], rel=1e-12)
    parts = sum(
        bs.batch(
            problem, walls | {key: np.full(3, float(key == own)) for key in keys}, kept
        ).place.values[0, 0]
        for own in keys
    )
    assert parts == pytest.approx(together[1], rel=1e-12)


def test_threads_and_order_change_no_bit() -> None:
    rng, runs = np.random.default_rng(6), 3000
    stiffness, scale = rng.uniform(1e3, 1e5, runs), rng.uniform(-2.0, 2.0, runs)
    order = rng.permutation(runs)

    def kept(chosen: NDArray[np.int_], workers: int) -> FloatArray:
        varied = {
            "stops.wall.stiffness": stiffness[chosen],
            "initial.velocity": scale[chosen],
        }
        found = bs.batch(ball(), varied, KEPT, workers=workers)
        return np.column_stack([found[key].values.reshape(len(chosen), -1) for key in KEPT])

    whole = kept(np.arange(runs), 1)
    assert np.array_equal(whole, kept(np.arange(runs), 3), equal_nan=True)
    assert np.array_equal(whole[order], kept(order, 2), equal_nan=True)
    assert np.array_equal(whole[700:1900], kept(np.arange(700, 1900), 1), equal_nan=True)


def test_a_failed_run_is_told_and_the_others_go_on() -> None:
    stiffness = [100.0, -1.0, 200.0, math.nan]
    found = bs.batch(ball(), {"stops.wall.stiffness": stiffness}, KEPT)
    assert found.failed.values.tolist() == [False, True, False, True]
    assert "must be positive (got -1)" in str(found.message.values[1])
    assert "not finite" in str(found.message.values[3])
    assert np.isnan(found.force.values).tolist() == [False, True, False, True]


def test_a_stop_too_stiff_for_the_run_fails_in_every_way(tmp_path: Path) -> None:
    found = bs.batch(ball(), {"stops.wall.stiffness": [100.0, 1e30, 1e150]}, KEPT)
    assert found.failed.values.tolist() == [False, True, True]
    assert "tell no more than" in str(found.message.values[1])
    beside = bs.batch(ball(), {"stops.wall.stiffness": [math.nan, 1e30]}, KEPT)
    assert "not finite" in str(beside.message.values[0])
    assert "tell no more than" in str(beside.message.values[1])
    bouncing = bs.load_study(written(tmp_path))
    force = {"force": bs.Output(quantity="peak_force", stop="spring", statistic="maximum")}
    study = bs.Study(bouncing.case, {"stops.spring.stiffness": [100.0, 1e30, 1e150]}, force)
    columns = {"stops.spring.stiffness": [100.0, 1e30, 1e150]}
    in_core, in_python = Evaluator(study.recipe), Evaluator(study.recipe)
    in_python._asks_core = False
    one, other = in_core.kept(columns), in_python.kept(columns)
    assert in_core._core is not None
    assert one.messages == other.messages
    assert one.status.tolist() == other.status.tolist() == [1, 2, 2]


def test_room_beside_the_numbers_does_not_grow() -> None:
    runs = 400_000
    stiffness = np.linspace(1e3, 1e4, runs)
    varied = {"stops.wall.stiffness": stiffness, "stops.wall.gap": np.full(runs, 1e9)}
    kept = {"impacts": bs.Output(quantity="impacts")}
    bs.batch(ball(), {key: values[:10] for key, values in varied.items()}, kept)
    tracemalloc.start()  # of what the core gives, numpy tells nothing
    try:
        found = bs.batch(ball(), varied, kept)
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert found["stops.wall.stiffness"].attrs == {"units": "N/m"}
    assert most - found.failed.nbytes - found.message.nbytes < runs


def test_progress_may_end_it() -> None:
    class EnoughError(Exception):
        pass

    def enough(_: float) -> None:
        raise EnoughError

    varied = {"stops.wall.stiffness": np.linspace(1e3, 1e4, 100_000)}
    with pytest.raises(EnoughError):
        bs.batch(ball(), varied, KEPT, workers=1, progress=enough)


@pytest.mark.parametrize(
    ("varied", "what"),
    [
        ({}, "there are none"),
        ({"stops.wall.stiffnes": [1.0]}, "did you mean 'stops.wall.stiffness'"),
        ({"stops.wall.gap": [[1.0]]}, "one value a run"),
        ({"stops.wall.gap": ["a"]}, "must be numbers"),
        ({"stops.wall.gap": [1.0], "loads": [1.0, 2.0]}, "different numbers of values"),
    ],
)
def test_bad_parameters_are_named(varied: dict[str, list[float]], what: str) -> None:
    with pytest.raises(bs.InputError, match=what):
        bs.batch(ball(), varied, KEPT)


def test_what_no_memory_holds_is_said() -> None:
    endless = np.broadcast_to(1e3, 10**14)
    with pytest.raises(bs.InputError, match="gap: has more values than the memory holds"):
        bs.batch(ball(), {"stops.wall.gap": endless}, KEPT)
    times = np.linspace(0.0, 1.0, 10**6).tolist()
    places = {"place": bs.Output(quantity="displacement", node="P", dof="dx", times=times)}
    with pytest.raises(bs.InputError, match="1,000,000 numbers of 10,000,000 runs each are more"):
        bs.batch(ball(), {"stops.wall.gap": np.full(10**7, 0.1)}, places)


def test_outputs_that_the_core_cannot_read_are_named() -> None:
    mean = bs.Output(quantity="displacement", node="P", dof="dx", statistic="mean")
    with pytest.raises(bs.InputError, match="not read by the core"):
        bs.batch(ball(), {"loads": [1.0]}, {"mean": mean})


def test_studies_take_the_core_and_get_the_same_bits(tmp_path: Path) -> None:
    bouncing = bs.load_study(written(tmp_path))
    kept = {
        "place": bs.Output(quantity="displacement", node="P", dof="dz", times=[0.5, 1.9]),
        "force": bs.Output(quantity="peak_force", stop="spring", statistic="maximum"),
    }
    study = bs.Study(
        bouncing.case,
        {"stops.spring.stiffness": ["1 kN/m", -5.0, 50.0, 800.0], "stops.spring.gap": [0.1, 0.25]},
        kept,
        chunk=100,
    )
    columns = study.task(0).columns
    in_core, in_python = Evaluator(study.recipe), Evaluator(study.recipe)
    assert in_core._core_runs(columns) is not None
    in_python._asks_core = False
    one, other = in_core.kept(columns), in_python.kept(columns)
    assert one.messages == other.messages
    assert sum(map(bool, one.messages)) == 2
    assert one.status.tolist() == other.status.tolist()
    for key in kept:
        assert np.array_equal(one.values[key], other.values[key], equal_nan=True)
