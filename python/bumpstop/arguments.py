"""Checks on what users hand over: each returns the clean value or says what is wrong."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from numbers import Integral, Real
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from bumpstop.errors import InputError

__all__ = [
    "FloatArray",
    "Vector",
    "all_of",
    "count",
    "did_you_mean",
    "finite",
    "listed",
    "name",
    "not_negative",
    "one_of",
    "pair",
    "positive",
    "refuse_twins",
    "samples",
    "series",
    "vector",
]

FloatArray: TypeAlias = NDArray[np.float64]
T = TypeVar("T")
Vector: TypeAlias = tuple[float, float, float]


def finite(key: str, value: object) -> float:
    """Return a finite number as a float.

    Raises
    ------
    InputError
        If ``value`` is not a real number, or is infinite or NaN.
    """
    if type(value) is float:  # the usual case; asking for a Real takes ten times as long
        number = value
    elif isinstance(value, bool | np.bool_) or not isinstance(value, Real):
        raise InputError("must be a number", key=key, value=value)
    else:
        number = float(value)
    if not math.isfinite(number):
        raise InputError("must be finite", key=key, value=value)
    return number


def positive(key: str, value: object) -> float:
    """Return a finite number above zero."""
    number = finite(key, value)
    if number <= 0.0:
        raise InputError("must be positive", key=key, value=value)
    return number


def not_negative(key: str, value: object) -> float:
    """Return a finite number that is zero or above."""
    number = finite(key, value)
    if number < 0.0:
        raise InputError("must not be negative", key=key, value=value)
    return number


def boolean(key: str, value: object) -> bool:
    """Return true or false."""
    if isinstance(value, bool | np.bool_):
        return bool(value)
    raise InputError("must be True or False", key=key, value=value)


def count(key: str, value: object, least: int = 1, most: int | None = None) -> int:
    """Return a whole number from ``least`` to ``most``."""
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise InputError("must be a whole number", key=key, value=value)
    if value < least:
        raise InputError(f"must be {least} or more", key=key, value=value)
    if most is not None and int(value) > most:
        raise InputError(f"must be at most {most:,}", key=key, value=value)
    return int(value)


def name(key: str, value: object) -> str:
    """Return a name: a string with something in it."""
    if not isinstance(value, str) or not value.strip():
        raise InputError("must be a name", key=key, value=value)
    return value


def by_name(key: str, value: object) -> dict[str, Any]:
    """Return things by their names, as a dict."""
    if not isinstance(value, Mapping):
        raise InputError("must be a dict, each by its name", key=key, value=value)
    return dict(value)


def one_of(key: str, value: object, known: Sequence[str]) -> str:
    """Return a word that is among the known ones."""
    if isinstance(value, str) and value in known:
        return value
    raise InputError(f"unknown {key}", key=key, value=value, hint=did_you_mean(value, known))


def vector(key: str, value: object) -> Vector:
    """Return three finite numbers along the global axes."""
    x, y, z = _numbers(key, value, length=3)
    return (x, y, z)


def pair(key: str, value: object) -> tuple[float, float]:
    """Return two finite numbers."""
    first, second = _numbers(key, value, length=2)
    return (first, second)


def series(key: str, value: object) -> tuple[float, ...]:
    """Return finite numbers, at least one."""
    return _numbers(key, value)


def samples(key: str, value: object) -> FloatArray:
    """Return numbers as an array of any shape; those that are not finite stay."""
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError("must be numbers", key=key) from error


def all_of(key: str, kind: type[T], value: object) -> tuple[T, ...]:
    """Return the members of a list, all of one kind."""
    members = listed(key, value)
    for member in members:
        if not isinstance(member, kind):
            raise InputError(f"must hold {kind.__name__}s only", key=key, value=member)
    return members


def listed(key: str, value: object) -> tuple[Any, ...]:
    """Return the members of a list or tuple."""
    if not isinstance(value, list | tuple):
        raise InputError("must be a list", key=key, value=value)
    return tuple(value)


def refuse_twins(key: str, names: Iterable[str]) -> None:
    """Raise where a name is used twice."""
    seen: set[str] = set()
    for used in names:
        if used in seen:
            raise InputError("this name is used twice", key=key, value=used)
        seen.add(used)


def did_you_mean(word: object, known: Iterable[str]) -> str:
    """Return a hint: the known word most like ``word``, or all of them where none is like it.

    >>> did_you_mean("guid", ["guide", "end stop"])
    "did you mean 'guide'?"
    >>> did_you_mean("x", ["guide", "end stop"])
    'known: guide, end stop'
    >>> did_you_mean("x", [])
    'none are defined'
    """
    from difflib import get_close_matches

    words = list(known)
    close = get_close_matches(str(word), words, n=1)
    if close:
        return f"did you mean {close[0]!r}?"
    return f"known: {_listed(words)}" if words else "none are defined"


def _listed(words: list[str], longest: int = 12) -> str:
    more = f" and {len(words) - longest} more" if len(words) > longest else ""
    return ", ".join(words[:longest]) + more


def _numbers(key: str, value: object, length: int | None = None) -> tuple[float, ...]:
    wanted = "a list of numbers" if length is None else f"a list of {length} numbers"
    listed = value.tolist() if isinstance(value, np.ndarray) else value
    if isinstance(listed, str | bytes) or not isinstance(listed, Sequence):
        raise InputError(f"must be {wanted}", key=key, value=value)
    if len(listed) == 0 or (length is not None and len(listed) != length):
        raise InputError(f"must be {wanted}", key=key, value=value)
    return tuple(finite(key, number) for number in listed)
