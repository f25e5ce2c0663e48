"""``bumpstop run``: what it prints, writes and returns."""

import errno
import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.cli import main
from bumpstop.errors import ComputationError
from bumpstop.io.case import load_case
from bumpstop.post.results.contacts import Statistics

SDNL32 = Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml"
RUN = ["run", str(SDNL32), "--method", "symplectic_euler"]

Output = Callable[..., tuple[int, str, str]]


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Output:
    """Run a command and return its status, output and error output."""

    def run(*arguments: str) -> tuple[int, str, str]:
        status = main(arguments)
        return status, *capsys.readouterr()

    return run


@pytest.fixture
def strict(tmp_path: Path) -> Path:
    """Return a case whose tolerance for the second variant is too small to be met."""
    file = tmp_path / "strict" / "case.toml"
    file.parent.mkdir()
    file.write_text(SDNL32.read_text().replace("tolerance = 0.012", "tolerance = 1e-6"))
    return file


def test_summary(call: Output) -> None:
    status, output, error = call(*RUN)
    assert (status, error) == (0, "")
    lines = output.splitlines()
    assert lines[0] == load_case(SDNL32).title
    assert "\x1b" not in output
    assert "soft" in lines
    assert "  Displacement dy of B, in m" in lines
    (row,) = [line.split() for line in lines if line.split()[:2] == ["0.003", "-0.00492"]]
    assert row[2].startswith("-0.00495")
    assert row[3:] == ["0.67", "%", "0.8", "%", "yes"]
    assert output.count("all 12 checks passed") == 2
    assert output.count("  1 rigid mode: rotation about z through A\n") == 2
    assert output.count("method symplectic_euler, 2,000 steps, 1 event, 1 impact") == 2


FLIES_APART = """
[nodes]
P = [0, 0, 0]
Q = [1, 0, 0]
[masses.P]
node = "P"
mass = 3
[masses.Q]
node = "Q"
mass = 1
[springs.s]
node = "P"
other = "Q"
stiffness = 1e4
[[supports]]
nodes = "all"
fixed = ["dy", "dz", "drx", "dry", "drz"]
[basis]
modes = 1
[initial]
translation = { velocity = [2, 0, 0], nodes = ["P"] }
[run]
duration = 1
"""


def test_lost_energy_of_the_start_is_told(call: Output, tmp_path: Path) -> None:
    """P flies alone, and one mode has them both fly: Q's share of the mass is lost."""
    file = tmp_path / "case.toml"
    file.write_text(FLIES_APART, encoding="utf-8")
    told = (
        "25 % of the kinetic energy of the initial translation is lost: "
        "the basis cannot follow it; more modes hold more of it"
    )
    _, output, _ = call("run", str(file), "--out", str(tmp_path / "out"))
    assert f"  {told}\n" in output
    assert told in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    _, output, _ = call("run", str(file), "--json")
    assert json.loads(output)["variants"][0]["remarks"][1:] == [told]


def test_columns_are_aligned(call: Output) -> None:
    _, output, _ = call(*RUN)
    tables = output.split("soft")[1].split("stiff")
    for table in tables:
        rows = [line for line in table.splitlines() if line.endswith(("yes", "ok"))]
        assert len(rows) == 13
        assert len({len(row) for row in rows}) == 1


def test_json(call: Output) -> None:
    status, output, error = call(*RUN, "--json")
    record = json.loads(output)
    assert (status, error) == (0, "")
    assert output.count("\n") == 1
    assert record.keys() == {"case", "variants", "passed"}
    assert (record["case"], record["passed"]) == ("sdnl32", True)
    assert [variant["name"] for variant in record["variants"]] == ["soft", "stiff"]
    for variant in record["variants"]:
        assert variant.keys() == {
            "name",
            "method",
            "method_reason",
            "steps",
            "certified_steps",
            "missed_penetration",
            "motion_error",
            "events",
            "impacts",
            "energy_residual",
            "solve_seconds",
            "references",
            "results",
            "remarks",
            "passed",
        }
        assert variant["results"] == []
        assert variant["remarks"] == ["1 rigid mode: rotation about z through A"]
        assert (variant["method"], variant["passed"]) == ("symplectic_euler", True)
        assert (variant["steps"], variant["events"], variant["impacts"]) == (2000, 1, 1)
        assert (variant["certified_steps"], variant["missed_penetration"]) == (None, None)
        assert variant["motion_error"] is None
        assert 0 < variant["solve_seconds"] < 1
        assert len(variant["references"]) == 12
    check = record["variants"][0]["references"][2]
    assert check.keys() == {
        "quantity",
        "node",
        "dof",
        "time",
        "value",
        "reference",
        "deviation",
        "tolerance",
        "passed",
    }
    assert (check["node"], check["dof"]) == ("B", "dy")
    assert (check["quantity"], check["time"], check["reference"]) == (
        "displacement",
        3e-3,
        -4.92e-3,
    )
    assert check["deviation"] == pytest.approx(abs(check["value"] / -4.92e-3 - 1), rel=1e-9)


