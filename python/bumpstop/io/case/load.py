"""load_case: from a path to a Case."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from pydantic_core import ValidationError

from bumpstop.errors import InputError
from bumpstop.io.case.build import Builder
from bumpstop.io.case.case import Case, Method, MethodOptions
from bumpstop.io.case.document import read_document
from bumpstop.io.case.keys import dotted
from bumpstop.io.case.mistakes import first_mistake
from bumpstop.io.case.overrides import overridden, overridden_paths
from bumpstop.io.case.references import build_references
from bumpstop.io.case.tables.case_file import CaseFile
from bumpstop.io.case.tables.check import checked
from bumpstop.io.case.tables.run import RunTable
from bumpstop.modal.basis import ModalBasis
from bumpstop.problem import Problem

if TYPE_CHECKING:
    from bumpstop.post.results.reading import Result

__all__ = ["checked_tables", "load_case", "method_of", "with_components"]

BASE = "base"
"""Name of the one variant of a case without variants."""


def load_case(path: str | PathLike[str]) -> Case:
    """Read a case file.

    Parameters
    ----------
    path
        The file, in TOML; ``bumpstop schema`` prints its keys.

    Raises
    ------
    InputError
        If the file cannot be read or something in it is wrong; the message names the file,
        the key and the value, and says how to mend it.
    """
    file = Path(path)
    document = read_document(file)
    try:
        with np.errstate(over="raise", invalid="raise", divide="raise"):
            return _case(file, document)
    except InputError as error:
        raise error.located(file=str(file)) from error
    except (OverflowError, FloatingPointError) as error:
        what = "holds a number that is too large or too small to compute with"
        raise InputError(what, file=str(file), hint="check the units") from error
    except RecursionError as error:
        raise InputError("is nested too deeply", file=str(file)) from error


def _case(file: Path, document: dict[str, Any]) -> Case:
    whole = with_components(document, file.parent)
    base = checked_tables(whole)
    documents = _documents(document, base, file.parent) or {BASE: whole}
    variants = _variants(documents, base, file.parent)
    bases, problems = _built(variants, base, file.parent)
    method = method_of(base.run) if base.run is not None else Method("auto", {})
    name = _readable(file.absolute().parent.name)
    return Case(
        name=name,
        title=base.title or name,
        description=base.description,
        path=file,
        bases=bases,
        problems=problems,
        references=build_references(base.references, bases, problems),
        methods={
            variant: method_of(tables.run) for variant, tables in variants.items() if tables.run
        },
        method=method.name,
        method_options=method.options,
        exports={variant: tables.run.export for variant, tables in variants.items() if tables.run},
        results=_results(variants, base, problems, file.parent),
        documents=documents,
    )


def with_components(document: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return a file's content with the structures of other files that its components name."""
    if "components" not in document:
        return document
    from bumpstop.io.case.component_files import with_component_files

    return with_component_files(document, folder)


def checked_tables(document: dict[str, Any]) -> CaseFile:
    """Return the tables of a file's content.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value cannot be used.
    """
    try:
        return checked(CaseFile, document)
    except ValidationError as error:
        raise first_mistake(error, CaseFile) from error


def _readable(name: str) -> str:
    """Return a file's name as text that can be written: what is not UTF-8 in it is replaced."""
    return os.fsencode(name).decode(errors="replace")


def method_of(run: RunTable) -> Method:
    """Return how the time of a case is integrated."""
    given = {name: getattr(run, name) for name in MethodOptions.__annotations__}
    options = {name: value for name, value in given.items() if value is not None}
    return Method(run.method, cast(MethodOptions, options))


def _documents(document: dict[str, Any], base: CaseFile, folder: Path) -> dict[str, dict[str, Any]]:
    """Return what the file says of each variant."""
    documents = {}
    for name, changes in base.variants.items():
        with _in_variant(name, base, folder):
            documents[name] = with_components(overridden(document, changes), folder)
    return documents


def _variants(
    documents: dict[str, dict[str, Any]], base: CaseFile, folder: Path
) -> dict[str, CaseFile]:
    """Return the tables of each variant; the case alone where there is none."""
    if not base.variants:
        return {BASE: base}
    variants = {}
    for name, document in documents.items():
        with _in_variant(name, base, folder):
            variants[name] = checked_tables(document)
            if base.run is None and variants[name].run is not None:
                hint = "give [run] in the case itself"
                raise InputError("is given in a variant alone", key="run", hint=hint)
    return variants


def _built(
    variants: dict[str, CaseFile], base: CaseFile, folder: Path
) -> tuple[dict[str, ModalBasis], dict[str, Problem]]:
    """Return the modes of each variant, and the problem of each that runs."""
    builder = Builder(folder)
    bases, problems = {}, {}
    for name, tables in variants.items():
        with _in_variant(name, base, folder):
            bases[name], problem = builder.variant(tables)
            if problem is not None:
                problems[name] = problem
    return bases, problems


def _results(
    variants: dict[str, CaseFile], base: CaseFile, problems: dict[str, Problem], folder: Path
) -> dict[str, list[Result]]:
    """Return what else each variant is asked for."""
    found = {}
    for name, tables in variants.items():
        if tables.results:
            from bumpstop.io.case.build.results import built_results

            with _in_variant(name, base, folder):
                found[name] = built_results(tables, problems[name])
    return found


@contextmanager
def _in_variant(name: str, base: CaseFile, folder: Path) -> Iterator[None]:
    """Say in which variant a key is wrong, unless the case without it is wrong as well."""
    try:
        yield
    except InputError as error:
        if name not in base.variants or error.file:
            raise
        key = error.key or ""
        if not _changed(key, base.variants[name]):
            Builder(folder).variant(base)
        quoted = key if key.startswith('"') else f'"{key}"'
        raise InputError(
            error.what, key=f"variants.{name}.{quoted}", value=error.value, hint=error.hint
        ) from error


def _changed(key: str, changes: dict[str, Any]) -> bool:
    """Tell whether a variant names this key."""
    paths = [dotted(path) for path in overridden_paths(changes)]
    return key.startswith('"') or any(f"{key}.".startswith(f"{path}.") for path in paths)
