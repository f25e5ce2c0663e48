"""Where the static shapes of a basis act."""

from __future__ import annotations

from typing import Annotated, Any

from bumpstop.errors import InputError
from bumpstop.io.case.fields.plain import Plain, read_list
from bumpstop.io.case.fields.quantities import read_number
from bumpstop.io.case.fields.words import choice, read_node
from bumpstop.io.units import Dimension
from bumpstop.structure.dofs import DOFS, Place

__all__ = ["Places", "PlacesOrStops"]

_COMPONENT = Dimension("a pure number", "", "0.6")


def _read_places(value: object) -> list[Place]:
    return read_list(value, _read_place, 'places such as ["B", "dy"]')


def _read_places_or_stops(value: object) -> list[Place] | str:
    return "stops" if value == "stops" else _read_places(value)


def _read_place(value: object) -> Place:
    if not isinstance(value, list) or len(value) != 2:
        what = 'must be a node and a dof, or a node and a direction, such as ["B", "dy"]'
        raise InputError(what, value=value)
    node, along = value
    if isinstance(along, list):
        return read_node(node), tuple(read_list(along, _read_component, "numbers", 3))
    return read_node(node), choice(*DOFS).read(along)


def _read_component(value: object) -> float:
    return read_number(value, _COMPONENT)


_STRING = {"type": "string"}
_DIRECTION = {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}
_PLACE: dict[str, Any] = {
    "type": "array",
    "prefixItems": [_STRING, {"anyOf": [{"enum": list(DOFS)}, _DIRECTION]}],
    "items": False,
    "minItems": 2,
}
_PLACES: dict[str, Any] = {"type": "array", "items": _PLACE, "minItems": 1}

Places = Annotated[list[Place], Plain(_read_places, _PLACES)]
PlacesOrStops = Annotated[
    list[Place] | str, Plain(_read_places_or_stops, {"anyOf": [{"const": "stops"}, _PLACES]})
]
