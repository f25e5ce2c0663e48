"""What make needs from the machine is missing or too old: one line says so, and how to mend it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
UTILITIES = ("sed", "sort", "tail")
OLDEST_RUST = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"][
    "package"
]["rust-version"]
NO_VENV = "import sys; sys.modules['ensurepip'] = None; exec(sys.argv[1])"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder that is the whole PATH, with what the scripts themselves call."""
    for name in UTILITIES:
        found = shutil.which(name)
        assert found
        (tmp_path / name).symlink_to(found)
    return tmp_path


def program(folder: Path, name: str, script: str) -> None:
    path = folder / name
    path.write_text(f"#!/bin/sh\n{script}\n", encoding="ascii")
    path.chmod(0o755)


def run(folder: Path, tool: str, **environment: str) -> subprocess.CompletedProcess[str]:
    shell = shutil.which("sh")
    assert shell
    return subprocess.run(
        [shell, str(ROOT / "tools" / tool)],
        cwd=ROOT,
        env={"PATH": str(folder), **environment},
        capture_output=True,
        text=True,
        check=False,
    )


def refusal(done: subprocess.CompletedProcess[str]) -> str:
    """Return the one line that a script refused with."""
    assert done.returncode == 1
    assert done.stdout == ""
    lines = done.stderr.splitlines()
    assert len(lines) == 1
    return lines[0]


def test_finds_a_python_that_will_do(folder: Path) -> None:
    program(folder, "python3", "echo 'is 3.9.18' >&2; exit 1")
    (folder / "python3.11").symlink_to(sys.executable)
    done = run(folder, "find-python")
    assert done.returncode == 0
    assert Path(done.stdout.strip()).exists()


def test_no_python(folder: Path) -> None:
    line = refusal(run(folder, "find-python"))
    assert "3.11 or newer with venv (python3 is not there)" in line
    assert "make run PYTHON=" in line


def test_old_python(folder: Path) -> None:
    probe = "import sys; sys.version_info = (3, 9, 18); sys.version = '3.9.18 (main)'; "
    program(folder, "python3", f'exec "{sys.executable}" -c "{probe}exec(sys.argv[1])" "$2"')
    assert "(python3 is 3.9.18)" in refusal(run(folder, "find-python"))


def test_python_without_venv(folder: Path) -> None:
    program(folder, "python3", f'exec "{sys.executable}" -c "{NO_VENV}" "$2"')
    assert "python3 has no venv" in refusal(run(folder, "find-python"))


def test_only_the_python_asked_for(folder: Path) -> None:
    (folder / "python3").symlink_to(sys.executable)
    line = refusal(run(folder, "find-python", PYTHON="/no/such/python"))
    assert "/no/such/python is not there" in line


@pytest.mark.parametrize(
    ("rustc", "complaint"),
    [
        (None, "rustc is not on the PATH"),
        ("echo 'rustc 1.84.1 (e71f9a9a9 2025-01-27)'", "rustc is 1.84.1"),
        ("echo 'rustc 1.9.0'", "rustc is 1.9.0"),
        ("echo 'error: no default toolchain' >&2; exit 1", "rustc does not run"),
    ],
)
def test_unusable_rust(folder: Path, rustc: str | None, complaint: str) -> None:
    program(folder, "cargo", "exit 0")
    program(folder, "cc", "exit 0")
    if rustc:
        program(folder, "rustc", rustc)
    line = refusal(run(folder, "require-rust"))
    assert complaint in line
    assert f"{OLDEST_RUST} or newer" in line
    assert "rustup" in line


def test_no_linker(folder: Path) -> None:
    program(folder, "cargo", "exit 0")
    program(folder, "rustc", "echo 'rustc 2.0.0-nightly (59807616e 2026-04-14)'")
    assert "linker 'cc'" in refusal(run(folder, "require-rust"))
    program(folder, "cc", "exit 0")
    assert run(folder, "require-rust").returncode == 0


@pytest.mark.skipif(not shutil.which("make"), reason="this machine has no make")
def test_make_alone_lists_what_can_be_made() -> None:
    environment = {**os.environ, "MAKEFLAGS": ""}
    done = subprocess.run(
        ["make", "--no-print-directory"],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    assert {"run", "test", "lint", "bench", "docs", "wheel"} <= {
        line.split()[0] for line in done.stdout.splitlines()
    }
