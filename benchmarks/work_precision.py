"""Work against precision of every method, and of other programs, on three problems.

``python benchmarks/work_precision.py`` prints the tables, ``--write`` puts them into
``docs/work-precision.md``. Each method has a ladder of steps or tolerances; its error is the
largest of the watched displacement at fifty instants, over the largest displacement, against the
exact method. Work is the processor time of one run, the least of some: other programs on the
machine disturb it least. Other programs take part where they are installed.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))  # the benchmarks are a package beside it

from benchmarks.precision.ladders import Ladder, climbed
from benchmarks.precision.problems import PROBLEMS, Watched
from benchmarks.precision.solvers import solvers

PAGE = Path(__file__).parents[1] / "docs" / "work-precision.md"
MARK = "<!-- tables -->"
ERRORS = (1e-2, 1e-4, 1e-6, 1e-8)
"""Errors that the tables tell the work for."""


def table(problem: Watched) -> str:
    """Return the work of all solvers on a problem, as Markdown."""
    head = ["method", *(f"{error:.0e}" for error in ERRORS), "least error", "order"]
    lines = [f"| {' | '.join(head)} |", "|---" * len(head) + "|"]
    for solver in solvers(problem):
        lines.append(_line(climbed(solver, problem)))
    return f"## {problem.title}\n\n{problem.told}\n\n" + "\n".join(lines)


def _line(ladder: Ladder) -> str:
    work = [ladder.work_for(error) for error in ERRORS]
    cells = ["–" if seconds is None else _seconds(seconds) for seconds in work]
    order = "–" if ladder.order is None else f"{ladder.order:.1f}"
    # The exact method is what errors are measured against.
    least = "–" if ladder.least == 0.0 else f"{ladder.least:.0e}"
    return f"| {ladder.name} | {' | '.join(cells)} | {least} | {order} |"


def _seconds(seconds: float) -> str:
    return f"{1e6 * seconds:,.0f} µs" if seconds < 1e-3 else f"{1e3 * seconds:,.1f} ms"


def main(arguments: Sequence[str]) -> None:
    """Print the tables, or write them."""
    tables = "\n\n".join(table(problem) for problem in PROBLEMS)
    if "--write" not in arguments:
        print(tables)
        return
    text = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(f"{text[: text.index(MARK)]}{MARK}\n\n{tables}\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
