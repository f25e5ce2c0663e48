"""Damping of a basis: a ratio, a list of them, or a table that says the rule."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any, TypeVar

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io.case.fields.plain import Plain, read_list
from bumpstop.io.case.fields.quantities import read_number
from bumpstop.io.units import Dimension
from bumpstop.modal.damping import DampingLaw, RayleighDamping, StructuralDamping

__all__ = ["ModalDamping"]

_RATIO = Dimension("a pure number", "", "0.01")
_RATE = Dimension("a rate", "1/s", "2 1/s")
_TIME = Dimension("a time", "s", "20 us")
_FREQUENCY = Dimension("a frequency", "Hz", "10 Hz")

T = TypeVar("T")


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
    _refuse_unknown(table, rules)
    if len(table) != 1:
        raise InputError("must have one key", value=dict(table), hint=did_you_mean("", rules))
    ((rule, value),) = table.items()
    return _at(rule, rules[rule], value)


def _read_rayleigh(table: object) -> RayleighDamping:
    if not isinstance(table, Mapping):
        hint = "give alpha and beta, or frequencies and ratios"
        raise InputError("must be a table", value=table, hint=hint)
    _refuse_unknown(table, ("alpha", "beta", "frequencies", "ratios"))
    terms = {"alpha": _RATE, "beta": _TIME}
    if "frequencies" in table or "ratios" in table:
        for key in ("frequencies", "ratios"):
            if key not in table:
                raise InputError("is missing", key=key, hint="two frequencies go with two ratios")
        for key in terms:
            if key in table:
                raise InputError("excludes frequencies and ratios", key=key, value=table[key])
        return RayleighDamping.from_ratios(
            frequencies=_at("frequencies", _pair(_FREQUENCY), table["frequencies"]),
            ratios=_at("ratios", _pair(_RATIO), table["ratios"]),
        )
    given = {key: _at(key, _one(unit), table[key]) for key, unit in terms.items() if key in table}
    return RayleighDamping(**given)


def _one(dimension: Dimension) -> Callable[[object], float]:
    return lambda value: read_number(value, dimension, least=0)


def _pair(dimension: Dimension) -> Callable[[object], list[float]]:
    return lambda value: read_list(value, _one(dimension), "numbers", 2)


def _at(key: str, read: Callable[[Any], T], value: object) -> T:
    """Read what stands under a key, and put it before the key of a mistake."""
    try:
        return read(value)
    except InputError as error:
        inner = f"{key}.{error.key}" if error.key else key
        raise InputError(error.what, key=inner, value=error.value, hint=error.hint) from error


def _refuse_unknown(
    table: Mapping[str, Any], known: Mapping[str, object] | tuple[str, ...]
) -> None:
    for key in table:
        if key not in known:
            raise InputError(
                "unknown key", key=key, value=table[key], hint=did_you_mean(key, known)
            )


def _object(**properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "additionalProperties": False}


_NUMBER = {"anyOf": [{"type": "number", "minimum": 0}, {"type": "string"}]}
_PAIR = {"type": "array", "items": _NUMBER, "minItems": 2, "maxItems": 2}
_SCHEMA = {
    "anyOf": [
        *_NUMBER["anyOf"],
        {"type": "array", "items": _NUMBER, "minItems": 1},
        _object(
            rayleigh=_object(
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
