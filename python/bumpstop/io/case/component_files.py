"""Components whose structure stands in a case file of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic_core import ValidationError

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io.case.document import read_document
from bumpstop.io.case.mistakes import first_mistake
from bumpstop.io.case.tables.case_file import CaseFile
from bumpstop.io.case.tables.check import checked
from bumpstop.io.case.tables.structure import StructureTables
from bumpstop.io.case.tables.table import keys_of

__all__ = ["with_component_files"]


def with_component_files(document: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return a case's content with the structures of other files in its components.

    What a component says itself changes or adds to what its file says. What is no table or
    no file's name is left as it is, for the checks of the whole to find.

    Parameters
    ----------
    document
        Content of the case file. It is left as it is.
    folder
        Where the case file is.

    Raises
    ------
    InputError
        If another file cannot be read or its structure is wrong; the error names that file.
    """
    components = document.get("components")
    if not isinstance(components, dict):
        return document
    filled = {name: _with_file(table, folder) for name, table in components.items()}
    return {**document, "components": filled}


def _with_file(component: Any, folder: Path) -> Any:
    if not isinstance(component, dict) or not isinstance(component.get("file"), str):
        return component
    return _merged(_structure(folder / component["file"]), component)


def _structure(file: Path) -> dict[str, Any]:
    """Return the tables of the structure in a case file, checked by themselves."""
    document = read_document(file)
    known = keys_of(CaseFile)
    tables = {key: document[key] for key in keys_of(StructureTables) if key in document}
    try:
        for key, value in document.items():
            if key not in known:
                raise InputError("unknown key", key=key, value=value, hint=did_you_mean(key, known))
        if "nodes" not in tables:
            what = "has no structure of its own that could be a component"
            raise InputError(what, key="nodes", hint="only nodes, and what stands on them, count")
        checked(StructureTables, tables)
    except ValidationError as error:
        raise first_mistake(error, StructureTables).located(file=str(file)) from error
    except InputError as error:
        raise error.located(file=str(file)) from error
    return tables


def _merged(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """Return a table with another's values over its own, tables in it likewise."""
    merged = dict(base)
    for key, value in changes.items():
        old = base.get(key)
        if isinstance(old, dict) and isinstance(value, dict):
            merged[key] = _merged(old, value)
        else:
            merged[key] = value
    return merged
