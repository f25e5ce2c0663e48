"""Forces spread along beams, against closed forms of cantilevers."""

from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.modal.static_shapes import StaticShapes

LENGTH, HEIGHT, WIDTH = 1.2, 0.03, 0.02
STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.25, density=7800.0)
BAR = bs.Rectangle(height=HEIGHT, width=WIDTH)
CLAMP = bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))
BENDING = 210e9 * WIDTH * HEIGHT**3 / 12  # about z: deflection along y
SHEAR = 84e9 * 5 / 6 * HEIGHT * WIDTH


def cantilever(end: tuple[float, float, float] = (LENGTH, 0, 0), **options: Any) -> bs.Structure:
    beam = bs.Beam("AB", nodes=("A", "B"), material=STEEL, section=BAR, **{"elements": 3} | options)
    return bs.Structure(nodes={"A": (0, 0, 0), "B": end}, beams=[beam], supports=[CLAMP])


def deflection(model: bs.Structure, load: bs.LineForce, node: str = "B") -> np.ndarray:
    """Static displacement of a node along X, Y, Z."""
    field = StaticShapes(model).under(load.nodal_forces(model))[:, 0]
    forms = [model.displacement_form(node, dof) for dof in ("dx", "dy", "dz")]
    return np.array([form.of(field) for form in forms])


@pytest.mark.parametrize("elements", [1, 4])
def test_uniform(elements: int) -> None:
    load = bs.LineForce("w", beam="AB", force=(7.0, -100.0, 0))
    x, y, z = deflection(cantilever(elements=elements), load)
    assert y == pytest.approx(-100 * (LENGTH**4 / (8 * BENDING) + LENGTH**2 / (2 * SHEAR)))
    assert x == pytest.approx(7.0 * LENGTH**2 / (2 * 210e9 * HEIGHT * WIDTH))
    assert z == pytest.approx(0.0, abs=1e-18)


def test_triangular() -> None:
    """Highest at the clamp, and highest at the tip."""
    down = bs.LineForce("w", beam="AB", force=(0, 90.0, 0), end_force=(0, 0, 0))
    bent, sheared = LENGTH**4 / BENDING, LENGTH**2 / SHEAR
    assert deflection(cantilever(), down)[1] == pytest.approx(90 * (bent / 30 + sheared / 6))
    up = bs.LineForce("w", beam="AB", force=(0, 0, 0), end_force=(0, 90.0, 0))
    expected = 90 * (bent * 11 / 120 + sheared / 3)
    assert deflection(cantilever(), up)[1] == pytest.approx(expected)


@pytest.mark.parametrize("elements", [1, 2, 5])
def test_a_part_of_the_length(elements: int) -> None:
    """From 0.2 m to 0.7 m: the sum of the deflections under point forces."""
    load = bs.LineForce(
        "w", beam="AB", force=(0, 50.0, 0), end_force=(0, 80.0, 0), start=0.2, end=0.7
    )
    nodes, weights = np.polynomial.legendre.leggauss(5)
    at = 0.45 + 0.25 * nodes
    size = 0.25 * weights * (50.0 + 30.0 * (at - 0.2) / 0.5)
    each = at**2 * (3 * LENGTH - at) / (6 * BENDING) + at / SHEAR
    found = deflection(cantilever(elements=elements), load)[1]
    assert found == pytest.approx(size @ each, rel=1e-10)


def test_local_axes_turn_with_the_beam() -> None:
    place = LENGTH * np.array([0.36, 0.48, 0.8])
    model = cantilever((place[0], place[1], place[2]), roll=0.4)
    local = bs.LineForce("w", beam="AB", force=(3.0, -100.0, 20.0), axes="local")
    straight = bs.LineForce("w", beam="AB", force=(3.0, -100.0, 20.0))
    turned = model.beam_axes("AB") @ deflection(model, local)
    np.testing.assert_allclose(turned, deflection(cantilever(), straight), rtol=1e-9)


