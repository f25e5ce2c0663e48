from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from bumpstop import (
    Assembly,
    Component,
    InputError,
    ModalBasis,
    Placed,
    ReducedComponent,
    Rotation,
    Structure,
    Support,
    craig_bampton,
    free_interface,
)
from bumpstop.structure.dofs import DOFS

Reduction = Callable[..., ReducedComponent]
both = pytest.mark.parametrize("reduction", [craig_bampton, free_interface])


@pytest.fixture(scope="module")
def third(bay: Callable[..., Structure]) -> Component:
    return Component(bay(), interface=["A", "B"])


def beam_of_three(reduced: ReducedComponent, clamped: bool) -> Assembly:
    return Assembly(
        parts={
            "left": Placed(reduced),
            "middle": Placed(reduced, at=(1, 0, 0)),
            "right": Placed(reduced, at=(2, 0, 0)),
        },
        joints=[("left.B", "middle.A"), ("middle.B", "right.A")],
        supports=[Support(nodes="left.A", fixed=DOFS)] if clamped else [],
    )


def uncut(bay: Callable[..., Structure], clamped: bool) -> Structure:
    whole = bay((3.0, 0.0, 0.0), elements=12)
    supports = [Support(nodes="A", fixed=DOFS)] if clamped else []
    return Structure(nodes=whole.nodes, beams=whole.beams, supports=supports)


@both
@pytest.mark.parametrize("clamped", [True, False])
def test_a_beam_cut_in_three_converges_to_the_whole_beam(
    bay: Callable[..., Structure], third: Component, reduction: Reduction, clamped: bool
) -> None:
    whole = ModalBasis.from_structure(uncut(bay, clamped), modes=18)
    flexible = whole.omega2 > 0.0
    before = np.full(np.count_nonzero(flexible), np.inf)
    for modes in (1, 2, 4, 7, 12, "all"):
        cut = ModalBasis.from_structure(
            beam_of_three(reduction(third, modes=modes), clamped), modes=18
        )
        np.testing.assert_array_equal(cut.omega2 > 0.0, flexible)
        excess = cut.omega2[flexible] / whole.omega2[flexible] - 1.0
        # Spaces that contain each other: frequencies come down, and never below the true ones.
        assert np.all(excess >= -1e-11)
        assert np.all(excess <= before + 1e-11)
        before = excess
    assert np.abs(before).max() < 1e-11


@both
def test_at_all_modes_the_shapes_are_those_of_the_whole_beam(
    bay: Callable[..., Structure], third: Component, reduction: Reduction
) -> None:
    whole = ModalBasis.from_structure(uncut(bay, True), modes=8)
    cut = ModalBasis.from_structure(beam_of_three(reduction(third, modes="all"), True), modes=8)
    for node, own in (("AB@0.35", "left.AB@0.35"), ("AB.4", "middle.A"), ("B", "right.B")):
        for dof in DOFS:
            expected = whole.row(node, dof)
            scale = np.abs(whole.row("B", "dy")).max()
            np.testing.assert_allclose(cut.row(own, dof), expected, atol=1e-9 * scale)


@both
@pytest.mark.parametrize("modes", [0, 3])
def test_forces_on_the_interface_are_answered_exactly(
    third: Component, reduction: Reduction, modes: int
) -> None:
    # Cantilevers, held at A: the reduced flexibility at B is that of all dofs.
    reduced = reduction(third, modes=modes)
    full = third.model.stiffness.to_dense()
    flexibility, exact = (
        np.linalg.inv(matrix[6:, 6:])[:6, :6] for matrix in (reduced.stiffness, full)
    )
    scale = np.sqrt(np.outer(exact.diagonal(), exact.diagonal()))
    np.testing.assert_allclose(flexibility / scale, exact / scale, atol=1e-10)


@both
def test_rigid_motions_are_in_the_reduced_space_to_the_last_bits(
    bay: Callable[..., Structure], reduction: Reduction
) -> None:
    component = Component(bay((0.3, -2.0, 1.1), elements=12), interface=["B", "A"])
    reduced = reduction(component, modes=2)
    model = component.model
    moved = reduced.shapes @ reduced.rigid
    coefficients, *_ = np.linalg.lstsq(model.rigid_shapes(), moved, rcond=None)
    np.testing.assert_allclose(model.rigid_shapes() @ coefficients, moved, atol=1e-14)
    assert np.linalg.matrix_rank(reduced.rigid) == 6


@pytest.mark.parametrize("interface", [[("A", "dy")], [("A", ("dx", "dy", "dz"))], ["A"]])
@both
def test_an_interface_that_cannot_hold_the_component_loses_no_rigid_motion(
    bay: Callable[..., Structure], reduction: Reduction, interface: Any
) -> None:
    reduced = reduction(Component(bay(), interface=interface), modes="all")
    free = ModalBasis.from_structure(Assembly(parts={"bay": Placed(reduced)}), modes=12)
    whole = ModalBasis.from_structure(bay(), modes=12)
    assert np.count_nonzero(free.omega2 == 0.0) == 6
    np.testing.assert_allclose(free.omega2, whole.omega2, rtol=1e-11)


