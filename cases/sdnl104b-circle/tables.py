"""By how much an adaptive run within a circle differs from the exact one between planes."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

import bumpstop as bs

CASES = Path(__file__).parents[1]
AT = {"displacement": 0.1315, "velocity": 0.1566}
TIMES = np.linspace(0.0, 1.0, 1001)


def rings() -> str:
    """Return the published quantities with both rings as Markdown."""
    planes = bs.load_case(CASES / "sdnl104b" / "case.toml").problems["exact"]
    circle = bs.load_case(CASES / "sdnl104b-circle" / "case.toml").problems["base"]
    exact = bs.simulate(planes, "exact")
    lines = ["| ring | displacement | velocity | over the whole run |", "|---|---|---|---|"]
    values = {each: _sampled(exact, each) for each in AT}
    told = [f"{values['displacement'] * 1e6:.5f} µm", f"{values['velocity'] * 1e3:.5f} mm/s"]
    lines.append(f"| planes, exact | {' | '.join(told)} | |")
    whole = exact.sample("displacement", "right.N", "dy", times=TIMES)
    for rtol in (1e-8, 1e-11):
        run = bs.simulate(circle, rtol=rtol)
        off = [abs(_sampled(run, each) / values[each] - 1.0) for each in AT]
        path = run.sample("displacement", "right.N", "dy", times=TIMES)
        off.append(float(np.abs(path - whole).max() / np.abs(whole).max()))
        cells = " | ".join(f"{10.0 ** math.ceil(math.log10(3.0 * each)):.0e}" for each in off)
        lines.append(f"| circle, {run.method}, rtol {rtol:.0e} | {cells} |")
    return "\n".join(lines)


def _sampled(response: bs.Response, quantity: str) -> float:
    return float(response.sample(quantity, "right.N", "dy", times=[AT[quantity]])[0])


TABLES = {"ring": rings}
