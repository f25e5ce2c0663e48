"""Interfaces of components, and how many shapes are kept inside."""

from __future__ import annotations

from typing import Annotated

from bumpstop.errors import InputError
from bumpstop.io.case.fields.plain import Plain, read_list
from bumpstop.io.case.fields.words import choice, read_node
from bumpstop.structure.dofs import DOFS

__all__ = ["InnerModes", "Interface"]

InterfaceItem = str | tuple[str, tuple[str, ...]]


def _read_interface(value: object) -> list[InterfaceItem]:
    return read_list(value, _read_item, 'nodes, such as ["A", "B"]')


def _read_item(value: object) -> InterfaceItem:
    if not isinstance(value, list):
        return read_node(value)
    if len(value) != 2:
        what = 'must be a node, or a node and its dofs, such as ["B", ["dx", "dy"]]'
        raise InputError(what, value=value)
    return read_node(value[0]), tuple(read_list(value[1], choice(*DOFS).read, "dofs"))


def _read_inner_modes(value: object) -> int | str:
    if value == "all":
        return "all"
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise InputError('must be a whole number, 0 or more, or "all"', value=value)
    return value


_STRING = {"type": "string"}
_DOFS = {"type": "array", "items": {"enum": list(DOFS)}, "minItems": 1}
_PAIR = {"type": "array", "prefixItems": [_STRING, _DOFS], "items": False, "minItems": 2}

Interface = Annotated[
    list[InterfaceItem],
    Plain(_read_interface, {"type": "array", "items": {"anyOf": [_STRING, _PAIR]}, "minItems": 1}),
]
InnerModes = Annotated[
    int | str,
    Plain(_read_inner_modes, {"anyOf": [{"type": "integer", "minimum": 0}, {"const": "all"}]}),
]
