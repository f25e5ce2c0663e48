"""Rigid modes that users announce, and mechanisms that they do not."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from bumpstop import (
    Beam,
    InputError,
    Material,
    Matrices,
    ModalBasis,
    PointMass,
    Rectangle,
    RigidLink,
    Spring,
    Structure,
    Support,
)
from bumpstop.modal.substructure import Assembly, Component, Joint, Placed, craig_bampton
from bumpstop.structure.dofs import DOFS

ALLOY = Material(young_modulus=67e9, poisson_ratio=0.0, density=2400.0)
BAR = Rectangle(height=0.014, width=0.014)
PLANE = Support(nodes="all", fixed=("dz", "drx", "dry"))
CLAMP = Support(nodes="A", fixed=DOFS)
PIN = Support(nodes="A", fixed=("dx", "dy"))


def chain(*supports: Support) -> Structure:
    return Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0), "C": (1, 0, 0), "D": (2, 0, 0)},
        beams=[
            Beam(a + b, nodes=(a, b), elements=4, material=ALLOY, section=BAR)
            for a, b in ("AB", "CD")
        ],
        supports=[PLANE, *supports],
        links=[RigidLink("hinge", nodes=("B", "C"), dofs=("dx", "dy"))],
    )


def test_a_mechanism_is_refused_by_name() -> None:
    expected = (
        r"rigid_modes: a mechanism: rotation about z through B of C, D and 3 more; "
        r"hold or brace it, or say rigid_modes = 1"
    )
    with pytest.raises(InputError, match=expected):
        ModalBasis.from_structure(chain(CLAMP), modes=4)


def test_an_announced_mechanism_is_a_rigid_mode() -> None:
    basis = ModalBasis.from_structure(chain(CLAMP), modes=4, rigid_modes=1)
    assert list(basis.omega2 == 0.0) == [True, False, False, False]
    assert basis.rigid_modes == ("rotation about z through B of C, D and 3 more",)
    np.testing.assert_array_equal(basis.row("B", "drz")[0], 0.0)
    np.testing.assert_allclose(basis.row("D", "dy")[0], basis.row("C", "drz")[0], rtol=1e-14)
    inertia = ALLOY.density * (BAR.area / 3.0 + BAR.inertia_z)
    assert basis.row("C", "drz")[0] == pytest.approx(inertia**-0.5, rel=1e-12)


@pytest.mark.parametrize(
    ("supports", "announced", "message"),
    [
        ((CLAMP,), 0, r"1 motion is free of strain: rotation about z through B .* \(got 0\)"),
        ((PIN,), 1, "2 motions are free of strain: rotation about z through A; rotation"),
        ((), 3, "4 motions are free of strain: translation along x; .*; and 1 more"),
        ((CLAMP, Support(nodes="D", fixed="dy")), 1, "no motion is free of strain"),
        ((CLAMP,), -1, "must be 0 or more"),
        ((CLAMP,), 1.5, "must be a whole number"),
        ((CLAMP,), True, "must be a whole number"),
    ],
)
def test_another_number_is_refused(
    supports: tuple[Support, ...], announced: Any, message: str
) -> None:
    with pytest.raises(InputError, match=f"^rigid_modes: ({message})"):
        ModalBasis.from_structure(chain(*supports), modes=4, rigid_modes=announced)


def test_a_pendulum_of_two_links() -> None:
    """In line, its two free motions are the rotation of both and that of the lower one."""
    basis = ModalBasis.from_structure(chain(PIN), modes=3, rigid_modes=2)
    assert list(basis.omega2 == 0.0) == [True, True, False]
    assert basis.rigid_modes[0] == "rotation about z through A"
    modal_mass = basis.shapes.T @ (chain(PIN).mass @ basis.shapes)
    np.testing.assert_allclose(modal_mass, np.eye(3), atol=1e-13)


def test_a_piece_that_moves_as_a_whole_needs_no_announcement() -> None:
    hinged = Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)}, beams=chain().beams[:1], supports=[PLANE, PIN]
    )
    basis = ModalBasis.from_structure(hinged, modes=2)
    assert basis.rigid_modes == ("rotation about z through A",)
    assert ModalBasis.from_structure(hinged, modes=2, rigid_modes=1).omega2[0] == 0.0


def two_beams(*supports: Support) -> Structure:
    return Structure(nodes=chain().nodes, beams=chain().beams, supports=[PLANE, *supports])


def test_a_loose_piece_beside_others_is_refused_by_its_nodes() -> None:
    expected = (
        r"^rigid_modes: a loose piece: C, D and 3 more, free in translation along x; "
        r"translation along y; rotation about z; join it by a part \(a stop is none\), hold it, "
        r"or say rigid_modes = 3 if it is meant to move$"
    )
    with pytest.raises(InputError, match=expected):
        ModalBasis.from_structure(two_beams(CLAMP), modes=4)
    basis = ModalBasis.from_structure(two_beams(CLAMP), modes=4, rigid_modes=3)
    assert basis.rigid_modes[0] == "translation along x of C, D and 3 more"
    assert basis.remarks[0].startswith("3 rigid modes: translation along x of C, D and 3 more; ")
    with pytest.raises(InputError, match="2 loose pieces, the first: A, B and 3 more, free in rot"):
        ModalBasis.from_structure(two_beams(PIN), modes=4)


def test_pieces_that_are_held_need_no_joint() -> None:
    both = two_beams(CLAMP, Support(nodes="C", fixed=DOFS))
    assert ModalBasis.from_structure(both, modes=2).rigid_modes == ()


def test_a_loose_part_of_an_assembly_is_refused_by_its_nodes() -> None:
    bay = Structure(nodes={"A": (0, 0, 0), "B": (1, 0, 0)}, beams=chain().beams[:1])
    reduced = craig_bampton(Component(bay, interface=["A", "B"]), modes=4)
    apart = Assembly(
        parts={"left": Placed(reduced), "right": Placed(reduced, at=(1, 0, 0))},
        supports=[Support(nodes="left.A", fixed=DOFS)],
    )
    with pytest.raises(InputError, match=r"a loose piece: right\.A, .*say rigid_modes = 6 "):
        ModalBasis.from_structure(apart, modes=3)


def test_imported_matrices_are_held_to_the_same() -> None:
    """Three masses in a row: joined, with one apart, and with two that nothing can join."""
    dofs = [("P", "dx"), ("Q", "dx"), ("R", "dx")]
    joined = np.array([[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    free = ModalBasis.from_structure(Matrices(stiffness=joined, mass=np.eye(3), dofs=dofs), modes=1)
    assert free.rigid_modes == ("translation along x",)
    apart = np.array([[2.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    model = Matrices(stiffness=apart, mass=np.eye(3), dofs=dofs)
    with pytest.raises(InputError, match="a loose piece: R, free in translation along x; join"):
        ModalBasis.from_structure(model, modes=1)
    assert ModalBasis.from_structure(model, modes=1, rigid_modes=1).omega2[0] == 0.0
    nothing = Matrices(stiffness=np.zeros((3, 3)), mass=np.eye(3), dofs=dofs)
    with pytest.raises(InputError, match=r"zero everywhere: .* If so, say rigid_modes = 3$"):
        ModalBasis.from_structure(nothing, modes=1)
    assert ModalBasis.from_structure(nothing, modes=1, rigid_modes=3).omega2[0] == 0.0
    odd = np.array([[1.0, -2.0, 0.0], [-2.0, 4.0, 0.0], [0.0, 0.0, 1.0]])  # P moves twice as Q
    model = Matrices(stiffness=odd, mass=np.eye(3), dofs=dofs)
    with pytest.raises(InputError, match=r"a mechanism: motion of P\.dx, Q\.dx; give positions"):
        ModalBasis.from_structure(model, modes=1)


def test_modes_from_elsewhere_know_no_rigid_modes() -> None:
    assert (
        ModalBasis.from_modes(frequency=[0.0, 2.0], shapes={("P", "dx"): [1, 1]}).rigid_modes == ()
    )


@pytest.mark.parametrize("masses", [(2.0, 3.0), (1.0, 1e-3)])
def test_two_masses_and_two_springs(masses: tuple[float, float]) -> None:
    """The chain of the textbooks, with one support beside the wall."""
    k1, k2 = 4e3, 1e3
    m1, m2 = masses
    structure = Structure(
        nodes={"wall": (0, 0, 0), "P": (1, 0, 0), "Q": (2, 0, 0)},
        masses=[PointMass("p", node="P", mass=m1), PointMass("q", node="Q", mass=m2)],
        springs=[
            Spring("first", node="wall", other="P", stiffness=k1),
            Spring("second", node="P", other="Q", stiffness=k2),
        ],
        supports=[
            Support(nodes="all", fixed=("dy", "dz")),
            Support(nodes="wall", fixed="dx"),
        ],
    )
    assert len(structure.free) == 2
    basis = ModalBasis.from_structure(structure, modes="all", rigid_modes=0)
    total = (k1 + k2) / m1 + k2 / m2
    root = np.sqrt(total**2 - 4.0 * k1 * k2 / (m1 * m2))
    high = 0.5 * (total + root)
    np.testing.assert_allclose(basis.omega2, [k1 * k2 / (m1 * m2) / high, high], rtol=1e-12)


def test_many_loose_masses_are_counted_and_some_are_named() -> None:
    """A chain without supports: every mass can leave the line in two directions."""
    names = [f"m{i}" for i in range(40)]
    structure = Structure(
        nodes={name: (float(i), 0, 0) for i, name in enumerate(names)},
        masses=[PointMass(name, node=name, mass=1.0) for name in names],
        springs=[Spring(a + b, node=a, other=b, stiffness=1e3) for a, b in pairwise(names)],
    )
    expected = r"translation along y of m0; translation along z of m0; .*say rigid_modes = 81 "
    with pytest.raises(InputError, match=expected):
        ModalBasis.from_structure(structure, modes=4)
    omega2 = ModalBasis.from_structure(structure, modes="all", rigid_modes=81).omega2
    assert np.count_nonzero(omega2 == 0.0) == 81
    waves = 4e3 * np.sin(np.pi * np.arange(1, 40) / 80.0) ** 2
    np.testing.assert_allclose(omega2[81:], waves, rtol=1e-11)


def test_a_hinge_between_substructures_is_named() -> None:
    """The amplitudes of their inner shapes have no place, and are not asked for one."""
    bay = Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[Beam("AB", nodes=("A", "B"), elements=4, material=ALLOY, section=BAR)],
    )
    reduced = craig_bampton(Component(bay, interface=["A", "B"]), modes=4)
    whole = Assembly(
        parts={"left": Placed(reduced), "right": Placed(reduced, at=(1, 0, 0))},
        joints=[Joint("left.B", "right.A", dofs=("dx", "dy", "dz", "drx", "dry"))],
        supports=[Support(nodes="left.A", fixed=DOFS)],
    )
    basis = ModalBasis.from_structure(whole, modes=3, rigid_modes=1)
    assert basis.rigid_modes[0].startswith("rotation about z through left.B of right.A, right.B")
    with pytest.raises(InputError, match="1 motion is free of strain: rotation about z through"):
        ModalBasis.from_structure(whole, modes=3, rigid_modes=0)
