"""Lists of names, where one name alone may stand for a list of one."""

from __future__ import annotations

from collections.abc import Sequence

from bumpstop.arguments import name
from bumpstop.errors import InputError

__all__ = ["names"]


def names(key: str, value: object) -> tuple[str, ...]:
    """Return one name or several as a tuple.

    Raises
    ------
    InputError
        If there is none, or one is not a name.

    Examples
    --------
    >>> names("nodes", "A"), names("nodes", ["A", "B"])
    (('A',), ('A', 'B'))
    """
    listed = [value] if isinstance(value, str) else value
    if not isinstance(listed, Sequence) or not listed:
        raise InputError("must be a list of names", key=key, value=value)
    return tuple(name(key, item) for item in listed)
