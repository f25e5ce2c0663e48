from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bumpstop import (
    Assembly,
    Beam,
    Bearing,
    Circle,
    Component,
    Gauge,
    Gravity,
    InputError,
    Joint,
    Material,
    Matrices,
    ModalBasis,
    NodalForce,
    Placed,
    PointMass,
    Problem,
    Rectangle,
    RigidTranslation,
    Rotation,
    Spring,
    Stop,
    Structure,
    Support,
    craig_bampton,
    free_interface,
    simulate,
)
from bumpstop.structure.dofs import DOFS

Bay = Callable[..., Structure]
STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = Rectangle(height=0.06, width=0.025)


def chain(bay: Bay, *, modes: int | str = "all", hinge: bool = False) -> Assembly:
    """Two bays in line, clamped at the left."""
    reduced = craig_bampton(Component(bay(), interface=["A", "B"]), modes=modes)
    dofs = ("dx", "dy", "dz") if hinge else None
    return Assembly(
        parts={"left": Placed(reduced), "right": Placed(reduced, at=(1, 0, 0))},
        joints=[Joint("left.B", "right.A", dofs=dofs)],
        supports=[Support(nodes="left.A", fixed=DOFS)],
    )


def two_bays(bay: Bay) -> Structure:
    """The same in one piece."""
    beam = bay((2.0, 0.0, 0.0), elements=8)
    return Structure(nodes=beam.nodes, beams=beam.beams, supports=[Support(nodes="A", fixed=DOFS)])


def test_a_portal_of_one_column_used_twice_is_the_frame(bay: Bay) -> None:
    column = craig_bampton(Component(bay((0.0, 0.0, 2.0)), interface=["A", "B"]), modes="all")
    beam = craig_bampton(Component(bay((3.0, 0.0, 0.0)), interface=["A", "B"]), modes="all")
    about_z = Rotation(axis=(0, 0, 1), angle=math.pi)
    portal = Assembly(
        parts={
            "left": Placed(column),
            "right": Placed(column, at=(3, 0, 0), rotation=about_z),
            "top": Placed(beam, at=(0, 0, 2)),
        },
        joints=[("left.B", "top.A"), ("top.B", "right.B")],
        supports=[Support(nodes=("left.A", "right.A"), fixed=DOFS)],
    )
    frame = Structure(
        nodes={"a": (0, 0, 0), "b": (0, 0, 2), "c": (3, 0, 2), "d": (3, 0, 0)},
        beams=[
            Beam(name, nodes=tuple(ends), elements=4, material=STEEL, section=BAR)
            for name, ends in (("left", "ab"), ("top", "bc"), ("right", "dc"))
        ],
        supports=[Support(nodes=("a", "d"), fixed=DOFS)],
    )
    coupled = ModalBasis.from_structure(portal, modes=12)
    direct = ModalBasis.from_structure(frame, modes=12)
    np.testing.assert_allclose(coupled.omega2, direct.omega2, rtol=1e-10)
    for node, own in (("b", "left.B"), ("c", "right.B"), ("top@1.3", "top.AB@1.3")):
        for dof in DOFS:
            # Sizes: of left and right in a symmetric frame, rounding decides which is positive.
            expected = np.abs(direct.row(node, dof))
            np.testing.assert_allclose(np.abs(coupled.row(own, dof)), expected, atol=1e-9)
    np.testing.assert_allclose(portal.position("right.AB@0.5"), (3, 0, 0.5), atol=1e-15)


