import numpy as np
import pytest

from bumpstop import (
    Beam,
    Gravity,
    InputError,
    Material,
    ModalBasis,
    PointMass,
    Rectangle,
    Structure,
    Support,
)

LENGTH, SIDE, DENSITY = 0.783, 0.014, 2400.0


def test_weight_on_the_rigid_mode_of_a_hinged_beam(hinged: ModalBasis) -> None:
    """The moment of the weight about the hinge over the root of the moment of inertia."""
    weight = Gravity("weight", acceleration=(0, -9.81, 0)).modal_force(hinged)
    line_mass = DENSITY * SIDE**2
    inertia = line_mass * LENGTH**3 / 3 + DENSITY * SIDE**4 / 12 * LENGTH
    moment = 9.81 * line_mass * LENGTH**2 / 2
    assert weight[0] == pytest.approx(-moment / np.sqrt(inertia), rel=1e-12)


def test_weight_bends_a_clamped_beam_as_in_statics() -> None:
    """All modes together give the static tip deflection, supports' share of mass included."""
    steel = Material(young_modulus=210e9, poisson_ratio=0.25, density=7800.0)
    bar = Rectangle(height=0.02, width=0.01)
    beam = Beam(
        "AB", nodes=("A", "B"), elements=2, theory="timoshenko", material=steel, section=bar
    )
    held = ("dx", "dz", "drx", "dry")
    cantilever = Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[beam],
        supports=[
            Support(nodes="all", fixed=held),
            Support(nodes=("A",), fixed=("dy", "drz")),
        ],
    )
    basis = ModalBasis.from_structure(cantilever, modes=4)
    force = Gravity("weight", acceleration=(0, -10.0, 0)).modal_force(basis)
    tip = basis.row("B", "dy") @ (force / basis.omega2)
    load, bending = 7800.0 * 2e-4 * 10.0, 210e9 * 0.01 * 0.02**3 / 12
    shear = 84e9 * 5 / 6 * 2e-4
    assert tip == pytest.approx(-load * (1 / (8 * bending) + 1 / (2 * shear)), rel=1e-10)


def test_weight_of_a_point_mass() -> None:
    ball = Structure(
        nodes={"P": (0, 0, 0)},
        masses=[PointMass("ball", node="P", mass=4.0)],
        supports=[Support(nodes=("P",), fixed=("dx", "dz", "drx", "dry", "drz"))],
    )
    basis = ModalBasis.from_structure(ball, modes=1)
    weight = Gravity("weight", acceleration=(0, -9.81, 0)).modal_force(basis)
    assert weight == pytest.approx([-9.81 * 2.0], rel=1e-15)


def test_modes_without_masses_have_no_weight() -> None:
    basis = ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    with pytest.raises(InputError, match="give a NodalForce"):
        Gravity("weight", acceleration=(0, -9.81, 0)).modal_force(basis)
