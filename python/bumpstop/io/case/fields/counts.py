"""Whole numbers and switches."""

from __future__ import annotations

from typing import Annotated

from bumpstop.errors import InputError
from bumpstop.io.case.fields.plain import Plain

__all__ = ["Count", "CountFromZero", "Switch"]


def _count(least: int) -> Plain:
    """Return a field of whole numbers that are ``least`` or above."""

    def read(value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            raise InputError("must be a whole number", value=value)
        if value < least:
            raise InputError(f"must be {least} or more", value=value)
        return value

    return Plain(read, {"type": "integer", "minimum": least})


def _read_switch(value: object) -> bool:
    if not isinstance(value, bool):
        raise InputError("must be true or false", value=value)
    return value


Count = Annotated[int, _count(1)]
CountFromZero = Annotated[int, _count(0)]
Switch = Annotated[bool, Plain(_read_switch, {"type": "boolean"})]
