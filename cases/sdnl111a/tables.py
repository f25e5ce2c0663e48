"""How near the modes come to waves in bars that touch rigidly."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np

import bumpstop as bs

HERE = Path(__file__).parent
CASE = bs.load_case(HERE / "case.toml")
TIMES = np.array([2e-4, 4e-4, 6e-4, 8e-4, 1e-3])
"""The published instants, in s."""
STIFFNESS, DAMPING = 5e9, 2e4
"""Of the contact, in N/m and N s/m."""
IMPEDANCE = 4e-4 * math.sqrt(2e11 * 7800.0)
"""Of a bar: force over speed of a wave, in N s/m."""
BACK = 2.0 * math.sqrt(7800.0 / 2e11)
"""Time of a wave there and back along a bar, in s."""
STEEL = bs.Material(young_modulus=2e11, poisson_ratio=0.0, density=7800.0)
SQUARE = bs.Rectangle(height=0.02, width=0.02)


def rigid_waves(times: np.ndarray) -> np.ndarray:
    """Return d'Alembert's solution for the face of the flying bar, rigid contact, in m.

    The faces move at -0.5 m/s until the wave is back from the far ends, at +0.5 m/s as long
    again, and then the bar flies off at 1 m/s.
    """
    down = -0.5 * np.minimum(times, BACK)
    up = 0.5 * np.clip(times - BACK, 0.0, BACK)
    return down + up + np.maximum(0.0, times - 2.0 * BACK)


def waves(times: np.ndarray) -> np.ndarray:
    """Return the same with the spring and the damper of the contact.

    With the impedance Z of a bar, its face moves at -1 + (F(t) + 2 F(t - T) + 2 F(t - 2 T) + ...)
    / Z, where T is the time there and back. What both far ends send back first cancels in the
    distance, so that the contact is compressed by x with x' = 1 - 2 F / Z and F = k x + c x'
    until 2 T, when the bar is torn off.
    """
    decay = (IMPEDANCE + 2.0 * DAMPING) / (2.0 * STIFFNESS)
    first = DAMPING / (1.0 + 2.0 * DAMPING / IMPEDANCE)

    def impulse(instants: np.ndarray) -> np.ndarray:
        since = np.clip(instants, 0.0, 2.0 * BACK)
        settling = (first - 0.5 * IMPEDANCE) * decay * -np.expm1(-since / decay)
        return 0.5 * IMPEDANCE * since + settling

    returned = 2.0 * impulse(times - BACK) + 2.0 * impulse(times - 2.0 * BACK)
    return -times + (impulse(times) + returned) / IMPEDANCE


def instants() -> str:
    """Return the displacements of the face, published and computed, as Markdown."""
    published = {
        table["source"].rsplit(": ")[-1]: table["values"]
        for table in tomllib.loads((HERE / "case.toml").read_text(encoding="utf-8"))["references"]
        if table.get("variant") == "published"
    }
    rows = {
        "waves, rigid contact": rigid_waves(TIMES),
        "waves, with the contact's spring and damper": waves(TIMES),
        "published computation": published["computed values"],
        "the same scheme here": _face("published", "symplectic_euler", 1e-6),
        "exact in time": _face("exact", "exact"),
    }
    head = " | ".join(f"{time * 1e3:.1f} ms" for time in TIMES)
    lines = [f"| displacement in µm | {head} |", "|---" * 6 + "|"]
    for name, values in rows.items():
        lines.append(f"| {name} | {' | '.join(f'{1e6 * value:.6f}' for value in values)} |")
    return "\n".join(lines)


def refinement() -> str:
    """Return how near models come to waves, as Markdown."""
    lines = ["| elements of a bar | modes | largest deviation |", "|---|---|---|"]
    for elements, modes in ((50, 20), (50, 40), (50, 80), (100, 80), (100, 160)):
        response = bs.simulate(_refined(elements, modes), "exact")
        face = response.sample("displacement", "A", "dx", times=TIMES)
        deviation = np.abs(face - waves(TIMES)).max()
        lines.append(f"| {elements} | {modes} | {deviation * 1e6:.2f} µm |")
    return "\n".join(lines)


def _face(variant: str, method: str, dt: float | None = None) -> np.ndarray:
    response = bs.simulate(CASE.problems[variant], method, dt=dt)
    return response.sample("displacement", "A", "dx", times=TIMES)


def _refined(elements: int, modes: int) -> bs.Problem:
    bars = [
        bs.Beam(name, nodes=ends, elements=elements, theory="bar", material=STEEL, section=SQUARE)
        for name, ends in (("flying", ("A", "B")), ("held", ("C", "D")))
    ]
    nodes = {"A": (1, 0, 0), "B": (2, 0, 0), "C": (1, 0, 0), "D": (0, 0, 0)}
    along = bs.Support(nodes="all", fixed=("dy", "dz", "drx", "dry", "drz"))
    structure = bs.Structure(
        nodes=nodes, beams=bars, supports=[along, bs.Support(nodes="D", fixed="dx")]
    )
    basis = bs.ModalBasis.from_structure(structure, modes=modes, damping=0.001, rigid_modes=1)
    return replace(CASE.problems["exact"], basis=basis)


TABLES = {"displacement in µm": instants, "elements of a bar": refinement}
