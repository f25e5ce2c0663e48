from __future__ import annotations

import math
from typing import Any

import pytest

from bumpstop import InputError, Material, Rectangle

STEEL = {"young_modulus": 210e9, "poisson_ratio": 0.3, "density": 7800.0}


def test_shear_modulus() -> None:
    assert Material(**STEEL).shear_modulus == pytest.approx(210e9 / 2.6, rel=1e-15)


@pytest.mark.parametrize("key", list(STEEL))
@pytest.mark.parametrize("value", [math.nan, math.inf, -2.0, "67 GPa", None, True, [1.0]])
def test_a_material_refuses_bad_values(key: str, value: Any) -> None:
    with pytest.raises(InputError, match=key):
        Material(**{**STEEL, key: value})


@pytest.mark.parametrize(
    ("ratio", "good"), [(-1.0, False), (-0.99, True), (0.5, True), (0.51, False)]
)
def test_bounds_of_poisson_ratio(ratio: float, good: bool) -> None:
    if good:
        assert Material(**{**STEEL, "poisson_ratio": ratio}).shear_modulus > 0.0
    else:
        with pytest.raises(InputError, match="poisson_ratio"):
            Material(**{**STEEL, "poisson_ratio": ratio})


@pytest.mark.parametrize("key", ["height", "width"])
@pytest.mark.parametrize("value", [0.0, -0.01, math.nan, math.inf, "14 mm"])
def test_a_rectangle_refuses_bad_sides(key: str, value: Any) -> None:
    with pytest.raises(InputError, match=key):
        Rectangle(**{"height": 0.01, "width": 0.01, key: value})


@pytest.mark.parametrize("factors", [(0.0, 1.0), (1.0,), "ab", 0.8])
def test_a_rectangle_refuses_bad_shear_factors(factors: Any) -> None:
    with pytest.raises(InputError, match="shear_factors"):
        Rectangle(height=0.01, width=0.01, shear_factors=factors)


def test_height_is_along_y() -> None:
    tall = Rectangle(height=0.03, width=0.01)
    assert tall.inertia_z == pytest.approx(0.01 * 0.03**3 / 12.0, rel=1e-14)
    assert tall.inertia_y == pytest.approx(0.03 * 0.01**3 / 12.0, rel=1e-14)
    assert tall.contains(0.015, 0.005)
    assert not tall.contains(0.005, 0.0051)


# Factors of a b^3 from the table in Timoshenko & Goodier, section 109.
@pytest.mark.parametrize(
    ("aspect", "factor"), [(1.0, 0.1406), (1.5, 0.196), (2.0, 0.229), (4.0, 0.281), (10.0, 0.312)]
)
@pytest.mark.parametrize("tall", [True, False])
def test_torsion_constant_of_a_rectangle(aspect: float, factor: float, tall: bool) -> None:
    sides = (aspect, 1.0) if tall else (1.0, aspect)
    section = Rectangle(height=sides[0], width=sides[1])
    assert section.torsion_constant / aspect == pytest.approx(factor, abs=6e-4)


@pytest.mark.parametrize("aspect", [1.0, 1.3, 7.0])
def test_torsion_constant_against_the_plain_series(aspect: float) -> None:
    import mpmath as mp

    long, short = mp.mpf(aspect), mp.mpf(1)
    total = mp.nsum(
        lambda i: mp.tanh((2 * i + 1) * mp.pi * long / 2) / (2 * i + 1) ** 5, [0, mp.inf]
    )
    exact = long * short**3 * (mp.mpf(1) / 3 - 64 / mp.pi**5 / long * total)
    computed = Rectangle(height=aspect, width=1.0).torsion_constant
    assert computed == pytest.approx(float(exact), rel=2e-15)


def test_a_thin_strip_twists_as_a_third() -> None:
    strip = Rectangle(height=1.0, width=1e-4)
    assert strip.torsion_constant == pytest.approx(1e-12 / 3.0, rel=1e-4)
