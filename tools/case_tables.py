"""Write the tables that a case computes into its README, or tell whether they are there.

A case with such tables has a ``tables.py`` with ``TABLES``: for the first cell of each table's
head, the function that computes the whole table as Markdown. ``python tools/case_tables.py``
prints them, for all cases or those named; with ``--write`` they go into the READMEs.
"""

from __future__ import annotations

import re
import runpy
import sys
from pathlib import Path

CASES = Path(__file__).parents[1] / "cases"


def cases_with_tables() -> list[str]:
    """Return the names of the cases that compute tables."""
    return sorted(script.parent.name for script in CASES.glob("*/tables.py"))


def readme(case: str) -> str:
    """Return a case's README with its tables as they are computed now.

    Raises
    ------
    LookupError
        If the README has no table with such a head.
    """
    text = (CASES / case / "README.md").read_text(encoding="utf-8")
    for head, table in computed(case).items():
        text, found = re.subn(rf"\| {re.escape(head)} \|.*\n(\|.*\n)*", f"{table}\n", text)
        if found != 1:
            raise LookupError(f"{case}/README.md must have one table headed '{head}'")
    return text


def computed(case: str) -> dict[str, str]:
    """Return a case's tables, computed now, by the first cells of their heads."""
    tables = runpy.run_path(str(CASES / case / "tables.py"))["TABLES"]
    return {head: table() for head, table in tables.items()}


def main(arguments: list[str]) -> None:
    """Print or write the tables of the cases named, or of all."""
    names = [each for each in arguments if each != "--write"] or cases_with_tables()
    for name in names:
        if "--write" in arguments:
            (CASES / name / "README.md").write_text(readme(name), encoding="utf-8")
        else:
            print(name, *computed(name).values(), sep="\n\n", end="\n\n")


if __name__ == "__main__":
    main(sys.argv[1:])