@settings(max_examples=25, deadline=None)
@given(
    axis=st.tuples(*[st.floats(-1, 1).filter(lambda x: x == 0 or abs(x) > 1e-3)] * 3).filter(any),
    angle=st.floats(-7, 7),
)
def test_an_assembly_does_not_know_how_it_is_turned(
    axis: tuple[float, float, float], angle: float
) -> None:
    rotation = Rotation(axis=axis, angle=angle)
    turn = rotation.matrix
    beam = Beam("AB", nodes=("A", "B"), elements=2, material=STEEL, section=BAR)
    model = Structure(nodes={"A": (0.2, 0, 0), "B": (1, 0.3, -0.4)}, beams=[beam])
    reduced = craig_bampton(Component(model, interface=["A", "B"]), modes=2)
    frequencies, tips = [], []
    for way, axes in ((None, np.eye(3)), (rotation, turn)):
        ends = axes @ np.array([1, 0.3, -0.4]), axes @ np.array([0.2, 0, 0])
        whole = Assembly(
            parts={
                "first": Placed(reduced, rotation=way),
                "second": Placed(reduced, at=ends[0] - ends[1], rotation=way),
            },
            joints=[("first.B", "second.A")],
            supports=[Support(nodes="first.A", fixed=DOFS)],
        )
        basis = ModalBasis.from_structure(whole, modes=10)
        tip = np.array([basis.row("second.B", dof) for dof in DOFS[:3]])
        frequencies.append(basis.omega2)
        # Sizes: the sign of a shape depends on its largest component, which turns.
        tips.append(np.abs(axes.T @ tip))
    np.testing.assert_allclose(frequencies[1], frequencies[0], rtol=1e-9)
    np.testing.assert_allclose(tips[1], tips[0], atol=1e-6 * tips[0].max())


def test_rigid_motions_of_the_whole_are_exact(bay: Bay) -> None:
    turned = Rotation(axis=(1, 2, 3), angle=0.7)
    reduced = free_interface(Component(bay(elements=3), interface=["A", "B"]), modes=2)
    end = turned.matrix @ np.array([1.0, 0.0, 0.0])
    whole = Assembly(
        parts={"first": Placed(reduced), "second": Placed(reduced, at=(1, 0, 0), rotation=turned)},
        joints=[("first.B", "second.A")],
    )
    basis = ModalBasis.from_structure(whole, modes=8)
    assert np.count_nonzero(basis.omega2 == 0.0) == 6
    assert np.all(basis.omega2[6:] > 1.0)
    np.testing.assert_allclose(whole.position("second.B"), np.array([1.0, 0, 0]) + end)
    # A turning about a far point, by the modes alone, is that of a rigid body.
    field = whole.rigid_field(rotation=(0.3, -0.2, 0.5), about=(2.0, -1.0, 4.0))
    amplitudes = basis.project_field(field)
    np.testing.assert_allclose(amplitudes[6:], 0.0, atol=1e-11 * np.abs(amplitudes).max())
    nodes = [row for row, (_, dof) in enumerate(whole.dofs) if dof in DOFS]
    shapes = basis.shapes[nodes, :6]
    np.testing.assert_allclose(shapes @ amplitudes[:6], field[nodes], atol=1e-12)
    strained = whole.stiffness @ basis.shapes[:, :6]
    assert np.abs(strained).max() < 1e-13 * np.abs(whole.stiffness.values).max()


def test_a_hinge_leaves_the_rotations_free(bay: Bay) -> None:
    # The right bay swings about all three axes: a mechanism, without frequency.
    with pytest.raises(InputError, match=r"a mechanism: rotation about x through .* of right\.A"):
        ModalBasis.from_structure(chain(bay, hinge=True), modes=8)
    basis = ModalBasis.from_structure(chain(bay, hinge=True), modes=8, rigid_modes=3)
    assert np.count_nonzero(basis.omega2 == 0.0) == 3
    swinging = basis.shapes[:, :3]
    rows = {dof: row for row, dof in enumerate(basis.dofs)}
    np.testing.assert_allclose(swinging[[rows["left.B", dof] for dof in DOFS]], 0.0, atol=1e-14)
    for dof in ("dx", "dy", "dz"):
        np.testing.assert_allclose(basis.row("left.B", dof), basis.row("right.A", dof), atol=1e-14)


def test_planar_components_can_be_turned_into_another_plane(bay: Bay) -> None:
    beam = bay()
    planar = Structure(
        nodes=beam.nodes,
        beams=beam.beams,
        supports=[Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))],
    )
    reduced = craig_bampton(Component(planar, interface=["A", "B"]), modes="all")
    frequencies = []
    for angle in (0.0, math.pi / 2, 0.3):
        way = Rotation(axis=(1, 0, 0), angle=angle)
        whole = Assembly(
            parts={
                "left": Placed(reduced, rotation=way),
                "right": Placed(reduced, at=(1, 0, 0), rotation=way),
            },
            joints=[("left.B", "right.A")],
            supports=[Support(nodes="left.A", fixed=("dy", "dz", "dry", "drz"))],
        )
        frequencies.append(ModalBasis.from_structure(whole, modes=6).omega2)
    np.testing.assert_allclose(frequencies[1], frequencies[0], rtol=1e-10)
    np.testing.assert_allclose(frequencies[2], frequencies[0], rtol=1e-10)
    expected = ModalBasis.from_structure(
        Structure(
            nodes=bay((2.0, 0, 0), elements=8).nodes,
            beams=bay((2.0, 0, 0), elements=8).beams,
            supports=[*planar.supports, Support(nodes="A", fixed=("dy", "drz"))],
        ),
        modes=6,
    )
    np.testing.assert_allclose(frequencies[0], expected.omega2, rtol=1e-10)


