"""What the step of the published scheme costs, and what the reduction of the beams does."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import bumpstop as bs

CASE = bs.load_case(Path(__file__).parent / "case.toml")
MID_SPANS = ("one.M", "two.M", "three.M")


def steps() -> str:
    """Return how far the schemes are from the exact solution at 1 s, as Markdown."""
    problem = CASE.problems["converged"]
    exact = _state(bs.simulate(problem, "exact"))
    lines = [_head("method"), "|---|---|---|"]
    for method, name in (
        ("symplectic_euler", "symplectic Euler"),
        ("central_difference", "central difference"),
    ):
        for step in (2e-4, 2e-5):
            state = _state(bs.simulate(problem, method, dt=step))
            lines.append(_line(f"{name}, {step * 1e6:g} µs", state, exact))
    return "\n".join(lines)


def reduction() -> str:
    """Return how far the reduced model is from the complete one at 1 s, as Markdown."""
    complete = _state(bs.simulate(CASE.problems["complete"], "exact"))
    reduced = _state(bs.simulate(CASE.problems["converged"], "exact"))
    lines = [_head("modes kept of each beam"), "|---|---|---|"]
    return "\n".join([*lines, _line("5", reduced, complete)])


def _state(response: bs.Response) -> np.ndarray:
    """Return displacements and velocities of the three mid-spans at the end, (2, 3)."""
    return np.array(
        [
            [response.sample(quantity, node, "dy", times=[1.0])[0] for node in MID_SPANS]
            for quantity in ("displacement", "velocity")
        ]
    )


def _head(first: str) -> str:
    return f"| {first} | displacements | velocities |"


def _line(name: str, state: np.ndarray, right: np.ndarray) -> str:
    displacement, velocity = np.abs(state / right - 1.0).max(axis=1)
    return f"| {name} | {displacement:.1e} | {velocity:.1e} |"


TABLES = {"method": steps, "modes kept of each beam": reduction}
