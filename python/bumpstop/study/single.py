"""One run of a study as a case of its own, to be opened, looked at and changed."""

from __future__ import annotations

import os
from collections.abc import Container
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.arguments import count
from bumpstop.errors import InputError
from bumpstop.files import written_whole
from bumpstop.io.case.overrides import overridden
from bumpstop.io.case.written import toml_text
from bumpstop.study.layout import STATE, worded
from bumpstop.study.store import check_definition, read_store

if TYPE_CHECKING:
    from bumpstop.study.study import Study

__all__ = ["checked_start", "write_case"]


def write_case(
    study: Study,
    run: int,
    path: str | os.PathLike[str],
    *,
    store: str | os.PathLike[str] | None = None,
) -> Path:
    """Write a run of a study as a case file.

    Parameters
    ----------
    study
        The study.
    run
        Which of its runs, counted from 0.
    path
        The file. One of that name is replaced.
    store
        The study's store, which the study must be that of. It is needed where runs follow one
        another, since it has the state that the run starts from, and where the worst case is
        searched for: it has the values of the parameters.

    Returns
    -------
    Path
        The file; `load_case` makes a case of it whose only variant is the run, to the bit.

    Raises
    ------
    InputError
        If there is no such run, a value cannot be put into the case, the store does not have
        its start or is of another study, or the file cannot be written.
    """
    start = checked_start(study, run, store)
    file = Path(path)
    values = study.runs.row(run)
    changed = overridden(study.document, dict(values)) | start
    document = {
        "title": f"{study.case.title}: run {run} of a study",
        "description": "\n".join(f"{name} = {value}" for name, value in values.items()),
        **_moved(changed, study.files, study.case.path.parent.absolute(), file.absolute().parent),
    }
    with written_whole(file) as part:
        part.write_text(toml_text(document), encoding="utf-8")
    return file


def checked_start(
    study: Study, run: int, store: str | os.PathLike[str] | None = None
) -> dict[str, Any]:
    """Return what a run's case has of its start, where the run before it tells; else nothing.

    A run of a search gets the values of its parameters from the store, where it has not been made
    by this study.

    Raises
    ------
    InputError
        If there is no such run, the store does not have its start or its values, or is of another
        study, such as this one before it was changed.
    """
    if count("run", run, least=0) >= study.runs.count:
        what = f"the study has runs 0 to {study.runs.count - 1}"
        raise InputError(what, key="run", value=run)
    if store is not None and Path(store).exists():
        check_definition(Path(store), study.definition)
    if run >= study.runs.known:
        _read_values(study, run, store)
    if not study.follows or run % (study.layout.count // 2) == 0:
        return {}
    if store is None:
        what = "starts where another run has ended, which the study's store knows"
        raise InputError(what, key="run", value=run, hint="name the store")
    _, _, read = read_store(Path(store))
    if not read("status", slice(run - 1, run)).any():
        raise InputError("the run before it has not been made", key="run", value=run)
    state = [read(name, slice(run - 1, run))[0] for name in STATE]
    if np.isnan(state).any():
        return {}
    displacement, velocity = (each.tolist() for each in state)
    return {"initial": {"modal": {"displacement": displacement, "velocity": velocity}}}


def _read_values(study: Study, run: int, store: str | os.PathLike[str] | None) -> None:
    """Take the values of the parameters in the runs of a search from its store."""
    if store is None:
        what = "has values that the search told, which the study's store knows"
        raise InputError(what, key="run", value=run, hint="name the store")
    _, arrays, read = read_store(Path(store))
    made = read("status")
    if run >= len(made) or not made[run]:
        raise InputError("has not been made", key="run", value=run)
    known = slice(0, int(np.count_nonzero(made)))
    columns = {
        name: worded(read(name, known), arrays[name].attributes) for name in study.parameters
    }
    study.runs.tell(0, columns)


def _moved(part: Any, files: Container[str], old: Path, new: Path) -> Any:
    """Return a document whose files are found from another folder, too."""
    if isinstance(part, dict):
        return {key: _moved(each, files, old, new) for key, each in part.items()}
    if isinstance(part, list):
        return [_moved(each, files, old, new) for each in part]
    if isinstance(part, str) and part in files:
        return Path(os.path.relpath(old / part, new)).as_posix()
    return part
