"""What laws are described by: coefficients of friction, directions of sliding, force curves."""

from __future__ import annotations

from typing import Annotated, Any

from bumpstop.errors import InputError
from bumpstop.io.case.fields.plain import Plain, read_list
from bumpstop.io.case.fields.quantities import WITH_UNIT, read_number
from bumpstop.io.case.fields.words import choice, read_node
from bumpstop.io.units import Dimension
from bumpstop.laws.contact import FRICTION_KEYS, SLIDING_RULES
from bumpstop.structure.dofs import DOFS, Dof

__all__ = [
    "ContactStiffness",
    "CrackPoints",
    "Curve",
    "DampingSlopes",
    "Deformations",
    "FrictionCoefficients",
    "Profile",
    "Sliding",
    "Slopes",
    "SpeedCurve",
    "Speeds",
    "Unloading",
    "contact_stiffness",
]

_COEFFICIENT = Dimension("a pure number", "", "0.2")
_TURN = Dimension("an angle", "rad", "30 deg")
_DEFORMATION = Dimension("a length", "m", "2 mm")
_FORCE = Dimension("a force", "N", "5 kN")
_ANGULAR_STIFFNESS = Dimension("an angular stiffness", "N m/rad", "2 MN m/rad")
_ANGULAR_SLOPE = Dimension("a slope of an angular stiffness", "N m/rad^2", "3e5 N m/rad^2")
_SLOPE = Dimension("a stiffness", "N/m", "18 kN/m")
_SPEED = Dimension("a speed", "m/s", "0.2 m/s")
_DAMPING = Dimension("a damping constant", "N s/m", "30 N s/m")


class _WithUnit(float):
    """A number that was written with its unit."""


def contact_stiffness(value: float, exponent: float) -> float:
    """Return the stiffness of a stop whose force goes with a power of its depth.

    Raises
    ------
    InputError
        If it was written in N/m and that is not its unit.

    Examples
    --------
    >>> contact_stiffness(2e9, 1.5)
    2000000000.0
    """
    if exponent != 1.0 and isinstance(value, _WithUnit):
        what = f"must be a number without a unit: it is in N/m^{exponent:g}"
        raise InputError(what, key="stiffness", value=float(value))
    return float(value)


def _read_contact_stiffness(value: object) -> float:
    """Read a number, and keep in mind whether it has a unit: an exponent changes that."""
    number = read_number(value, _SLOPE, above=0)
    return _WithUnit(number) if isinstance(value, str) else number


def _read_friction(value: object) -> float | dict[str, float | str]:
    if not isinstance(value, dict):
        return read_number(value, _COEFFICIENT, least=0)
    friction: dict[str, float | str] = {}
    for key, told in value.items():
        choice(*FRICTION_KEYS).read(key)
        try:
            if key == "rule":
                friction[key] = choice(*SLIDING_RULES).read(told)
            else:
                friction[key] = read_number(told, _COEFFICIENT, least=0)
        except InputError as error:
            raise error.located(key=key) from error
    return friction


def _read_sliding(value: object) -> str | tuple[float, ...] | dict[Dof, float]:
    if isinstance(value, str):
        choice("plane").read(value)
        return value
    if isinstance(value, list):
        return tuple(read_list(value, _read_component, "numbers", 3))
    if not isinstance(value, dict):
        raise InputError("must be a direction, or weights of dofs", value=value)
    terms = {}
    for node, weights in value.items():
        if not isinstance(weights, dict):
            raise InputError("must be weights of dofs, such as { dx = 1.0 }", value=weights)
        for dof, weight in weights.items():
            where = (read_node(node), choice(*DOFS).read(dof))
            terms[where] = read_number(weight, _DEFORMATION)
    return terms


def _read_component(value: object) -> float:
    return read_number(value, _COEFFICIENT)


def _read_deformations(value: object) -> list[float]:
    return read_list(value, lambda each: read_number(each, _DEFORMATION), "numbers")


def _read_slopes(value: object) -> list[float]:
    return read_list(value, lambda each: read_number(each, _SLOPE), "numbers")


def _read_speeds(value: object) -> list[float]:
    return read_list(value, lambda each: read_number(each, _SPEED), "numbers")


def _read_damping_slopes(value: object) -> list[float]:
    return read_list(value, lambda each: read_number(each, _DAMPING), "numbers")


def _read_speed_curve(value: object) -> list[tuple[float, float]]:
    return read_list(value, _read_speed_point, "points [speed, force]")


