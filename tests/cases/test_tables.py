"""The tables in the READMEs of cases are those that their scripts compute."""

import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TOOL = runpy.run_path(str(ROOT / "tools" / "case_tables.py"))


@pytest.mark.parametrize("case", TOOL["cases_with_tables"]())
def test_the_readme_has_the_tables_that_are_computed(case: str) -> None:
    written = (ROOT / "cases" / case / "README.md").read_text(encoding="utf-8")
    assert TOOL["readme"](case) == written
