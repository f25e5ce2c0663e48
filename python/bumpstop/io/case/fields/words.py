"""Words: names that the file gives to things, names of nodes, and words from a fixed list."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Annotated

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io import FORMATS
from bumpstop.io.case.fields.plain import Plain, read_list
from bumpstop.structure.dofs import DOFS

__all__ = [
    "BeamEnds",
    "BeamName",
    "Command",
    "Dofs",
    "Formats",
    "Group",
    "LinkedNodes",
    "LoadNames",
    "Name",
    "Names",
    "Node",
    "NodeName",
    "Nodes",
    "OneDof",
    "Text",
    "Units",
    "choice",
    "read_node",
]

_NAME = r"[\w-]+"


_PATH = rf"{_NAME}(\.{_NAME})*"
"""A name after those of the parts that it belongs to."""


def _read_text(value: object) -> str:
    if not isinstance(value, str):
        raise InputError("must be a text in quotes", value=value)
    return value


def _read_group(value: object) -> str:
    """Return the name of a group of another program's file, whatever it is."""
    if not isinstance(value, str) or not value.strip():
        raise InputError("must be the name of a group", value=value)
    return value


def _read_name(value: object) -> str:
    """Return a name that can also be a folder's, since variants become folders."""
    if not isinstance(value, str) or not re.fullmatch(_NAME, value):
        hint = "letters, digits, '_' and '-' make a name"
        raise InputError("must be a name", value=value, hint=hint)
    return value


def _read_beam(value: object) -> str:
    """Return the name of a beam, or of one in a part."""
    if not isinstance(value, str) or not re.fullmatch(_PATH, value):
        hint = "a beam is called like 'AB', one of a part like 'left.AB'"
        raise InputError("must be the name of a beam", value=value, hint=hint)
    return value


def _read_node_name(value: object) -> str:
    if value == "all":
        raise InputError("no node can be called 'all'", hint="supports use it for every node")
    return _read_name(value)


def read_node(value: object) -> str:
    """Return the name of a node, or of a point along a beam; whether it is there comes later."""
    if not isinstance(value, str) or not value.strip():
        raise InputError("must be the name of a node", value=value)
    return value


def _read_nodes(value: object) -> list[str]:
    return ["all"] if value == "all" else read_list(value, read_node, 'node names, or "all"')


def _read_ends(value: object) -> tuple[str, ...]:
    return tuple(read_list(value, read_node, "node names", length=2))


def _read_linked(value: object) -> tuple[str, ...]:
    return tuple(read_list(value, read_node, "node names"))


def choice(*words: str) -> Plain:
    """Return a field that is one of these words."""

    def read(value: object) -> str:
        return _one_of(value, words)

    return Plain(read, {"enum": list(words)})


def _one_of(value: object, words: Sequence[str]) -> str:
    if isinstance(value, str) and value in words:
        return value
    if len(words) == 1:
        raise InputError(f"must be {words[0]!r}", value=value)
    raise InputError("is not one of the known words", value=value, hint=did_you_mean(value, words))


def _read_dofs(value: object) -> list[str]:
    return read_list(value, choice(*DOFS).read, "dofs")


def _read_names(value: object) -> list[str]:
    return [_read_name(value)] if isinstance(value, str) else read_list(value, _read_name, "names")


def _read_load_names(value: object) -> list[str] | str:
    return "all" if value == "all" else read_list(value, _read_name, "names of loads")


def _read_command(value: object) -> list[str]:
    return read_list(value, _read_text, "texts, the program first")


def _read_units(value: object) -> list[str]:
    units = read_list(value, _read_text, "units")
    if len(units) != 2:
        raise InputError("must be two units, of times and of values", value=value)
    return units


def _read_formats(value: object) -> list[str]:
    return [] if value == [] else read_list(value, choice(*FORMATS).read, "formats")


_STRING = {"type": "string"}
_STRINGS = {"type": "array", "items": _STRING, "minItems": 1}

Text = Annotated[str, Plain(_read_text, _STRING)]
Group = Annotated[str, Plain(_read_group, {**_STRING, "pattern": "^.+$"})]
Name = Annotated[str, Plain(_read_name, {**_STRING, "pattern": f"^{_NAME}$"})]
BeamName = Annotated[
    str, Plain(_read_beam, {**_STRING, "pattern": f"^{_PATH}$", "examples": ["AB", "left.AB"]})
]
Names = Annotated[list[str], Plain(_read_names, {"anyOf": [_STRING, _STRINGS]})]
NodeName = Annotated[str, Plain(_read_node_name, {**_STRING, "pattern": f"^{_NAME}$"})]
Node = Annotated[str, Plain(read_node, {**_STRING, "examples": ["B", "AB.3", "AB@0.462 m"]})]
Nodes = Annotated[list[str], Plain(_read_nodes, {"anyOf": [{"const": "all"}, _STRINGS]})]
BeamEnds = Annotated[tuple[str, str], Plain(_read_ends, {**_STRINGS, "minItems": 2, "maxItems": 2})]
LinkedNodes = Annotated[tuple[str, ...], Plain(_read_linked, {**_STRINGS, "minItems": 2})]
LoadNames = Annotated[
    list[str] | str, Plain(_read_load_names, {"anyOf": [{"const": "all"}, _STRINGS]})
]
Command = Annotated[list[str], Plain(_read_command, _STRINGS)]
Units = Annotated[list[str], Plain(_read_units, {**_STRINGS, "minItems": 2, "maxItems": 2})]
Formats = Annotated[
    list[str], Plain(_read_formats, {**_STRINGS, "items": {"enum": list(FORMATS)}, "minItems": 0})
]
OneDof = Annotated[str, choice(*DOFS)]
Dofs = Annotated[list[str], Plain(_read_dofs, {**_STRINGS, "items": {"enum": list(DOFS)}})]
