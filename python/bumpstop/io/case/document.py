"""The file itself: from a path to the tables and values that TOML finds in it."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from bumpstop.errors import InputError
from bumpstop.io.case.keys import KeyPath, dotted

__all__ = ["LARGEST", "read_document"]

LARGEST = 10_000_000
"""Largest case file, in bytes: they are written by people."""

_LARGEST_INTEGER = 2**63
_UNQUOTED = ("Invalid value", "Expected newline")
"""How tomllib complains of a word or a unit without quotes."""

_PLACE = r"\s*\(at (.*)\)$"


def read_document(path: Path) -> dict[str, Any]:
    """Return the content of a TOML file.

    Raises
    ------
    InputError
        If there is no such file, it cannot be read, is empty, too large, not UTF-8 or not
        TOML, or holds a number that is not finite.
    """
    try:
        return _parsed(_text(_content(path)))
    except InputError as error:
        raise error.located(file=str(path)) from error.__cause__


def _content(path: Path) -> bytes:
    _check_kind(path)
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST + 1)
    except FileNotFoundError as error:
        raise InputError("no such file", hint="check the path") from error
    except (OSError, ValueError) as error:  # ValueError: a null character in the path
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"cannot be read: {reason}") from error
    if len(content) > LARGEST:
        size = path.stat().st_size
        raise InputError(f"is too large, {size:,} bytes", hint=f"at most {LARGEST:,} are read")
    return content


def _check_kind(path: Path) -> None:
    if path.is_dir():
        hint = f"did you mean {str(path / 'case.toml')!r}?"
        raise InputError("is a folder, not a case file", hint=hint)
    if path.exists() and not path.is_file():
        raise InputError("is not a regular file", hint="give the path of a case file")


def _text(content: bytes) -> str:
    if not content.strip():
        raise InputError("is empty", hint="'bumpstop schema' tells what a case file holds")
    if b"\0" in content:
        raise InputError("is a binary file, not a case file in TOML")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = f"line {content.count(10, 0, error.start) + 1}"  # 10 is a line feed
        raise InputError("is not UTF-8 text", key=line, hint="save it as UTF-8") from error


def _parsed(text: str) -> dict[str, Any]:
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _syntax_error(str(error)) from error
    except RecursionError as error:
        raise InputError("is nested too deeply") from error
    except ValueError as error:  # Python refuses to read an integer of thousands of digits
        raise _too_many_digits(text) from error
    for path, number in _numbers(document, ()):
        _check_number(path, number)
    return document


def _syntax_error(message: str) -> InputError:
    place = re.search(_PLACE, message)
    what = re.sub(_PLACE, "", message)
    return InputError(
        f"is not TOML: {what[:1].lower()}{what[1:]}",
        key=place[1] if place else None,
        hint="texts and units need quotes" if what.startswith(_UNQUOTED) else None,
    )


def _too_many_digits(text: str) -> InputError:
    longest = max(re.finditer(r"[\d_]+", text), key=lambda found: len(found[0]))
    line = text.count("\n", 0, longest.start()) + 1
    digits = len(longest[0].replace("_", ""))
    what = f"a whole number of {digits:,} digits is too large"
    return InputError(what, key=f"line {line}", hint="write it as a real one, like 1e20")


def _numbers(value: object, path: KeyPath) -> Iterator[tuple[KeyPath, float]]:
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _numbers(item, (*path, key))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from _numbers(item, (*path, index))
    elif isinstance(value, int | float):
        yield path, value


def _check_number(path: KeyPath, number: float) -> None:
    if isinstance(number, float) and not math.isfinite(number):
        raise InputError("must be finite", key=dotted(path), value=number)
    if isinstance(number, int) and abs(number) >= _LARGEST_INTEGER:
        # Not shown: Python refuses to write out an integer of thousands of digits.
        what = "is too large for a whole number"
        raise InputError(what, key=dotted(path), hint="write it as a real one, like 1e20")
