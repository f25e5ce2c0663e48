"""Numbers as people read them say what the numbers are."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bumpstop.report.scales import percent, power_of_ten, scale_for, significant, with_unit

numbers = st.floats(1e-12, 1e12) | st.floats(-1e12, -1e-12)


def read(text: str) -> float:
    """Read a number as this module writes it."""
    mantissa, _, power = text.replace("−", "-").partition(" × 10")
    plain = power.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    return float(mantissa) * 10.0 ** int(plain or 0)


@given(value=numbers, digits=st.integers(2, 7))
def test_a_number_reads_back_to_its_digits(value: float, digits: int) -> None:
    assert read(significant(value, digits)) == pytest.approx(value, rel=0.51 * 10.0 ** (1 - digits))


@given(value=numbers)
def test_a_prefix_brings_the_number_between_1_and_1000(value: float) -> None:
    scale = scale_for("m", [0.0, value, value / 3.0])
    assert 0.999999 <= abs(value) * scale.factor < 1000.0


@pytest.mark.parametrize(
    ("value", "unit", "told"),
    [
        (1e-3, "m", "1 mm"),
        (0.9999e-3, "m", "999.9 µm"),
        (-18e3, "N/m", "−18 kN/m"),
        (67e9, "Pa", "67 GPa"),
        (0.0, "s", "0 s"),
        (1e-5, "s", "10 µs"),
        (703.8e-6, "strain", "703.8 µε"),
        (math.nan, "N", "– N"),
    ],
)
def test_units(value: float, unit: str, told: str) -> None:
    assert with_unit(value, unit) == told


def test_no_prefix_for_what_is_out_of_all_bounds() -> None:
    assert scale_for("m", 1e30).unit == "m"
    assert scale_for("m", [math.inf, math.nan]).unit == "m"


def test_a_vanishing_percentage_has_no_sign() -> None:
    assert percent(-1e-9, sign=True) == "0.00 %"
    assert percent(-0.0089, sign=True) == "−0.89 %"
    assert percent(math.nan) == "–"


def test_powers_of_ten() -> None:
    assert power_of_ten(3.4e-15) == "3.4 × 10⁻¹⁵"
    assert power_of_ten(0.0) == "0"
