"""The card that a notebook shows for a response."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from bumpstop.post.energy import residual_told

if TYPE_CHECKING:
    from bumpstop.response import Response

__all__ = ["response_card"]

MOST_NAMES = 4
STYLE = "style='padding:0.1em 1em 0.1em 0;text-align:left'"


def response_card(response: Response) -> str:
    """Return a small HTML table: what was run, how, and how well its energies balance."""
    problem = response.problem
    step = response.options.get("dt")
    forces = [float(force) for force in response.impact_table()["peak_force"]]
    method = response.method if step is None else f"{response.method}, dt = {step:g} s"
    rows = {
        "duration": f"{problem.duration:g} s",
        "modes": str(len(problem.basis.omega2)),
        "laws": _names([law.name for law in problem.laws]),
        "method": method,
        "steps": f"{response.steps:,}",
        "impacts": f"{len(forces):,}",
        "largest force": f"{max(forces):.4g} N" if forces else "–",
        "energy residual": residual_told(response.energy_residual),
        "solved in": f"{response.solve_seconds * 1e3:.3g} ms",
    }
    body = "".join(_row(label, value) for label, value in rows.items())
    return f"<table><caption>bumpstop response</caption>{body}</table>"


def _names(names: list[str]) -> str:
    """Return names in a line: the first ones, and how many more there are."""
    told = ", ".join(names[:MOST_NAMES]) or "none"
    more = len(names) - MOST_NAMES
    return f"{told} and {more} more" if more > 0 else told


def _row(label: str, value: str) -> str:
    return f"<tr><th {STYLE}>{escape(label)}</th><td {STYLE}>{escape(value)}</td></tr>"
