"""Damping of a basis: a ratio, a list of them, or a table that says the rule."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io.case.fields.nested import object_schema, read_at, refuse_unknown
from bumpstop.io.case.fields.plain import Plain, read_list
from bumpstop.io.case.fields.quantities import read_number
from bumpstop.io.units import Dimension
from bumpstop.modal.damping import DampingLaw, RayleighDamping, StructuralDamping

__all__ = ["ModalDamping"]

_RATIO = Dimension("a pure number", "", "0.01")
_RATE = Dimension("a rate", "1/s", "2 1/s")
_TIME = Dimension("a time", "s", "20 us")
_FREQUENCY = Dimension("a frequency", "Hz", "10 Hz")


def _read_damping(value: object) -> float | list[float] | DampingLaw:
    if isinstance(value, Mapping):
        return _read_rule(value)
    if isinstance(value, list):
        return read_list(value, _read_ratio, "numbers")
    return _read_ratio(value)


def _read_ratio(value: object) -> float:
    return read_number(value, _RATIO, least=0)


def _read_rule(table: Mapping[str, Any]) -> DampingLaw:
    rules: dict[str, Callable[[Any], DampingLaw]] = {
        "rayleigh": _read_rayleigh,
        "structural": lambda value: StructuralDamping(_read_ratio(value)),
    }
    refuse_unknown(table, rules)
    if len(table) != 1:
        raise InputError("must have one key", value=dict(table), hint=did_you_mean("", rules))
    ((rule, value),) = table.items()
    return read_at(rule, rules[rule], value)


def _read_rayleigh(table: object) -> RayleighDamping:
    if not isinstance(table, Mapping):
        hint = "give alpha and beta, or frequencies and ratios"
        raise InputError("must be a table", value=table, hint=hint)
    refuse_unknown(table, ("alpha", "beta", "frequencies", "ratios"))
    terms = {"alpha": _RATE, "beta": _TIME}
    if "frequencies" in table or "ratios" in table:
        for key in ("frequencies", "ratios"):
            if key not in table:
                raise InputError("is missing", key=key, hint="two frequencies go with two ratios")
        for key in terms:
            if key in table:
                raise InputError("excludes frequencies and ratios", key=key, value=table[key])
        return RayleighDamping.from_ratios(
            frequencies=read_at("frequencies", _pair(_FREQUENCY), table["frequencies"]),
            ratios=read_at("ratios", _pair(_RATIO), table["ratios"]),
        )
    given = {
        key: read_at(key, _one(unit), table[key]) for key, unit in terms.items() if key in table
    }
    return RayleighDamping(**given)


def _one(dimension: Dimension) -> Callable[[object], float]:
    return lambda value: read_number(value, dimension, least=0)


def _pair(dimension: Dimension) -> Callable[[object], list[float]]:
    return lambda value: read_list(value, _one(dimension), "numbers", 2)


_NUMBER = {"anyOf": [{"type": "number", "minimum": 0}, {"type": "string"}]}
_PAIR = {"type": "array", "items": _NUMBER, "minItems": 2, "maxItems": 2}
_SCHEMA = {
    "anyOf": [
        *_NUMBER["anyOf"],
        {"type": "array", "items": _NUMBER, "minItems": 1},
        object_schema(
            rayleigh=object_schema(
                alpha=_NUMBER | {"description": "Damping by mass, in 1/s"},
                beta=_NUMBER | {"description": "Damping by stiffness, in s"},
                frequencies=_PAIR | {"description": "Two frequencies, in Hz"},
                ratios=_PAIR | {"description": "Damping ratios at these frequencies"},
            ),
            structural=_NUMBER | {"description": "Loss factor"},
        ),
    ],
    "examples": [0.01],
}

ModalDamping = Annotated[float | list[float] | DampingLaw, Plain(_read_damping, _SCHEMA)]
