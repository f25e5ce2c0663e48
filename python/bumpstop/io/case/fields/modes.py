"""Which modes a basis has: a number of them, all, those of a band or around a frequency."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from bumpstop.errors import InputError
from bumpstop.io.case.fields.nested import object_schema, read_at, refuse_unknown
from bumpstop.io.case.fields.plain import Plain, read_list
from bumpstop.io.case.fields.quantities import read_number
from bumpstop.io.units import Dimension
from bumpstop.modal.selection import (
    AllModes,
    LowestModes,
    ModesAround,
    ModeSelection,
    ModesInBand,
)

__all__ = ["Band", "Modes"]

_FREQUENCY = Dimension("a frequency", "Hz", "120 Hz")


def _read_modes(value: object) -> ModeSelection:
    if isinstance(value, Mapping):
        return _read_table(value)
    if value == "all":
        return AllModes()
    if isinstance(value, bool) or not isinstance(value, int):
        hint = "or a table: { band = [0, 500] }, { around = 120, count = 5 }"
        raise InputError('must be a whole number, or "all"', value=value, hint=hint)
    return LowestModes(_read_count(value))


def _read_table(table: Mapping[str, Any]) -> ModeSelection:
    refuse_unknown(table, ("band", "around", "count"))
    if "band" in table:
        for key in ("around", "count"):
            if key in table:
                raise InputError("excludes band", key=key, value=table[key])
        return ModesInBand(*read_at("band", _read_band, table["band"]))
    for key in ("around", "count"):
        if key not in table:
            hint = "give { band = [0, 500] } or { around = 120, count = 5 }"
            raise InputError("is missing", key=key, hint=hint)
    return ModesAround(
        frequency=read_at("around", _read_frequency, table["around"]),
        count=read_at("count", _read_count, table["count"]),
    )


def _read_band(value: object) -> tuple[float, float]:
    low, high = read_list(value, _read_frequency, "frequencies", 2)
    if high <= low:
        raise InputError("must end above its start", value=value)
    return low, high


def _read_count(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise InputError("must be a whole number", value=value)
    if value < 1:
        raise InputError("must be 1 or more", value=value)
    return value


def _read_frequency(value: object) -> float:
    return read_number(value, _FREQUENCY, least=0)


_COUNT = {"type": "integer", "minimum": 1}
_HERTZ = {"anyOf": [{"type": "number", "minimum": 0}, {"type": "string"}]}
_BAND = {"type": "array", "items": _HERTZ, "minItems": 2, "maxItems": 2}
_SCHEMA: dict[str, Any] = {
    "anyOf": [
        _COUNT,
        {"const": "all"},
        object_schema(band=_BAND | {"description": "All modes between two frequencies, in Hz"})
        | {"required": ["band"]},
        object_schema(
            around=_HERTZ | {"description": "The modes nearest to a frequency, in Hz"},
            count=_COUNT | {"description": "How many of them"},
        )
        | {"required": ["around", "count"]},
    ],
    "examples": [10],
}

Band = Annotated[tuple[float, float], Plain(_read_band, _BAND)]
Modes = Annotated[ModeSelection, Plain(_read_modes, _SCHEMA)]
