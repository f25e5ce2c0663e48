"""Where something stands in a case file."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TypeAlias

from bumpstop.errors import InputError

__all__ = ["KeyPath", "dotted", "keyed"]

KeyPath: TypeAlias = tuple[str | int, ...]
"""Keys of tables and indices of lists, from the top of the file down."""

_INDEX = r"\[(\d+)\]"
_BARE = r"[\w-]+"


def dotted(path: KeyPath) -> str:
    """Return a path as it is written in TOML and in variants.

    >>> dotted(("supports", 0, "fixed"))
    'supports.0.fixed'
    >>> dotted(("nodes", "a b"))
    'nodes."a b"'
    """
    return ".".join(_part(str(part)) for part in path)


def _part(part: str) -> str:
    if re.fullmatch(_BARE, part):
        return part
    import json

    return json.dumps(part, ensure_ascii=False)


@contextmanager
def keyed(table: str = "", renamed: Mapping[str, str] | None = None) -> Iterator[None]:
    """Turn the argument that a lower layer refused into a key of the file.

    Parameters
    ----------
    table
        The table whose keys the arguments are; empty where errors name their table already.
    renamed
        What arguments, or the beginnings of their dotted names, are called in the file; the
        longest that fits counts.

    Examples
    --------
    >>> with keyed("stops.guide"):
    ...     raise InputError("must be positive", key="stiffness", value=-1.0)
    Traceback (most recent call last):
    bumpstop.errors.InputError: stops.guide.stiffness: must be positive (got -1.0)
    """
    try:
        yield
    except InputError as error:
        if error.file:  # of another file, whose keys are not ours
            raise
        inner = _renamed(error.key or "", renamed or {})
        key = re.sub(_INDEX, r".\1", ".".join(part for part in (table, inner) if part))
        raise InputError(error.what, key=key, value=error.value, hint=error.hint) from error


def _renamed(key: str, renamed: Mapping[str, str]) -> str:
    for old in sorted(renamed, key=len, reverse=True):
        if key == old or key.startswith(f"{old}."):
            return renamed[old] + key[len(old) :]
    return key