def test_a_stop_on_a_part_is_hit_as_on_the_whole_structure(bay: Bay) -> None:
    responses = []
    for model, node, tip, beam in (
        (two_bays(bay), "AB@1.5", "B", "AB"),
        (chain(bay), "right.AB@0.5", "right.B", "right.AB"),
    ):
        basis = ModalBasis.from_structure(model, modes=48, damping=0.01)
        problem = Problem(
            basis,
            laws=[Stop("stop", node=node, normal=(0, 1, 0), gap=1e-3, stiffness=2e5)],
            loads=[
                Gravity("weight", acceleration=(0, -9.81, 0)),
                NodalForce("push", node=tip, force=(0, -20, 0), moment=(0, 0, 3)),
            ],
            initial=RigidTranslation((0, -0.5, 0), nodes=tip),
            duration=0.2,
            gauges=[Gauge("gauge", beam=beam, at=1.2 if tip == "B" else 0.2, fibre=(0.03, 0.0))],
        )
        responses.append((simulate(problem, method="exact"), tip))
    (whole, tip), (coupled, own) = responses
    assert whole.event_count == coupled.event_count > 2
    for quantity, names in (
        ("displacement", ((tip, "dy"), (own, "dy"))),
        ("stop_force", (("stop",), ("stop",))),
        ("gauge", (("gauge",), ("gauge",))),
    ):
        expected = whole.sample(quantity, *names[0])
        got = coupled.sample(quantity, *names[1])
        np.testing.assert_allclose(got, expected, atol=1e-9 * np.abs(expected).max())


def test_an_assembly_can_be_a_component_itself(bay: Bay) -> None:
    reduced = craig_bampton(Component(bay(), interface=["A", "B"]), modes="all")
    pair = Assembly(
        parts={"one": Placed(reduced), "two": Placed(reduced, at=(1, 0, 0))},
        joints=[("one.B", "two.A")],
    )
    double = craig_bampton(Component(pair, interface=["one.A", "two.B"]), modes="all")
    way = Rotation(axis=(0, 0, 1), angle=0.4)
    end = way.matrix @ np.array([2.0, 0, 0])
    four = Assembly(
        parts={"left": Placed(double, rotation=way), "right": Placed(double, at=end, rotation=way)},
        joints=[("left.two.B", "right.one.A")],
        supports=[Support(nodes="left.one.A", fixed=DOFS)],
    )
    beam = bay((4.0, 0, 0), elements=16)
    whole = Structure(nodes=beam.nodes, beams=beam.beams, supports=[Support(nodes="A", fixed=DOFS)])
    coupled = ModalBasis.from_structure(four, modes=10)
    direct = ModalBasis.from_structure(whole, modes=10)
    np.testing.assert_allclose(coupled.omega2, direct.omega2, rtol=1e-9)
    np.testing.assert_allclose(
        np.abs(coupled.row("right.two.AB@0.7", "dz")), np.abs(direct.row("AB@3.7", "dz")), atol=1e-7
    )


