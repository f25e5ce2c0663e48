"""Ways to spoil a case file: each key in turn, and values that cannot be right."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from copy import deepcopy
from itertools import product
from typing import Any, NamedTuple

Path = tuple[str | int, ...]
Document = dict[str, Any]

OPTIONAL = {
    ("title",),
    ("beams", "AB", "theory"),
    ("basis", "damping"),
    ("stops", "spring", "obstacle"),
    ("stops", "spring", "gap"),
    ("run", "method"),
    ("run", "dt"),
    ("run", "sample"),
    ("references", 0, "variant"),
    ("references", 0, "source"),
    ("initial",),
    ("gauges",),
    ("variants",),
    ("references",),
    ("supports",),
    ("stops", "spring", "stiffness"),  # each variant has its own
}
"""Keys that a case can do without, among those of the file that is spoilt."""

POSITIVE: list[Path] = [
    ("materials", "alloy", "young_modulus"),
    ("materials", "alloy", "density"),
    ("sections", "bar", "height"),
    ("sections", "bar", "width"),
    ("beams", "AB", "elements"),
    ("basis", "modes"),
    ("stops", "spring", "stiffness"),
    ("run", "duration"),
    ("run", "dt"),
    ("run", "sample"),
    ("references", 0, "tolerance"),
]

NOT_NEGATIVE: list[Path] = [("basis", "damping"), ("gauges", "strain", "at")]

NUMBERS = [
    *POSITIVE,
    *NOT_NEGATIVE,
    ("nodes", "B", 0),
    ("materials", "alloy", "poisson_ratio"),
    ("stops", "spring", "normal", 1),
    ("stops", "spring", "gap"),
    ("initial", "rotation", "rate", 2),
    ("gauges", "strain", "fibre", 0),
    ("references", 0, "times", 3),
    ("references", 0, "values", 3),
]

LISTS = [
    ("nodes", "B"),
    ("beams", "AB", "nodes"),
    ("supports", 1, "nodes"),
    ("supports", 1, "fixed"),
    ("stops", "spring", "normal"),
    ("initial", "rotation", "rate"),
    ("gauges", "strain", "fibre"),
    ("references", 0, "times"),
    ("references", 0, "values"),
]

WORDS = [
    ("sections", "bar", "shape"),
    ("beams", "AB", "theory"),
    ("beams", "AB", "material"),
    ("beams", "AB", "section"),
    ("beams", "AB", "nodes", 1),
    ("supports", 1, "nodes", 0),
    ("supports", 1, "fixed", 0),
    ("stops", "spring", "node"),
    ("stops", "spring", "obstacle"),
    ("initial", "rotation", "about"),
    ("gauges", "strain", "beam"),
    ("run", "method"),
    ("references", 0, "variant"),
    ("references", 0, "quantity"),
    ("references", 0, "node"),
    ("references", 0, "dof"),
]

NO_NUMBERS: list[Any] = [math.nan, math.inf, "much", True, {}, [1.0], "3 kg*K"]
NO_LISTS: list[Any] = [3, "Z", [], [[]], {}]
NO_WORDS: list[Any] = ["bogus", "", 3, ["A"]]

UNFITTING: list[tuple[Path, Any]] = [
    (("nodes", "B"), [0.783, 0.0]),
    (("nodes", "B"), [0.783, 0.0, 0.0, 0.0]),
    (("materials", "alloy", "poisson_ratio"), 0.6),
    (("beams", "AB", "elements"), 2.5),
    (("beams", "AB", "elements"), 10**7),
    (("beams", "AB", "nodes"), ["A", "A"]),  # a beam of zero length
    (("basis", "modes"), 22),  # one more than the free dofs
    (("basis", "damping"), [0.01, 0.01]),
    (("stops", "spring", "normal"), [0, 0, 0]),
    (("stops", "spring", "node"), "AB@0.8"),  # beyond the beam
    (("stops", "spring", "node"), "AB@x"),
    (("gauges", "strain", "at"), 0.8),
    (("gauges", "strain", "fibre"), [0.1, 0.0]),
    (("run", "sample"), 1.0),
    (("run", "sample"), 1e-12),
    (("references", 0, "times"), [2e-3, 1e-3]),
    (("references", 0, "times", 11), 1.0),  # after the end of the run
    (("references", 0, "times"), [1e-3]),  # fewer than values
    (("variants", "soft", "stops.spring.stiffness"), "18 kN/m2"),
    (("variants", "soft", "stops.spring.stiffness"), -1.0),
    (("variants", "soft", "stops.spring.stifness"), 18e3),
    (("variants", "soft", "stops.sprnig.stiffness"), 18e3),
    (("variants", "soft", "stops.spring.normal.3"), 1.0),
    (("variants", "soft", "supports.7.fixed"), ["dx"]),
    (("variants", "soft", "references.0.tolerance"), 1.0),
    (("variants", "so ft"), {}),
]


class Mutation(NamedTuple):
    """A spoilt case file, and what the message must say."""

    name: str
    document: Document
    says: list[str]


def mutations(document: Document) -> Iterator[Mutation]:
    """Yield every way of spoiling a document that is known here."""
    for path in _keys(document, ()):
        if path not in OPTIONAL:
            yield _removed(document, path)
        yield _misspelt(document, path)
    unfitting = [
        *product(NUMBERS, NO_NUMBERS),
        *product(POSITIVE, [0]),
        *product(POSITIVE + NOT_NEGATIVE, [-1]),
        *product(LISTS, NO_LISTS),
        *product(WORDS, NO_WORDS),
        *UNFITTING,
    ]
    for path, value in unfitting:
        yield _replaced(document, path, value)


def _keys(value: Any, path: Path) -> Iterator[Path]:
    """Yield the paths of all keys, of tables too, but not names that the case chose itself."""
    if isinstance(value, dict):
        for key, item in value.items():
            if path[:1] == ("variants",):
                continue
            if not (len(path) == 1 and path[0] in NAMED):
                yield (*path, key)
            yield from _keys(item, (*path, key))
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        yield from _keys(value[0], (*path, 0))


NAMED = {"nodes", "materials", "sections", "beams", "stops", "gauges", "variants"}


def _removed(document: Document, path: Path) -> Mutation:
    spoilt = deepcopy(document)
    del _holder(spoilt, path)[path[-1]]
    return Mutation(f"without {_dotted(path)}", spoilt, [_what_misses(path)])


def _what_misses(path: Path) -> str:
    """Return what the message names: the key, or whatever needs the table that is gone."""
    needed_by: dict[Path, str] = {
        ("materials",): "beams.AB.material",
        ("sections",): "beams.AB.section",
        ("beams",): "nodes.A",
        ("stops",): 'variants.soft."stops.spring.stiffness"',
        ("initial", "rotation"): "initial",
    }
    return needed_by.get(path, _dotted(path))


def _misspelt(document: Document, path: Path) -> Mutation:
    right = str(path[-1])
    wrong = right[:-2] + right[-1] if len(right) > 3 else right + "x"
    spoilt = deepcopy(document)
    holder = _holder(spoilt, path)
    holder[wrong] = holder.pop(right)
    says = [_dotted((*path[:-1], wrong)), f"did you mean '{right}'?"]
    return Mutation(f"{_dotted(path)} misspelt", spoilt, says)


def _replaced(document: Document, path: Path, value: Any) -> Mutation:
    spoilt = deepcopy(document)
    _holder(spoilt, path)[path[-1]] = value
    says = [_where(path)]
    if not isinstance(value, dict | list) and path[0] != "variants":
        says.append(repr(value))
    return Mutation(f"{_dotted(path)} = {toml_value(value)}", spoilt, says)


def _where(path: Path) -> str:
    """Return how a message names a place: a variant's key in quotes, a name without its index."""
    if path[0] == "variants":
        return ".".join(part if part.isalpha() else f'"{part}"' for part in map(str, path))
    return _dotted(path[:-1] if path in WORDS and isinstance(path[-1], int) else path)


def _holder(document: Document, path: Path) -> Any:
    holder: Any = document
    for part in path[:-1]:
        holder = holder[part]
    return holder


def _dotted(path: Path) -> str:
    return ".".join(str(part) for part in path)


def toml_text(document: Document) -> str:
    """Return a document as TOML: a table a line, the rest inline."""
    return "".join(f"{toml_key(key)} = {toml_value(value)}\n" for key, value in document.items())


def toml_key(key: str) -> str:
    """Return a key in quotes."""
    return json.dumps(key, ensure_ascii=False)


def toml_value(value: Any) -> str:
    """Return a value as TOML writes it inline."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, dict):
        pairs = (f"{toml_key(key)} = {toml_value(item)}" for key, item in value.items())
        return "{" + ", ".join(pairs) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    return repr(value)
