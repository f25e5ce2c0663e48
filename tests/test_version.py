"""The version stands in four files, since each is read by another tool; they must agree."""

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
