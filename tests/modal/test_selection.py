from __future__ import annotations

import re

import pytest

from bumpstop import InputError
from bumpstop.modal.selection import (
    AllModes,
    LowestModes,
    ModesAround,
    ModesInBand,
    mode_selection,
)


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        (3, LowestModes(3)),
        ("all", AllModes()),
        (ModesInBand(0, 10), ModesInBand(0.0, 10.0)),
        (ModesAround(50, 4), ModesAround(50.0, 4)),
        (LowestModes(2), LowestModes(2)),
    ],
)
def test_what_users_say(said: object, meant: object) -> None:
    assert mode_selection(said) == meant


@pytest.mark.parametrize(
    ("said", "answer"),
    [
        (0, "modes: must be 1 or more (got 0)"),
        (2.5, "modes: must be a whole number (got 2.5)"),
        ("every", "unknown selection of modes (got 'every'); give a number, or \"all\""),
    ],
)
def test_what_cannot_be_meant(said: object, answer: str) -> None:
    with pytest.raises(InputError, match=re.escape(answer)):
        mode_selection(said)


def test_bands_and_shifts_are_checked() -> None:
    with pytest.raises(InputError, match="low: must not be negative"):
        ModesInBand(-1.0, 2.0)
    with pytest.raises(InputError, match="high: must be finite"):
        ModesInBand(0.0, float("inf"))
    with pytest.raises(InputError, match="high: must be above low"):
        ModesInBand(3.0, 3.0)
    with pytest.raises(InputError, match="modes: must be 1 or more"):
        ModesAround(3.0, 0)
