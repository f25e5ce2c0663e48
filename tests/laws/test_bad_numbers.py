"""No law takes a number that is none: each tells in one line which key it is."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from typing import Any

import pytest

import bumpstop as bs

from .sound import SOUND

WRONG = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf, "text": "much", "none": None}


def numbers(value: Any) -> Iterator[tuple[int, ...]]:
    """Yield where numbers stand in nested lists."""
    if isinstance(value, bool | str) or value is None:
        return
    if isinstance(value, int | float):
        yield ()
    elif isinstance(value, list | tuple):
        for place, each in enumerate(value):
            yield from ((place, *inner) for inner in numbers(each))


def put(value: Any, place: tuple[int, ...], other: Any) -> Any:
    """Return nested lists with something else at a place."""
    if not place:
        return other
    first, *rest = place
    return [put(each, tuple(rest), other) if n == first else each for n, each in enumerate(value)]


def everywhere() -> Iterator[tuple[str, str, tuple[int, ...]]]:
    """Yield each number of each law: those that are given, and those that may be."""
    for name, (law, given) in SOUND.items():
        made = law("law", **given)
        for field in dataclasses.fields(law):
            value = given.get(field.name, getattr(made, field.name))
            if field.name not in ("rotation", "name"):
                yield from ((name, field.name, place) for place in numbers(value))


@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize(("name", "key", "place"), list(everywhere()))
def test_what_is_no_number_is_refused_by_its_key(
    name: str, key: str, place: tuple[int, ...], wrong: str
) -> None:
    law, given = SOUND[name]
    sound = law("law", **given)
    if wrong == "none" and not place and _may_be_none(law, key):
        return
    value = put(given.get(key, getattr(sound, key)), place, WRONG[wrong])
    with pytest.raises(bs.InputError) as told:
        law("law", **given | {key: value})
    assert "\n" not in str(told.value)
    assert key in str(told.value)


def _may_be_none(law: Any, key: str) -> bool:
    (field,) = (field for field in dataclasses.fields(law) if field.name == key)
    return "None" in str(field.type)