def test_matrices_from_elsewhere_make_components() -> None:
    # A chain of four masses, free, in two halves: closed form omega2 = 4 k/m sin2(i pi / 8).
    def half(first: float, second: float) -> Matrices:
        return Matrices(
            stiffness=[[1e4, -1e4, 0], [-1e4, 2e4, -1e4], [0, -1e4, 1e4]],
            mass=np.diag([first, 2.0, second]).tolist(),
            dofs=[("P", "dx"), ("Q", "dx"), ("R", "dx")],
            positions={"P": (0, 0, 0), "Q": (1, 0, 0), "R": (2, 0, 0)},
        )

    parts = {
        "left": Placed(craig_bampton(Component(half(2.0, 1.0), interface=["R"]), modes="all")),
        "right": Placed(
            craig_bampton(Component(half(1.0, 2.0), interface=["P"]), modes="all"), at=(2, 0, 0)
        ),
    }
    whole = Assembly(parts=parts, joints=[("left.R", "right.P")])
    basis = ModalBasis.from_structure(whole, modes=5)
    expected = 4 * 1e4 / 2.0 * np.sin(np.arange(5) * np.pi / 10) ** 2
    np.testing.assert_allclose(basis.omega2, expected, rtol=1e-12, atol=0.0)
    with pytest.raises(InputError, match=r"parts.left.rotation: turns dx of 'P' towards dy"):
        Assembly(parts={"left": Placed(parts["left"].component, rotation=Rotation((0, 0, 1), 0.1))})
    with pytest.raises(InputError, match="the component has no beams"):
        basis.gauge_row(Gauge("g", beam="left.AB", at=0.0, fibre=(0, 0)))


def shaft(axes: Any, at: Any) -> Structure:
    """A spinning shaft in a bearing, with a damped spring, built along the first of the axes."""
    places = {node: tuple(at + axes[:, 0] * x) for node, x in (("A", 0.0), ("B", 0.5), ("C", 1.0))}
    round_bar = Circle(radius=0.02)
    return Structure(
        nodes=places,
        beams=[
            Beam(name, nodes=tuple(name), elements=2, material=STEEL, section=round_bar, spin=300.0)
            for name in ("AB", "BC")
        ],
        bearings=[Bearing("film", node="A", axis=tuple(axes[:, 0]), stiffness=1e7, damping=1e3)],
        springs=[Spring("mount", node="C", other="B", stiffness=1e5, damping=30.0)],
    )


@pytest.mark.parametrize("reduction", [craig_bampton, free_interface])
def test_damping_and_spin_turn_with_their_component(reduction: Any) -> None:
    way, at = Rotation(axis=(1, 2, 3), angle=0.8), (1.0, 2.0, 3.0)
    component = Component(shaft(np.eye(3), np.zeros(3)), interface=["A", "C"])
    placed = Placed(reduction(component, modes="all"), at=at, rotation=way)
    turned = Assembly(parts={"shaft": placed})
    built = shaft(way.matrix, np.array(at))
    size = len(built.dofs)
    for kind in ("stiffness", "mass", "damping", "gyroscopic"):
        expected = getattr(built, kind).to_dense()
        found = getattr(turned, kind).to_dense()[:size, :size]
        np.testing.assert_allclose(found, expected, atol=1e-13 * np.abs(expected).max())
        sign = getattr(turned, kind).mirror_sign()
        assert sign == (-1.0 if kind == "gyroscopic" else 1.0)
    one, other = (ModalBasis.from_structure(model, modes="all") for model in (turned, built))
    np.testing.assert_allclose(one.omega2, other.omega2, rtol=1e-9)
    # Modes of equal frequency may be combined in any way; what they damp together stays.
    assert one.damping_matrix is not None
    assert other.damping_matrix is not None
    np.testing.assert_allclose(
        np.linalg.eigvalsh(one.damping_matrix),
        np.linalg.eigvalsh(other.damping_matrix),
        atol=1e-10 * float(np.abs(other.damping_matrix).max()),
    )


def test_dofs_that_follow_others_are_no_interface_unless_left_out() -> None:
    # The masses have no inertia in rotation: what the spring makes of it follows the rest.
    pair = Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        masses=[PointMass("a", node="A", mass=1.0), PointMass("b", node="B", mass=2.0)],
        springs=[Spring("s", node="A", other="B", stiffness=(1e4, 1e4, 1e4, 10.0, 10.0, 10.0))],
    )
    with pytest.raises(InputError, match=r"dr. follows other dofs, by a relation or because"):
        Component(pair, interface=["A", "B"])
    ends = [(node, ("dx", "dy", "dz")) for node in ("A", "B")]
    reduced = craig_bampton(Component(pair, interface=ends), modes=0)
    row = Assembly(
        parts={"one": Placed(reduced), "two": Placed(reduced, at=(1, 0, 0))},
        joints=[("one.B", "two.A")],
    )
    whole = Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0), "C": (2, 0, 0)},
        masses=[PointMass(n, node=n, mass=m) for n, m in (("A", 1.0), ("B", 3.0), ("C", 2.0))],
        springs=[
            Spring(a + b, node=a, other=b, stiffness=(1e4, 0.0, 0.0, 0.0, 0.0, 0.0))
            for a, b in ("AB", "BC")
        ],
        supports=[Support(nodes="all", fixed=("dy", "dz"))],
    )
    expected = ModalBasis.from_structure(whole, modes=3).omega2
    found = ModalBasis.from_structure(row, modes="all", rigid_modes=7).omega2
    for value in expected[1:]:
        assert np.isclose(found, value, rtol=1e-10).any()


