"""Streams that are closed or full, and names that the locale cannot spell."""

import json
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr

SDNL32 = Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml"
FULL = Path("/dev/full")
PLAIN_C = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
"""A locale that knows ASCII alone, and a Python that does not help itself out of it."""


def shell(line: str, **environment: str) -> subprocess.CompletedProcess[bytes]:
    """Run a line of the shell in which ``bumpstop`` is the command."""
    program = shlex.join([sys.executable, "-m", "bumpstop"])
    return subprocess.run(
        ["sh", "-c", line.replace("bumpstop", program, 1)],
        capture_output=True,
        check=False,
        env=os.environ | environment,
    )


@pytest.mark.parametrize(
    ("arguments", "status"),
    [(["modes", str(SDNL32)], 0), (["--help"], 0), (["modes", "nowhere"], 2)],
)
def test_nobody_listens(arguments: list[str], status: int) -> None:
    command = shlex.join(["bumpstop", *arguments])
    for closed in (">&-", "2>&-", ">&- 2>&- <&-"):
        assert shell(f"{command} {closed}").returncode == status


def test_files_are_whole_where_nobody_listens(tmp_path: Path) -> None:
    out = tmp_path / "out"
    line = f"bumpstop run {SDNL32} --no-report --out {out} >&- 2>&- <&-"
    assert shell(line).returncode == 0
    with xr.open_dataset(out / "soft" / "response.nc", engine="h5netcdf") as file:
        assert file.attrs["case"] == "sdnl32"


@pytest.mark.skipif(not FULL.exists(), reason="this system has no /dev/full")
def test_an_error_that_finds_no_room() -> None:
    assert shell("bumpstop modes nowhere 2>/dev/full").returncode == 2


@pytest.mark.parametrize(
    ("folder", "told"),
    [("Träger 梁".encode(), "Träger 梁"), (b"Tr\xe4ger", "Tr\N{REPLACEMENT CHARACTER}ger")],
)
@pytest.mark.parametrize("locale", [{}, PLAIN_C])
def test_folders_in_any_spelling(
    folder: bytes, told: str, locale: dict[str, str], tmp_path: Path
) -> None:
    place = tmp_path / os.fsdecode(folder)
    try:
        place.mkdir()
    except OSError:
        pytest.skip("this file system wants UTF-8")
    shutil.copy(SDNL32, place)
    line = f"cd {tmp_path}/Tr* && exec bumpstop run case.toml --json --out Ergebnisse"
    done = shell(line, **locale)
    assert (done.returncode, done.stderr) == (0, b"")
    assert json.loads(done.stdout)["case"] == told
    with xr.open_dataset(place / "Ergebnisse/stiff/response.nc", engine="h5netcdf") as file:
        assert file.attrs["case"] == told
    assert "SDNL32" in (place / "Ergebnisse" / "report.html").read_text(encoding="utf-8")


def test_an_interrupt_after_the_work_is_too_late() -> None:
    """Else Python, about to end, would print a traceback beside the status of good work."""
    script = (
        "import os, signal, sys; from bumpstop.cli import main; sys.argv[1:] = ['--version']; "
        "status = main(); os.kill(os.getpid(), signal.SIGINT); sys.exit(status)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
