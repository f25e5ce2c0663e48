"""Points along beams, by name: ``"AB@0.462"`` or ``"AB@46.2 cm"``."""

from __future__ import annotations

import math

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError

__all__ = ["beam_point"]

_METRES = {
    "": 1.0,
    "m": 1.0,
    "km": 1e3,
    "cm": 1e-2,
    "mm": 1e-3,
    "um": 1e-6,
    "in": 0.0254,
    "ft": 0.3048,
}


def beam_point(point: str, key: str = "node") -> tuple[str, float] | None:
    """Return the beam and the distance from its first node in m; None for a plain node.

    Raises
    ------
    InputError
        If what follows the ``@`` is not a length.

    Examples
    --------
    >>> beam_point("AB@0.462"), beam_point("AB@462 mm"), beam_point("B")
    (('AB', 0.462), ('AB', 0.462), None)
    """
    beam, is_point, place = point.partition("@")
    return (beam.strip(), _length(place, point, key)) if is_point else None


def _length(text: str, point: str, key: str) -> float:
    number, unit = _split(text.strip())
    try:
        length = float(number)
    except ValueError:
        length = math.nan
    if not math.isfinite(length):
        what, hint = "not a length after '@'", "write a point as 'AB@0.462' or 'AB@0.462 m'"
        raise InputError(what, key=key, value=point, hint=hint)
    if unit not in _METRES:
        hint = did_you_mean(unit, [known for known in _METRES if known])
        raise InputError("unknown unit of length", key=key, value=point, hint=hint)
    return length * _METRES[unit]


def _split(text: str) -> tuple[str, str]:
    """Return the number and the unit of ``"46.2 cm"``."""
    number = text.rstrip("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ")
    return number, text[len(number) :]
