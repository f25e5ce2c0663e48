"""How the published scheme comes near to the closed form as its step becomes smaller."""

from __future__ import annotations

import math
from pathlib import Path

import bumpstop as bs

PROBLEM = bs.load_case(Path(__file__).parent / "case.toml").problems["exact"]
CONTACT = math.sqrt((1e4 + 1e6) / 100.0)
"""Angular frequency in contact, in rad/s."""
SECOND = {
    "peak_time": 3.0 * math.pi / (2.0 * CONTACT) + math.pi / 10.0,
    "peak_force": 1e6 / CONTACT,
    "duration": math.pi / CONTACT,
    "impulse": 2e6 / CONTACT**2,
}
"""The second impact in closed form."""


def steps() -> str:
    """Return how far each computation is from the closed form as Markdown."""
    lines = [
        "| second impact | peak time | peak force | duration | impulse |",
        "|---|---|---|---|---|",
    ]
    for step in (5e-4, 1e-4, 1e-5):
        response = bs.simulate(PROBLEM, "symplectic_euler", dt=step)
        lines.append(_line(f"symplectic Euler, {step * 1e6:g} µs", response))
    lines.append(_line("exact", bs.simulate(PROBLEM, "exact")))
    return "\n".join(lines)


def _line(name: str, response: bs.Response) -> str:
    impacts = response.impact_table()
    errors = [abs(float(impacts[key][1]) / value - 1.0) for key, value in SECOND.items()]
    cells = [f"{error:.1e}" if error > 1e-12 else "rounding" for error in errors]
    return f"| {' | '.join([name, *cells])} |"


TABLES = {"second impact": steps}
