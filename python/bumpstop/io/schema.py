"""JSON schemas of case files and their like, which editors check and complete them with."""

from __future__ import annotations

from typing import Any

from bumpstop.io.case.tables.case_file import CaseFile
from bumpstop.io.case.tables.models import model_of
from bumpstop.io.case.tables.table import Table

__all__ = ["case_schema", "schema_of"]


def case_schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of a case file.

    Examples
    --------
    >>> case_schema()["title"]
    'bumpstop case'
    """
    return schema_of(CaseFile, "bumpstop case")


def schema_of(table: type[Table], title: str) -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of a file that holds what a table says."""
    annotation: Any = table  # to mypy, a class of tables has no hash to cache by
    schema = _without_null(model_of(annotation).model_json_schema())
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **schema,
        "title": title,
    }


def _without_null(part: Any) -> Any:
    """Return a part of the schema without the null that stands for a key left out.

    TOML cannot write it.
    """
    if isinstance(part, list):
        return [_without_null(each) for each in part]
    if not isinstance(part, dict):
        return part
    kept = {
        key: _without_null(value)
        for key, value in part.items()
        if not (key == "default" and value is None)
    }
    kinds = [kind for kind in kept.get("anyOf", ()) if kind != {"type": "null"}]
    if len(kinds) == 1:
        del kept["anyOf"]
        return kinds[0] | kept
    return kept | {"anyOf": kinds} if kinds else kept
