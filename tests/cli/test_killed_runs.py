"""A run that is killed leaves nothing that the next one to the same place does not clear away."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from bumpstop.cli import main
from bumpstop.files import temporary_name

SDNL32 = Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml"

STUCK_WRITING = """
import sys
from bumpstop.cli import main
from bumpstop.report import html

def write_report(*_):
    print("writing", flush=True)
    sys.stdin.read()  # until nobody is there to kill it

html.write_report = write_report
main(sys.argv[1:])
"""


def arguments(out: Path) -> list[str]:
    return ["run", str(SDNL32), "--out", str(out)]


def found(folder: Path) -> set[str]:
    """Return the paths of all files below a folder, hidden ones too."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


@contextmanager
def run_that_is_killed(out: Path) -> Iterator[None]:
    """Start a run, go on once its first files are written, and kill it at the end."""
    command = [sys.executable, "-c", STUCK_WRITING, *arguments(out)]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "writing\n"
        try:
            yield
        finally:
            process.send_signal(signal.SIGKILL)


@pytest.mark.parametrize("there_before", [False, True])
def test_the_next_run_clears_away_what_a_killed_one_left(
    there_before: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "results" / "sdnl32"
    if there_before:
        out.mkdir(parents=True)
    with run_that_is_killed(out):
        pass
    left = found(tmp_path)
    assert len(left) == 2
    assert all(".part/" in path for path in left)
    assert main([*arguments(out), "--no-report"]) == 0
    assert list(out.parent.iterdir()) == [out]
    assert found(out) == {"soft/response.nc", "stiff/response.nc"}
    assert capsys.readouterr().err == ""


def test_a_run_that_still_goes_on_is_left_alone(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with run_that_is_killed(out):
        before = found(tmp_path)
        assert main([*arguments(out), "--no-report"]) == 0
        assert before < found(tmp_path)


def test_neither_other_machines_nor_other_names_are_touched(tmp_path: Path) -> None:
    out = tmp_path / "out"
    nobody = 999_999_999  # far above any process number
    of_the_dead = temporary_name(out).name.replace(f"-{os.getpid()}-", f"-{nobody}-")
    elsewhere = f".out.another-machine-{nobody}-0.part"
    for name in (of_the_dead, elsewhere, f".outer.{nobody}-0.part", f"out-{nobody}-0.part"):
        (tmp_path / name).mkdir()
    assert main([*arguments(out), "--no-report"]) == 0
    kept = {path.name for path in tmp_path.iterdir()} - {"out"}
    assert kept == {elsewhere, f".outer.{nobody}-0.part", f"out-{nobody}-0.part"}
