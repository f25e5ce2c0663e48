"""Numbers with units, read into SI.

Conversions are made with rational numbers, so ``"10 us"`` is the float ``1e-5`` itself and a
case written with units gives the same bits as one written in SI numbers. pint is loaded when
the first unit is met, since most case files have none.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from bumpstop.errors import InputError

if TYPE_CHECKING:
    from fractions import Fraction

    from pint import Unit, UnitRegistry

__all__ = [
    "WRONG_UNIT",
    "Dimension",
    "asked_unit",
    "read_number_of_any_unit",
    "read_quantity",
    "si_factor",
]

# Compiled by the functions that use them, since most case files have no unit.
_NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?"
_NUMBER_AND_UNIT = rf"\s*({_NUMBER})\s*(.*?)\s*"
# Names, joined by * / · and spaces, with small exponents: nothing that pint could compute with.
_UNIT = r"(?:1\s*/|(?:_[0-9]|[^\W\d])++(?:(?:\^|\*\*)?-?[0-9]\b)?[⁻¹²³⁴]*+|[%°]|[*/·()\s])++"
_BARE_EXPONENT = r"(?<=[^\W\d_])(-?[0-9])\b"
_LONGEST = 60
WRONG_UNIT = "wrong unit"
"""What messages begin with where a unit measures something else."""


@dataclass(frozen=True, slots=True)
class Dimension:
    """A kind of physical quantity.

    Parameters
    ----------
    name
        With its article, as messages say it: ``"a stiffness"``.
    unit
        The SI unit in which numbers of this kind are held.
    example
        A value as a user may write it.
    """

    name: str
    unit: str
    example: str


def read_quantity(text: str, dimension: Dimension) -> float:
    """Return the SI value of a number written with its unit.

    Parameters
    ----------
    text
        ``"18 kN/m"``: a number, then a unit that pint knows.
    dimension
        What the number must measure.

    Raises
    ------
    InputError
        If the text is not a number with a unit, or the unit measures something else.

    Examples
    --------
    >>> stiffness = Dimension("a stiffness", "N/m", "18 kN/m")
    >>> read_quantity("18 kN/m", stiffness)
    18000.0
    >>> read_quantity("18 kN/m2", stiffness)
    Traceback (most recent call last):
    bumpstop.errors.InputError: wrong unit: 'kN/m2' is a pressure, expected a stiffness like 'N/m' \