def test_json_says_what_a_reference_is_of(call: Output, tmp_path: Path) -> None:
    wanted: list[dict[str, Any]] = [
        {"quantity": "stop_force", "stop": "spring", "times": [0.01], "values": [1.0]},
        {"quantity": "gauge", "gauge": "strain", "times": [0.01], "values": [1.0]},
        {"quantity": "peak_force", "stop": "spring", "impact": 1, "values": [1.0]},
        {"quantity": "modal_displacement", "mode": 2, "times": [0.01], "values": [1.0]},
        {"quantity": "energy", "term": "kinetic", "times": [0.01], "values": [1.0]},
        {"quantity": "frequency", "mode": 3, "values": [1.0]},
    ]
    text = SDNL32.read_text().partition("[variants")[0]
    for reference in wanted:
        lines = [f"{key} = {json.dumps(value)}" for key, value in reference.items()]
        text += "\n".join(["[[references]]", *lines, "tolerance = 1\n"])
    file = tmp_path / "case.toml"
    file.write_text(text, encoding="utf-8")
    _, output, _ = call("run", str(file), "--json")
    found = json.loads(output)["variants"][0]["references"]
    shared = {"time", "value", "reference", "deviation", "tolerance", "passed"}
    for record, reference in zip(found, wanted, strict=True):
        of = {key: value for key, value in record.items() if key not in shared}
        given = {key: reference[key] for key in reference if key not in ("times", "values")}
        assert of == given
    assert found[-1]["time"] is None


def test_a_failed_check_is_status_1(call: Output, strict: Path) -> None:
    status, output, error = call("run", str(strict), "--method", "symplectic_euler")
    assert (status, error) == (1, "")
    assert "all 12 checks passed" in output
    assert "12 of 12 checks FAILED" in output
    assert output.count(" NO\n") == 12
    status, output, _ = call("run", str(strict), "--method", "symplectic_euler", "--json")
    record = json.loads(output)
    assert status == 1
    assert [variant["passed"] for variant in record["variants"]] == [True, False]
    assert record["passed"] is False


def test_the_exact_method_says_what_it_has_proved(call: Output) -> None:
    _, output, _ = call("run", str(SDNL32), "--json")
    for variant in json.loads(output)["variants"]:
        assert variant["certified_steps"] == variant["steps"] > 0
        assert 0.0 < variant["missed_penetration"] < 1e-14
        assert 0.0 < variant["motion_error"] < 1e-12
    _, output, _ = call("run", str(SDNL32))
    proved = (
        r"  certified: no contact deeper than \d\.\de-1\d m missed, "
        r"motion true to \d\.\de-1\d m between switches\n"
    )
    assert len(re.findall(proved, output)) == 2


@pytest.fixture
def without_values(tmp_path: Path) -> Path:
    """Return a case with references to a seventh impact, and to the end of one that goes on."""
    lines = [SDNL32.read_text().replace("duration = 0.02 ", "duration = 0.012 ")]
    for quantity, impact in (("peak_force", 7), ("impact_end", 1)):
        lines += ["[[references]]", 'variant = "soft"', f'quantity = "{quantity}"']
        lines += [
            'stop = "spring"',
            f"impact = {impact}",
            "values = [1]",
            "absolute_tolerance = 0.1",
        ]
    file = tmp_path / "case.toml"
    file.write_text("\n".join(lines))
    return file


def test_what_has_no_value_is_null_in_json(call: Output, without_values: Path) -> None:
    status, output, _ = call("run", str(without_values), "--json")
    *_, absent, open_end = json.loads(output, parse_constant=pytest.fail)["variants"][0][
        "references"
    ]
    assert status == 1
    assert [absent[key] for key in ("time", "value", "deviation", "passed")] == [None] * 3 + [False]
    assert open_end["time"] == 0.0
    assert [open_end[key] for key in ("value", "deviation", "passed")] == [None, None, False]