def test_a_tapered_beam_takes_the_whole_force() -> None:
    model = cantilever(end_section=bs.Rectangle(height=0.01, width=0.01))
    load = bs.LineForce("w", beam="AB", force=(0, 50.0, 0))
    field = load.nodal_force(model)
    along, about = (model.rigid_field(**{kind: axis}) for kind, axis in RIGID)
    assert field @ along == pytest.approx(50 * LENGTH)
    assert field @ about == pytest.approx(50 * LENGTH**2 / 2)


RIGID: list[tuple[str, Any]] = [("translation", (0, 1.0, 0)), ("rotation", (0, 0, 1.0))]


def test_modes_of_a_part_feel_it() -> None:
    """Two reduced bays in place of the beam: the same whole force and moment."""
    bay = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH / 2, 0, 0)},
        beams=[bs.Beam("AB", nodes=("A", "B"), elements=2, material=STEEL, section=BAR)],
    )
    part = bs.craig_bampton(bs.Component(bay, interface=["A", "B"]), modes="all")
    half_turn = bs.Rotation(axis=(0, 0, 1), angle=np.pi)
    bays = bs.Assembly(
        parts={
            "left": bs.Placed(part),
            "right": bs.Placed(part, at=(LENGTH, 0, 0), rotation=half_turn),
        },
        joints=[("left.B", "right.B")],
        supports=[bs.Support(nodes="left.A", fixed=CLAMP.fixed)],
    )
    loads = [
        bs.LineForce(bay, beam=f"{bay}.AB", force=(0, sign * 50.0, 0), axes="local")
        for bay, sign in (("left", 1.0), ("right", -1.0))
    ]
    basis = bs.ModalBasis.from_structure(bays, modes="all")
    force = sum(load.modal_force(basis) for load in loads)
    tip = basis.row("right.A", "dy") @ (force / basis.omega2)
    expected = 50 * (LENGTH**4 / (8 * BENDING) + LENGTH**2 / (2 * SHEAR))
    assert tip == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("options", "key", "what"),
    [
        ({"beam": "AX"}, "beam", "unknown beam.*known: AB"),
        ({"end": 2.0}, "end", "on the beam, which is 1.2 m long"),
        ({"start": 0.5, "end": 0.4}, "end", "beyond the start"),
        ({"start": 1.3}, "start", "on the beam"),
        ({"force": (1.0,)}, "force", "3 numbers"),
        ({"axes": "own"}, "axes", "known: global, local"),
    ],
)
def test_mistakes_are_one_line(options: dict[str, Any], key: str, what: str) -> None:
    said: dict[str, Any] = {"beam": "AB", "force": (0, 1.0, 0)} | options
    with pytest.raises(bs.InputError, match=what) as caught:
        bs.LineForce("w", **said).nodal_force(cantilever())
    assert caught.value.key == key


def test_modes_from_elsewhere_have_no_beams() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    with pytest.raises(bs.InputError, match="the basis has no beams"):
        bs.LineForce("w", beam="AB", force=(0, 1, 0)).modal_force(basis)


@pytest.mark.parametrize(
    "load",
    [
        bs.LineForce("w", beam="AB", force=(0, 30.0, 5.0), start=0.3),
        bs.NodalForce("p", node="AB@0.5", force=(0, 9.0, 0), moment=(0, 2.0, 0)),
        bs.Gravity("g", acceleration=(0, -9.81, 1.0)),
        bs.BaseMotion(acceleration=(0, 2.0, 0), name="b"),
    ],
)
def test_a_load_may_bring_its_static_shape(load: Any) -> None:
    """With it two modes give way to the load as the whole structure does."""
    model = cantilever()
    basis = bs.ModalBasis.from_structure(model, modes=2, load_shapes=[load])
    plain = bs.ModalBasis.from_structure(model, modes=2)
    whole = StaticShapes(model).under(load.nodal_forces(model))[:, 0]
    static = basis.shapes @ (load.modal_force(basis) / basis.omega2)
    size = np.abs(whole).max()
    np.testing.assert_allclose(static, whole, atol=1e-10 * size)
    truncated = plain.shapes @ (load.modal_force(plain) / plain.omega2)
    assert np.abs(truncated - whole).max() > 1e-4 * size
    assert basis.labels[-1] == f"static shape of load {load.name}"
