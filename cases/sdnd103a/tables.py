"""How far both variants are from the sine that the shaking was made of."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import bumpstop as bs

CASE = bs.load_case(Path(__file__).parent / "case.toml")
TIMES = np.array([2.0, 6.0, 10.0, 14.0, 18.0])


def deviations() -> str:
    """Return the largest deviations as Markdown."""
    lines = [
        "| variant | deviation from the sine, in displacement | in acceleration |\n|---|---|---|"
    ]
    pace = np.pi / 4.0
    sine = 0.01 * np.sin(pace * TIMES)
    for variant, problem in CASE.problems.items():
        method = CASE.methods[variant]
        response = bs.simulate(problem, method.name, **method.options)
        cells = []
        for quantity, right in (("displacement", sine), ("acceleration", -(pace**2) * sine)):
            found = response.sample(quantity, "M", "dx", times=TIMES)
            cells.append(f"{np.abs(found / right - 1.0).max():.1e}")
        lines.append(f"| {' | '.join([variant, *cells])} |")
    return "\n".join(lines)


TABLES = {"variant": deviations}