def test_what_has_no_value_is_told_in_words(
    call: Output, without_values: Path, tmp_path: Path
) -> None:
    status, output, error = call("run", str(without_values), "--out", str(tmp_path / "out"))
    assert (status, error) == (1, "")
    rows = [line.split() for line in output.splitlines()]
    assert ["-", "1", "no", "such", "impact", "-", "0.1", "NO"] in rows
    assert ["0", "1", "still", "closed", "-", "0.1", "NO"] in rows
    assert "nan" not in output
    page = (tmp_path / "out" / "report.html").read_text()
    assert ">no such impact<" in page
    assert ">still closed<" in page


def test_outputs(call: Output, tmp_path: Path) -> None:
    out = tmp_path / "deep" / "out"
    status, output, _ = call(*RUN, "--out", str(out))
    files = {str(file.relative_to(out)) for file in out.rglob("*") if file.is_file()}
    assert status == 0
    assert files == {"soft/response.nc", "stiff/response.nc", "report.html"}
    assert output.endswith(f"written to {out}\n")
    assert list(out.parent.iterdir()) == [out]


def test_outputs_replace_older_ones_and_leave_the_rest(call: Output, tmp_path: Path) -> None:
    (tmp_path / "soft").mkdir()
    (tmp_path / "soft" / "response.nc").write_text("old")
    (tmp_path / "soft" / "notes.txt").write_text("mine")
    assert call(*RUN, "--out", str(tmp_path), "--no-report")[0] == 0
    assert (tmp_path / "soft" / "response.nc").read_bytes()[:4] == b"\x89HDF"
    assert (tmp_path / "soft" / "notes.txt").read_text() == "mine"
    assert not (tmp_path / "report.html").exists()


def contents(folder: Path) -> dict[str, bytes | None]:
    """Return all that is in a folder: the files with what they hold."""
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() else None
        for path in folder.rglob("*")
    }


@pytest.mark.parametrize("taken", ["soft", "stiff/response.nc/", "report.html/"])
def test_what_stands_in_the_way_of_a_file_is_named(
    taken: str, call: Output, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "stiff").mkdir()
    (tmp_path / "stiff" / "notes.txt").write_text("mine")
    in_the_way = tmp_path / taken
    if taken.endswith("/"):
        in_the_way.mkdir(parents=True)
    else:
        in_the_way.touch()
    before = contents(tmp_path)
    status, output, error = call(*RUN, "--out", str(tmp_path))
    assert (status, output) == (2, "")
    kind = "is a folder" if taken.endswith("/") else "is not a folder"
    hint = "move it away, or name another folder"
    assert error == f"error: --out: nothing was written: {in_the_way} {kind}; {hint}\n"
    assert contents(tmp_path) == before
    # So too where it comes to stand there during the run.
    monkeypatch.setattr("bumpstop.cli.run.check_writable", lambda *_: None)
    assert call(*RUN, "--out", str(tmp_path)) == (2, "", error)
    assert contents(tmp_path) == before


