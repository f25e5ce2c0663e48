"""Numbers for people: the SI prefix that fits, significant digits, a true minus sign."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["Scale", "percent", "power_of_ten", "scale_for", "significant", "with_unit"]

_PREFIXES = {4: "T", 3: "G", 2: "M", 1: "k", 0: "", -1: "m", -2: "µ", -3: "n", -4: "p"}
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Scale:
    """How a quantity is shown: multiply its SI value by ``factor`` to get it in ``unit``."""

    factor: float
    unit: str

    def show(self, value: float, digits: int = 4) -> str:
        """Return an SI value in this unit, without the unit.

        Examples
        --------
        >>> Scale(1e3, "mm").show(-0.00266300)
        '−2.663'
        """
        return significant(value * self.factor, digits)


def scale_for(unit: str, values: ArrayLike) -> Scale:
    """Choose the prefix that brings the largest magnitude between 1 and 1000.

    Parameters
    ----------
    unit
        An SI unit that takes a prefix in front, or ``"strain"`` (shown in microstrain).
    values
        Numbers in that unit; those that are not finite do not count.

    Examples
    --------
    >>> scale_for("m", [1e-3, -4.9e-3])
    Scale(factor=1000.0, unit='mm')
    >>> scale_for("N/m", 18e3).unit
    'kN/m'
    """
    if unit == "strain":
        return Scale(1e6, "µε")
    magnitudes = np.abs(np.atleast_1d(np.asarray(values, dtype=float)))
    magnitudes = magnitudes[np.isfinite(magnitudes)]
    largest = float(magnitudes.max()) if magnitudes.size else 0.0
    if largest == 0.0:
        return Scale(1.0, unit)
    # One part in 1e9 of slack, so that 0.001 m is 1 mm and not 1000 µm.
    group = math.floor(math.log10(largest * (1.0 + 1e-9)) / 3.0)
    if group not in _PREFIXES:
        return Scale(1.0, unit)
    return Scale(float(f"1e{-3 * group}"), _PREFIXES[group] + unit)


def with_unit(value: float, unit: str, digits: int = 4) -> str:
    """Return a number with the prefix that suits it.

    Examples
    --------
    >>> with_unit(0.783, "m")
    '783 mm'
    >>> with_unit(18e3, "N/m")
    '18 kN/m'
    """
    scale = scale_for(unit, value)
    shown = significant(value * scale.factor, digits, zeros=False)
    return f"{shown} {scale.unit}" if scale.unit else shown


def significant(value: float, digits: int = 4, *, zeros: bool = True) -> str:
    """Return a number to so many significant digits, in powers of ten where it is extreme.

    Examples
    --------
    >>> significant(2.5), significant(2.5, zeros=False), significant(-3.1e-14, 2)
    ('2.500', '2.5', '−3.1 × 10⁻¹⁴')
    >>> significant(2.5e7, 6, zeros=False), significant(1e7, 6, zeros=False)
    ('2.5 × 10⁷', '10⁷')
    """
    if not math.isfinite(value):
        return "–" if math.isnan(value) else ("∞" if value > 0 else "−∞")
    if value == 0.0:
        return "0"
    exponent = int(f"{value:.{digits - 1}e}".split("e")[1])
    if not -4 <= exponent < max(digits, 6):
        return power_of_ten(value, digits, zeros=zeros)
    text = f"{value:.{max(digits - 1 - exponent, 0)}f}"
    if not zeros and "." in text:
        text = text.rstrip("0").rstrip(".")
    return text.replace("-", "−")


def power_of_ten(value: float, digits: int = 2, *, zeros: bool = True) -> str:
    """Return a number as mantissa and power of ten; without zeros at its end if so wished.

    Examples
    --------
    >>> power_of_ten(3.14e-15)
    '3.1 × 10⁻¹⁵'
    """
    if value == 0.0 or not math.isfinite(value):
        return significant(value)
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    power = f"10{str(int(exponent)).translate(_SUPERSCRIPTS)}"
    if not zeros and "." in mantissa:
        mantissa = mantissa.rstrip("0").rstrip(".")
        if mantissa == "1":
            return power
    return f"{mantissa.replace('-', '−')} × {power}"


def percent(fraction: float, decimals: int = 2, *, sign: bool = False) -> str:
    """Return a fraction in percent.

    Examples
    --------
    >>> percent(-0.0066), percent(0.01, 1, sign=True)
    ('−0.66 %', '+1.0 %')
    """
    if math.isnan(fraction):
        return "–"
    text = f"{fraction * 100:{'+' if sign else ''}.{decimals}f}"
    if float(text) == 0.0:
        text = text.lstrip("+-")
    return f"{text} %".replace("-", "−")
