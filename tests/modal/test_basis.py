from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from bumpstop import Beam, Gauge, InputError, Material, ModalBasis, Rectangle, Structure

from ..hinged_beam import hinged_modes

MODES: dict[str, Any] = {
    "frequency": [0.0, 3.0, 7.5],
    "damping": [0.0, 0.01, 0.02],
    "shapes": {("P", "dx"): [1.0, 0.5, 0.4], ("P", "dy"): [0.0, 0.1, 0.2], ("Q", "dx"): [1, 2, 3]},
}


@pytest.fixture(scope="module")
def hinged() -> ModalBasis:
    return hinged_modes()


def test_modes_from_elsewhere() -> None:
    basis = ModalBasis.from_modes(**MODES)
    np.testing.assert_allclose(basis.omega2, (2 * np.pi * np.array([0, 3, 7.5])) ** 2)
    np.testing.assert_allclose(basis.frequencies, [0.0, 3.0, 7.5])
    np.testing.assert_allclose(basis.damping, [0.0, 0.02 * 2 * np.pi * 3, 0.04 * 2 * np.pi * 7.5])
    np.testing.assert_array_equal(basis.row("P", "dx"), [1.0, 0.5, 0.4])
    assert basis.dofs == (("P", "dx"), ("P", "dy"), ("Q", "dx"))
    assert basis.mass_rows is None
    assert basis.structure is None


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("frequency", []),
        ("frequency", [1.0, 2.0, math.nan]),
        ("frequency", [1.0, 2.0, -3.0]),
        ("frequency", "3 Hz"),
        ("damping", [0.01]),
        ("damping", -0.01),
        ("damping", math.inf),
        ("damping", "1 %"),
        ("damping", [0.01, 0.01, None]),
        ("shapes", {}),
        ("shapes", [1.0, 2.0, 3.0]),
        ("shapes", {"P": [1.0, 2.0, 3.0]}),
        ("shapes", {("P", "dx"): [1.0]}),
        ("shapes", {("P", "dx"): [1.0, 2.0, math.nan]}),
    ],
)
def test_bad_modes_are_refused(key: str, value: Any) -> None:
    with pytest.raises(InputError, match=rf"^{key}"):
        ModalBasis.from_modes(**{**MODES, key: value})


def test_an_unknown_dof_of_a_shape_is_refused() -> None:
    with pytest.raises(InputError, match=r"dof: unknown dof \(got 'rx'\); did you mean 'drx'"):
        ModalBasis.from_modes(**{**MODES, "shapes": {("P", "rx"): [1.0, 2.0, 3.0]}})


def test_what_a_basis_from_elsewhere_cannot_say() -> None:
    basis = ModalBasis.from_modes(**MODES)
    with pytest.raises(InputError, match=r"node: no mode shape at this node .*known: P, Q"):
        basis.row("R", "dx")
    with pytest.raises(InputError, match=r"dof: no mode shape for this dof .*known at 'P': dx, dy"):
        basis.row("P", "dz")
    with pytest.raises(InputError, match=r"dof: unknown dof .*did you mean 'dx'"):
        basis.row("P", "x")
    with pytest.raises(InputError, match="a gauge needs a basis computed from a structure"):
        basis.gauge_row(Gauge("g", beam="AB", at=0.0, fibre=(0.0, 0.0)))
    with pytest.raises(InputError, match="no mass matrix"):
        basis.project_field(np.zeros(3))


@pytest.mark.parametrize("modes", [0, -1, 2.0, "ten", True, None])
def test_bad_mode_counts_are_refused(hinged: ModalBasis, modes: Any) -> None:
    assert hinged.structure is not None
    with pytest.raises(InputError, match=r"^modes: "):
        ModalBasis.from_structure(hinged.structure, modes=modes)