@pytest.mark.parametrize("last", ["report.html", "soft/response.nc", "stiff/response.nc"])
def test_a_move_that_fails_midway_is_taken_back(
    last: str, call: Output, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    (out / "stiff").mkdir(parents=True)
    (out / "stiff" / "response.nc").write_text("old")
    (out / "report.html").write_text("old")
    before = contents(tmp_path)
    rename = Path.rename

    def fail(path: Path, place: Path) -> Path:
        if place == out / last and ".replaced" not in path.name:
            raise OSError(errno.EIO, "Input/output error")
        return rename(path, place)

    monkeypatch.setattr(Path, "rename", fail)
    status, output, error = call(*RUN, "--out", str(out))
    assert (status, output) == (2, "")
    assert "Input/output error" in error
    assert contents(tmp_path) == before


def test_what_an_earlier_run_left_is_said(call: Output, tmp_path: Path) -> None:
    for name in ("softer/response.nc", "report.html", "soft/response.nc"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("old")
    said = "of an earlier run, left as they were: report.html, softer/response.nc\n"
    assert said in call(*RUN, "--out", str(tmp_path), "--no-report")[1]
    assert (tmp_path / "report.html").read_text() == "old"
    assert "of an earlier run" not in call(*RUN, "--out", str(tmp_path / "new"), "--no-report")[1]


def test_without_out_nothing_is_written(
    call: Output, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert call(*RUN)[0] == 0
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("below", [".", "below"])
def test_out_that_is_a_file(below: str, call: Output, tmp_path: Path) -> None:
    taken = tmp_path / "taken"
    taken.write_text("mine")
    status, output, error = call(*RUN, "--out", str(taken / below))
    assert (status, output) == (2, "")
    assert error.startswith("error: --out: cannot be written to: ")
    assert error.count("\n") == 1
    assert taken.read_text() == "mine"


def test_out_that_turns_out_unwritable(call: Output) -> None:
    status, output, error = call(*RUN, "--out", "/proc/self/out/deep")
    assert (status, output) == (2, "")
    assert error.startswith("error: --out: cannot be written to: ")
    assert error.count("\n") == 1


@pytest.mark.parametrize("existing", [False, True])
def test_a_disk_that_fills_up_leaves_nothing(
    existing: bool, call: Output, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "new" / "out"
    if existing:
        out.mkdir(parents=True)
    before = sorted(tmp_path.rglob("*"))
    write = bs.Response.to_netcdf

    def fill_up(response: bs.Response, path: Path, **words: Any) -> None:
        write(response, path, **words)
        if path.parent.name == "stiff":
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(bs.Response, "to_netcdf", fill_up)
    status, _, error = call(*RUN, "--out", str(out))
    assert status == 2
    assert "No space left on device" in error
    assert sorted(tmp_path.rglob("*")) == before


def test_what_could_not_be_computed_is_status_3(
    call: Output, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def give_up(*_arguments: object, **_options: object) -> None:
        raise ComputationError("it diverged")

    monkeypatch.setattr("bumpstop.cli.solve.simulate", give_up)
    status, output, error = call(*RUN, "--out", str(tmp_path / "out"))
    assert (status, output) == (3, "")
    assert error == f"error: {SDNL32}: variant soft: it diverged\n"
    assert not (tmp_path / "out").exists()


def test_memory_that_does_not_suffice_is_status_3(
    call: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    def ask_for_too_much(*_arguments: object, **_options: object) -> None:
        raise MemoryError

    monkeypatch.setattr("bumpstop.cli.solve.simulate", ask_for_too_much)
    status, output, error = call(*RUN)
    assert (status, output) == (3, "")
    assert error == "error: not enough memory; take fewer samples, elements or modes\n"


@pytest.mark.parametrize(
    ("written", "instead", "told"),
    [
        (
            "stiffness = 18e3",
            "stiffness = 1e24",
            "stops.spring.stiffness: is 1.2e+17 times that of the stiffest mode there, "
            "more than double precision can hold apart (got 1e+24); check the units",
        ),
        (
            "stiffness = 18e3",
            "stiffness = 18e3\ndamping = 1e10",
            "stops.spring.damping: is 3.6e+07 times critical",
        ),
        ("damping = 0.01 ", "damping = 1e5 ", "basis.damping: is 1e+05 times critical"),
        ("damping = 0.01 ", "damping = 1e308 ", "basis.damping: is 1e+308 times critical"),
        (
            "young_modulus = 67e9",
            "young_modulus = 1e300",
            "basis: has a mode that turns through 2.3e+147 rad in the run",
        ),
    ],
)
def test_numbers_out_of_scale_are_status_2(
    written: str, instead: str, told: str, call: Output, tmp_path: Path
) -> None:
    text = SDNL32.read_text().partition("[variants")[0]
    assert written in text
    file = tmp_path / "case.toml"
    file.write_text(text.replace(written, instead), encoding="utf-8")
    status, output, error = call("run", str(file), "--method", "exact")
    assert (status, output) == (2, "")
    assert error.startswith(f"error: {file}: {told}")
    assert error.count("\n") == 1


def test_numbers_that_overflow_are_status_3(call: Output, monkeypatch: pytest.MonkeyPatch) -> None:
    def overflow(*_arguments: object, **_options: object) -> None:
        np.float64(1e300) * np.float64(1e300)

    monkeypatch.setattr("bumpstop.cli.solve.simulate", overflow)
    status, output, error = call(*RUN)
    assert (status, output) == (3, "")
    assert "too large or too small to compute with" in error
    assert error.count("\n") == 1


def test_a_mistake_of_our_own_is_one_line_and_status_3(
    call: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stumble(*_arguments: object, **_options: object) -> None:
        raise ZeroDivisionError("by zero\nindeed")

    monkeypatch.setattr("bumpstop.cli.solve.simulate", stumble)
    status, output, error = call(*RUN)
    assert (status, output) == (3, "")
    assert "ZeroDivisionError: by zero indeed" in error
    assert "--debug" in error
    assert error.count("\n") == 1


def test_debug_shows_where(call: Output) -> None:
    status, output, error = call("run", "nowhere.toml", "--debug")
    assert (status, output) == (2, "")
    assert error.startswith("Traceback")
    assert error.endswith("error: nowhere.toml: no such file; check the path\n")


def test_ctrl_c(call: Output, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_arguments: object, **_options: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("bumpstop.cli.outputs._write_report", interrupt)
    status, _, error = call(*RUN, "--out", str(tmp_path / "out"))
    assert (status, error) == (130, "interrupted\n")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["run"], "the following arguments are required: CASE.toml; see 'bumpstop run --help'"),
        (
            ["run", str(SDNL32), "--mehtod", "exact"],
            "'--mehtod'; did you mean '--method'?",
        ),
        (["run", str(SDNL32), "--outt=x"], "there is no option '--outt'; did you mean '--out'"),
        (["run", str(SDNL32), "--json=yes"], "error: --json takes no value (got 'yes'); see 'bump"),
        (["run", str(SDNL32), "--method"], "argument --method: expected one argument; see 'bump"),
        (
            ["run", str(SDNL32), "--method", "rk4"],
            "--method: unknown method (got 'rk4'); did you mean 'rk54'",
        ),
        (["run", str(SDNL32), "--method", "exakt"], "did you mean 'exact'?"),
        (["run", str(SDNL32), "--out", ""], "argument --out: is empty; see 'bumpstop run --help'"),
        (["rnu", str(SDNL32)], "there is no command 'rnu'; did you mean 'run'?"),
        (["--versoin"], "there is no option '--versoin'; did you mean '--version'?"),
        (["run", str(SDNL32), "more"], "one argument too many, 'more'; see 'bumpstop run --help'"),
    ],
)
def test_wrong_arguments(arguments: list[str], says: str, call: Output) -> None:
    status, output, error = call(*arguments)
    assert (status, output) == (2, "")
    assert error.startswith("error: ")
    assert says in error
    assert error.count("\n") == 1


def test_a_step_above_the_stability_limit(call: Output, tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_text(SDNL32.read_text().replace("dt = 1e-5", "dt = 1e-3"))
    status, _, error = call("run", str(file), "--method", "central_difference")
    assert status == 2
    assert error.startswith(f"error: {file}: run.dt: is above the stability limit of ")


def test_schemes_and_their_parameters_stand_in_case_files(call: Output, tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    scheme = 'method = "generalized_alpha"\nspectral_radius = 0.5\n'
    text = SDNL32.read_text()
    file.write_text(text.replace("[run]\n", f"[run]\n{scheme}").replace('method = "exact"\n', ""))
    status, output, _ = call("run", str(file), "--json")
    variants = json.loads(output)["variants"]
    assert status == 0
    assert {each["method"] for each in variants} == {"generalized_alpha"}
    assert {each["steps"] for each in variants} == {2000}
    file.write_text(file.read_text().replace("radius = 0.5", "radius = 1.5"))
    status, _, error = call("run", str(file))
    assert status == 2
    assert error.startswith(f"error: {file}: run.spectral_radius: must be from 0 to 1 (got 1.5)")


def test_the_reader_of_a_pipe_may_leave(tmp_path: Path) -> None:
    script = f"{sys.executable} -m bumpstop {' '.join(RUN)} 2>{tmp_path}/error | head -1"
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == f"{load_case(SDNL32).title}\n"
    assert (tmp_path / "error").read_text() == ""


def test_version_and_help(call: Output) -> None:
    assert call("--version") == (0, f"bumpstop {bs.__version__}\n", "")
    for arguments in ([], ["--help"]):
        status, output, _ = call(*arguments)
        assert status == 0
        assert all(word in output for word in ("run", "modes", "verify", "report", "schema"))
    for arguments in (["run", "--help"], ["run", str(SDNL32), "-h"]):
        status, output, _ = call(*arguments)
        assert status == 0
        assert all(word in output for word in ("CASE.toml", "--method M", "--out DIR", "--json"))


def test_a_bearing_with_cross_stiffness_runs(call: Output, tmp_path: Path) -> None:
    case = tmp_path / "case.toml"
    case.write_text(
        "[nodes]\nP = [0, 0, 0]\n"
        '[masses.disc]\nnode = "P"\nmass = 2.0\n'
        '[bearings.film]\nnode = "P"\nstiffness = [[2e6, 1e5], [-1e5, 2e6]]\n'
        '[[supports]]\nnodes = ["P"]\nfixed = ["dx"]\n'
        "[initial]\nmodal = { velocity = [0.1, 0.0] }\n"
        "[basis]\nmodes = 2\n[run]\nduration = 0.1\n"
    )
    status, output, error = call("run", str(case), "--json")
    assert (status, error) == (0, "")
    assert json.loads(output)["variants"][0]["energy_residual"] < 1e-12


def test_exports(call: Output, tmp_path: Path) -> None:
    options = ["--out", str(tmp_path), "--no-report"]
    status, _, error = call(*RUN, *options, "--export", "csv,wav")
    assert (status, error) == (0, "")
    for variant in ("soft", "stiff"):
        names = sorted(path.name for path in (tmp_path / variant).iterdir())
        assert names == ["response.csv", "response.nc", "response.wav"]
    again = call(*RUN, *options, "--export", "csv")
    left = "of an earlier run, left as they were: soft/response.wav, stiff/response.wav"
    assert left in again[1]


def test_exports_that_the_case_asks_for(call: Output, tmp_path: Path) -> None:
    text = SDNL32.read_text().replace("[run]", '[run]\nexport = ["uff", "mat"]')
    (tmp_path / "case.toml").write_text(text + '\n[variants.bare]\n"run.export" = []\n')
    status, _, error = call("run", str(tmp_path / "case.toml"), "--out", str(tmp_path / "out"))
    assert (status, error) == (0, "")
    found = {path.relative_to(tmp_path / "out").as_posix() for path in tmp_path.glob("out/*/*")}
    files = ("response.nc", "response.uff", "response.mat")
    assert found == {f"{name}/{file}" for name in ("soft", "stiff") for file in files} | {
        "bare/response.nc"
    }
    assert call("run", str(tmp_path / "case.toml"))[0] == 0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--export", "csv"], "error: --export: needs a folder to write to; give --out, too"),
        (["--export", "csv,exel", "--out", "x"], "error: --export: unknown"),
        (["--export", "", "--out", "x"], "error: --export: unknown"),
    ],
)
def test_exports_that_cannot_be(
    options: list[str], message: str, call: Output, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    status, output, error = call("run", str(SDNL32), *options)
    assert (status, output) == (2, "")
    assert error.startswith(message)
    assert error.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_an_export_that_fails_leaves_nothing(call: Output, tmp_path: Path) -> None:
    text = SDNL32.read_text().replace("[run]", '[run]\nexport = ["exel"]')
    (tmp_path / "case.toml").write_text(text)
    status, _, error = call("run", str(tmp_path / "case.toml"), "--out", str(tmp_path / "out"))
    assert status == 2
    assert "run.export" in error
    assert not (tmp_path / "out").exists()


def with_results(folder: Path, end: float) -> Path:
    """Return SDNL32 with statistics of its stop between two instants."""
    file = folder / "counted" / "case.toml"
    file.parent.mkdir()
    asked = f'\n[results.rattle]\ntype = "contact_statistics"\nstop = "spring"\nend = {end}\n'
    file.write_text(SDNL32.read_text() + asked + "blocks = 1\n")
    return file


def test_results_that_a_case_asks_for_are_told(call: Output, tmp_path: Path) -> None:
    case = with_results(tmp_path, 0.02)
    status, output, error = call("run", str(case), "--json")
    assert (status, error) == (0, "")
    for variant in json.loads(output)["variants"]:
        (told,) = variant["results"]
        assert (told["name"], told["missing"]) == ("rattle", None)
        numbers = {each["quantity"]: each for each in told["numbers"]}
        assert numbers["number of impacts"]["value"] == 1
        assert numbers["time loaded"]["units"] == "s"
        assert all(
            each.keys() == {"quantity", "units", "value", "uncertainty"}
            for each in numbers.values()
        )
    status, output, _ = call("run", str(case))
    lines = [line.split() for line in output.splitlines()]
    assert status == 0
    assert lines.count(["rattle"]) == 2
    assert lines.count(["number", "of", "impacts", "1"]) == 2


def test_a_result_that_cannot_be_read_is_told_without_a_report(
    call: Output, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise ComputationError("no such luck")

    monkeypatch.setattr(Statistics, "read", broken)
    case = with_results(tmp_path, 0.02)
    status, output, error = call("run", str(case), "--json")
    assert status == 1
    assert error == f"error: {case}: results.rattle: no such luck\n"
    for variant in json.loads(output)["variants"]:
        (told,) = variant["results"]
        assert told["numbers"] == []
        assert told["missing"] == "results.rattle: no such luck"
