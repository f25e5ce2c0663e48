"""Variants: the same case with some keys changed."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io.case.keys import KeyPath, dotted

__all__ = ["overridden", "overridden_paths"]

_OWN = ("variants", "references")
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
        *way, last = name.split(".")
        holder, path = target, above
        for part in way:
            path = (*path, part)
            holder = holder[_step(holder, part, path)]
        _put(holder, last, value, (*path, last))


def _put(holder: Any, last: str, value: Any, path: KeyPath) -> None:
    if path[0] in _OWN:
        raise InputError("cannot be changed by a variant", key=_quoted(path))
    if isinstance(holder, dict) and last not in holder:
        holder[last] = value  # a key that the case leaves to its default, or a wrong one
        return
    step = _step(holder, last, path)
    if isinstance(value, dict) and isinstance(holder[step], dict):
        _merge(holder[step], value, path)
    else:
        holder[step] = value


def _step(holder: Any, part: str, path: KeyPath) -> Any:
    """Return the key or index under which a part is there."""
    if isinstance(holder, dict):
        if part in holder:
            return part
        hint = did_you_mean(part, holder)
    elif isinstance(holder, list):
        if part.isdecimal() and int(part) < len(holder):
            return int(part)
        hint = f"{dotted(path[:-1])} has items 0 to {len(holder) - 1}"
    else:
        hint = f"{dotted(path[:-1])} is not a table"
    raise InputError("leads nowhere in this file", key=_quoted(path), hint=hint)


def _quoted(path: KeyPath) -> str:
    return f'"{dotted(path)}"'