def test_what_lies_together_is_joined_where_that_is_asked_for(bay: Bay) -> None:
    reduced = craig_bampton(Component(bay(), interface=["A", "B"]), modes=3)
    parts = {"left": Placed(reduced), "right": Placed(reduced, at=(1, 0, 0))}
    supports = [Support(nodes="left.A", fixed=DOFS)]
    apart = Assembly(parts=parts, supports=supports)
    by_name = Assembly(parts=parts, supports=supports, joints=[("left.B", "right.A")])
    by_place = Assembly(parts=parts, supports=supports, join_coincident=True)
    assert len(apart.free) == len(by_place.free) + 6
    np.testing.assert_array_equal(
        ModalBasis.from_structure(by_name, modes=4).omega2,
        ModalBasis.from_structure(by_place, modes=4).omega2,
    )
    hinge = Joint("right.A", "left.B", dofs=("dx", "dy", "dz"))
    hinged = Assembly(parts=parts, supports=supports, joints=[hinge], join_coincident=True)
    assert len(hinged.free) == len(by_place.free) + 3


def test_a_ring_closes_whatever_the_order_of_its_joints(bay: Bay) -> None:
    reduced = craig_bampton(Component(bay(), interface=["A", "B"]), modes=2)
    corner, places = (0.0, 0.0, 0.0), []
    for side in range(3):
        way = Rotation(axis=(0, 0, 1), angle=2 * math.pi / 3 * side)
        places.append(Placed(reduced, at=corner, rotation=way))
        x, y, _ = way.matrix[:, 0]
        corner = (corner[0] + x, corner[1] + y, 0.0)
    ring = Assembly(
        parts=dict(zip("abc", places, strict=True)),
        joints=[("a.B", "b.A"), ("b.B", "c.A"), ("c.B", "a.A")],
    )
    omega2 = ModalBasis.from_structure(ring, modes=10).omega2
    assert np.count_nonzero(omega2 == 0.0) == 6
    # Three-fold symmetry: flexible modes come in pairs.
    assert omega2[6] > 1.0


def test_inner_modes_can_be_read_by_name(bay: Bay) -> None:
    whole = chain(bay, modes=2)
    basis = ModalBasis.from_structure(whole, modes=3)
    assert ("left", "mode 1") in basis.dofs
    assert len(whole.free) == 2 * 6 + 2 * 2
    np.testing.assert_array_equal(whole.free, np.sort(whole.free))
    coordinates = basis.shapes[whole.free]
    np.testing.assert_allclose(whole.expansion @ coordinates, basis.shapes, atol=1e-15)
    assert np.abs(whole.displacement_form("left", "mode 1").of(basis.shapes)).max() > 0.0


def test_supports_alone_may_not_hold_everything(bay: Bay) -> None:
    reduced = craig_bampton(Component(bay(), interface=["A", "B"]), modes=0)
    with pytest.raises(InputError, match="supports: hold everything"):
        Assembly(
            parts={"bay": Placed(reduced)},
            supports=[Support(nodes=("bay.A", "bay.B"), fixed=DOFS)],
        )