def test_rows_of_nodes(hinged: ModalBasis) -> None:
    assert hinged.shapes.shape == (66, 10)
    number = hinged.dofs.index(("AB.3", "drz"))
    np.testing.assert_array_equal(hinged.row("AB.3", "drz"), hinged.shapes[number])
    np.testing.assert_array_equal(hinged.row("A", "dy"), np.zeros(10))
    np.testing.assert_array_equal(hinged.row("B", "dz"), np.zeros(10))
    with pytest.raises(InputError, match=r"did you mean 'AB.1'"):
        hinged.row("AB.11", "dy")


def test_rows_of_points(hinged: ModalBasis) -> None:
    rigid = hinged.row("AB@0.462", "dy")[0]
    assert rigid == pytest.approx(0.462 * hinged.row("A", "drz")[0], rel=1e-14)
    np.testing.assert_array_equal(hinged.row("AB@0.462 m", "dy"), hinged.row("AB@0.462", "dy"))
    near, far = hinged.row("AB.5", "dy"), hinged.row("AB.6", "dy")
    within = hinged.row("AB@0.43", "dy")[:3]
    assert np.all((within - near[:3]) * (within - far[:3]) < 0.0)


def test_a_rigid_mode_strains_no_gauge(hinged: ModalBasis) -> None:
    row = hinged.gauge_row(Gauge("g", beam="AB", at=0.462, fibre=(0.007, 0.0)))
    assert abs(row[0]) < 1e-15 * np.abs(row).max()
    assert np.all(np.abs(row[1:]) > 1e-2)


def test_projection_gives_back_what_the_modes_span(hinged: ModalBasis) -> None:
    coordinates = np.random.default_rng(5).normal(size=10)
    field = hinged.shapes @ coordinates
    np.testing.assert_allclose(hinged.project_field(field), coordinates, atol=1e-12)


def test_mass_rows_carry_the_whole_weight() -> None:
    """Uniform acceleration of a free beam excites its translations alone."""
    structure = Structure(
        nodes={"A": (0, 0, 0), "B": (0.4, 0.3, 0)},
        beams=[
            Beam(
                "AB",
                nodes=("A", "B"),
                elements=4,
                material=Material(young_modulus=67e9, poisson_ratio=0.3, density=2400.0),
                section=Rectangle(height=0.02, width=0.01),
            )
        ],
    )
    basis = ModalBasis.from_structure(structure, modes=14)
    weight = basis.project_field(structure.rigid_field(translation=(0.0, 0.0, -9.81)))
    total = 2400.0 * 0.02 * 0.01 * 0.5
    assert weight @ weight == pytest.approx(9.81**2 * total, rel=1e-12)
    assert np.abs(weight[6:]).max() < 1e-13 * np.abs(weight[:6]).max()


def test_what_is_printed_is_short(hinged: ModalBasis) -> None:
    assert "omega2" in repr(hinged)
    assert "shapes" not in repr(hinged)


def test_modal_masses_scale_the_shapes_and_keep_the_users_coordinates() -> None:
    basis = ModalBasis.from_modes(
        frequency=[3.0, 7.5], modal_mass=[4.0, 1.0], shapes={("P", "dx"): [2.0, 0.4]}
    )
    np.testing.assert_array_equal(basis.row("P", "dx"), [1.0, 0.4])
    amplitudes = np.array([0.3, -0.2])
    canonical = basis.canonical(amplitudes)
    assert basis.row("P", "dx") @ canonical == pytest.approx(2.0 * 0.3 - 0.4 * 0.2)
    np.testing.assert_allclose(basis.amplitudes(canonical), amplitudes)


@pytest.mark.parametrize(
    ("modal_mass", "message"),
    [(0.0, "must be positive"), ([1.0], "one for each of the 2"), (["a", "b"], "be a number")],
)
def test_impossible_modal_masses(modal_mass: Any, message: str) -> None:
    with pytest.raises(InputError, match=f"modal_mass: .*{message}"):
        ModalBasis.from_modes(
            frequency=[3.0, 7.5], modal_mass=modal_mass, shapes={("P", "dx"): [2.0, 0.4]}
        )
