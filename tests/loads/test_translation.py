from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop import Beam, InputError, ModalBasis, RigidTranslation, Structure, Support

STEEL = bs.Material(young_modulus=2e11, poisson_ratio=0.3, density=7800.0)
BAR = bs.Rectangle(height=0.02, width=0.03)
MASS = 7800.0 * 0.02 * 0.03
ALL = ("dx", "dy", "dz", "drx", "dry", "drz")


def bar(first: str, last: str) -> Beam:
    return Beam(first + last, nodes=(first, last), elements=3, material=STEEL, section=BAR)


@pytest.fixture(scope="module")
def two_bars() -> ModalBasis:
    """Two bars of 1 m on one line that do not touch: one free along it, one held at its end."""
    nodes = {"A": (0, 0, 0), "B": (1, 0, 0), "C": (1.5, 0, 0), "D": (2.5, 0, 0)}
    along = Support(nodes="all", fixed=ALL[1:])
    structure = Structure(
        nodes=nodes,
        beams=[bar("A", "B"), bar("C", "D")],
        supports=[along, Support(nodes="D", fixed="dx")],
    )
    return ModalBasis.from_structure(structure, modes="all", rigid_modes=1)


def test_a_free_bar_that_flies_is_its_rigid_mode_alone(two_bars: ModalBasis) -> None:
    displacement, velocity = RigidTranslation((2, 0, 0), beams="AB").modal_state(two_bars)
    assert not displacement.any()
    assert velocity[0] == pytest.approx(2.0 * np.sqrt(MASS), rel=1e-12)
    np.testing.assert_allclose(velocity[1:], 0.0, atol=1e-11)


@pytest.mark.parametrize(
    ("moving", "expected"),
    [
        ({"beams": ["AB"]}, [2.0, 2.0, 2.0, 2.0, 0.0, 0.0, 0.0]),
        ({"nodes": ["AB.1", "C"]}, [0.0, 2.0, 0.0, 0.0, 2.0, 0.0, 0.0]),
        ({"nodes": ["C"], "beams": "AB"}, [2.0, 2.0, 2.0, 2.0, 2.0, 0.0, 0.0]),
    ],
)
def test_nodes_move_with_all_modes(
    moving: dict[str, Any], expected: list[float], two_bars: ModalBasis
) -> None:
    """All modes hold every field that the supports allow, node by node."""
    _, velocity = RigidTranslation((2, 0, 0), **moving).modal_state(two_bars)
    places = ["A", "AB.1", "AB.2", "B", "C", "CD.1", "CD.2"]
    found = [two_bars.row(place, "dx") @ velocity for place in places]
    np.testing.assert_allclose(found, expected, atol=1e-11)


def two_masses(first: float, second: float, modes: int) -> ModalBasis:
    """Two masses that fly along x, joined by a spring."""
    structure = Structure(
        nodes={"P": (0, 0, 0), "Q": (1, 0, 0)},
        masses=[bs.PointMass("P", node="P", mass=first), bs.PointMass("Q", node="Q", mass=second)],
        springs=[bs.Spring("s", node="P", other="Q", stiffness=1e4)],
        supports=[Support(nodes="all", fixed=ALL[1:])],
    )
    return ModalBasis.from_structure(structure, modes=modes)


def test_the_whole_moves_where_nothing_is_named() -> None:
    basis = two_masses(3.0, 1.0, modes=1)
    state = RigidTranslation((2, 0, 0))
    _, velocity = state.modal_state(basis)
    np.testing.assert_allclose([basis.row(p, "dx") @ velocity for p in "PQ"], 2.0, rtol=1e-14)
    assert state.remarks(basis) == ()


@pytest.mark.parametrize(
    ("flying", "modes", "told"),
    [(3.0, 1, "25 %"), (98.9, 1, "1.1 %"), (99.1, 1, None), (3.0, 2, None)],
)
def test_kinetic_energy_beyond_the_basis_is_told(
    flying: float, modes: int, told: str | None
) -> None:
    """P flies alone: its momentum, and no more of its energy, is in the flight of both."""
    total = 4.0 if flying == 3.0 else 100.0
    basis = two_masses(flying, total - flying, modes)
    state = RigidTranslation((2, 0, 0), nodes="P")
    _, velocity = state.modal_state(basis)
    assert velocity[0] == pytest.approx(2.0 * flying / np.sqrt(total), rel=1e-12)
    remarks = bs.Problem(basis, initial=state, duration=1.0).remarks
    expected = [] if told is None else [f"{told} of the kinetic energy of the initial translation"]
    assert [line.partition(" is lost")[0] for line in remarks[1:]] == expected


