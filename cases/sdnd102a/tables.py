"""How far the published steps are from converged."""

from __future__ import annotations

from pathlib import Path

import bumpstop as bs

CASE = bs.load_case(Path(__file__).parent / "case.toml")


def pair() -> str:
    """Return the displacement of P, published and computed, as Markdown."""
    published = CASE.references["published_pair"][0]
    stepped = bs.simulate(CASE.problems["published_pair"], "symplectic_euler", dt=2.5e-4)
    exact = bs.simulate(CASE.problems["exact"], "exact")
    times = published.times
    columns = [
        published.values,
        stepped.sample("displacement", "P", "dx", times=times),
        exact.sample("displacement", "P", "dx", times=times),
    ]
    lines = ["| time | published, 250 µs | the scheme here, 250 µs | exact |", "|---|---|---|---|"]
    for time, *values in zip(times, *columns, strict=True):
        cells = [f"{1e6 * value:.3f} µm" for value in values]
        lines.append(f"| {time:g} s | {' | '.join(cells)} |")
    return "\n".join(lines)


TABLES = {"time": pair}
