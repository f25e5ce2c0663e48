"""Shear factors of a section: two numbers, or the name of a formula."""

from __future__ import annotations

from typing import Annotated, Any

from bumpstop.errors import InputError
from bumpstop.io.case.fields.plain import Plain, read_list
from bumpstop.io.case.fields.quantities import read_number
from bumpstop.io.units import Dimension

__all__ = ["COWPER", "PlainShearFactors", "ShearFactors"]

COWPER = "cowper"
"""The word for Cowper's shear factors at the Poisson's ratio of the beam's material."""

_NUMBER = Dimension("a pure number", "", "0.5")


def _read_pair(value: object) -> object:
    return tuple(read_list(value, lambda one: read_number(one, _NUMBER, above=0), "numbers", 2))


def _read_factors(value: object) -> object:
    if value == COWPER:
        return value
    if isinstance(value, str):
        raise InputError(f"must be two numbers or {COWPER!r}", value=value)
    return _read_pair(value)


_PAIR = {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}

PlainShearFactors = Annotated[Any, Plain(_read_pair, _PAIR)]
ShearFactors = Annotated[
    Any,
    Plain(
        _read_factors,
        {"anyOf": [{"const": COWPER}, _PAIR]},
    ),
]
