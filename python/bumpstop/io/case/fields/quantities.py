"""Physical quantities: SI numbers, or strings with a unit. Also pure numbers and counts."""

from __future__ import annotations

import math
from typing import Annotated, Any

from bumpstop.errors import InputError
from bumpstop.io.case.fields.plain import Plain, read_list
from bumpstop.io.units import Dimension, read_quantity

__all__ = [
    "WITH_UNIT",
    "Acceleration3",
    "Angle",
    "AngularRate",
    "AngularRate3",
    "Area",
    "AreaMoment",
    "DampingConstant",
    "Density",
    "Directions",
    "Force",
    "Force3",
    "Frequencies",
    "Frequency",
    "Frequency2",
    "InverseSpeed",
    "Length",
    "Length2",
    "Length3",
    "LineForce3",
    "LineMass",
    "Mass",
    "Moment3",
    "Number",
    "Number3",
    "Numbers",
    "PoissonRatio",
    "PositiveLength",
    "PositiveNumber",
    "PositiveTime",
    "Pressure",
    "Ratio",
    "Stiffness",
    "Time",
    "Times",
    "Velocity",
    "Velocity3",
    "Written",
    "WrittenList",
    "read_number",
    "read_time",
]

_WITHOUT_UNIT = r"^\s*[-+]?(\d+\.?\d*|\.\d+)"
WITH_UNIT = _WITHOUT_UNIT + r"(?![eE][-+]?\d+\s*$)([eE][-+]?\d+)?\s*[^\d\s.]"
"""How a number begins, and one that a unit follows, for editors; `read_quantity` knows the rest."""

_NUMBER = Dimension("a pure number", "", "0.3")
_LENGTH = Dimension("a length", "m", "14 mm")
_PRESSURE = Dimension("a pressure", "Pa", "67 GPa")
_DENSITY = Dimension("a density", "kg/m^3", "7.85 g/cm^3")
_AREA = Dimension("an area", "m^2", "4.5 cm^2")
_AREA_MOMENT = Dimension("a second moment of area", "m^4", "120 cm^4")
_LINE_MASS = Dimension("a mass a length", "kg/m", "1.2 kg/m")
_MASS = Dimension("a mass", "kg", "300 g")
_STIFFNESS = Dimension("a stiffness", "N/m", "18 kN/m")
_DAMPING = Dimension("a damping constant", "N*s/m", "20 N*s/m")
_ACCELERATION = Dimension("an acceleration", "m/s^2", "386 in/s^2")
_VELOCITY = Dimension("a velocity", "m/s", "10 in/s")
_INVERSE_SPEED = Dimension("a time a length", "s/m", "0.2 s/m")
_ANGLE = Dimension("an angle", "rad", "90 deg")
_ANGULAR_RATE = Dimension("an angular rate", "rad/s", "30 deg/s")
_TIME = Dimension("a time", "s", "20 ms")
_FREQUENCY = Dimension("a frequency", "Hz", "10 Hz")
_FORCE = Dimension("a force", "N", "5 kN")
_LINE_FORCE = Dimension("a force per length", "N/m", "2 kN/m")
_MOMENT = Dimension("a moment", "N*m", "5 kN*m")


def read_number(
    value: object,
    dimension: Dimension,
    *,
    above: float | None = None,
    least: float | None = None,
) -> float:
    """Return a finite number in SI units.

    Parameters
    ----------
    value
        A number, or a string with a unit.
    dimension
        What it measures.
    above, least
        It must be greater than ``above`` and not less than ``least``.

    Raises
    ------
    InputError
        If it is something else, has a wrong unit or is out of range.

    Examples
    --------
    >>> length = Dimension("a length", "m", "14 mm")
    >>> read_number("14 mm", length), read_number(3, length)
    (0.014, 3.0)
    """
    number = _finite(value, dimension)
    if above is not None and number <= above:
        raise InputError(
            "must be positive" if above == 0 else f"must exceed {above:g}", value=value
        )
    if least is not None and number < least:
        what = "must not be negative" if least == 0 else f"must be at least {least:g}"
        raise InputError(what, value=value)
    return number


def _finite(value: object, dimension: Dimension) -> float:
    if isinstance(value, str):
        return read_quantity(value, dimension)
    if isinstance(value, bool) or not isinstance(value, int | float):
        unit = dimension.unit
        wanted = f"must be a number in {unit}" if unit else "must be a number"
        hint = f"or a string with a unit like {dimension.example!r}" if unit else None
        raise InputError(wanted, value=value, hint=hint)
    if not math.isfinite(value):
        raise InputError("must be finite", value=value)
    return float(value)


def read_time(value: object) -> float:
    """Return a time in s, of a number or of a number with its unit.

    Raises
    ------
    InputError
        If it is none.
    """
    return read_number(value, _TIME)


