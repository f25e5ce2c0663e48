"""No law takes a number that is none: each tells in one line which key it is."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from typing import Any

import pytest

import bumpstop as bs

ALONG: dict[str, Any] = {"node": "P", "direction": (1, 0, 0)}
FACING: dict[str, Any] = {"node": "P", "normal": (1, 0, 0)}
SHAFT = bs.ShaftRotation(50.0)
SQUARE = [(0.0, 0.01), (1.5, 0.01), (3.0, 0.01), (4.5, 0.01)]
BREATHING = [(0.0, 1e5), (1.5, 9e4), (3.0, 5e4), (4.5, 8e4)]
RUBBED: dict[str, Any] = {"friction": 0.2, "tangential_stiffness": 1e4, "tangential_damping": 1.0}
SOUND: dict[str, tuple[Any, dict[str, Any]]] = {
    "Stop": (bs.Stop, FACING | RUBBED | {"stiffness": 1e4, "sliding": (0, 1, 0)}),
    "HertzStop": (bs.HertzStop, FACING | {"stiffness": 1e8}),
    "CircleStop": (
        bs.CircleStop,
        {"node": "P", "stiffness": 1e4, "axis": (0, 0, 1), "radius": 1e-3, "centre": (0, 0, 0)}
        | RUBBED,
    ),
    "PlaneStop": (bs.PlaneStop, FACING | RUBBED | {"stiffness": 1e4}),
    "PolarStop": (
        bs.PolarStop,
        {"node": "P", "stiffness": 1e4, "axis": (0, 0, 1), "profile": SQUARE} | RUBBED,
    ),
    "RigidStop": (
        bs.RigidStop, FACING | {"restitution": 0.5, "friction": 0.2, "sliding": (0, 1, 0)}
    ),
    "BucklingStop": (
        bs.BucklingStop,
        FACING
        | {"stiffness": 1e4, "critical_force": 100.0, "post_force": 50.0, "plateau": 1e-3}
        | {"fall": 1e3, "unloading_stiffness": 8e3},
    ),
    "SeismicDevice": (
        bs.SeismicDevice,
        ALONG | {"first_stiffness": 1e5, "second_stiffness": 1e4, "threshold": 10.0},
    ),
    "ZenerDamper": (
        bs.ZenerDamper, ALONG | {"series_stiffness": 1e5, "branch_stiffness": 1e4, "damping": 1e3}
    ),
    "SpringLaw": (bs.SpringLaw, ALONG | {"stiffness": [1e3, 2e3], "breaks": [0.01]}),
    "DamperLaw": (bs.DamperLaw, ALONG | {"damping": [10.0, 20.0], "breaks": [0.1]}),
    "HardeningSpring": (
        bs.HardeningSpring, ALONG | {"curve": [(1e-3, 100.0), (3e-3, 150.0)]}
    ),
    "CrackedRotor": (
        bs.CrackedRotor,
        {"node": "P", "rotation": SHAFT, "stiffness": BREATHING},
    ),
    "UserLaw": (
        bs.UserLaw,
        ALONG | {"force": lambda *_: 0.0, "further_directions": [(0, 1, 0)]},
    ),
}  # fmt: skip
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
