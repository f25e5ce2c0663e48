"""Areas, moments and shear factors of sections against quadrature and published formulas."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from bumpstop import Circle, GeneralSection, InputError, Rectangle, Section, Tube

SHAPES: list[tuple[Section, float]] = [
    (Rectangle(height=0.06, width=0.04), 0.03),
    (Rectangle(height=0.06, width=0.04, thickness=0.005), 0.03),
    (Circle(radius=0.025), 0.025),
    (Tube(outer_radius=0.025, thickness=0.004), 0.025),
]


@pytest.mark.parametrize(("section", "reach"), SHAPES, ids=lambda value: type(value).__name__)
def test_area_and_moments_by_counting_fibres(section: Section, reach: float) -> None:
    """A grid of fibres, those that the section contains, each with the area of its cell."""
    count = 400
    places = ((np.arange(count) + 0.5) / count * 2 - 1) * reach
    cell = (2 * reach / count) ** 2
    fibres = np.array([(y, z) for y in places for z in places if section.contains(y, z)])
    assert len(fibres) * cell == pytest.approx(section.area, rel=1.5e-2)
    assert (fibres[:, 0] ** 2).sum() * cell == pytest.approx(section.inertia_z, rel=1.5e-2)
    assert (fibres[:, 1] ** 2).sum() * cell == pytest.approx(section.inertia_y, rel=1.5e-2)


def test_round_sections_twist_with_their_polar_moment() -> None:
    for section in (Circle(radius=0.02), Tube(outer_radius=0.02, thickness=0.005)):
        polar = section.inertia_y + section.inertia_z
        assert section.torsion_constant == pytest.approx(polar, rel=1e-15)


def test_a_square_tube_twists_by_bredt() -> None:
    """Side a along the middle of the wall: J = t a3."""
    box = Rectangle(height=0.05, width=0.05, thickness=0.002)
    assert box.torsion_constant == pytest.approx(0.002 * 0.048**3, rel=1e-14)


def test_cowper_shear_factors() -> None:
    """Values from the formulas of Cowper (1966) at nu = 0.3, worked out by hand."""
    assert Rectangle(height=2, width=1).cowper(0.3).shear_factors[0] == pytest.approx(13 / 15.3)
    assert Circle(radius=1).cowper(0.3).shear_factors[0] == pytest.approx(7.8 / 8.8)
    thin = Tube(outer_radius=1, thickness=1e-9).cowper(0.3)
    assert thin.shear_factors[1] == pytest.approx(2 * 1.3 / (4 + 3 * 0.3), rel=1e-8)
    solid = Tube(outer_radius=1, thickness=1 - 1e-9)
    assert solid.shear_factors == pytest.approx(Circle(radius=1).shear_factors)


@pytest.mark.parametrize(("height", "width"), [(1.0, 1.0), (2.0, 1.0), (0.5, 2.0)])
def test_the_shear_factor_of_a_box_by_the_energy_of_its_shear_flow(
    height: float, width: float
) -> None:
    """At nu = 0 it is I2 / (A times the integral of Q2 / t): thin walls, shear along y."""
    wall = 1e-3
    a, b = height - wall, width - wall
    inertia = 2 * wall * (b * (a / 2) ** 2 + a**3 / 12)
    flange, web = np.linspace(0, b / 2, 20001), np.linspace(0, a / 2, 20001)
    energy = 4 * wall * np.trapezoid((flange * a / 2) ** 2, flange)
    energy += 4 * wall * np.trapezoid((b / 2 * a / 2 + ((a / 2) ** 2 - web**2) / 2) ** 2, web)
    expected = inertia**2 / (2 * wall * (a + b) * energy)
    factor, _ = Rectangle(height=height, width=width, thickness=wall).shear_factors
    assert factor == pytest.approx(expected, rel=1e-6)


def test_between_two_sections() -> None:
    first, last = Tube(outer_radius=0.02, thickness=0.004), Tube(outer_radius=0.04, thickness=0.002)
    middle = first.between(last, 0.5)
    assert (middle.outer_radius, middle.thickness) == pytest.approx((0.03, 0.003))
    assert first.between(last, 0.0) == first
    assert first.between(last, 1.0) == last


def test_general_sections_scale_as_similar_figures() -> None:
    def numbers(side: float) -> GeneralSection:
        square = Rectangle(height=side, width=side)
        return GeneralSection(
            area=square.area,
            inertia_y=square.inertia_y,
            inertia_z=square.inertia_z,
            torsion_constant=square.torsion_constant,
        )

    middle, expected = numbers(1.0).between(numbers(3.0), 0.5), numbers(2.0)
    for key in ("area", "inertia_y", "inertia_z", "torsion_constant"):
        assert getattr(middle, key) == pytest.approx(getattr(expected, key), rel=1e-14)


def test_a_general_section_knows_its_extent_if_told() -> None:
    numbers: dict[str, Any] = {
        "area": 1.0,
        "inertia_y": 1.0,
        "inertia_z": 1.0,
        "torsion_constant": 1.0,
    }
    assert GeneralSection(**numbers).contains(7.0, -9.0)
    told = GeneralSection(**numbers, extent_y=(-0.1, 0.3))
    assert told.contains(0.3, 5.0)
    assert not told.contains(-0.11, 0.0)


RECTANGLE: dict[str, Any] = {"height": 0.06, "width": 0.04}
TUBE: dict[str, Any] = {"outer_radius": 0.02, "thickness": 0.002}
GENERAL: dict[str, Any] = {"area": 1.0, "inertia_y": 1.0, "inertia_z": 1.0, "torsion_constant": 1.0}
BAD: list[tuple[Any, dict[str, Any], str]] = [
    (Rectangle, {**RECTANGLE, "thickness": 0.02}, "thickness: the walls fill the section"),
    (Rectangle, {**RECTANGLE, "thickness": -0.02}, "thickness: must be positive"),
    (Rectangle, {**RECTANGLE, "thickness": 0.0}, "thickness: must be positive"),
    (Circle, {"radius": 0.0}, "radius: must be positive"),
    (Circle, {"radius": 1.0, "shear_factors": (1.0, -1.0)}, "shear_factors: must be positive"),
    (Tube, {**TUBE, "thickness": 0.02}, "thickness: the wall fills the tube"),
    (Tube, {**TUBE, "outer_radius": math.nan}, "outer_radius: must be finite"),
    (GeneralSection, {**GENERAL, "area": -1.0}, "area: must be positive"),
    (GeneralSection, {**GENERAL, "inertia_y": 0.0}, "inertia_y: must be positive"),
    (GeneralSection, {**GENERAL, "shear_center": 0.1}, "shear_center: must be a list of 2"),
    (GeneralSection, {**GENERAL, "extent_z": (0.1, 0.3)}, "extent_z: must be a negative and"),
]


@pytest.mark.parametrize(("shape", "said", "message"), BAD)
def test_bad_sections_are_refused(shape: Any, said: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=f"^{message}"):
        shape(**said)


def test_only_sections_of_one_shape_have_others_in_between() -> None:
    with pytest.raises(InputError, match="end_section: the sections at the two ends must have"):
        Circle(radius=1.0).between(Tube(**TUBE), 0.5)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="end_section: the sections at the two ends must have"):
        Rectangle(**RECTANGLE).between(Rectangle(**RECTANGLE, thickness=0.001), 0.5)
