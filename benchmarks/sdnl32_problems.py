"""SDNL32 as modal arrays: the two published problems and seeded random ones."""

import numpy as np

import bumpstop as bs
from bumpstop.canonical import canonical_form
from tests.reference.problem import Array, StopProblem

DURATION = 0.02
OUTPUTS = 20
TIMES: Array = np.arange(1, OUTPUTS + 1, dtype=np.float64) * (DURATION / OUTPUTS)
PUBLISHED = (18e3, 45e3)
PUBLISHED_RATE = -3.8


def beam() -> bs.ModalBasis:
    """Return the ten transverse modes of the hinged beam."""
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (0.783, 0, 0)},
        beams=[
            bs.Beam(
                "AB",
                nodes=("A", "B"),
                elements=10,
                theory="timoshenko",
                material=bs.Material(young_modulus=67e9, poisson_ratio=0.0, density=2400.0),
                section=bs.Rectangle(height=0.014, width=0.014),
            )
        ],
        supports=[
            bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry")),
            bs.Support(nodes=("A",), fixed=("dy",)),
        ],
    )
    return bs.ModalBasis.from_structure(structure, modes=10, damping=0.01)


def published() -> list[StopProblem]:
    """Return the problems with 18 and 45 kN/m."""
    basis = beam()
    problem = bs.Problem(
        basis, initial=bs.RigidRotation(about="A", rate=(0, 0, PUBLISHED_RATE)), duration=DURATION
    )
    velocity = canonical_form(problem).velocity
    return [
        StopProblem(
            omega2=basis.omega2,
            damping=basis.damping,
            row=basis.row("B", "dy"),
            stiffness=stiffness,
            velocity=velocity,
            duration=DURATION,
        )
        for stiffness in PUBLISHED
    ]


def random_cases(count: int, seed: int = 32) -> list[StopProblem]:
    """Return problems with stiffness in 5e3 to 1e5 N/m and rate in -6 to -1 rad/s."""
    rng, base = np.random.default_rng(seed), published()[0]
    stiffness = rng.uniform(5e3, 1e5, count)
    rate = rng.uniform(-6.0, -1.0, count)
    return [
        base.but(stiffness=float(k), velocity=base.velocity * (float(w) / PUBLISHED_RATE))
        for k, w in zip(stiffness, rate, strict=True)
    ]
