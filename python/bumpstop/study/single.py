"""One run of a study as a case of its own, to be opened, looked at and changed."""

from __future__ import annotations

import os
from collections.abc import Container
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bumpstop.arguments import count
from bumpstop.errors import InputError
from bumpstop.files import written_whole
from bumpstop.io.case.overrides import overridden
from bumpstop.io.case.written import toml_text

if TYPE_CHECKING:
    from bumpstop.study.study import Study

__all__ = ["check_run", "write_case"]


def write_case(study: Study, run: int, path: str | os.PathLike[str]) -> Path:
    """Write a run of a study as a case file.

    Parameters
    ----------
    study
        The study.
    run
        Which of its runs, counted from 0.
    path
        The file. One of that name is replaced.

    Returns
    -------
    Path
        The file; `load_case` makes a case of it whose only variant is the run, to the bit.

    Raises
    ------
    InputError
        If there is no such run, a value cannot be put into the case, or the file cannot be
        written.
    """
    check_run(study, run)
    file = Path(path)
    values = study.runs.row(run)
    changed = overridden(study.document, dict(values))
    document = {
        "title": f"{study.case.title}: run {run} of a study",
        "description": "\n".join(f"{name} = {value}" for name, value in values.items()),
        **_moved(changed, study.files, study.case.path.parent.absolute(), file.absolute().parent),
    }
    with written_whole(file) as part:
        part.write_text(toml_text(document), encoding="utf-8")
    return file


def check_run(study: Study, run: int) -> None:
    """Raise `InputError` where a study has no such run."""
    if count("run", run, least=0) >= study.runs.count:
        what = f"the study has runs 0 to {study.runs.count - 1}"
        raise InputError(what, key="run", value=run)


def _moved(part: Any, files: Container[str], old: Path, new: Path) -> Any:
    """Return a document whose files are found from another folder, too."""
    if isinstance(part, dict):
        return {key: _moved(each, files, old, new) for key, each in part.items()}
    if isinstance(part, list):
        return [_moved(each, files, old, new) for each in part]
    if isinstance(part, str) and part in files:
        return Path(os.path.relpath(old / part, new)).as_posix()
    return part
