"""How far models of SDNL32 are from published values and each other, and how many modes suffice."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

import bumpstop as bs
from bumpstop.post.references import check_references

HERE = Path(__file__).parent
CASE = bs.load_case(HERE / "case.toml")
ALLOY = bs.Material(young_modulus=67e9, poisson_ratio=0.0, density=2400.0)
BAR = bs.Rectangle(height=0.014, width=0.014)
LENGTH = 0.783
EVEN = ((LENGTH, 10),)
WITH_MISPLACED_NODE = ((0.3915, 5), (0.4620, 1), (0.5481, 1), (LENGTH, 3))
"""Stretches of equal elements: where each ends, in m, and how many it has."""
FINE = ((LENGTH, 160),)
TIMES = np.linspace(0.0, 0.02, 4001)
"""Instants in s at which stop forces are compared."""
COMPARED = ((LENGTH, 40),)
"""The mesh on which the answers stand side by side."""


def basis(
    stretches: tuple[tuple[float, int], ...] = EVEN,
    *,
    modes: int | str = 10,
    damping: float = 0.01,
    axial: bool = False,
    static_shapes: tuple[tuple[str, str], ...] = (),
) -> bs.ModalBasis:
    """Return the modes of the hinged beam, without or with those along its axis.

    Static shapes under forces at some places join them where asked for.
    """
    ends = [0.0, *(end for end, _ in stretches)]
    names = ["A", *(f"P{number}" for number in range(1, len(stretches))), "B"]
    beams = [
        bs.Beam(
            f"{first}{last}", nodes=(first, last), elements=elements, material=ALLOY, section=BAR
        )
        for first, last, (_, elements) in zip(names, names[1:], stretches, strict=False)
    ]
    out_of_plane = ("dz", "drx", "dry")
    structure = bs.Structure(
        nodes={name: (end, 0.0, 0.0) for name, end in zip(names, ends, strict=True)},
        beams=beams,
        supports=[
            bs.Support(nodes="all", fixed=out_of_plane if axial else ("dx", *out_of_plane)),
            bs.Support(nodes=("A",), fixed=("dx", "dy")),
        ],
    )
    return bs.ModalBasis.from_structure(
        structure, modes=modes, damping=damping, static_shapes=static_shapes
    )


def deviations(modes: bs.ModalBasis) -> list[float]:
    """Return, for each variant, the largest deviation from its published values, in %."""
    return [100.0 * _worst(modes, variant) for variant in CASE.problems]


def _worst(modes: bs.ModalBasis, variant: str) -> float:
    problem = replace(CASE.problems[variant], basis=modes, gauges=())
    checks = check_references(bs.simulate(problem, "exact"), CASE.references[variant])
    return max(check.deviation for check in checks)


def converged() -> tuple[str, list[float]]:
    """Refine mesh and basis until no deviation changes by 0.005 % any more."""
    elements, before = 10, deviations(basis())
    while True:
        elements *= 2
        now = deviations(basis(((LENGTH, elements),), modes=elements))
        if max(abs(a - b) for a, b in zip(now, before, strict=True)) < 0.005:
            return f"converged: {elements} elements, all {elements} bending modes", now
        before = now


def model_table() -> str:
    """Return the deviations of several models as Markdown."""
    rows = [
        ("clean: this case", deviations(basis())),
        ("nine bending modes and the axial one", deviations(basis(axial=True))),
        ("no damping", deviations(basis(damping=0.0))),
        ("a node at 0.462 m", deviations(basis(WITH_MISPLACED_NODE))),
        converged(),
    ]
    lines = [f"| {name} | {soft:.2f} % | {stiff:.2f} % |" for name, (soft, stiff) in rows]
    return "\n".join([_head("model"), *lines])


def force_errors() -> dict[str, list[float]]:
    """Return how far the stop force on several bases is from that on all modes.

    For each basis and variant: the largest difference over time, in % of the largest force.
    """
    tip = (("B", "dy"),)
    bases = {
        "5 modes": basis(FINE, modes=5),
        "5 modes and the static shape of the stop": basis(FINE, modes=5, static_shapes=tip),
        "10 modes": basis(FINE, modes=10),
        "10 modes and the static shape of the stop": basis(FINE, modes=10, static_shapes=tip),
        "20 modes": basis(FINE, modes=20),
    }
    everything = basis(FINE, modes="all")
    errors: dict[str, list[float]] = {name: [] for name in bases}
    for variant in CASE.problems:
        converged = _stop_force(everything, variant)
        for name, modes in bases.items():
            difference = np.abs(_stop_force(modes, variant) - converged).max()
            errors[name].append(100.0 * difference / converged.max())
    return errors


def _stop_force(modes: bs.ModalBasis, variant: str) -> np.ndarray:
    problem = replace(CASE.problems[variant], basis=modes, gauges=())
    return bs.simulate(problem, "exact").sample("stop_force", "spring", times=TIMES)


def force_table() -> str:
    """Return the errors of the stop force as Markdown."""
    lines = [
        f"| {name} | {soft:.3f} % | {stiff:.3f} % |"
        for name, (soft, stiff) in force_errors().items()
    ]
    return "\n".join([_head("basis"), *lines])


@cache
def answers() -> dict[str, dict[str, bs.Response]]:
    """Return what several models of one mesh give, by their names and by variant.

    Ten modes and all of them exactly, the beam unreduced with steps that add nothing to the
    digits shown.
    """
    modal = basis(COMPARED)
    implicit = bs.FullModel.from_structure(modal.model, damping=0.01)
    explicit = bs.FullModel.from_structure(modal.model, damping=0.01, mass="lumped")
    runs = {
        "ten modes": (modal, "exact", {}),
        "all modes": (basis(COMPARED, modes="all"), "exact", {}),
        "unreduced, implicit": (implicit, "newmark", {"dt": 4e-6}),
        "unreduced, explicit": (explicit, "central_difference", {"dt": 4e-7}),
    }
    return {
        name: {
            variant: bs.simulate(replace(problem, basis=model, gauges=()), method, **options)
            for variant, problem in CASE.problems.items()
        }
        for name, (model, method, options) in runs.items()
    }


def tip_table() -> str:
    """Return the tip's displacement by all models beside the published one, as Markdown."""
    found = answers()
    lines = [f"| tip of the beam, mm | published | {' | '.join(found)} |", "|---|" + 5 * "---|"]
    for variant, references in CASE.references.items():
        (published,) = references
        for at, value in list(zip(published.times, published.values, strict=True))[1::2]:
            told = [
                value,
                *(_at(runs[variant], at, "displacement", "B", "dy") for runs in found.values()),
            ]
            cells = [f"{1e3 * each:.3f}" for each in told]
            lines.append(f"| {variant}, {1e3 * at:.0f} ms | {' | '.join(cells)} |")
    return "\n".join(lines)


def contact_table() -> str:
    """Return the force of the stop by all models, as Markdown; none was published."""
    found = answers()
    lines = [f"| force of the stop, N | {' | '.join(found)} |", "|---|" + 4 * "---|"]
    for variant, references in CASE.references.items():
        for at in list(references[0].times)[1::2]:
            cells = [
                f"{_at(runs[variant], at, 'stop_force', 'spring'):.2f}" for runs in found.values()
            ]
            lines.append(f"| {variant}, {1e3 * at:.0f} ms | {' | '.join(cells)} |")
    return "\n".join(lines)


def _at(response: bs.Response, time: float, quantity: str, *target: str) -> float:
    return float(response.sample(quantity, *target, times=[time])[0])


def _head(first: str) -> str:
    return f"| {first} | soft, 18 kN/m | stiff, 45 kN/m |\n|---|---|---|"


TABLES = {
    "model": model_table,
    "basis": force_table,
    "tip of the beam, mm": tip_table,
    "force of the stop, N": contact_table,
}
