"""Studies in Python: results against closed forms, the same bits whoever makes them."""

import math
import shutil
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import bumpstop as bs
from bumpstop.study import pool
from bumpstop.study.evaluation import Evaluator, Recipe
from bumpstop.study.execution import Progress
from tests.study.bouncing import CASE, IN_PYTHON, STUDY, written

SPEED, MASS = 3.0, 2.0
GAP, STIFFNESS = "stops.spring.gap", "stops.spring.stiffness"


@pytest.fixture
def bouncing(tmp_path: Path) -> bs.Study:
    return bs.load_study(written(tmp_path))


@pytest.fixture
def in_python(tmp_path: Path) -> bs.Study:
    """The same, made by processes."""
    return bs.load_study(written(tmp_path, IN_PYTHON))


def files(store: Path) -> dict[str, bytes]:
    """Return the content of every file of a store."""
    return {
        str(path.relative_to(store)): path.read_bytes()
        for path in store.rglob("*")
        if path.is_file()
    }


def test_a_grid_against_closed_forms(bouncing: bs.Study) -> None:
    found = bouncing.run(workers=1)
    assert found.run.values.tolist() == np.arange(10).reshape(5, 2).tolist()
    found = found.drop_vars("run")
    assert dict(found.sizes) == {STIFFNESS: 5, GAP: 2, "place_time": 2}
    assert found[STIFFNESS].values == pytest.approx([50.0, 100.0, 200.0, 400.0, 800.0])
    assert found[GAP].values.tolist() == [0.25, 0.5]
    assert not found.failed.any()
    rate = np.sqrt(found[STIFFNESS] / MASS)
    xr.testing.assert_allclose(
        found.force, SPEED * MASS * rate + 0.0 * found[GAP], rtol=1e-12, check_dim_order=False
    )
    start = found[GAP] / SPEED
    xr.testing.assert_allclose(
        found.start, (start + 0.0 * rate).transpose(STIFFNESS, GAP), rtol=1e-12
    )
    after = -found[GAP] + SPEED * (1.9 - start - math.pi / rate)
    assert found.place.isel(place_time=0).values == pytest.approx(np.full((5, 2), -0.15))
    xr.testing.assert_allclose(
        found.place.isel(place_time=1, drop=True).drop_vars("place_time", errors="ignore"),
        after.transpose(STIFFNESS, GAP),
        rtol=1e-11,
    )
    assert found.force.attrs == {"units": "N", "long_name": "largest force of spring"}


@pytest.mark.parametrize("written_as", [STUDY, IN_PYTHON], ids=["core", "python"])
def test_workers_chunks_and_stores_change_no_bit(written_as: str, tmp_path: Path) -> None:
    bouncing = bs.load_study(written(tmp_path, written_as))
    alone = bouncing.run(workers=1)
    in_one = bs.Study(bouncing.case, bouncing.parameters, bouncing.outputs, chunk=100)
    assert in_one.run(workers=1).identical(alone)
    assert bouncing.run(tmp_path / "two.zarr", workers=2).identical(alone)
    assert bouncing.run(tmp_path / "one.zarr", workers=1).identical(alone)
    assert files(tmp_path / "one.zarr") == files(tmp_path / "two.zarr")
    assert bs.open_study(tmp_path / "one.zarr").identical(alone)


def test_each_run_is_that_of_the_case_alone(tmp_path: Path) -> None:
    study = bs.load_study(written(tmp_path))
    found = study.run(workers=1)
    own = CASE.replace("stiffness = 200.0", "stiffness = 100.0")
    own = own.replace("gap = 0.5", 'gap = "50 cm"')
    written(tmp_path, case=own)
    response = bs.simulate(bs.load_case(tmp_path / "case.toml").problems["base"])
    chosen = found.sel({GAP: 0.5}).isel({STIFFNESS: 1})
    level = study.runs.row(2)[STIFFNESS]
    assert level == pytest.approx(100.0, rel=1e-15)
    if level == 100.0:  # geometric ranges may be a bit off
        assert chosen.force == response.impact_table()["peak_force"][0]
    assert chosen.force == pytest.approx(response.impact_table()["peak_force"][0], rel=1e-14)


