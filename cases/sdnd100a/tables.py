"""How much of the closed form is left by a contact that gives way, and by steps in time."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

import bumpstop as bs

PROBLEM = bs.load_case(Path(__file__).parent / "case.toml").problems["published"]
TIMES = np.arange(1, 5) * np.pi / 100.0
PEAKS = np.array([-0.65e-3, 0.45e-3, -0.25e-3, 0.05e-3]) / np.sqrt(2.0)
"""The first four peaks in closed form, in m."""


def contact() -> str:
    """Return the deviation of several contacts from the closed form as Markdown."""
    lines = [_head("stick: stiffness, damping")]
    for stiffness, damping in ((4e5, 0.0), (4e5, 1833.03), (4e7, 1e3), (4e9, 1e4)):
        changed = {"tangential_stiffness": stiffness, "tangential_damping": damping}
        stops = [replace(stop, **changed) for stop in PROBLEM.laws]
        peaks = _peaks(bs.simulate(replace(PROBLEM, laws=stops), "exact"))
        lines.append(_line(f"{stiffness:g} N/m, {damping:g} N s/m", peaks, PEAKS))
    return "\n".join(lines)


def steps() -> str:
    """Return the deviation of the schemes from the exact solution as Markdown."""
    exact = _peaks(bs.simulate(PROBLEM, "exact"))
    lines = [_head("step")]
    for step in (5e-4, 1e-4, 2e-5, 4e-6):
        peaks = _peaks(bs.simulate(PROBLEM, "symplectic_euler", dt=step))
        lines.append(_line(f"symplectic Euler, {step * 1e6:g} µs", peaks, exact))
    return "\n".join(lines)


def _peaks(response: bs.Response) -> np.ndarray:
    return response.sample("displacement", "P", "dy", times=TIMES)


def _head(first: str) -> str:
    columns = [first, "1st peak", "2nd", "3rd", "4th"]
    return f"| {' | '.join(columns)} |\n{'|---' * len(columns)}|"


def _line(name: str, peaks: np.ndarray, right: np.ndarray) -> str:
    cells = [f"{error:.1e}" for error in np.abs(peaks / right - 1.0)]
    return f"| {' | '.join([name, *cells])} |"


TABLES = {"stick: stiffness, damping": contact, "step": steps}
