"""``bumpstop sweep``: what it prints, writes and returns, and that it survives being killed."""

import errno
import itertools
import json
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.cli import main
from tests.study.bouncing import CASE, IN_PYTHON, STUDY, written


def content(store: Path) -> dict[str, bytes]:
    """Return the content of every file of a store."""
    found = (path for path in store.rglob("*") if path.is_file())
    return {str(path.relative_to(store)): path.read_bytes() for path in found}


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """Return the one line that says why a sweep is refused."""
    assert main(["sweep", *words]) == 2
    captured = capsys.readouterr()
    (line,) = captured.err.splitlines()
    assert not captured.out
    return line


def test_table_and_store(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = written(tmp_path)
    assert main(["sweep", str(study), "--workers", "1"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "A ball thrown at a spring"
    assert lines[1].startswith("10 runs: ")
    assert lines[3].split()[:5] == ["output", "unit", "smallest", "mean", "largest"]
    (force,) = [line.split() for line in lines if line.split()[:1] == ["force"]]
    # 3 m/s sqrt(k m) with m = 2 kg and k from 50 to 800 N/m
    mean = 3.0 * np.sqrt(2.0 * np.geomspace(50.0, 800.0, 5)).mean()
    assert force[1:5] == ["N", "30", f"{mean:.6g}", "120"]
    assert force[5:8] == ["stops.spring.stiffness", "=", "800,"]
    assert lines[-2:] == [
        f"written to {tmp_path / 'study.zarr'}",
        f"report in {tmp_path / 'study.html'}",
    ]
    assert bs.open_study(tmp_path / "study.zarr").sizes["stops.spring.gap"] == 2


def test_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = STUDY.replace('[0.25, "50 cm"]', "[0.25, 0.5]").replace('from = "50 N/m"', "from = -50")
    study = study.replace('"log"', '"linear"')
    path = written(tmp_path, study)
    words = ["sweep", str(path), "--store", str(tmp_path / "other"), "--workers", "1", "--json"]
    assert main(words) == 0
    record = json.loads(capsys.readouterr().out)
    assert (record["runs"], record["made"], record["failed"]) == (10, 10, 2)
    assert record["store"] == str(tmp_path / "other")
    assert record["failures"][0]["parameters"]["stops.spring.stiffness"] == -50.0
    assert "must be positive" in record["failures"][0]["message"]
    assert record["outputs"]["force"]["largest"] == pytest.approx(120.0)
    assert record["outputs"]["force"]["largest_with"]["stops.spring.stiffness"] == 800.0
    assert main([*words, "--resume"]) == 0
    assert json.loads(capsys.readouterr().out)["made"] == 0


def test_the_worst_case(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sampling = '[sampling]\nmethod = "worst_case"\nof = "force"\ncount = 160\n'
    path = written(tmp_path, STUDY.replace("[execution]\nchunk = 3", sampling))
    assert main(["sweep", str(path)]) == 0
    (told,) = [line for line in capsys.readouterr().out.splitlines() if "worst case" in line]
    found = bs.open_study(tmp_path / "study.zarr")
    worst = int(found.force.values.argmax())
    # 3 m/s sqrt(k m) with m = 2 kg and k up to 800 N/m
    assert found.force.values[worst] == pytest.approx(120.0, rel=1e-3)
    assert told == f"worst case: force = {found.force.values[worst]:.9g} N in run {worst}"
    assert "Search for the largest force" in (tmp_path / "study.html").read_text()
    assert main(["sweep", str(path), "--open", str(worst), "--json"]) == 0
    opened = tmp_path / f"study-run-{worst}" / "case.toml"
    (problem,) = bs.load_case(opened).problems.values()
    again = bs.Output(quantity="largest_force", stop="spring").value(bs.simulate(problem))
    assert again == found.force.values[worst]


def test_what_each_parameter_does(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sampling = '[sampling]\nmethod = "one_at_a_time"\n[execution]'
    study = STUDY.replace("[execution]", sampling).replace(', spacing = "log"', "")
    path = written(tmp_path, study)
    assert main(["sweep", str(path), "--workers", "1"]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    # 3 m/s sqrt(k m), m = 2 kg, at 5, 50 and 95 % of 50 to 800 N/m
    stiffness = np.array([87.5, 425.0, 762.5])
    force = [f"{each:.4g}" for each in 3.0 * np.sqrt(2.0 * stiffness)]
    assert ["output", "parameter", "low", "middle", "high"] in rows
    assert ["force", "stops.spring.stiffness", *force] in rows
    drawn = study.replace("one_at_a_time", "saltelli").replace('saltelli"', 'saltelli"\ncount = 8')
    path = written(tmp_path, drawn.replace("impact = 1", "impact = 7"))
    words = ["sweep", str(path), "--store", str(tmp_path / "drawn"), "--workers", "1", "--json"]
    assert main(words) == 0
    told = json.loads(capsys.readouterr().out)["sensitivities"]
    # There are no seven impacts, and so no variance of when the last begins.
    assert told["start"]["stops.spring.gap"] == {"alone": None, "with_others": None}
    assert set(told) == {"force", "start"}
    found = bs.open_study(tmp_path / "drawn")
    assert told["force"]["stops.spring.stiffness"]["alone"] == found.force_first.values[0]


def test_failures_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    all_wrong = STUDY.replace('"50 N/m"', "-2").replace("800", "-1").replace('"log"', '"linear"')
    assert main(["sweep", str(written(tmp_path, all_wrong)), "--workers", "1"]) == 3
    output = capsys.readouterr().out
    assert "10 failed, such as" in output
    assert "stops.spring.stiffness: must be positive (got -2.0)" in output


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("stops.spring.stiffness", "stops.spring.stifness", "did you mean 'stiffness'?"),
        ('"stops.spring.gap"', "stops.spring.gap", "a dotted name goes in quotes"),
        ('[0.25, "50 cm"]', "[]", 'gap".values: must be a list of one value or more (got [])'),
        ('[0.25, "50 cm"]', '["50 N"]', "wrong unit: 'N' is a force, expected a length"),
        ("count = 5", "count = 1000000000000", "at most 20,000,000"),
        ("count = 5", "cuont = 5", "did you mean 'count'?"),
        ('[0.25, "50 cm"]', '{ distribution = "normel", mean = 1 }', "did you mean 'normal'?"),
        ("impact = 1", "impct = 1", "did you mean 'impact'?"),
        ("largest_force", "larges_force", "did you mean 'largest_force'?"),
        ('node = "P"', 'node = "Q"', "outputs.place.node: unknown node"),
        ("[execution]", '[sampling]\nmethod = "sobl"\n[execution]', "did you mean 'sobol'?"),
        (
            "[execution]",
            '[sampling]\nmethod = "sobol"\ncount = 100\n[execution]',
            "sampling.count: must be a power of two",
        ),
        ("case.toml", "cse.toml", "cse.toml: no such file"),
        ("chunk = 3", "workers = 0", "execution.workers: must be 1 or more"),
        ("case = ", "cases = ", "did you mean 'case'?"),
    ],
)
def test_wrong_studies(
    old: str, new: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, STUDY.replace(old, new))
    assert told in refused(capsys, str(path))
    assert not (tmp_path / "study.zarr").exists()


def test_places_that_cannot_be_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = str(written(tmp_path))
    assert "cannot be written" in refused(capsys, study, "--store", "/proc/study.zarr")
    (tmp_path / "file").touch()
    inside = refused(capsys, study, "--store", str(tmp_path / "file" / "s.zarr"))
    assert "cannot be written" in inside
    assert "is not the store" in refused(capsys, study, "--resume", "--store", str(tmp_path))
    assert main(["sweep", study, "--workers", "1"]) == 0
    capsys.readouterr()
    assert "is there already; go on with it by --resume" in refused(capsys, study)


def test_a_full_disk_loses_nothing(tmp_path: Path) -> None:
    study = written(
        tmp_path, STUDY.replace("0.05, 1.9", ", ".join(f"{t / 500:g}" for t in range(1000)))
    )
    store = tmp_path / "study.zarr"
    words = [sys.executable, "-m", "bumpstop", "sweep", str(study), "--workers", "1"]

    def narrow() -> None:
        # A write beyond this fails as on a full disk, instead of ending the process.
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (15_000, 15_000))

    failed = subprocess.run(words, preexec_fn=narrow, capture_output=True, text=True, check=False)
    assert failed.returncode == 2
    (line,) = failed.stderr.splitlines()
    assert "study.zarr: store: cannot be written: File too large" in line
    assert "make room, or name another folder" in line  # not even the study itself had room
    assert not store.exists()
    assert subprocess.run(words, capture_output=True, check=False).returncode == 0
    whole = tmp_path / "whole.zarr"
    assert main(["sweep", str(study), "--workers", "1", "--store", str(whole)]) == 0
    assert content(store) == content(whole)


@pytest.mark.parametrize("reason", [errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EIO])
@pytest.mark.parametrize("write", [0, 3, 17])
def test_a_write_that_fails_loses_nothing(
    reason: int,
    write: int,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    words = ["sweep", str(written(tmp_path)), "--workers", "1", "--no-report"]
    assert main([*words, "--store", str(tmp_path / "whole.zarr")]) == 0
    capsys.readouterr()
    writes = itertools.count()
    replace = Path.replace

    def fail(path: Path, target: Path) -> Path:
        # Counted when the store has been made: its files are then those of chunks.
        made = path.suffix == ".partial" and (tmp_path / "study.zarr").exists()
        if made and next(writes) >= write:
            raise OSError(reason, os.strerror(reason))
        return replace(path, target)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "replace", fail)
        line = refused(capsys, *words[1:])
    assert f"study.zarr: store: cannot be written: {os.strerror(reason)}" in line
    assert "go on with --resume" in line
    assert main([*words, "--resume"]) == 0
    assert content(tmp_path / "study.zarr") == content(tmp_path / "whole.zarr")


def test_a_store_that_is_read_only(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    study = str(written(tmp_path))
    assert main(["sweep", study, "--workers", "1"]) == 0
    capsys.readouterr()
    before = content(tmp_path / "study.zarr")
    # Permissions hold nobody off who runs as root.
    monkeypatch.setattr(os, "access", lambda path, _: "study.zarr" not in str(path))
    line = refused(capsys, study, "--resume")
    assert line == f"error: {tmp_path / 'study.zarr'}: store: is read-only"
    assert content(tmp_path / "study.zarr") == before


def test_runs_that_cannot_be_opened(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = str(written(tmp_path))
    assert "--open: the study has runs 0 to 9 (got 10)" in refused(capsys, study, "--open", "10")
    assert "--open: must be 0 or more" in refused(capsys, study, "--open=-1")
    assert not (tmp_path / "study-run-10").exists()
    (tmp_path / "study-run-3").touch()
    assert "--open: cannot be written to" in refused(capsys, study, "--open", "3")


def wait_for(file: Path, process: subprocess.Popen[Any]) -> None:
    """Wait until a process has written a file, however busy the machine is."""
    while not file.exists():
        assert process.poll() is None, "it ended early"
        time.sleep(0.005)


def test_killed_at_any_instant_and_resumed(tmp_path: Path) -> None:
    slow = CASE.replace("duration = 2.0", "duration = 2.0\nsample = 2e-6")
    many = IN_PYTHON.replace("count = 5", "count = 30")
    study = written(tmp_path, many, slow)
    whole, store = tmp_path / "whole.zarr", tmp_path / "study.zarr"
    assert main(["sweep", str(study), "--store", str(whole), "--workers", "1"]) == 0
    words = [sys.executable, "-m", "bumpstop", "sweep", str(study), "--workers", "2"]
    random = np.random.default_rng(5)
    for chunk in (0, 4, 9):  # of 20
        resume = ["--resume"] if store.exists() else []
        with subprocess.Popen([*words, *resume], stdout=subprocess.DEVNULL) as process:
            wait_for(store / "status" / "c" / str(chunk), process)
            time.sleep(random.uniform(0.0, 0.05))
            process.send_signal(signal.SIGKILL)
            assert process.wait() == -signal.SIGKILL
    done = subprocess.run([*words, "--resume"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert content(store) == content(whole)


def hear_interrupts() -> None:
    """Let a process hear Ctrl-C even where the tests run in the background, which does not."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.parametrize("given", [STUDY, IN_PYTHON], ids=["core", "python"])
def test_interrupted(given: str, tmp_path: Path) -> None:
    study = written(tmp_path, given.replace("count = 5", "count = 50000"))
    words = [sys.executable, "-m", "bumpstop", "sweep", str(study), "--workers", "2"]
    with subprocess.Popen(
        words, stderr=subprocess.PIPE, text=True, preexec_fn=hear_interrupts
    ) as process:
        wait_for(tmp_path / "study.zarr" / "status" / "c" / "0", process)
        process.send_signal(signal.SIGINT)
        assert process.stderr is not None
        lines = process.stderr.read().splitlines()
        assert process.wait() == 130
    assert lines[-1] == "interrupted"
    assert "of 100000 runs are kept; go on by --resume" in lines[0]
    assert len(lines) == 2


def test_a_run_of_a_study_that_has_changed_is_not_opened(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path)
    assert main(["sweep", str(path), "--workers", "1", "--no-report"]) == 0
    case = tmp_path / "case.toml"
    case.write_text(CASE.replace("-3.0]", "-6.0]"))
    capsys.readouterr()
    line = refused(capsys, str(path), "--open", "3")
    assert "the study has changed: case.initial.translation.velocity.2 was -3.0" in line
    assert not (tmp_path / "study-run-3").exists()
    case.write_text(CASE)
    assert main(["sweep", str(path), "--open", "3", "--json"]) == 0


def test_a_store_that_is_not_there_is_not_resumed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path)
    line = refused(capsys, str(path), "--resume", "--store", str(tmp_path / "nothere.zarr"))
    assert "nothere.zarr: store: no such store; leave out --resume" in line
    assert not (tmp_path / "nothere.zarr").exists()
