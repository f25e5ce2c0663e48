"""Modal masses: one for all modes, or one for each."""

from __future__ import annotations

from typing import Annotated

from bumpstop.io.case.fields.plain import Plain, read_list
from bumpstop.io.case.fields.quantities import read_number
from bumpstop.io.units import Dimension

__all__ = ["ModalMass"]

_MASS = Dimension("a mass", "kg", "300 g")


def _read_mass(value: object) -> float:
    return read_number(value, _MASS, above=0)


def _read_masses(value: object) -> float | list[float]:
    return read_list(value, _read_mass, "masses") if isinstance(value, list) else _read_mass(value)


_ONE = {"type": ["number", "string"]}
_MANY = {"type": "array", "items": _ONE, "minItems": 1}

ModalMass = Annotated[float | list[float], Plain(_read_masses, {"anyOf": [_ONE, _MANY]})]
