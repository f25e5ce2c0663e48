"""Numbers with units: exact conversion, and what is refused."""

import math

import pytest

from bumpstop.errors import InputError
from bumpstop.io.units import Dimension, read_quantity

STIFFNESS = Dimension("a stiffness", "N/m", "18 kN/m")
LENGTH = Dimension("a length", "m", "14 mm")
TIME = Dimension("a time", "s", "10 us")
MASS = Dimension("a mass", "kg", "3 g")
ACCELERATION = Dimension("an acceleration", "m/s^2", "386 in/s^2")
RATE = Dimension("an angular rate", "rad/s", "3 rad/s")
PRESSURE = Dimension("a pressure", "Pa", "67 GPa")
NUMBER = Dimension("a pure number", "", "0.3")

INCH = 0.0254
POUND_FORCE = 0.45359237 * 9.80665


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("18 kN/m", STIFFNESS, 18e3),
        ("18kN/m", STIFFNESS, 18e3),
        ("  1.8e4  N/m ", STIFFNESS, 18e3),
        ("18 N/mm", STIFFNESS, 18e3),
        ("-0.783 m", LENGTH, -0.783),
        ("14 mm", LENGTH, 0.014),
        ("1 in", LENGTH, INCH),
        ("10 us", TIME, 1e-5),
        ("10 µs", TIME, 1e-5),
        ("20 ms", TIME, 0.02),
        ("67 GPa", PRESSURE, 67e9),
        ("67 kN/mm2", PRESSURE, 67e9),
        ("67 kN/mm^2", PRESSURE, 67e9),
        ("67 kN/mm**2", PRESSURE, 67e9),
        ("67 kN/mm²", PRESSURE, 67e9),
        ("67 kN·mm⁻²", PRESSURE, 67e9),
        ("67 kN mm^-2", PRESSURE, 67e9),
        ("30 rad/s", RATE, 30.0),
        ("-2 g_0", ACCELERATION, -2 * 9.80665),
        ("5 %", NUMBER, 0.05),
        ("0.05", NUMBER, 0.05),
    ],
)
def test_decimal_units_give_the_very_float_that_the_digits_mean(
    text: str, dimension: Dimension, value: float
) -> None:
    assert read_quantity(text, dimension) == value


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("0.5 lbf*s^2/in", MASS, 0.5 * POUND_FORCE / INCH),
        ("0.5 lbf s2/in", MASS, 0.5 * POUND_FORCE / INCH),
        ("1973.92 lbf/in", STIFFNESS, 1973.92 * POUND_FORCE / INCH),
        ("-386 in/s^2", ACCELERATION, -386 * INCH),
        ("30 degrees/s", RATE, math.pi / 6),
        ("30 deg/s", RATE, math.pi / 6),
        ("30 °/s", RATE, math.pi / 6),
        ("60 rpm", RATE, 2 * math.pi),
    ],
)
def test_other_units(text: str, dimension: Dimension, value: float) -> None:
    assert read_quantity(text, dimension) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "dimension", "says"),
    [
        ("18 kN/m2", STIFFNESS, "wrong unit: 'kN/m2' is a pressure, expected a stiffness like"),
        ("18 m", STIFFNESS, "wrong unit: 'm' is a length"),
        ("18 mm", TIME, "'mm' is a length, expected a time like 's'"),
        ("2 Hz", RATE, "'Hz' is a frequency, expected an angular rate like 'rad/s'"),
        ("20 degC", LENGTH, "'degC' is a temperature"),
        ("20 degC/m", LENGTH, "'degC/m' is something else"),
        ("18 bananas", STIFFNESS, "unknown unit 'bananas', expected a stiffness like '18 kN/m'"),
        ("18 N/m/", STIFFNESS, "unknown unit"),
        ("18 (N", STIFFNESS, "unknown unit"),
        ("18 N/m^(1)", STIFFNESS, "unknown unit"),
        ("18 9**9**9**9**9", STIFFNESS, "unknown unit"),
        ("18 m**99999", STIFFNESS, "unknown unit"),
        ("18 __import__('os')", STIFFNESS, "unknown unit"),
        ("18 2 N/m", STIFFNESS, "unknown unit '2 N/m'"),
        ("18 " + "a" * 50 + "!", STIFFNESS, "unknown unit"),
        ("18", STIFFNESS, "has no unit, expected a stiffness like '18 kN/m'"),
        ("", STIFFNESS, "is not a number with a unit"),
        ("N/m", STIFFNESS, "is not a number with a unit"),
        ("nan N/m", STIFFNESS, "is not a number with a unit"),
        ("inf N/m", STIFFNESS, "is not a number with a unit"),
        ("0x12 N/m", STIFFNESS, "unknown unit"),
        ("1" * 80 + " N/m", STIFFNESS, "is not a number with a unit"),
        ("1e999 N/m", STIFFNESS, "must be finite"),
        ("5 mm", NUMBER, "'mm' is a length, expected a pure number"),
    ],
)
def test_what_is_refused_says_why(text: str, dimension: Dimension, says: str) -> None:
    with pytest.raises(InputError) as refused:
        read_quantity(text, dimension)
    assert says in refused.value.what
    assert refused.value.value == text
