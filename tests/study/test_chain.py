"""Studies whose runs follow one another, up and then down."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import bumpstop as bs
from bumpstop.cli import main
from bumpstop.report.html import write_study

SWING = Path(__file__).parents[2] / "docs" / "studies" / "swing" / "case.toml"
FORCE, GAP = "loads.shaker.force.0", "stops.wall.gap"
STUDY = """
case = "case.toml"
[parameters]
"loads.shaker.force.0" = { from = 0.4, to = 2.0, count = 9 }
[sampling]
method = "continuation"
[outputs.place]
quantity = "displacement"
node = "P"
dof = "dx"
times = [13.0, 14.0, 15.0]
[outputs.speed]
quantity = "closing_speed"
stop = "wall"
latest = 4
[outputs.impacts]
quantity = "impacts"
[execution]
chunk = 2
"""
START = """
[initial.nodal.velocity.P]
dx = 0.1
"""
TIMES = [13.0, 14.0, 15.0]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Return the path of a study of 15 periods a run, whose motion has not settled then."""
    text = SWING.read_text(encoding="utf-8").replace("duration = 1.0", "duration = 15.0")
    (tmp_path / "case.toml").write_text(text + START, encoding="utf-8")
    file = tmp_path / "study.toml"
    file.write_text(STUDY)
    return file


def content(store: Path) -> dict[str, bytes]:
    """Return the content of every file of a store."""
    found = (each for each in store.rglob("*") if each.is_file())
    return {str(each.relative_to(store)): each.read_bytes() for each in found}


def places(case: bs.Case, values: list[float]) -> list[list[float]]:
    """Return what is kept of runs, each from the last state of the one before."""
    runs = bs.continuation(case, FORCE, values)
    return [run.sample("displacement", "P", "dx", times=TIMES).tolist() for _, run in runs]


def test_both_ways_are_those_of_runs_one_after_the_other(path: Path) -> None:
    study = bs.load_study(path)
    found = study.run()
    up = found[FORCE].values.tolist()
    assert up == np.linspace(0.4, 2.0, 9).tolist()
    assert found.place.dims == ("way", "run", "place_time")
    assert found.place.sel(way="up").values.tolist() == places(study.case, up)
    assert found.place.sel(way="down").values[::-1].tolist() == places(study.case, up[::-1])
    assert found.run_number.values.tolist() == [[*range(9)], [*range(17, 8, -1)]]
    # What the first run of each way does not know, the second does: it starts in motion.
    assert (found.place.values[0, 1] != found.place.values[1, 1]).any()


def test_killed_and_resumed_it_has_the_same_bytes(path: Path, tmp_path: Path) -> None:
    whole, store = tmp_path / "whole.zarr", tmp_path / "study.zarr"
    study = bs.load_study(path)
    found = study.run(whole)
    words = [sys.executable, "-m", "bumpstop", "sweep", str(path), "--no-report"]
    for chunk in (0, 3, 6):  # of 9; the fifth holds the end of one way and the start of the other
        resume = ["--resume"] if store.exists() else []
        with subprocess.Popen([*words, *resume], stdout=subprocess.DEVNULL) as process:
            while not (store / "status" / "c" / str(chunk)).exists():
                assert process.poll() is None, "it ended early"
                time.sleep(0.002)
            process.send_signal(signal.SIGKILL)
            process.wait()
    resumed = study.run(store, resume=True)
    assert content(store) == content(whole)
    xr.testing.assert_identical(resumed, found)
    xr.testing.assert_identical(bs.open_study(store), study.run())


def test_a_run_that_fails_is_left_out_of_its_way(path: Path) -> None:
    case = bs.load_study(path).case
    kept = {"place": bs.Output(quantity="displacement", node="P", dof="dx", times=TIMES)}
    sampling = bs.Sampling("continuation")

    def made(factors: list[float]) -> xr.Dataset:
        stiffness = [200.0 * factor for factor in factors]
        study = bs.Study(case, {"stops.wall.stiffness": stiffness}, kept, sampling=sampling)
        return study.run()

    found, without = made([-1.0, 1.0, -1.0, 2.0]), made([1.0, 2.0])
    assert found.failed.values.tolist() == [[True, False, True, False]] * 2
    assert "must be positive" in str(found.message.values[0, 2])
    assert np.isnan(found.place.values[:, [0, 2]]).all()
    np.testing.assert_array_equal(found.place.values[:, [1, 3]], without.place.values)


def test_a_run_is_opened_to_the_same_bits(path: Path, tmp_path: Path) -> None:
    assert main(["sweep", str(path)]) == 0
    found = bs.open_study(tmp_path / "study.zarr")
    assert main(["sweep", str(path), "--open", "12"]) == 0
    case = bs.load_case(tmp_path / "study-run-12" / "case.toml")
    (problem,) = case.problems.values()
    place = bs.simulate(problem).sample("displacement", "P", "dx", times=TIMES)
    (at,) = np.argwhere(found.run_number.values == 12)
    assert place.tolist() == found.place.values[tuple(at)].tolist()
    study = bs.load_study(path)
    with pytest.raises(bs.InputError, match=r"starts where another run has ended.*name the store"):
        bs.write_case(study, 12, tmp_path / "none.toml")
    first = bs.load_case(bs.write_case(study, 9, tmp_path / "first.toml"))
    assert first.problems.keys() == {"base"}


def test_a_run_whose_start_is_not_there_is_not_opened(
    path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["sweep", str(path), "--open", "12"]) == 2
    assert "no such store" in capsys.readouterr().err
    assert not (tmp_path / "study-run-12").exists()


def test_its_page_draws_both_ways(path: Path, tmp_path: Path) -> None:
    study = bs.load_study(path)
    found = study.run()
    write_study(study, found, tmp_path / "page.html", opened_by="bumpstop --open")
    assert FORCE in (tmp_path / "page.html").read_text()
    up, down = bs.bifurcation_diagram(found, "speed").data
    assert (up.name, down.name) == ("up", "down")
    assert [*up.customdata[:4], *down.customdata[:4]] == [0, 0, 0, 0, 17, 17, 17, 17]


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (FORCE, "masses.mass.mass", "changes the modes"),
        (FORCE, "initial.nodal.velocity.P.dx", "is that of the run before"),
        ("[outputs.place]", "[outputs.way]", "this name is taken"),
        (
            "[execution]",
            '[basins]\nnode = "P"\ndof = "dx"\nperiod = 0.5\n[execution]',
            "basins: asks",
        ),
        ("[sampling]", '"stops.wall.gap" = [0.1]\n[sampling]', "has 1 values, and"),
        ("{ from = 0.4, to = 2.0, count = 9 }", "[]", "must be a list of one value or more"),
    ],
)
def test_what_cannot_go_on(
    old: str, new: str, told: str, path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path.write_text(STUDY.replace(old, new))
    assert main(["sweep", str(path)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert told in line


def test_a_scheduler_is_of_no_use(path: Path, tmp_path: Path) -> None:
    from distributed import LocalCluster

    study = bs.load_study(path)
    with (
        LocalCluster(
            n_workers=1, processes=False, dashboard_address=None, silence_logs=50
        ) as cluster,
        pytest.raises(bs.InputError, match="scheduler: is of no use"),
    ):
        study.run(tmp_path / "study.zarr", scheduler=cluster)
    assert not (tmp_path / "study.zarr").exists()
