"""load_study: from a path to a Study."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import NamedTuple

from pydantic_core import ValidationError

from bumpstop.errors import InputError
from bumpstop.io.case.document import read_document
from bumpstop.io.case.keys import keyed
from bumpstop.io.case.load import load_case
from bumpstop.io.case.mistakes import first_mistake
from bumpstop.io.case.tables.check import checked
from bumpstop.study.basins import Basins
from bumpstop.study.outputs import Output
from bumpstop.study.sampling import Sampling
from bumpstop.study.study import Study
from bumpstop.study.tables import ExecutionTable, StudyFile, StudyOutputTable

__all__ = ["LoadedStudy", "load_study", "read_study"]


class LoadedStudy(NamedTuple):
    """A study from a file, and how the file wants it to be run."""

    study: Study
    title: str
    store: Path
    workers: int | None


def load_study(path: str | PathLike[str]) -> Study:
    """Read a study file.

    Parameters
    ----------
    path
        The file, in TOML.

    Raises
    ------
    InputError
        If the file, or the case that it names, cannot be read, or something in it is wrong;
        the message names file, key and value, and says how to mend it.
    """
    return read_study(path).study


def read_study(path: str | PathLike[str]) -> LoadedStudy:
    """Read a study file, with how it is to be run; see `load_study`."""
    file = Path(path)
    document = read_document(file)
    try:
        try:
            tables = checked(StudyFile, document)
        except ValidationError as error:
            raise first_mistake(error, StudyFile) from error
        return _loaded(file, tables)
    except InputError as error:
        raise error.located(file=str(file)) from error


def _loaded(file: Path, tables: StudyFile) -> LoadedStudy:
    execution = tables.execution
    case = load_case(file.parent / tables.case)
    with keyed("sampling"):
        table = tables.sampling
        sampling = Sampling() if table is None else Sampling(**dict(table))
    with keyed(renamed={"chunk": "execution.chunk", "count": "sampling.count"}):
        study = Study(
            case,
            tables.parameters,
            _outputs(tables.outputs),
            sampling=sampling,
            variant=tables.variant,
            chunk=None if execution is None else execution.chunk,
            basins=None if tables.basins is None else Basins(**dict(tables.basins)),
        )
    return LoadedStudy(
        study=study,
        title=tables.title or case.title,
        store=_store(file, execution),
        workers=None if execution is None else execution.workers,
    )


def _outputs(tables: Mapping[str, StudyOutputTable]) -> dict[str, Output]:
    outputs = {}
    for name, table in tables.items():
        with keyed(f"outputs.{name}"):
            outputs[name] = Output(**dict(table) | {"times": table.times or ()})
    return outputs


def _store(file: Path, execution: ExecutionTable | None) -> Path:
    if execution is None or execution.store is None:
        return file.with_suffix(".zarr")
    return file.parent / execution.store
