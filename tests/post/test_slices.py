"""Slices of a beam within one element, in balance: their forces, loads and momentum, by hand.

The forces in both sections, what acts between them and the change of momentum of what is between
them are summed here in another way than `recovery` takes: by Gauss points along the slice, from
what is given of the loads and what is read of motion and laws.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.arguments import FloatArray
from bumpstop.structure.dofs import DOFS

STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
PIPE = bs.Tube(outer_radius=0.012, thickness=0.002)
FIRST, LAST = 0.26, 0.45
"""Within the first of two elements of 0.5 m."""
STOPPED, PUSHED = 0.37, 0.31
SPIN = 400.0
WAVE = bs.Harmonic(40.0, sine=1.0)
WIND = bs.LineForce(
    "wind", beam="AB", force=(30.0, 200.0, -150.0), end_force=(0.0, -90.0, 60.0), start=0.3, end=0.4
)
MOVED: dict[str, Any] = {
    "still": None,
    "relative": bs.BaseMotion(acceleration=(2.0, 60.0, 90.0), time=WAVE),
    "absolute": bs.BaseMotion(acceleration=(2.0, 60.0, 90.0), time=WAVE, frame="absolute"),
    "supports": bs.SupportMotion("foot", nodes="A", displacement=(0, 1e-4, 2e-4), time=WAVE),
}
DAMPING = 0.03


class Slice(NamedTuple):
    """Gauss points between two places, with their weights in m."""

    places: list[float]
    weights: FloatArray

    @classmethod
    def between(cls, first: float, last: float) -> Slice:
        nodes, weights = np.polynomial.legendre.leggauss(10)
        half = 0.5 * (last - first)
        return cls((0.5 * (first + last) + half * nodes).tolist(), half * weights)


def shaken(moved: str) -> bs.Response:
    """A spinning pipe on a clamp, with a stop, a push and a wind inside of one element."""
    beam = bs.Beam("AB", nodes=("A", "B"), elements=2, material=STEEL, section=PIPE, spin=SPIN)
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[beam],
        supports=[bs.Support(nodes="A", fixed=DOFS)],
    )
    basis = bs.ModalBasis.from_structure(structure, modes=6, damping=DAMPING)
    stop = bs.Stop("stop", node=f"AB@{STOPPED}", normal=(0, -1, 0), gap=1e-5, stiffness=4e4)
    loads: list[Any] = [
        bs.Gravity("weight", acceleration=(1.0, -3.0, -9.81)),
        WIND,
        bs.NodalForce(
            "push", node=f"AB@{PUSHED}", force=(9, 40, -25), moment=(0, 2.0, 1.0), time=WAVE
        ),
        *([] if MOVED[moved] is None else [MOVED[moved]]),
    ]
    return bs.simulate(bs.Problem(basis, laws=[stop], loads=loads, duration=0.05, sample=5e-4))


def rows(run: bs.Response, dof: str, part: Slice) -> FloatArray:
    """Return how the modes move the places of a slice, (place, mode)."""
    return np.stack([run.problem.basis.row(f"AB@{x!r}", dof) for x in part.places])


def carried(run: bs.Response, moved: str, dof: str) -> FloatArray:
    """Return the acceleration by which supports that move carry all along, (time, 1).

    Rigidly, since the clamp does not turn.
    """
    load, omega = MOVED[moved], 2.0 * np.pi * 40.0
    if load is None or dof not in DOFS[:3]:
        return np.zeros((len(run.times), 1))
    direction = DOFS.index(dof)
    if moved == "supports":
        size = -load.displacement[direction] * omega**2
    else:
        size = load.acceleration[direction]
    return np.outer(size * np.sin(omega * run.times), 1.0)


def wind_at(place: float) -> FloatArray:
    share = (place - 0.3) / 0.1
    return np.array([30.0, 200.0, -150.0]) * (1 - share) + np.array([0.0, -90.0, 60.0]) * share


@pytest.mark.parametrize("moved", MOVED)
def test_slices_are_in_balance(moved: str) -> None:
    run = shaken(moved)
    recovery = bs.recovery(run)
    whole, windy = Slice.between(FIRST, LAST), Slice.between(0.3, 0.4)
    edges = [FIRST, 0.3, PUSHED, STOPPED, 0.4, LAST]
    ends = recovery.section_forces("AB", [FIRST, LAST])
    push = np.sin(2.0 * np.pi * 40.0 * run.times)
    stop = -run.sample("stop_force", "stop")
    weight = STEEL.density * PIPE.area
    turning = STEEL.density * PIPE.inertia_y
    given = 2.0 * DAMPING * np.sqrt(run.problem.basis.omega2)

    def spread(dof: str) -> FloatArray:
        """Return accelerations, and what modal damping does as if it were one."""
        own = (run.motion(2) + run.motion(1) * given) @ rows(run, dof, whole).T
        return own + carried(run, moved, dof)

    for number, (dof, force) in enumerate((("dx", "N"), ("dy", "Vy"), ("dz", "Vz"))):
        left = np.diff(ends[force].values, axis=1)[:, 0]
        acting = weight * (1.0, -3.0, -9.81)[number] * (LAST - FIRST)
        acting += sum(w * wind_at(x)[number] for x, w in zip(*windy, strict=True))
        acting = acting + (9.0, 40.0, -25.0)[number] * push
        if dof == "dy":
            acting = acting + stop
        gained = weight * spread(dof) @ whole.weights
        scale = np.abs(ends[force].values).max()
        np.testing.assert_allclose(left, gained - acting, rtol=0.0, atol=1e-9 * scale)
    for moment, shear, sign, own, other, couple in (
        ("My", "Vz", 1.0, "dry", "drz", 2.0),
        ("Mz", "Vy", -1.0, "drz", "dry", 1.0),
    ):
        left = np.diff(ends[moment].values, axis=1)[:, 0] + couple * push
        for first, last in pairwise(edges):
            # Apart where shear forces jump.
            part = Slice.between(first, last)
            shears = recovery.section_forces("AB", part.places)[shear].values
            left -= sign * shears @ part.weights
        gained = turning * spread(own)
        gained += sign * 2.0 * turning * SPIN * run.motion(1) @ rows(run, other, whole).T
        scale = np.abs(ends[moment].values).max()
        np.testing.assert_allclose(left, gained @ whole.weights, rtol=0.0, atol=1e-9 * scale)
