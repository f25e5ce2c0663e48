"""follow: runs of one problem, each from the end of the one before, made by the core alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.continued import refuse_memory
from bumpstop.errors import InputError
from bumpstop.problem import Problem
from bumpstop.study.batch import as_columns, labelled, made
from bumpstop.study.outputs import Output

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

__all__ = ["follow"]


def follow(
    problem: Problem,
    parameters: Mapping[str, ArrayLike],
    outputs: Mapping[str, Output],
    *,
    workers: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Follow a motion up and down through values of parameters, by the exact method in the core.

    The first run of the way up starts as the problem does, each other where the one before it
    ended; the way down goes from the last value to the first, and starts as the problem does, too.
    Each run begins at its own t = 0, loads with it: let it last a whole number of periods.
    `continuation` does the same for cases with whatever method, and yields responses.

    Parameters
    ----------
    problem
        The problem. No law of it may rub or remember more than the motion tells.
    parameters
        What changes, as in `batch`, each an array of as many values, ascending for a way up.
    outputs
        What to keep of each run, as in `batch`: ``Output(..., latest=200)`` for the last impacts,
        or ``times`` once a period, make the points of a bifurcation diagram.
    workers
        How many threads; the two ways go side by side. Results do not depend on it.
    progress
        Called with the fraction done, between 0 and 1, about ten times a second.

    Returns
    -------
    xarray.Dataset
        The outputs over ``way`` (``up`` and ``down``) and ``run``, with the parameters beside it;
        whether a run ``failed``, and its ``message``. A run that fails is left out of its way: the
        next one starts where the last good one ended.

    Raises
    ------
    InputError
        As `batch` does, or if a law would forget what it remembers.

    Examples
    --------
    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[1.0], damping=0.05, shapes={("P", "dx"): [1.0]})
    >>> wall = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=0.01, stiffness=2e3)
    >>> shaker = bs.NodalForce("shaker", node="P", force=(1, 0, 0), time=bs.Harmonic(1.0))
    >>> problem = bs.Problem(basis, laws=[wall], loads=[shaker], duration=50.0)
    >>> speeds = {"speed": bs.Output(quantity="closing_speed", stop="wall", latest=20)}
    >>> found = bs.follow(problem, {"loads": [0.5, 1.0, 2.0]}, speeds)
    >>> found.speed.dims, found.speed.shape
    (('way', 'run', 'speed_impact'), (2, 3, 20))
    """
    columns = as_columns(parameters)
    for key in ("initial.displacement", "initial.velocity"):
        if key in columns:
            raise InputError("is that of the run before", key="parameters", value=key)
    if not isinstance(problem, Problem):
        raise InputError("must be a Problem", key="problem", value=problem)
    for law in problem.laws:
        refuse_memory(law)
        if getattr(law, "friction", None) is not None:
            what = "rubs, and where its spring is anchored would be forgotten"
            raise InputError(what, key=f"{law.table}.{law.name}", hint="take bs.continuation")
    both = {key: np.concatenate([values, values[::-1]]) for key, values in columns.items()}
    runs = len(next(iter(columns.values())))
    found, failed = made(
        problem, both, outputs, lanes=False, workers=workers, progress=progress, chain=runs
    )
    up = labelled(columns, outputs, found[:runs], [each for each in failed if each[0] < runs])
    of_down = [(2 * runs - 1 - run, message) for run, message in failed if run >= runs]
    down = labelled(columns, outputs, found[runs:][::-1], of_down)
    import xarray as xr

    way = xr.DataArray(["up", "down"], dims="way", name="way")
    return xr.concat([up, down], way, data_vars="all", coords="minimal", compat="override")