def test_failing_runs_are_recorded_and_the_others_made(bouncing: bs.Study) -> None:
    stiffness = [100.0, -1.0, 200.0]
    found = bs.study(
        bouncing.case, {STIFFNESS: stiffness}, {"force": bouncing.outputs["force"]}, workers=1
    )
    assert found.failed.values.tolist() == [False, True, False]
    assert np.isnan(found.force.values).tolist() == [False, True, False]
    message = "stops.spring.stiffness: must be positive (got -1.0)"
    assert found.message.values.tolist() == ["", message, ""]


def test_modes_are_computed_once(bouncing: bs.Study, monkeypatch: pytest.MonkeyPatch) -> None:
    from bumpstop.io.case import build

    made = []
    built = build.built_basis  # type: ignore[attr-defined]

    def counted(*given: object) -> object:
        made.append(given)
        return built(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(build, "built_basis", counted)
    bouncing.run(workers=1)
    assert not made  # the case had them
    masses = {"masses.ball.mass": [2.0, 3.0], GAP: [0.1, 0.2, 0.3]}
    outputs = {"force": bouncing.outputs["force"]}
    found = bs.study(bouncing.case, masses, outputs, workers=1)
    # One evaluation knows the modes of the mass that the case has.
    assert len(made) == 1
    assert found.force.dims == ("masses.ball.mass", GAP)
    assert found.force.values == pytest.approx(
        np.repeat(SPEED * np.sqrt(200.0 * np.array([[2.0], [3.0]])), 3, axis=1), rel=1e-12
    )


def test_parameters_have_their_units(tmp_path: Path) -> None:
    study = bs.load_study(written(tmp_path))
    varied = {"stops.spring.gap": [0.25], "masses.ball.mass": [2.0], "basis.modes": [1]}
    found = bs.Study(study.case, varied, study.outputs).run(tmp_path / "s.zarr", workers=1)
    units = {key: found[key].attrs.get("units") for key in varied}
    assert units == {"stops.spring.gap": "m", "masses.ball.mass": "kg", "basis.modes": None}
    reopened = bs.open_study(tmp_path / "s.zarr")
    assert {key: reopened[key].attrs.get("units") for key in varied} == units
    assert bs.heat_map(found, "force").layout.xaxis.title.text in {
        "stops.spring.gap (m)",
        "masses.ball.mass (kg)",
    }


def test_results_stand_where_their_parameters_are(bouncing: bs.Study, tmp_path: Path) -> None:
    # The modes depend on the mass: it changes least often, although it is not the first.
    varied = {GAP: [0.1, 0.2, 0.4], "masses.ball.mass": [2.0, 3.0], STIFFNESS: [100.0, 200.0]}
    outputs = {"force": bouncing.outputs["force"], "start": bouncing.outputs["start"]}
    store = tmp_path / "s.zarr"
    found = bs.study(bouncing.case, varied, outputs, workers=1, store=store)
    assert found.force.dims == tuple(varied)
    gap, mass, stiffness = np.meshgrid(*varied.values(), indexing="ij")
    assert found.force.values == pytest.approx(SPEED * np.sqrt(stiffness * mass), rel=1e-12)
    assert found.start.values == pytest.approx(gap / SPEED, rel=1e-12)
    assert bs.open_study(store).identical(found)


def test_drawn_samples_lie_side_by_side(bouncing: bs.Study) -> None:
    found = bs.study(
        bouncing.case,
        {
            STIFFNESS: bs.Distribution("lognormal", median=200.0, sigma=0.1),
            "stops.spring.obstacle": ["plane"],
        },
        {"force": bouncing.outputs["force"]},
        sampling="sobol",
        count=16,
        workers=1,
    )
    assert dict(found.sizes) == {"run": 16}
    assert found["stops.spring.obstacle"].values.tolist() == ["plane"] * 16
    expected = SPEED * np.sqrt(found[STIFFNESS].values * MASS)
    assert found.force.values == pytest.approx(expected, rel=1e-12)


def test_modal_cases_keep_frequencies(tmp_path: Path) -> None:
    modal = CASE.partition("[stops.spring]")[0]
    modal += '[springs.s]\nnode = "P"\nstiffness = [0.0, 0.0, 50.0, 0.0, 0.0, 0.0]\n'
    written(tmp_path, case=modal)
    frequency = {"f": bs.Output(quantity="frequency", mode=1)}
    found = bs.study(tmp_path / "case.toml", {"masses.ball.mass": [2.0, 8.0]}, frequency, workers=1)
    expected = np.sqrt(50.0 / np.array([2.0, 8.0])) / (2 * math.pi)
    assert found.f.values == pytest.approx(expected, rel=1e-12)


def test_a_study_that_ended_is_resumed_to_the_same_bits(bouncing: bs.Study, tmp_path: Path) -> None:
    whole, part = tmp_path / "whole.zarr", tmp_path / "part.zarr"
    expected = bouncing.run(whole, workers=1)

    class EnoughError(Exception):
        pass

    def stop(progress: object) -> None:
        if progress.done >= 6:  # type: ignore[attr-defined]
            raise EnoughError

    with pytest.raises(EnoughError):
        bouncing.run(part, workers=1, progress=stop)
    unfinished = bs.open_study(part)
    assert np.count_nonzero(~np.isnan(unfinished.force)) == 6
    not_made = unfinished.message == "not made yet"
    assert np.array_equal(not_made, np.isnan(unfinished.force))
    (part / "force" / "c" / f"3.{'0' * 32}.partial").write_bytes(b"half")
    assert bouncing.run(part, workers=1, resume=True).identical(expected)
    assert files(part) == files(whole)


def test_a_chunk_without_its_status_is_made_again(bouncing: bs.Study, tmp_path: Path) -> None:
    whole, part = tmp_path / "whole.zarr", tmp_path / "part.zarr"
    bouncing.run(whole, workers=1)
    shutil.copytree(whole, part)
    (part / "status" / "c" / "1").unlink()
    (part / "force" / "c" / "1").write_bytes((part / "force" / "c" / "0").read_bytes())
    bouncing.run(part, workers=1, resume=True)
    assert files(part) == files(whole)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("count = 5", "count = 6", "parameters.stops.spring.stiffness.count was 5, and is 6"),
        ('"50 cm"]', '"51 cm"]', 'gap.values.1 was "50 cm", and is "51 cm"'),
        ("chunk = 3", "chunk = 4", "chunk was 3, and is 4"),
        ("impact = 1", "impact = 2", "outputs.start.impact was 1, and is 2"),
    ],
)
def test_a_changed_study_does_not_resume(old: str, new: str, told: str, tmp_path: Path) -> None:
    store = tmp_path / "study.zarr"
    bs.load_study(written(tmp_path)).run(store, workers=1)
    before = files(store)
    changed = bs.load_study(written(tmp_path, STUDY.replace(old, new)))
    with pytest.raises(bs.InputError) as error:
        changed.run(store, workers=1, resume=True)
    assert f"the study has changed: {told}" in str(error.value) or told in str(error.value)
    assert files(store) == before


