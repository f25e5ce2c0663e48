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
    _, velocity = RigidTranslation((2, 5, 0), **moving).modal_state(two_bars)
    places = ["A", "AB.1", "AB.2", "B", "C", "CD.1", "CD.2"]
    found = [two_bars.row(place, "dx") @ velocity for place in places]
    np.testing.assert_allclose(found, expected, atol=1e-11)


def test_the_whole_moves_where_nothing_is_named(two_bars: ModalBasis) -> None:
    """D is held, so that the bar that ends there follows as well as the masses let it."""
    _, all_of_it = RigidTranslation((2, 0, 0)).modal_state(two_bars)
    _, both = RigidTranslation((2, 0, 0), beams=["AB", "CD"]).modal_state(two_bars)
    assert all_of_it.tolist() == both.tolist()
    assert two_bars.row("A", "dx") @ all_of_it == pytest.approx(2.0, rel=1e-11)
    assert two_bars.row("D", "dx") @ all_of_it == 0.0


def test_what_cannot_move_is_refused(two_bars: ModalBasis) -> None:
    with pytest.raises(InputError, match="no mode takes part in this translation"):
        RigidTranslation((0, 1, 0)).modal_state(two_bars)


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
    with pytest.raises(InputError, match="needs a structure to move"):
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
