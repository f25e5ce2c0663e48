"""Numbers of a spring, a bearing or an inertia: one, a few, or a square matrix, with units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from bumpstop.errors import InputError
from bumpstop.io.case.fields.plain import Plain, read_list
from bumpstop.io.case.fields.quantities import read_number
from bumpstop.io.units import Dimension

__all__ = ["Axes2", "Inertia", "PlaneDamping", "PlaneStiffness", "SpringDamping", "SpringStiffness"]

_ONE = {"type": ["number", "string"]}
_LIST: dict[str, Any] = {"type": "array", "items": _ONE}
_MATRIX: dict[str, Any] = {"type": "array", "items": _LIST}


def _read_constants(value: object, table: Sequence[Sequence[Dimension]], what: str) -> object:
    """Return one number, one for each row of a table of dimensions, or a square matrix."""
    if not isinstance(value, list):
        return read_number(value, table[0][0])
    if any(isinstance(row, list) for row in value):
        return _read_matrix(value, table, what)
    diagonal = [row[i] for i, row in enumerate(table)]
    if len(value) != len(table):
        raise InputError(f"must be {what}", value=value)
    return _read_each(value, diagonal)


def _read_matrix(value: list[object], table: Sequence[Sequence[Dimension]], what: str) -> object:
    size = len(value)
    if size % len(table) or any(not isinstance(row, list) or len(row) != size for row in value):
        raise InputError(f"must be {what}", value=value)
    rows = iter(range(size))

    def read_row(row: list[object]) -> object:
        dimensions = table[next(rows) % len(table)]
        return _read_each(row, [dimensions[i % len(table)] for i in range(size)])

    return tuple(read_list(value, read_row, "rows"))


def _read_each(values: list[object], dimensions: Sequence[Dimension]) -> tuple[float, ...]:
    each = iter(dimensions)
    return tuple(read_list(values, lambda value: read_number(value, next(each)), "numbers"))


def _constants(table: Sequence[Sequence[Dimension]], what: str, example: str) -> Plain:
    """Return a field of numbers whose dimensions a table tells."""

    def read(value: object) -> object:
        return _read_constants(value, table, what)

    shapes = [{"type": "number"}, {"type": "string"}, _LIST, _MATRIX]
    return Plain(read, {"anyOf": shapes, "examples": [example]})


def _six(along: Dimension, coupling: Dimension, about: Dimension) -> list[list[Dimension]]:
    """Return the dimensions of a matrix of displacements and rotations."""
    return [[along] * 3 + [coupling] * 3] * 3 + [[coupling] * 3 + [about] * 3] * 3


_SIX = "a number, six numbers or a matrix of 6 x 6"
_TWO = "a number or a matrix of 2 x 2"
_STIFFNESS = Dimension("a stiffness", "N/m", "18 kN/m")
_DAMPING = Dimension("a damping constant", "N*s/m", "20 N*s/m")
_INERTIA = Dimension("a moment of inertia", "kg*m^2", "0.02 kg*m^2")
_NUMBER = Dimension("a pure number", "", "0.3")

_SPRING_STIFFNESS = _six(
    _STIFFNESS, Dimension("a force", "N", "5 N"), Dimension("a moment", "N*m", "5 N*m")
)
_SPRING_DAMPING = _six(
    _DAMPING,
    Dimension("a damping of rotation by displacement", "N*s", "5 N*s"),
    Dimension("a damping of rotation", "N*m*s", "5 N*m*s"),
)


def _read_inertia(value: object) -> object:
    read = Plain(lambda one: read_number(one, _INERTIA), {}).read
    if not isinstance(value, list) or len(value) not in (3, 6):
        what = "must be three or six moments of inertia, or a matrix of 3 x 3"
        raise InputError(what, value=value)
    if any(isinstance(row, list) for row in value):
        return tuple(read_list(value, lambda row: read_list(row, read, "numbers", 3), "rows", 3))
    return tuple(read_list(value, read, "numbers"))


def _read_axes(value: object) -> object:
    def read_vector(vector: object) -> object:
        return tuple(read_list(vector, lambda one: read_number(one, _NUMBER), "numbers", 3))

    return tuple(read_list(value, read_vector, "vectors", 2))


SpringStiffness = Annotated[Any, _constants(_SPRING_STIFFNESS, _SIX, "18 kN/m")]
SpringDamping = Annotated[Any, _constants(_SPRING_DAMPING, _SIX, "20 N*s/m")]
PlaneStiffness = Annotated[Any, _constants([[_STIFFNESS] * 2] * 2, _TWO, "2e7 N/m")]
PlaneDamping = Annotated[Any, _constants([[_DAMPING] * 2] * 2, _TWO, "1e4 N*s/m")]
Inertia = Annotated[
    Any, Plain(_read_inertia, {"type": "array", "items": {"anyOf": [_ONE, _LIST]}, "minItems": 3})
]
Axes2 = Annotated[
    Any,
    Plain(
        _read_axes, {**_MATRIX, "minItems": 2, "maxItems": 2, "examples": [[[1, 0, 0], [0, 1, 0]]]}
    ),
]