def test_a_changed_case_does_not_resume(tmp_path: Path) -> None:
    store = tmp_path / "study.zarr"
    bs.load_study(written(tmp_path)).run(store, workers=1)
    changed = bs.load_study(written(tmp_path, case=CASE.replace("mass = 2.0", "mass = 2.5")))
    with pytest.raises(bs.InputError, match=r"case.masses.ball.mass was 2.0, and is 2.5"):
        changed.run(store, workers=1, resume=True)


def test_a_store_is_not_overwritten(bouncing: bs.Study, tmp_path: Path) -> None:
    bouncing.run(tmp_path / "s.zarr", workers=1)
    with pytest.raises(bs.InputError, match="is there already; go on with it by --resume"):
        bouncing.run(tmp_path / "s.zarr", workers=1)
    with pytest.raises(bs.InputError, match="no such store"):
        bs.open_study(tmp_path / "other.zarr")
    with pytest.raises(bs.InputError, match="is not the store of a study"):
        bs.open_study(tmp_path)


def test_a_worker_that_dies_takes_no_run_with_it(
    in_python: bs.Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = in_python.run(workers=1)
    victims: list[int] = []

    class Mortal(pool.Worker):
        def __init__(self, recipe: Recipe) -> None:
            super().__init__(recipe)
            if not victims:
                victims.append(self.process.pid)
                self.process.kill()

    monkeypatch.setattr(pool, "Worker", Mortal)
    assert in_python.run(workers=2).identical(expected)
    assert victims


def test_a_run_that_kills_its_process_has_failed(
    in_python: bs.Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pool.Worker, "answer", lambda *_: None)
    found = in_python.run(workers=2)
    assert found.failed.all()
    assert "it was killed, or found no memory" in str(found.message.values[0, 0])


def test_our_own_mistakes_stop_no_study(
    in_python: bs.Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError("oh")

    monkeypatch.setattr(Evaluator, "_values", broken)
    found = in_python.run(workers=1)
    assert set(found.message.values.ravel()) == {
        "this is a mistake in bumpstop itself: ZeroDivisionError: oh"
    }


@pytest.mark.parametrize(
    ("parameters", "told"),
    [
        ({}, "parameters: there are none"),
        ({"stops.spring.stifness": [1.0]}, "did you mean 'stiffness'?"),
        ({"stops.sprng.stiffness": [1.0]}, "did you mean 'spring'?"),
        ({"stops.spring.gap": ["1 kN"]}, "wrong unit: 'kN' is a force, expected a length"),
        ({"stops.spring.gap": bs.Range("1 mm", "1 s", 3)}, "'s' is a time, expected a length"),
        ({"stops.spring.gap": "1 mm"}, "must be a list of values, a Range or a Distribution"),
        ({"title": ["a"]}, "the case has no such key"),
        (
            {GAP: bs.Distribution("normal", mean="20 mm", standard_deviation="1 N")},
            "'N' is a force, expected a length",
        ),
        (
            {GAP: bs.Distribution("weibull_min", c=2.0, scale="1 N")},
            "'N' is a force, expected a length",
        ),
    ],
)
def test_parameters_that_are_refused(
    parameters: dict[str, object], told: str, bouncing: bs.Study
) -> None:
    with pytest.raises(bs.InputError) as error:
        bs.Study(bouncing.case, parameters, bouncing.outputs)
    assert told in str(error.value)
    assert str(error.value).startswith("parameters")


@pytest.mark.parametrize(
    ("outputs", "told"),
    [
        ({}, "outputs: there are none"),
        ({"run": bs.Output(quantity="impacts")}, "this name is taken (got 'run')"),
        ({"a": bs.Output(quantity="largest_force", stop="sprin")}, "did you mean 'spring'?"),
        (
            {"a": bs.Output(quantity="displacement", node="P", dof="dz", times=[3.0])},
            "is after the end of the run",
        ),
        ({"a": "impacts"}, "outputs.a: must be an Output"),
    ],
)
def test_outputs_that_are_refused(
    outputs: dict[str, bs.Output], told: str, bouncing: bs.Study
) -> None:
    with pytest.raises(bs.InputError) as error:
        bs.Study(bouncing.case, bouncing.parameters, outputs)
    assert told in str(error.value)


def test_a_case_with_variants_needs_one() -> None:
    case = bs.load_case("cases/sdnl32/case.toml")
    outputs = {"n": bs.Output(quantity="impacts")}
    with pytest.raises(bs.InputError, match="variant: is missing; the case has soft, stiff"):
        bs.Study(case, {GAP: [0.0]}, outputs)
    with pytest.raises(bs.InputError, match="did you mean 'stiff'"):
        bs.Study(case, {GAP: [0.0]}, outputs, variant="stif")


def test_ranges_between_whole_numbers_are_drawn_as_the_key_takes_them() -> None:
    study = bs.Study(
        bs.load_case("cases/sdnl32/case.toml"),
        {GAP: bs.Range(0, 1), "basis.modes": bs.Range(1, 4)},
        {"n": bs.Output(quantity="impacts")},
        sampling=bs.Sampling("latin_hypercube", 8),
        variant="soft",
    )
    columns = study.runs.columns(0, 8)
    assert sorted(int(8 * float(gap)) for gap in columns[GAP]) == list(range(8))
    assert sorted(columns["basis.modes"]) == [1, 1, 2, 2, 3, 3, 4, 4]


def test_numbers_of_modes_in_equal_ratios_and_by_chance() -> None:
    case = bs.load_case("cases/sdnl32/case.toml")
    outputs = {"f": bs.Output(quantity="frequency", mode=1)}
    ratios = {"basis.modes": bs.Range(1, 10, 4, spacing="log")}
    found = bs.study(case, ratios, outputs, variant="soft", workers=1)
    assert found["basis.modes"].values.tolist() == [1, 2, 5, 10]
    assert not found.failed.any()
    chance = {"basis.modes": bs.Distribution("randint", low=2, high=5)}
    drawn = bs.study(
        case, chance, outputs, sampling="monte_carlo", count=4, variant="soft", workers=1
    )
    assert not drawn.failed.any()
    assert set(drawn["basis.modes"].values.tolist()) <= {2, 3, 4}


@pytest.mark.parametrize("array", ["place", "status"])
@pytest.mark.parametrize("emptied", [False, True])
def test_chunks_whose_files_are_lost_are_made_again(
    bouncing: bs.Study, tmp_path: Path, array: str, emptied: bool
) -> None:
    """Files that are gone, or empty as a loss of power leaves them."""
    store = tmp_path / "many.zarr"
    bouncing.run(store, workers=1)
    expected = {file: file.read_bytes() for file in store.rglob("*") if file.is_file()}
    (lost,) = (store / array / "c").glob("1/0" if array == "place" else "1")
    if emptied:
        lost.write_bytes(b"")
    else:
        lost.unlink()
    told: list[Progress] = []
    bouncing.run(store, workers=1, resume=True, progress=told.append)
    assert len(told) == 1
    assert {file: file.read_bytes() for file in store.rglob("*") if file.is_file()} == expected


@pytest.mark.parametrize(
    ("given", "key"),
    [
        ({"parameters": [1]}, "parameters: must be a dict"),
        ({"parameters": None}, "parameters: must be a dict"),
        ({"outputs": bs.Output(quantity="impacts")}, "outputs: must be a dict"),
        ({"basins": {"node": "P"}}, "basins: must be Basins"),
        ({"parameters": {"stops.spring": [1, 2]}}, r'parameters\."stops\.spring": must be a table'),
        (
            {"parameters": {"stops.spring.stiffness": [200.0, True]}},
            r'parameters\."stops\.spring\.stiffness": must be a number in N/m',
        ),
    ],
)
def test_what_is_of_another_kind_is_told_at_once(
    bouncing: bs.Study, given: dict[str, object], key: str
) -> None:
    asked = {"parameters": {"stops.spring.gap": [0.1]}, "outputs": bouncing.outputs} | given
    with pytest.raises(bs.InputError, match=key):
        bs.Study(bouncing.case, **asked)  # type: ignore[arg-type]


def test_stores_and_cases_are_paths(bouncing: bs.Study) -> None:
    with pytest.raises(bs.InputError, match="store: must be the path of a folder"):
        bouncing.run(5)  # type: ignore[arg-type]
    with pytest.raises(bs.InputError, match="case: must be a case from a file"):
        bs.study(5, {}, {})  # type: ignore[arg-type]
