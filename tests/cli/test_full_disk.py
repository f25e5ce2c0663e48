"""Output that finds no room is the user's to mend, and is said in one line."""

import subprocess
import sys
from pathlib import Path

import pytest

FULL = Path("/dev/full")


@pytest.mark.skipif(not FULL.exists(), reason="this system has no /dev/full")
def test_standard_output_without_room() -> None:
    with FULL.open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "bumpstop", "schema"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2
    assert done.stderr.splitlines() == [
        "error: no space left where the output goes; make room or write elsewhere"
    ]
