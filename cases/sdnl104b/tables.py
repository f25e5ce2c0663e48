"""How much of the difference from the finite elements is due to the number of modes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import bumpstop as bs

PROBLEM = bs.load_case(Path(__file__).parent / "case.toml").problems["exact"]
DISPLACEMENT, VELOCITY = -1.85356696663e-6, -4.63289359505e-3
"""Of the tip, at 0.1315 and at 0.1566 s: all the degrees of freedom, published."""


def modes() -> str:
    """Return the published quantities on several bases as Markdown."""
    lines = [
        "| basis | displacement | deviation | velocity | deviation |",
        "|---|---|---|---|---|",
        _line("5 modes, substructured: this case", PROBLEM, "right.N"),
    ]
    for number in (5, 10, 20):
        name = f"{number} modes" + (", all there are" if number == 20 else "")
        lines.append(_line(name, _direct(number), "tip"))
    return "\n".join(lines)


def _line(name: str, problem: bs.Problem, tip: str) -> str:
    response = bs.simulate(problem, "exact")
    displacement = float(response.sample("displacement", tip, "dy", times=[0.1315])[0])
    velocity = float(response.sample("velocity", tip, "dy", times=[0.1566])[0])
    cells = [
        f"{displacement * 1e6:.5f} µm",
        f"{abs(displacement / DISPLACEMENT - 1.0):.2%}",
        f"{velocity * 1e3:.5f} mm/s",
        f"{abs(velocity / VELOCITY - 1.0):.2%}",
    ]
    return f"| {name} | {' | '.join(cells)} |"


def _direct(modes: int) -> bs.Problem:
    """Return the problem on modes of the whole cantilever, without substructures."""
    soft = bs.Material(young_modulus=1e10, poisson_ratio=0.3, density=1e6)
    beam = bs.Beam(
        "beam",
        nodes=("root", "tip"),
        elements=10,
        theory="euler_bernoulli",
        material=soft,
        section=bs.Circle(radius=0.1),
    )
    structure = bs.Structure(
        nodes={"root": (0, 0, 0), "tip": (1, 0, 0)},
        beams=[beam],
        supports=[
            bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry")),
            bs.Support(nodes="root", fixed=("dy", "drz")),
        ],
    )
    return replace(
        PROBLEM,
        basis=bs.ModalBasis.from_structure(structure, modes=modes),
        laws=[replace(stop, node="tip") for stop in PROBLEM.laws],
        loads=[replace(load, node="tip") for load in PROBLEM.loads],
    )


TABLES = {"basis": modes}
