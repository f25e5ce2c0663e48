"""The JSON schema of study files."""

from __future__ import annotations

from typing import Any

from bumpstop.io.schema import schema_of
from bumpstop.study.tables import StudyFile

__all__ = ["study_schema"]


def study_schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of a study file.

    Examples
    --------
    >>> study_schema()["required"]
    ['case', 'parameters']
    """
    return schema_of(StudyFile, "bumpstop study")
