"""The JSON schema of case files, which editors check and complete them with."""

from __future__ import annotations

from typing import Any

from bumpstop.io.case.tables.case_file import CaseFile
from bumpstop.io.case.tables.models import model_of

__all__ = ["case_schema"]


def case_schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of a case file.

    Examples
    --------
    >>> case_schema()["title"]
    'bumpstop case'
    """
    schema = _without_null(model_of(CaseFile).model_json_schema())
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **schema,
        "title": "bumpstop case",
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
