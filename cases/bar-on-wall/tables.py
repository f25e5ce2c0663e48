"""How impulse and end of the contact converge with the number of modes."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import bumpstop as bs
from bumpstop.modal.basis import ModalBasis

PROBLEMS = bs.load_case(Path(__file__).parent / "case.toml").problems
MODEL = PROBLEMS["stiff"].basis.model
BACK = 2.0 * math.sqrt(7800.0 / 210e9)
"""Time of a wave to the free end and back, in s."""
IMPULSE = 2.0 * 7800.0 * 314e-6 * 0.1
"""Twice the momentum of the bar, in N s."""
EXPLICIT = 1e-7
"""Step in s of the central difference."""


def modes() -> str:
    """Return how far each number of modes is from waves, as Markdown."""
    lines = [
        "| modes | stop | contact | impulse | mean force | loss of energy |",
        "|---|---|---|---|---|---|",
        f"| waves | rigid | {BACK * 1e3:.4f} ms | {IMPULSE:.4f} N s | {IMPULSE / BACK:.1f} N | 0 |",
    ]
    for number in (6, 12, 25, 50):
        basis = ModalBasis.from_structure(MODEL, modes=number)
        for stop, problem in PROBLEMS.items():
            response = bs.simulate(replace(problem, basis=basis), "exact")
            lines.append(_line(f"{number} | {stop}", response))
    everything = ModalBasis.from_structure(MODEL, modes="all")
    problem = replace(PROBLEMS["stiff"], basis=everything)
    explicit = bs.simulate(problem, "central_difference", dt=EXPLICIT)
    lines.append(_line("all 151, central difference | stiff", explicit))
    return "\n".join(lines)


def _line(name: str, response: bs.Response) -> str:
    impacts = response.impact_table()
    contact = max(map(float, impacts["end"])) - float(impacts["start"][0])
    impulse = sum(map(float, impacts["impulse"]))
    terms = response.energy_terms([response.problem.duration])
    loss = terms["dissipated_stops"][0] / terms["total_initial"][0]
    cells = [f"{contact * 1e3:.4f} ms", f"{impulse:.4f} N s", f"{impulse / contact:.1f} N"]
    return f"| {name} | {' | '.join(cells)} | {100.0 * loss:.2f} % |"


TABLES = {"modes": modes}