(got '18 kN/m2')
    """
    from fractions import Fraction

    match = re.fullmatch(_NUMBER_AND_UNIT, text) if len(text) <= _LONGEST else None
    if match is None:
        raise _refused(text, "is not a number with a unit", dimension)
    number, unit = match.groups()
    if not unit and dimension.unit:
        what = f"has no unit, expected {dimension.name} like {dimension.example!r}"
        raise InputError(what, value=text, hint=_PLAIN.format(dimension.unit))
    return _in_range(text, Fraction(number) * _factor(text, unit, dimension))


_PLAIN = "numbers in {} go without quotes"
"""Hint where a unit is missing, with the unit that numbers are held in."""


def asked_unit(error: InputError) -> str | None:
    """Return the SI unit of a quantity from what is said of a text that has none.

    Examples
    --------
    >>> try:
    ...     read_quantity("18", Dimension("a stiffness", "N/m", "18 kN/m"))
    ... except InputError as error:
    ...     print(asked_unit(error))
    N/m
    """
    found = re.search(_PLAIN.format("(.+?)"), error.hint or "")
    return found and found.group(1)


def si_factor(unit: str, dimension: Dimension | None = None) -> float:
    """Return what a number in a unit is multiplied by to be in SI units.

    Parameters
    ----------
    unit
        ``"kN"``: a unit that pint knows.
    dimension
        What it must measure; anything where left out.

    Raises
    ------
    InputError
        If the unit is unknown, or measures something else.

    Examples
    --------
    >>> si_factor("kN"), si_factor("mm/s^2")
    (1000.0, 0.001)
    """
    if dimension is not None:
        return _in_range(unit, _factor(unit, unit, dimension))
    return _in_range(unit, _base_factor(unit))


def read_number_of_any_unit(text: str) -> float:
    """Return the SI value of a number written with a unit, whatever it measures.

    Raises
    ------
    InputError
        If the text is not a number with a unit that is known.

    Examples
    --------
    >>> read_number_of_any_unit("18 kN/m"), read_number_of_any_unit("20 us")
    (18000.0, 2e-05)
    """
    from fractions import Fraction

    match = re.fullmatch(_NUMBER_AND_UNIT, text) if len(text) <= _LONGEST else None
    if match is None or not match[2]:
        raise InputError("is not a number with a unit", value=text, hint="such as '18 kN/m'")
    return _in_range(text, Fraction(match[1]) * _base_factor(match[2]))


def _base_factor(unit: str) -> Fraction:
    from fractions import Fraction

    try:
        return Fraction(_registry().Quantity(Fraction(1), _parsed(unit)).to_base_units().m)
    except Exception as error:  # as below
        raise InputError("unknown unit", value=unit, hint="such as 'kN' or 'mm/s^2'") from error


def _in_range(text: str, exact: Fraction) -> float:
    try:
        return float(exact)
    except OverflowError:
        raise InputError("must be finite", value=text) from None


def _factor(text: str, unit: str, dimension: Dimension) -> Fraction:
    from fractions import Fraction

    registry = _registry()
    try:
        found = _parsed(unit)
    except Exception as error:  # pint lets errors of tokenize, asserts and TypeErrors through
        raise _refused(text, f"unknown unit {unit!r}", dimension) from error
    if found.dimensionality != registry.parse_units(dimension.unit).dimensionality:
        raise _wrong_unit(text, unit, _what_it_measures(found.dimensionality), dimension)
    one = registry.Quantity(Fraction(1), found)
    if dimension.unit.startswith("rad") and any("hertz" in name for name, _ in one.unit_items()):
        # pint takes 1 Hz as 1/s, which would be wrong by 2 pi.
        raise _wrong_unit(text, unit, "a frequency", dimension)
    return Fraction(one.to(dimension.unit).magnitude)


def _parsed(unit: str) -> Unit:
    """Return a unit as pint knows it."""
    if unit and not re.fullmatch(_UNIT, unit):
        raise ValueError(unit)
    # "m2" is how people write square metres, but a name to pint.
    return _registry().parse_units(re.sub(_BARE_EXPONENT, r"**\1", unit))


def _refused(text: str, what: str, dimension: Dimension) -> InputError:
    expected = f"{what}, expected {dimension.name} like {dimension.example!r}"
    return InputError(expected, value=text)


def _wrong_unit(text: str, unit: str, found: str, dimension: Dimension) -> InputError:
    like = f" like {dimension.unit!r}" if dimension.unit else ""
    return InputError(
        f"{WRONG_UNIT}: {unit!r} is {found}, expected {dimension.name}{like}", value=text
    )


@lru_cache(maxsize=1)
def _registry() -> UnitRegistry[Fraction]:
    from fractions import Fraction

    from pint import UnitRegistry

    return UnitRegistry(non_int_type=Fraction)


_NAMED = {
    "m": "a length",
    "m^2": "an area",
    "m^3": "a volume",
    "m^4": "a second moment of area",
    "s": "a time",
    "1/s": "a rate or frequency",
    "kg": "a mass",
    "kg/m": "a mass per length",
    "kg/m^3": "a density",
    "kg m^2": "a moment of inertia",
    "m/s": "a velocity",
    "m/s^2": "an acceleration",
    "1/s^2": "an angular acceleration",
    "N": "a force",
    "N/m": "a stiffness",
    "N s/m": "a damping constant",
    "N s": "an impulse",
    "N/m^2": "a pressure",
    "N m": "an energy or moment",
    "W": "a power",
    "K": "a temperature",
    "A": "an electric current",
    "V": "a voltage",
    "": "a pure number or angle",
}


def _what_it_measures(dimensionality: object) -> str:
    registry = _registry()
    for unit, name in _NAMED.items():
        if registry.parse_units(unit).dimensionality == dimensionality:
            return name
    return "something else"
