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
    schema = model_of(CaseFile).model_json_schema()
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **schema,
        "title": "bumpstop case",
    }
