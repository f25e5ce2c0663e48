"""Finer models: the content of a case file with more elements or modes.

The names of mesh nodes count elements: ``AB.3`` of ten elements is ``AB.6`` of twenty.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

__all__ = [
    "Elements",
    "beam_elements",
    "finer_mesh",
    "has_beams",
    "renamed",
    "with_modes",
    "with_static_shapes",
]

Document: TypeAlias = dict[str, Any]
Elements: TypeAlias = Mapping[str, int]
"""How many elements each beam has that node names may count, by the name before the dot."""

_TEXTS = ("title", "description", "source")
"""Keys whose values are read by people, and name nothing."""


def beam_elements(document: Document) -> dict[str, int]:
    """Return how many elements the beams of a case have, by the names of their inner nodes.

    Those of a part are called ``part.beam``. Beams on the lines of a mesh are not among them:
    the file does not name them.
    """
    own = _elements_of(document)
    for name, part in document.get("parts", {}).items():
        inside = _elements_of(document["components"][part["component"]])
        own |= {f"{name}.{beam}": elements for beam, elements in inside.items()}
    return own


def has_beams(document: Document) -> bool:
    """Tell whether there are beams that can be cut into more elements."""
    parts = document.get("components", {}).values()
    return any(bool(each.get("beams") or each.get("mesh")) for each in (document, *parts))


def finer_mesh(document: Document, factor: int, elements: Elements) -> Document:
    """Return the content of a file with so many elements in the place of one.

    Parameters
    ----------
    document
        The content, with the structures of components in it.
    factor
        Elements in the place of one.
    elements
        Elements of each beam whose inner nodes the file may name.
    """
    finer: Document = renamed(document, elements, factor)
    finer |= _multiplied(finer, factor)
    if "mesh" in finer:
        groups = finer["mesh"]["beams"].items()
        beams = {
            name: beam | {"elements": beam.get("elements", 1) * factor} for name, beam in groups
        }
        finer["mesh"] = finer["mesh"] | {"beams": beams}
    if "components" in finer:
        finer["components"] = {
            name: _finer_component(component, factor)
            for name, component in document["components"].items()
        }
    return finer


def _finer_component(component: Document, factor: int) -> Document:
    named: Document = renamed(component, _elements_of(component), factor)
    return named | _multiplied(named, factor)


def _elements_of(structure: Document) -> dict[str, int]:
    return {name: beam["elements"] for name, beam in structure.get("beams", {}).items()}


def _multiplied(structure: Document, factor: int) -> Document:
    if "beams" not in structure:
        return {}
    beams = structure["beams"].items()
    return {"beams": {name: beam | {"elements": beam["elements"] * factor} for name, beam in beams}}


def renamed(value: Any, elements: Elements, factor: int) -> Any:
    """Return a value in which mesh nodes have the names that they have in a finer mesh.

    Examples
    --------
    >>> renamed({"node": "AB.3", "other": "AB@0.2 m"}, {"AB": 10}, 2)
    {'node': 'AB.6', 'other': 'AB@0.2 m'}
    """
    if isinstance(value, dict):
        return {
            renamed(key, elements, factor): (
                item if key in _TEXTS else renamed(item, elements, factor)
            )
            for key, item in value.items()
        }
    if isinstance(value, list):
        return [renamed(item, elements, factor) for item in value]
    if not isinstance(value, str):
        return value
    beam, _, number = value.rpartition(".")
    inner = number.isdecimal() and 0 < int(number) < elements.get(beam, 0)
    return f"{beam}.{int(number) * factor}" if inner else value


def with_modes(document: Document, modes: Any) -> Document:
    """Return the content of a file with another selection of modes.

    Parameters
    ----------
    document
        The content.
    modes
        As ``[basis]`` has it. Where damping is listed mode by mode, modes beyond the list are
        damped as its last one, and `modes` is their number.
    """
    basis = document["basis"] | {"modes": modes}
    damping = basis.get("damping")
    if isinstance(damping, list):
        basis["damping"] = [*damping, *damping[-1:] * modes][:modes]
    return document | {"basis": basis}


def with_static_shapes(document: Document) -> Document | None:
    """Return the content of a file with the static shapes of its stops beside the modes.

    Where damping is listed mode by mode, they are damped as the last mode. None where there are
    no stops, or static shapes already.
    """
    basis = document["basis"]
    if not document.get("stops") or basis.get("static_shapes"):
        return None
    damping = basis.get("damping")
    damped = {"static_damping": damping[-1]} if isinstance(damping, list) else {}
    return document | {"basis": damped | basis | {"static_shapes": "stops"}}