def test_a_field_that_no_mode_has_is_lost_or_refused() -> None:
    """Flight along x is nothing that a mode along y, or one that stretches the spring, has."""
    both = two_masses(3.0, 1.0, modes=2)
    assert both.model is not None
    stretch = ModalBasis.from_vectors(both.model, both.shapes[:, 1:])
    (told,) = RigidTranslation((1, 0, 0)).remarks(stretch)
    assert told.startswith("100 % of the kinetic energy of the initial translation is lost")
    point = Structure(
        nodes={"P": (0, 0, 0)},
        masses=[bs.PointMass("P", node="P", mass=4.0)],
        supports=[Support(nodes="P", fixed=ALL[2:])],
    )
    across = ModalBasis.from_vectors(point, np.eye(6)[:, 1:2])
    with pytest.raises(InputError, match="no mode takes part in this translation"):
        RigidTranslation((1, 0, 0)).modal_state(across)


@pytest.mark.parametrize(
    ("velocity", "moving", "moved"),
    [
        ((2, 0, 0), {}, "D dx"),
        ((2, 0, 0), {"beams": ["AB", "CD"]}, "D dx"),
        ((2, 5, 0), {"beams": ["AB"]}, "A dy"),
        ((0, 1, 0), {}, "A dy"),
    ],
)
def test_what_is_held_cannot_fly(
    velocity: tuple[float, float, float], moving: dict[str, Any], moved: str, two_bars: ModalBasis
) -> None:
    with pytest.raises(InputError, match=f"velocity: would move {moved}, which is held, at . m/s"):
        RigidTranslation(velocity, **moving).modal_state(two_bars)


@pytest.mark.parametrize(
    ("moving", "message"),
    [
        ({"nodes": "Q"}, r"nodes: unknown node \(got 'Q'\)"),
        ({"nodes": "AB.4"}, r"nodes: unknown node .*; did you mean 'AB\.[12]'"),
        ({"beams": "AC"}, r"beams: unknown beam \(got 'AC'\); known: AB, CD"),
    ],
)
def test_unknown_names(moving: dict[str, Any], message: str, two_bars: ModalBasis) -> None:
    with pytest.raises(InputError, match=message):
        RigidTranslation((1, 0, 0), **moving).modal_state(two_bars)


def test_it_needs_a_structure() -> None:
    basis = ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    with pytest.raises(InputError, match="needs a basis computed from a structure"):
        RigidTranslation((1, 0, 0)).modal_state(basis)


@pytest.mark.parametrize("value", [(1, 0), (float("inf"), 0, 0), "fast"])
def test_a_velocity_is_three_finite_numbers(value: Any) -> None:
    with pytest.raises(InputError) as caught:
        RigidTranslation(value)
    assert caught.value.key == "velocity"


def test_a_part_of_an_assembly_flies() -> None:
    free = Structure(nodes={"A": (0, 0, 0), "B": (1, 0, 0)}, beams=[bar("A", "B")])
    part = bs.craig_bampton(bs.Component(free, interface=["A", "B"]), modes=2)
    assembly = bs.Assembly(parts={"left": bs.Placed(part), "right": bs.Placed(part, at=(2, 0, 0))})
    basis = ModalBasis.from_structure(assembly, modes=14, rigid_modes=12)
    _, velocity = RigidTranslation((0, 3, 0), beams="left.AB").modal_state(basis)
    for node, speed in (("left.A", 3.0), ("left.AB.2", 3.0), ("right.A", 0.0), ("right.B", 0.0)):
        assert basis.row(node, "dy") @ velocity == pytest.approx(speed, abs=1e-11)
    with pytest.raises(InputError, match=r"beams: unknown beam \(got 'left.AC'\)"):
        RigidTranslation((0, 3, 0), beams="left.AC").modal_state(basis)


CASE = """
[nodes]
P = [0, 0, 0]
[masses.block]
node = "P"
mass = 4
[[supports]]
nodes = ["P"]
fixed = ["dy", "dz", "drx", "dry", "drz"]
[basis]
modes = 1
[run]
duration = 1
[initial]
"""


@pytest.fixture
def loaded(tmp_path: Path) -> Callable[[str], bs.Case]:
    def load(initial: str) -> bs.Case:
        file = tmp_path / "case.toml"
        file.write_text(CASE + initial, encoding="utf-8")
        return bs.load_case(file)

    return load


def test_in_a_case_file(loaded: Callable[[str], bs.Case]) -> None:
    case = loaded('translation = { velocity = ["36 km/h", 0, 0], nodes = ["P"] }')
    assert bs.simulate(case.problems["base"]).sample("displacement", "P", "dx", times=[0.5]) == 5.0


@pytest.mark.parametrize(
    ("initial", "message"),
    [
        ("translation = {}", "initial.translation.velocity: is missing"),
        (
            "translation = { velocity = [1, 0, 0] }\nmodal = { velocity = [1] }",
            "initial: translation and modal exclude each other",
        ),
        (
            'translation = { velocity = [1, 0, 0], beams = ["AB"] }',
            "initial.translation.beams: unknown beam",
        ),
    ],
)
def test_mistakes_in_a_case_file(
    initial: str, message: str, loaded: Callable[[str], bs.Case]
) -> None:
    with pytest.raises(InputError, match=message):
        loaded(initial)
