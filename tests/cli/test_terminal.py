"""On a terminal: colours, lines that are not broken, a progress bar for long runs."""

import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest

from bumpstop.cli import progress
from bumpstop.study.execution import Progress

SDNL32 = Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml"
GREEN = "\x1b[32m"


def on_terminal(*arguments: str, columns: int = 80) -> str:
    """Return what a command shows on a terminal of its own."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "TERM": "xterm-256color", "COLUMNS": str(columns)}
    environment.pop("NO_COLOR", None)
    command = [sys.executable, "-m", "bumpstop", *arguments]
    process = subprocess.Popen(command, stdout=theirs, stderr=theirs, env=environment)
    os.close(theirs)
    shown = b""
    while True:
        try:
            part = os.read(ours, 65536)
        except OSError:  # the other end is closed
            break
        if not part:
            break
        shown += part
    os.close(ours)
    process.wait()
    return shown.decode()


def test_summary_in_colour() -> None:
    shown = on_terminal("run", str(SDNL32))
    assert shown.count(f"{GREEN}yes") == 24
    plain = re.sub(r"\x1b\[[0-9;]*m", "", shown)
    assert "time [s]" in plain
    assert re.search(r"  method exact, .* solved in [0-9.]+ .?s\r\n", plain)


@pytest.mark.parametrize("columns", [0, 1, 30])
def test_a_narrow_terminal_hides_no_number(columns: int) -> None:
    narrow, wide = (
        re.sub(r"\x1b\[[0-9;]*m", "", on_terminal("modes", str(SDNL32), columns=width))
        for width in (columns, 80)
    )
    assert "SDNL32: a hinged beam thrown against an elastic stop" in narrow
    assert narrow.split() == wide.split()
    assert "85.4068" in wide


def test_help_in_colour() -> None:
    assert "\x1b[" in on_terminal("run", "--help")


def test_no_bar_without_a_terminal() -> None:
    with progress.progress_display("a run") as tell:
        assert tell is None


def test_a_bar_for_a_run_that_takes_long(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    clock = iter([0.0, 0.5, 1.5])
    monkeypatch.setattr(progress, "monotonic", lambda: next(clock))
    with progress.progress_display("a run") as tell:
        assert tell is not None
        tell(0.2)
        assert capsys.readouterr().err == ""
        tell(0.4)
        tell(0.6)
    assert "a run" in capsys.readouterr().err


def test_a_bar_for_a_study(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.setattr(progress, "monotonic", iter([0.0, 2.0, 4.0]).__next__)
    with progress.runs_display("a study") as tell:
        assert tell is not None
        tell(Progress(done=30, runs=100, made=20, failed=0))
        tell(Progress(done=70, runs=100, made=60, failed=2))
    shown = capsys.readouterr().err
    assert "a study" in shown
    assert "70/100" in shown
    assert "15 a second, 2 failed" in shown
    assert re.search(r"\d:\d\d:\d\d", shown)  # time left
