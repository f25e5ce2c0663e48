"""Which modes of a model are asked for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from bumpstop.arguments import count, finite, not_negative
from bumpstop.errors import InputError

__all__ = [
    "AllModes",
    "LowestModes",
    "ModeSelection",
    "ModesAround",
    "ModesInBand",
    "mode_selection",
]


@dataclass(frozen=True)
class LowestModes:
    """The modes of lowest frequency, rigid ones first.

    Parameters
    ----------
    count
        Number of modes.

    Raises
    ------
    InputError
        If it is not a whole number above zero.
    """

    count: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "count", count("modes", self.count))


@dataclass(frozen=True)
class ModesInBand:
    """All modes from one frequency to another, both included; there may be none.

    Parameters
    ----------
    low, high
        Ends of the band in Hz; rigid modes belong to a band that starts at 0.

    Raises
    ------
    InputError
        If an end is negative or not finite, or ``high`` is not above ``low``.

    Examples
    --------
    >>> ModesInBand(100.0, 50.0)
    Traceback (most recent call last):
    bumpstop.errors.InputError: high: must be above low, 100.0 Hz (got 50.0)
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "low", not_negative("low", self.low))
        object.__setattr__(self, "high", finite("high", self.high))
        if self.high <= self.low:
            what = f"must be above low, {self.low} Hz"
            raise InputError(what, key="high", value=self.high)


@dataclass(frozen=True)
class ModesAround:
    """The modes nearest to a frequency, in ascending order.

    Nearest is measured in squared frequency, in which a model's eigenvalues are linear.

    Parameters
    ----------
    frequency
        In Hz.
    count
        Number of modes.

    Raises
    ------
    InputError
        If the frequency is negative or not finite, or the count not a whole number above zero.
    """

    frequency: float
    count: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "frequency", not_negative("frequency", self.frequency))
        object.__setattr__(self, "count", count("modes", self.count))


@dataclass(frozen=True)
class AllModes:
    """Every mode of a model: as many as it has free dofs. Meant for small models."""


ModeSelection: TypeAlias = LowestModes | ModesInBand | ModesAround | AllModes


def mode_selection(value: object) -> ModeSelection:
    """Return what a user's ``modes=`` asks for: a number, ``"all"``, or a selection itself.

    Raises
    ------
    InputError
        If it is none of these, or the number is not a whole one above zero.

    Examples
    --------
    >>> mode_selection(10)
    LowestModes(count=10)
    >>> mode_selection("all")
    AllModes()
    >>> mode_selection(ModesInBand(0.0, 250.0))
    ModesInBand(low=0.0, high=250.0)
    """
    if isinstance(value, LowestModes | ModesInBand | ModesAround | AllModes):
        return value
    if isinstance(value, str):
        if value == "all":
            return AllModes()
        hint = 'give a number, or "all"'
        raise InputError("unknown selection of modes", key="modes", value=value, hint=hint)
    return LowestModes(count("modes", value))
