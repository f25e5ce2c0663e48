"""Tables inside a field, key by key."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError

__all__ = ["object_schema", "read_at", "refuse_unknown"]

T = TypeVar("T")


def read_at(key: str, read: Callable[[Any], T], value: object) -> T:
    """Read what stands under a key, and put it before the key of a mistake."""
    try:
        return read(value)
    except InputError as error:
        inner = f"{key}.{error.key}" if error.key else key
        raise InputError(error.what, key=inner, value=error.value, hint=error.hint) from error


def refuse_unknown(table: Mapping[str, Any], known: Iterable[str]) -> None:
    """Raise InputError where a table has a key that is not known."""
    names = tuple(known)
    for key, value in table.items():
        if key not in names:
            raise InputError("unknown key", key=key, value=value, hint=did_you_mean(key, names))


def object_schema(**properties: dict[str, Any]) -> dict[str, Any]:
    """Return the JSON schema of a table with these keys and no others."""
    return {"type": "object", "properties": properties, "additionalProperties": False}
