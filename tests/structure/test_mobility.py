"""What can move of structures whose parts leave dofs without inertia."""

from __future__ import annotations

import numpy as np
import pytest

from bumpstop import (
    Beam,
    InputError,
    Material,
    ModalBasis,
    PointMass,
    Problem,
    Rectangle,
    RigidLink,
    Spring,
    Stop,
    Structure,
    Support,
)
from bumpstop.structure.dofs import DOFS

STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = Rectangle(height=0.06, width=0.025)


def in_series() -> Structure:
    """A mass behind two springs on a slanting line, with a joint between them."""
    return Structure(
        nodes={"wall": (0, 0, 0), "joint": (0.3, 0.4, 0), "P": (0.6, 0.8, 0)},
        masses=[PointMass("ball", node="P", mass=2.0)],
        springs=[
            Spring("first", node="wall", other="joint", stiffness=300.0),
            Spring("second", node="joint", other="P", stiffness=600.0),
        ],
        supports=[Support(nodes="wall", fixed=DOFS), Support(nodes="P", fixed="dz")],
    )


def test_springs_in_series() -> None:
    structure = in_series()
    assert [structure.dofs[row] for row in structure.free] == [("P", "dx"), ("P", "dy")]
    basis = ModalBasis.from_structure(structure, modes="all")
    np.testing.assert_allclose(basis.omega2, [0.0, 200.0 / 2.0], rtol=1e-13)
    joint, ball = (
        np.array([basis.row(node, dof)[1] for dof in DOFS[:3]]) for node in ("joint", "P")
    )
    np.testing.assert_allclose(joint, ball * 2.0 / 3.0, atol=1e-15)


@pytest.mark.parametrize("normal", [(0.6, 0.8, 0.0), (0.8, -0.6, 0.0), (0.0, 0.0, 1.0)])
def test_a_stop_at_a_joint_without_mass_is_refused(normal: tuple[float, float, float]) -> None:
    basis = ModalBasis.from_structure(in_series(), modes=2)
    stop = Stop("guide", node="joint", normal=normal, stiffness=1e4)
    with pytest.raises(InputError, match=r"stops.guide.node: a force here has no mass to move"):
        Problem(basis, laws=[stop], duration=1.0)


def test_a_stop_where_there_is_mass_is_taken() -> None:
    basis = ModalBasis.from_structure(in_series(), modes=2)
    stop = Stop("guide", node="P", normal=(0.6, 0.8, 0.0), stiffness=1e4)
    np.testing.assert_allclose(np.abs(stop.row(basis)), [0.0, 2.0**-0.5], atol=1e-12)


def test_a_pendulum_on_a_torsion_spring() -> None:
    """The turning of its pivot has no inertia but that of the mass on the arm: k / m r2."""
    pendulum = Structure(
        nodes={"A": (0, 0, 0), "B": (0.3, 0.4, 0)},
        masses=[PointMass("bob", node="B", mass=2.0)],
        springs=[Spring("twist", node="A", stiffness=(0, 0, 0, 0, 0, 50.0))],
        links=[RigidLink("arm", nodes=("A", "B"))],
        supports=[Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry"))],
    )
    assert [pendulum.dofs[row] for row in pendulum.free] == [("A", "drz")]
    assert ModalBasis.from_structure(pendulum, modes=1).omega2[0] == pytest.approx(50.0 / 0.5)


def test_a_massless_hinge_spring_between_beams() -> None:
    """Two beams joined through a node of springs alone: as soft as the springs in series."""
    nodes = {"A": (0, 0, 0), "B": (1, 0, 0), "N": (1, 0, 0), "C": (1, 0, 0), "D": (2, 0, 0)}
    stiff = (1e12, 1e12, 1e12, 1e12, 1e12, 4e4)

    def joined(*springs: Spring, without: str = "") -> ModalBasis:
        structure = Structure(
            nodes={node: place for node, place in nodes.items() if node != without},
            beams=[
                Beam(a + b, nodes=(a, b), elements=3, material=STEEL, section=BAR)
                for a, b in ("AB", "CD")
            ],
            springs=springs,
            supports=[Support(nodes="A", fixed=DOFS)],
        )
        return ModalBasis.from_structure(structure, modes=4)

    through = joined(
        Spring("one", node="B", other="N", stiffness=stiff),
        Spring("two", node="N", other="C", stiffness=stiff),
    )
    half = tuple(0.5 * constant for constant in stiff)
    direct = joined(Spring("one", node="B", other="C", stiffness=half), without="N")
    np.testing.assert_allclose(through.omega2, direct.omega2, rtol=1e-6)
    rotation = 0.5 * (through.row("B", "drz") + through.row("C", "drz"))
    np.testing.assert_allclose(through.row("N", "drz"), rotation, atol=1e-9)


def test_a_damper_at_a_node_without_mass_is_refused() -> None:
    with pytest.raises(InputError, match=r"nodes.B: dx is moved by a damper, but has no mass"):
        Structure(
            nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
            masses=[PointMass("ball", node="A", mass=1.0)],
            springs=[
                Spring("spring", node="A", other="B", stiffness=1e3),
                Spring("pot", node="B", damping=(20.0, 0, 0, 0, 0, 0)),
            ],
        )


def test_nothing_but_springs() -> None:
    with pytest.raises(InputError, match="nothing that can move has mass"):
        Structure(nodes={"A": (0, 0, 0)}, springs=[Spring("s", node="A", stiffness=[1e3] * 6)])


def test_a_damper_that_a_motion_without_inertia_does_not_move_is_taken() -> None:
    """A slanting dumbbell spins about its own line; a damper at its end knows nothing of it."""
    dumbbell = Structure(
        nodes={"A": (0.1, 0.2, 0.3), "B": (0.83, 1.07, -0.59)},
        masses=[PointMass(node, node=node, mass=1.0) for node in "AB"],
        springs=[Spring("pot", node="B", damping=(20.0, 20.0, 20.0, 0, 0, 0))],
        links=[RigidLink("bar", nodes=("A", "B"))],
    )
    assert len(dumbbell.free) == 5