@both
@pytest.mark.parametrize("modes", [0, "all"])
def test_a_component_that_is_all_interface_stays_as_it_is(
    bay: Callable[..., Structure], reduction: Reduction, modes: int | str
) -> None:
    beam = bay(elements=1)
    reduced = reduction(Component(beam, interface=["A", "B"]), modes=modes)
    np.testing.assert_array_equal(reduced.shapes, np.eye(12))
    found = ModalBasis.from_structure(Assembly(parts={"bay": Placed(reduced)}), modes="all")
    expected = ModalBasis.from_structure(beam, modes="all")
    np.testing.assert_allclose(found.omega2, expected.omega2, rtol=1e-12)


@both
def test_a_long_chain_of_turned_parts_floats_freely(
    bay: Callable[..., Structure], reduction: Reduction
) -> None:
    reduced = reduction(Component(bay(elements=2), interface=["A", "B"]), modes=1)
    parts, at = {}, (0.0, 0.0, 0.0)
    for number in range(20):
        way = Rotation(axis=(0.1, 0.2, 1.0), angle=0.3 * number)
        parts[f"p{number}"] = Placed(reduced, at=at, rotation=way)
        x, y, z = way.matrix[:, 0]
        at = (at[0] + x, at[1] + y, at[2] + z)
    joints = [(f"p{number}.B", f"p{number + 1}.A") for number in range(19)]
    omega2 = ModalBasis.from_structure(Assembly(parts=parts, joints=joints), modes=8).omega2
    assert np.count_nonzero(omega2 == 0.0) == 6
    assert omega2[6] > 0.1


def test_reduced_matrices_are_those_of_the_shapes(third: Component) -> None:
    reduced = craig_bampton(third, modes=5)
    shapes = reduced.shapes
    full = third.model.mass.to_dense()
    np.testing.assert_allclose(reduced.mass, shapes.T @ full @ shapes, rtol=1e-12, atol=1e-12)
    # Craig-Bampton's form: unit modal mass, squared frequencies, no static coupling.
    np.testing.assert_allclose(reduced.mass[12:, 12:], np.eye(5), atol=1e-12)
    scale = reduced.stiffness[12:, 12:].diagonal()
    np.testing.assert_allclose(reduced.stiffness[:12, 12:] / scale, 0.0, atol=1e-10)
    assert not reduced.damping.any()
    np.testing.assert_array_equal(reduced.stiffness, reduced.stiffness.T)


@both
@pytest.mark.parametrize("modes", [-1, 2.5, True, "some", None])
def test_what_is_no_number_of_modes_is_refused(
    third: Component, reduction: Reduction, modes: Any
) -> None:
    with pytest.raises(InputError, match='modes: must be a whole number, 0 or more, or "all"'):
        reduction(third, modes=modes)


def test_more_modes_than_there_are_are_refused(third: Component) -> None:
    with pytest.raises(InputError, match=r"modes: more modes than there are \(got 19\).*has 18"):
        craig_bampton(third, modes=19)
    with pytest.raises(InputError, match=r"modes: more modes than there are \(got 25\).*has 24"):
        free_interface(third, modes=25)


@pytest.mark.parametrize(
    ("interface", "message"),
    [
        ([], "interface: must list its nodes"),
        ("A", "interface: must list its nodes"),
        (None, "interface: must list its nodes"),
        (["C"], r"interface: unknown node \(got 'C'\); known: A, B, AB.1"),
        (["A", "A"], r"interface: this name is used twice \(got 'A'\)"),
        ([3], "interface: must hold names of nodes, or pairs"),
        ([("A", "B")], r"dof: unknown dof \(got 'B'\)"),
        ([("A", ())], "interface.A: must list dofs"),
        ([("A", ("dx", "dx"))], r"interface.A: this name is used twice \(got 'dx'\)"),
    ],
)
def test_interfaces_that_cannot_be_used_are_refused(
    bay: Callable[..., Structure], interface: Any, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        Component(bay(), interface=interface)


def test_what_a_component_holds_itself_is_no_interface(bay: Callable[..., Structure]) -> None:
    beam = bay()
    planar = Structure(
        nodes=beam.nodes,
        beams=beam.beams,
        supports=[
            Support(nodes="all", fixed=("dx", "dz", "drx", "dry")),
            Support(nodes="A", fixed=("dy", "drz")),
        ],
    )
    assert Component(planar, interface=["B"]).interface == (("B", ("dy", "drz")),)
    with pytest.raises(InputError, match=r"dz is held by the component's own supports"):
        Component(planar, interface=[("B", ("dy", "dz"))])
    with pytest.raises(InputError, match=r"cannot be joined: its component holds it \(got 'A'\)"):
        Component(planar, interface=["A"])


def test_only_a_model_makes_a_component() -> None:
    model: Any = "beam"
    with pytest.raises(InputError, match="model: must be a structure"):
        Component(model, interface=["A"])
