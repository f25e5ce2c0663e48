"""Continuation: runs one after the other, each from the state in which the last one ended."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from bumpstop.continued import continued
from bumpstop.errors import InputError, ModellingWarning
from bumpstop.study.evaluation import Evaluator, simulated
from bumpstop.study.outputs import Output
from bumpstop.study.sampling import Sampling
from bumpstop.study.study import Study

if TYPE_CHECKING:
    from bumpstop.io.case import Case
    from bumpstop.response import Response

__all__ = ["continuation"]


def continuation(
    case: Case,
    parameter: str,
    values: Any,
    *,
    along: Mapping[str, Any] | None = None,
    variant: str | None = None,
) -> Iterator[tuple[Any, Response]]:
    """Follow a motion while a parameter changes: the last state starts the next run.

    Where several motions are stable for one value, a sweep up and one down end on different
    ones; runs that all start alike find one of them. Each run begins at its own t = 0, loads
    with it: for a harmonic load, let each last a whole number of periods.

    Parameters
    ----------
    case
        A case from a file.
    parameter
        What changes: a key of the case by dotted name. The modes must not depend on it.
    values
        Its values one after the other, ascending for a sweep up: a list or a `Range`.
    along
        Other keys that change with it, each with as many values, such as ``run.duration``.
    variant
        Which variant of the case; needed where it has several.

    Yields
    ------
    value, response
        As `bifurcation` takes them. One run is kept at a time.

    Raises
    ------
    InputError
        If something is not as it must be, see `Study`; the modes change; or a contact rubs at
        the end of a run, whose anchor the next would forget.
    ComputationError
        If a run could not be finished.

    Examples
    --------
    >>> import bumpstop as bs
    >>> case = bs.load_case("cases/ball-on-floor/case.toml")
    >>> key = "stops.floor.restitution"
    >>> runs = list(bs.continuation(case, key, [0.9, 0.8]))
    >>> [value for value, _ in runs]
    [0.9, 0.8]
    """
    if parameter in (along or {}):
        raise InputError("is what changes already", key="along", value=parameter)
    study = Study(
        case,
        {parameter: values, **(along or {})},
        {"impacts": Output(quantity="impacts")},
        sampling=Sampling("list"),
        variant=variant,
    )
    return _runs(study, parameter)


def _runs(study: Study, parameter: str) -> Iterator[tuple[Any, Response]]:
    evaluator = Evaluator(study.recipe)
    last: Response | None = None
    for number in range(study.runs.count):
        row = study.runs.row(number)
        basis, problem, tables = evaluator.built(row)
        if problem is None or tables.run is None:
            raise InputError("is missing: nothing runs", key="run")
        if last is not None:
            if last.problem.basis is not basis:
                what = "changes the modes, and the state of others says nothing of these"
                raise InputError(what, key=f'parameters."{parameter}"')
            start = continued(last, duration=problem.duration).initial
            problem = replace(problem, initial=start)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModellingWarning)
            last = simulated(problem, tables.run)
        yield row[parameter], last
