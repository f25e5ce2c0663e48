"""What one table names of another."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError

__all__ = ["named"]

T = TypeVar("T")


def named(key: str, name: str, known: Mapping[str, T]) -> T:
    """Return the thing of that name.

    Raises
    ------
    InputError
        If there is none.

    Examples
    --------
    >>> named("section", "bar", {"bar": 1, "plate": 2})
    1
    """
    if name not in known:
        raise InputError(f"unknown {key}", key=key, value=name, hint=did_you_mean(name, known))
    return known[name]