def _quantity(
    dimension: Dimension, above: float | None = None, least: float | None = None
) -> Plain:
    """Return a field of one number."""

    def read(value: object) -> float:
        return read_number(value, dimension, above=above, least=least)

    bounds = {"exclusiveMinimum": above, "minimum": least}
    number = {"type": "number"} | {key: bound for key, bound in bounds.items() if bound is not None}
    text = {"type": "string", "pattern": WITH_UNIT if dimension.unit else _WITHOUT_UNIT}
    return Plain(read, {"anyOf": [number, text], "examples": [dimension.example]})


def _vector(dimension: Dimension, length: int = 3) -> Plain:
    """Return a field of components: three along the global axes, or two in a section."""
    item = _quantity(dimension)

    def read(value: object) -> tuple[float, ...]:
        return tuple(read_list(value, item.read, "numbers", length))

    return Plain(read, _array(item, length))


def _vectors(dimension: Dimension) -> Plain:
    """Return a field of one list of three components or more."""
    item = _vector(dimension)

    def read(value: object) -> list[tuple[float, ...]]:
        return read_list(value, item.read, "lists of three numbers")

    return Plain(read, _array(item))


def _series(dimension: Dimension, least: float | None = None) -> Plain:
    """Return a field of one number or more."""
    item = _quantity(dimension, least=least)

    def read(value: object) -> list[float]:
        return read_list(value, item.read, "numbers")

    return Plain(read, _array(item))


def _array(item: Plain, length: int | None = None) -> dict[str, Any]:
    bounds = {"minItems": 1} if length is None else {"minItems": length, "maxItems": length}
    return {"type": "array", "items": item.schema, **bounds}


def _read_written(value: object) -> float | str:
    """Keep a number or a string as it is: what it measures is known later."""
    return value if isinstance(value, str) else read_number(value, _NUMBER)


def _read_written_list(value: object) -> list[float | str]:
    return read_list(value, _read_written, "numbers")


Length = Annotated[float, _quantity(_LENGTH)]
Angle = Annotated[float, _quantity(_ANGLE)]
PositiveLength = Annotated[float, _quantity(_LENGTH, above=0)]
Pressure = Annotated[float, _quantity(_PRESSURE, above=0)]
Density = Annotated[float, _quantity(_DENSITY, above=0)]
Area = Annotated[float, _quantity(_AREA, above=0)]
AreaMoment = Annotated[float, _quantity(_AREA_MOMENT, above=0)]
LineMass = Annotated[float, _quantity(_LINE_MASS, least=0)]
InverseSpeed = Annotated[float, _quantity(_INVERSE_SPEED, least=0)]
AngularRate = Annotated[float, _quantity(_ANGULAR_RATE)]
Force = Annotated[float, _quantity(_FORCE)]
Mass = Annotated[float, _quantity(_MASS, least=0)]
Stiffness = Annotated[float, _quantity(_STIFFNESS, above=0)]
DampingConstant = Annotated[float, _quantity(_DAMPING, least=0)]
Frequency = Annotated[float, _quantity(_FREQUENCY, above=0)]
Frequency2 = Annotated[tuple[float, float], _vector(_FREQUENCY, length=2)]
Time = Annotated[float, _quantity(_TIME, least=0)]
PositiveTime = Annotated[float, _quantity(_TIME, above=0)]
Number = Annotated[float, _quantity(_NUMBER)]
PositiveNumber = Annotated[float, _quantity(_NUMBER, above=0)]
Ratio = Annotated[float, _quantity(_NUMBER, least=0)]
PoissonRatio = Annotated[float, _quantity(_NUMBER)]

Length2 = Annotated[tuple[float, float], _vector(_LENGTH, length=2)]
Length3 = Annotated[tuple[float, float, float], _vector(_LENGTH)]
Number3 = Annotated[tuple[float, float, float], _vector(_NUMBER)]
Directions = Annotated[list[tuple[float, float, float]], _vectors(_NUMBER)]
Acceleration3 = Annotated[tuple[float, float, float], _vector(_ACCELERATION)]
Velocity = Annotated[float, _quantity(_VELOCITY)]
Velocity3 = Annotated[tuple[float, float, float], _vector(_VELOCITY)]
AngularRate3 = Annotated[tuple[float, float, float], _vector(_ANGULAR_RATE)]
LineForce3 = Annotated[tuple[float, float, float], _vector(_LINE_FORCE)]
Force3 = Annotated[tuple[float, float, float], _vector(_FORCE)]
Moment3 = Annotated[tuple[float, float, float], _vector(_MOMENT)]

Frequencies = Annotated[list[float], _series(_FREQUENCY, least=0)]
Times = Annotated[list[float], _series(_TIME, least=0)]
Numbers = Annotated[list[float], _series(_NUMBER)]

_WRITTEN = {"type": ["number", "string"]}
Written = Annotated[float | str, Plain(_read_written, _WRITTEN)]
WrittenList = Annotated[
    list[float | str],
    Plain(_read_written_list, {"type": "array", "items": _WRITTEN, "minItems": 1}),
]
