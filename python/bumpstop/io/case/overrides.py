"""Variants: the same case with some keys changed."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io.case.keys import KeyPath, dotted

__all__ = ["overridden", "overridden_paths"]

_OWN = ("title", "description", "variants", "references")
"""Keys that belong to the case, not to a variant of it."""


def overridden(document: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """Return a case file's content with some keys changed.

    Parameters
    ----------
    document
        Content of the file. It is left as it is.
    changes
        New values by dotted name: ``"stops.spring.stiffness"``, ``"supports.0.fixed"``. A
        table changes what it names and leaves the rest.

    Raises
    ------
    InputError
        If a name leads nowhere; its key is that name in quotes.

    Examples
    --------
    >>> overridden({"run": {"duration": 1.0}}, {"run.duration": 2.0})
    {'run': {'duration': 2.0}}
    """
    changed = {key: deepcopy(value) for key, value in document.items() if key not in _OWN}
    _merge(changed, changes, ())
    return changed


def overridden_paths(changes: dict[str, Any], above: KeyPath = ()) -> list[KeyPath]:
    """Return the paths that changes lead to.

    >>> overridden_paths({"run.duration": 2.0, "stops": {"spring": {"gap": 0.1}}})
    [('run', 'duration'), ('stops', 'spring', 'gap')]
    """
    paths = []
    for name, value in changes.items():
        path = (*above, *name.split("."))
        paths += overridden_paths(value, path) if isinstance(value, dict) else [path]
    return paths


def _merge(target: Any, changes: dict[str, Any], above: KeyPath) -> None:
    for name, value in changes.items():
        path = (*above, *name.split("."))
        try:
            _put(target, path[len(above) :], value, path)
        except LookupError as error:
            hint = error.args[0]
            raise InputError("leads nowhere", key=f'"{dotted(path)}"', hint=hint) from error


def _put(target: Any, way: KeyPath, value: Any, path: KeyPath) -> None:
    """Set what a way leads to; raise LookupError with a hint where it leads nowhere."""
    if path[0] in _OWN:
        raise InputError("cannot be changed by a variant", key=f'"{dotted(path)}"')
    holder = target
    for part in way[:-1]:
        holder = holder[_step(holder, str(part))]
    last = str(way[-1])
    if isinstance(holder, dict) and last not in holder:
        holder[last] = value  # a key that the case leaves to its default, or a wrong one
        return
    step = _step(holder, last)
    if isinstance(value, dict) and isinstance(holder[step], dict):
        _merge(holder[step], value, path)
    else:
        holder[step] = value


def _step(holder: Any, part: str) -> Any:
    """Return the key or index under which a part is there."""
    if isinstance(holder, dict):
        if part in holder:
            return part
        raise LookupError(f"the case has no {part!r} there; {did_you_mean(part, holder)}")
    if isinstance(holder, list):
        if part.isdecimal() and int(part) < len(holder):
            return int(part)
        raise LookupError(f"the list there has items 0 to {len(holder) - 1}")
    raise LookupError(f"there is no table that could hold {part!r}")
