"""What several files say, since each is read by another tool or person, must agree."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import bumpstop

ROOT = Path(__file__).parents[1]


def test_version_is_the_same_everywhere() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    citation = re.search(r"^version: (.+)$", (ROOT / "CITATION.cff").read_text("utf-8"), re.M)
    assert citation
    assert {
        bumpstop.__version__,
        project["project"]["version"],
        workspace["workspace"]["package"]["version"],
        citation[1],
    } == {bumpstop.__version__}


def test_readme_asks_for_the_versions_that_are_needed() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    python = project["project"]["requires-python"].removeprefix(">=")
    rust = workspace["workspace"]["package"]["rust-version"]
    assert f"Python {python} or newer" in readme
    assert f"Rust toolchain ({rust} or newer)" in readme