def _read_speed_point(value: object) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2:
        raise InputError("must be a speed and a force", value=value)
    return read_number(value[0], _SPEED), read_number(value[1], _FORCE)


def _read_unloading(value: object) -> float | list[tuple[float, float]]:
    if isinstance(value, list):
        return read_list(value, _read_unloading_point, "points [residual crushing, stiffness]")
    return read_number(value, _SLOPE, above=0)


def _read_unloading_point(value: object) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2:
        raise InputError("must be a residual crushing and a stiffness", value=value)
    return read_number(value[0], _DEFORMATION, least=0), read_number(value[1], _SLOPE, above=0)


def _read_curve(value: object) -> list[tuple[float, float]]:
    return read_list(value, _read_point, "points [deformation, force]")


def _read_crack(value: object) -> list[tuple[float, ...]]:
    return read_list(value, _read_crack_point, "points [angle, stiffness]")


def _read_crack_point(value: object) -> tuple[float, ...]:
    if not isinstance(value, list) or len(value) not in (2, 3):
        what = "must be an angle and a stiffness, and the derivative of that or none"
        raise InputError(what, value=value)
    dimensions = (_TURN, _ANGULAR_STIFFNESS, _ANGULAR_SLOPE)
    both = zip(value, dimensions, strict=False)
    return tuple(read_number(number, dimension) for number, dimension in both)


def _read_profile(value: object) -> list[tuple[float, float]]:
    return read_list(value, _read_corner, "corners [angle, radius]")


def _read_corner(value: object) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2:
        raise InputError("must be an angle and a radius", value=value)
    return read_number(value[0], _TURN), read_number(value[1], _DEFORMATION)


def _read_point(value: object) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2:
        raise InputError("must be a deformation and a force", value=value)
    return read_number(value[0], _DEFORMATION), read_number(value[1], _FORCE)


_STIFFNESS = {
    "anyOf": [{"type": "number", "exclusiveMinimum": 0}, {"type": "string", "pattern": WITH_UNIT}],
    "examples": [_SLOPE.example],
}
_ONE: dict[str, Any] = {"type": ["number", "string"]}
_LIST: dict[str, Any] = {"type": "array", "items": _ONE, "minItems": 1}
_DIRECTION = {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}
_WEIGHTS = {"type": "object", "additionalProperties": _ONE}
_POINT = {"type": "array", "items": _ONE, "minItems": 2, "maxItems": 2}
_FRICTION = {
    "anyOf": [
        {"type": "number", "minimum": 0},
        {
            "type": "object",
            "properties": {
                **{key: {"type": "number", "minimum": 0} for key in FRICTION_KEYS if key != "rule"},
                "rule": {"enum": list(SLIDING_RULES)},
            },
            "required": ["static"],
            "additionalProperties": False,
        },
    ]
}

ContactStiffness = Annotated[float, Plain(_read_contact_stiffness, _STIFFNESS)]
FrictionCoefficients = Annotated[float | dict[str, float | str], Plain(_read_friction, _FRICTION)]
Sliding = Annotated[
    str | tuple[float, float, float] | dict[Dof, float],
    Plain(
        _read_sliding,
        {
            "anyOf": [
                {"const": "plane"},
                _DIRECTION,
                {"type": "object", "additionalProperties": _WEIGHTS},
            ]
        },
    ),
]
Slopes = Annotated[list[float], Plain(_read_slopes, _LIST)]
Deformations = Annotated[list[float], Plain(_read_deformations, _LIST)]
Unloading = Annotated[
    float | list[tuple[float, float]],
    Plain(_read_unloading, {"anyOf": [_STIFFNESS, {"type": "array", "items": _POINT}]}),
]
Speeds = Annotated[list[float], Plain(_read_speeds, _LIST)]
DampingSlopes = Annotated[list[float], Plain(_read_damping_slopes, _LIST)]
SpeedCurve = Annotated[
    list[tuple[float, float]],
    Plain(_read_speed_curve, {"type": "array", "items": _POINT, "minItems": 2}),
]
Curve = Annotated[
    list[tuple[float, float]],
    Plain(_read_curve, {"type": "array", "items": _POINT, "minItems": 2}),
]
CrackPoints = Annotated[
    list[tuple[float, ...]],
    Plain(
        _read_crack,
        {"type": "array", "items": _POINT | {"maxItems": 3}, "minItems": 4},
    ),
]
Profile = Annotated[
    list[tuple[float, float]],
    Plain(_read_profile, {"type": "array", "items": _POINT, "minItems": 3}),
]
