"""Whole numbers and switches."""

from __future__ import annotations

from typing import Annotated

from bumpstop.errors import InputError
from bumpstop.io.case.fields.plain import Plain

__all__ = ["Count", "Switch"]


def _read_count(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise InputError("must be a whole number", value=value)
    if value < 1:
        raise InputError("must be 1 or more", value=value)
    return value


def _read_switch(value: object) -> bool:
    if not isinstance(value, bool):
        raise InputError("must be true or false", value=value)
    return value


Count = Annotated[int, Plain(_read_count, {"type": "integer", "minimum": 1})]
Switch = Annotated[bool, Plain(_read_switch, {"type": "boolean"})]
