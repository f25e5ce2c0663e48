"""The core's checks of tables, against pydantic's own models of the same tables."""

import tomllib
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from pydantic import BaseModel
from pydantic_core import ValidationError

from bumpstop.io.case.tables.case_file import CaseFile
from bumpstop.io.case.tables.check import checked
from bumpstop.io.case.tables.models import model_of
from bumpstop.io.case.tables.table import Table

CASES = sorted((Path(__file__).parents[2] / "cases").glob("*/case.toml"))
KINDS = {
    "springs": {"s": {"node": "B", "stiffness": 1.0}},
    "bearings": {"b": {"node": "B", "stiffness": 1.0}},
    "loads": {"g": {"type": "gravity", "acceleration": [0, 0, -9.81]}},
    "relations": [{"terms": {"B": {"dx": 1.0}}}],
    "links": {"l": {"nodes": ["A", "B"]}},
    "mesh": {"file": "a.msh", "beams": {"g": {"theory": "bar", "material": "m", "section": "s"}}},
    "modes": {"file": "a.npz"},
}
"""Tables that the cases may lack."""


def plain(value: Any) -> Any:
    """Return tables or models as plain dictionaries."""
    if isinstance(value, Table | BaseModel):
        return {key: plain(item) for key, item in value}
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    return [plain(item) for item in value] if isinstance(value, list) else value


def found(read: Any, document: dict[str, Any]) -> Any:
    """Return what is read, or where the mistakes are and of what kind."""
    try:
        return plain(read(document))
    except ValidationError as error:
        return [(mistake["loc"], mistake["type"]) for mistake in error.errors()]


def by_core(document: dict[str, Any]) -> Any:
    return found(lambda content: checked(CaseFile, content), document)


def by_models(document: dict[str, Any]) -> Any:
    return found(lambda content: model_of(CaseFile).model_validate(content, strict=True), document)


@pytest.mark.parametrize("case", CASES, ids=lambda path: path.parent.name)
def test_they_read_the_same_from_a_case(case: Path) -> None:
    document = tomllib.loads(case.read_text())
    assert isinstance(by_core(document), dict)
    assert by_core(document) == by_models(document)


def test_they_read_the_same_from_rare_tables() -> None:
    document = tomllib.loads(CASES[0].read_text()) | KINDS
    assert isinstance(by_core(document), dict)
    assert by_core(document) == by_models(document)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("wrong", [3, [], {"x": 1}, {"x": {}}, [{"type": "wind"}], [{"y": 0}]])
def test_they_find_the_same_mistakes(kind: str, wrong: object) -> None:
    document = tomllib.loads(CASES[0].read_text()) | deepcopy(KINDS)
    document[kind] = wrong
    document["basis"] = {"mods": 3}
    mistakes = by_core(document)
    assert isinstance(mistakes, list)
    assert mistakes == by_models(document)