@pytest.mark.parametrize(
    ("joints", "message"),
    [
        ([("left.B", "right.C")], r"joints\[0\]: is not an interface node \(got 'right.C'\)"),
        ([("left.AB.1", "right.A")], r"joints\[0\]: is not an interface node .*'left.AB.1'"),
        ([("left.A", "right.A")], r"at different places, \(0, 0, 0\) and \(1, 0, 0\)"),
        ([("left.B", "left.B")], "joins a node to itself"),
        ([("left.B", "right.A"), ("right.A", "left.B")], r"joints\[1\]: .* are joined already"),
        (
            [("left.B", "right.A"), ("right.A", "up.A"), ("up.A", "left.B")],
            r"joints\[2\]: up.A and left.B are joined already; directly, or through",
        ),
        ([("left.B", "pinned.A")], r"the interfaces have different dofs: left.B has dx dy dz drx"),
        ([Joint("left.B", "pinned.A", dofs=("drx",))], r"drx is not in the interface of pinned.A"),
        ([("left.B",)], r"joints\[0\]: must be a Joint or the names of two nodes"),
        (["left.B"], r"joints\[0\]: must be a Joint or the names of two nodes"),
        ("left.B", "joints: must be a list"),
    ],
)
def test_joints_that_cannot_be_made_are_refused(bay: Bay, joints: Any, message: str) -> None:
    reduced = craig_bampton(Component(bay(), interface=["A", "B"]), modes=1)
    pinned = craig_bampton(Component(bay(), interface=[("A", ("dx", "dy", "dz")), "B"]), modes=1)
    parts = {
        "left": Placed(reduced),
        "right": Placed(reduced, at=(1, 0, 0)),
        "up": Placed(reduced, at=(1, 0, 0), rotation=Rotation((0, 0, 1), math.pi / 2)),
        "pinned": Placed(pinned, at=(1, 0, 0)),
    }
    with pytest.raises(InputError, match=message):
        Assembly(parts=parts, joints=joints)


@pytest.mark.parametrize(
    ("support", "message"),
    [
        (Support(nodes="all", fixed="dx"), r"supports\[0\].nodes: must name interface nodes"),
        (Support(nodes="B", fixed="dx"), r"supports\[0\].nodes: is not an interface node"),
        (Support(nodes="bay.AB.2", fixed="dx"), r"is not an interface node \(got 'bay.AB.2'\)"),
        (Support(nodes="bay.A", fixed="drx"), r"supports\[0\].fixed: drx is not in the interface"),
        ("bay.A", "supports: must hold Supports only"),
    ],
)
def test_supports_that_cannot_be_made_are_refused(bay: Bay, support: Any, message: str) -> None:
    pinned = craig_bampton(Component(bay(), interface=[("A", ("dx", "dy", "dz")), "B"]), modes=1)
    with pytest.raises(InputError, match=message):
        Assembly(parts={"bay": Placed(pinned)}, supports=[support])


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({}, "parts: must name at least one placed component"),
        ({"a.b": None}, r"cannot have '.' or '@' in its name \(got 'a.b'\)"),
        ({"": None}, "parts: must be a name"),
        ({"a": "bay"}, "parts.a: must be placed"),
    ],
)
def test_parts_that_cannot_be_used_are_refused(parts: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Assembly(parts=parts)


def test_only_reduced_components_are_placed(bay: Bay) -> None:
    component: Any = Component(bay(), interface=["A"])
    with pytest.raises(InputError, match="component: is not reduced yet; reduce it with"):
        Placed(component)
    other: Any = "bay"
    with pytest.raises(InputError, match="component: must be a reduced component"):
        Placed(other)


@pytest.mark.parametrize(
    ("node", "message"),
    [
        ("rigth.B", r"node: unknown part \(got 'rigth.B'\); did you mean 'right'\?"),
        ("B", "node: unknown part"),
        ("right.C", r"node: unknown node \(got 'right.C'\)"),
        ("right.AB@3", r"node: must be on the beam, which is 1 m long \(got 'right.AB@3'\)"),
    ],
)
def test_nodes_that_are_not_there_are_named_with_their_part(
    bay: Bay, node: str, message: str
) -> None:
    basis = ModalBasis.from_structure(chain(bay, modes=1), modes=2)
    with pytest.raises(InputError, match=message):
        basis.row(node, "dy")


def test_gauges_name_the_part_of_their_beam(bay: Bay) -> None:
    basis = ModalBasis.from_structure(chain(bay, modes=1), modes=2)
    with pytest.raises(InputError, match=r"beam: unknown beam \(got 'left.BA'\)"):
        basis.gauge_row(Gauge("g", beam="left.BA", at=0.1, fibre=(0, 0)))
    with pytest.raises(InputError, match=r"beam: unknown part \(got 'AB'\)"):
        basis.gauge_row(Gauge("g", beam="AB", at=0.1, fibre=(0, 0)))
