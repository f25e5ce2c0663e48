"""batch: many runs of one problem, made by the core."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from bumpstop import _core
from bumpstop.arguments import FloatArray, by_name, count, one_of
from bumpstop.canonical import canonical_form
from bumpstop.errors import InputError
from bumpstop.methods import check_method
from bumpstop.problem import Problem
from bumpstop.scale import stiffest, too_stiff
from bumpstop.study.core_outputs import core_quantity
from bumpstop.study.core_runs import STOP_NUMBERS
from bumpstop.study.outputs import Output
from bumpstop.study.pool import usable_cores

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

__all__ = ["batch"]

FACTORS = ("initial.displacement", "initial.velocity", "loads", "loads.pace")
"""What may be given as factors of what the problem has."""

_UNITS = {"gap": "m", "stiffness": "N/m", "damping": "N s/m"}
"""Of the numbers of a stop; factors have none."""

_IN_PARTS = "make the runs in several batches, or a study with a store"


class Made(NamedTuple):
    """Runs that the core has made."""

    values: FloatArray
    """What is kept, (run, number); NaN where the run failed."""
    failed: list[tuple[int, str]]
    """Which runs failed, and why."""


def batch(
    problem: Problem,
    parameters: Mapping[str, ArrayLike],
    outputs: Mapping[str, Output],
    *,
    lanes: bool = True,
    workers: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Make many runs of one problem by the exact method, in the core alone.

    Only numbers of stops, the size of the initial state and that of the loads may vary: what the
    modes do not depend on. A run then takes microseconds. `study` varies everything.

    Parameters
    ----------
    problem
        The problem. What does not vary is as it has it.
    parameters
        What varies, each an array of one value a run: ``"stops.guide.gap"`` in m,
        ``"stops.guide.stiffness"`` in N/m, ``"stops.guide.damping"`` in N s/m of a stop without
        friction; ``"initial.displacement"`` and ``"initial.velocity"``, factors of the problem's
        initial state; ``"loads"``, a factor of all its loads; ``"loads.pace"``, how many
        times as fast these change: the run, and all times at which something is kept, are then
        as much shorter, so that a harmonic load has as many periods.
    outputs
        What to keep of each run, by a name of your own: quantities at given times or with a
        statistic, numbers and statistics of impacts, the ``largest_force``, and numbers of the
        whole run; not ``mean``, ``rms`` and other contact statistics.
    lanes
        Make eight runs at a time in the vector registers where the problem has one stop without
        damper or friction, constant loads and lightly damped modes, and what is kept are
        quantities at times, instants, speeds and largest forces of impacts, or counts. Numbers
        then differ from those of `simulate` by rounding, some 1e-15 of the largest; without lanes
        they are the same to the bit, and take some three times as long.
    workers
        How many threads; as many as there are cores where left out. Results do not depend on it,
        to the last bit, nor on the order of the runs.
    progress
        Called with the fraction done, between 0 and 1, about ten times a second.

    Returns
    -------
    xarray.Dataset
        The outputs over ``run``, with the parameters beside it; whether a run ``failed``, and
        its ``message``. Numbers of a failed run are NaN.

    Raises
    ------
    InputError
        If the exact method does not take the problem, it has not what varies or is kept, the
        core cannot read an output, or there are not as many values of each parameter.

    Examples
    --------
    >>> import numpy as np
    >>> import bumpstop as bs
    >>> case = bs.load_case("cases/sdnl32/case.toml")
    >>> stiffness = np.linspace(1e4, 1e5, 1000)
    >>> found = bs.batch(
    ...     case.problems["soft"],
    ...     {"stops.spring.stiffness": stiffness},
    ...     {"force": bs.Output(quantity="peak_force", stop="spring", statistic="maximum")},
    ... )
    >>> found.force.dims, bool(found.failed.any())
    (('run',), False)
    """
    columns = as_columns(parameters)
    found = made(
        problem, columns, outputs, lanes=lanes, workers=workers, progress=progress, chain=1
    )
    return labelled(columns, outputs, *found)


def made(
    problem: Problem,
    columns: Mapping[str, FloatArray],
    outputs: Mapping[str, Output],
    *,
    lanes: bool,
    workers: int | None,
    progress: Callable[[float], None] | None,
    chain: int,
) -> Made:
    """Make runs in the core; of each chain all but the first start where the last one ended."""
    if not isinstance(problem, Problem):
        hint = "of a case, take one of its problems; bs.study takes cases"
        raise InputError("must be a Problem", key="problem", value=problem, hint=hint)
    check_method("exact", problem)
    runs = len(next(iter(columns.values())))
    quantities = _quantities(problem, outputs)
    _check_room(runs, outputs)
    if (blamed := too_stiff(problem)) is not None:
        raise blamed
    model = canonical_form(problem)
    if model.states is not None:
        what = "goes on with what the laws of another run remember, which a batch does not"
        raise InputError(what, key="problem", hint="take bs.study, or simulate it by itself")
    stops = {law.name: number for number, law in enumerate(problem.laws)}
    plain = [name for name, number in stops.items() if type(model.laws[number]) is _core.Stop]
    varied, most = [], stiffest(problem)
    refused: dict[int, str] = {}
    for key, values in columns.items():
        if key not in FACTORS:
            stop, number = _stop_number(key, plain)
            # Seen at once where all are soft enough, without an array of the runs' size.
            if number == "stiffness" and not values.max() <= most[stop]:
                stiff = values > most[stop]
                told = f"{key}: the run's instants tell no more than {most[stop]:.2g} N/m"
                refused |= {int(run): f"{told} (got {values[run]:g})" for run in stiff.nonzero()[0]}
                values = np.where(stiff, np.nan, values)
            varied.append((stops[stop], number, values))
    displacements, velocities = (
        columns.get(f"initial.{key}") for key in ("displacement", "velocity")
    )
    try:
        found, failed = _core.batch(
            model.system,
            model.laws,
            model.forcing,
            model.displacement,
            model.velocity,
            problem.duration,
            list(quantities.values()),
            runs,
            varied,
            None if displacements is None else (True, displacements),
            None if velocities is None else (True, velocities),
            columns.get("loads"),
            columns.get("loads.pace"),
            chain,
            lanes=lanes,
            threads=usable_cores() if workers is None else count("workers", workers),
            progress=progress,
        )
    except _core.CoreError as error:
        raise InputError(str(error), key="problem") from error
    return Made(found, [(run, refused.get(run, message)) for run, message in failed])


def as_columns(parameters: Mapping[str, ArrayLike]) -> dict[str, FloatArray]:
    """Return parameters as arrays of one length."""
    columns: dict[str, FloatArray] = {}
    for key, given in by_name("parameters", parameters).items():
        try:
            values = np.ascontiguousarray(given, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise InputError("must be numbers", key=f"parameters.{key}") from error
        except MemoryError as error:
            what = "has more values than the memory holds"
            raise InputError(what, key=f"parameters.{key}", hint=_IN_PARTS) from error
        if values.ndim != 1 or not len(values):
            what = "must be an array of one value a run"
            raise InputError(what, key=f"parameters.{key}", value=f"shape {values.shape}")
        columns[key] = values
    lengths = {len(values) for values in columns.values()}
    if len(lengths) > 1:
        what = f"have different numbers of values: {', '.join(map(str, sorted(lengths)))}"
        raise InputError(what, key="parameters", hint="give one value a run for each")
    if not columns:
        hint = "name what varies and its values"
        raise InputError("there are none", key="parameters", hint=hint)
    return columns


def _stop_number(key: str, stops: list[str]) -> tuple[str, str]:
    """Return stop and number of a key such as ``stops.guide.gap``."""
    table, _, rest = key.partition(".")
    stop, _, number = rest.rpartition(".")
    known = [f"stops.{stop}.{number}" for stop in stops for number in STOP_NUMBERS]
    if table != "stops" or stop not in stops or number not in STOP_NUMBERS:
        one_of("parameters", key, [*known, *FACTORS])
    return stop, number


def _check_room(runs: int, outputs: Mapping[str, Output]) -> None:
    """Raise where the memory does not hold what is kept."""
    width = sum(math.prod(output.shape) for output in outputs.values())
    try:
        np.empty((runs, width))
    except (MemoryError, ValueError) as error:
        what = f"{width:,} numbers of {runs:,} runs each are more than the memory holds"
        raise InputError(what, key="outputs", hint=_IN_PARTS) from error


def _quantities(problem: Problem, outputs: Mapping[str, Output]) -> dict[str, _core.Quantity]:
    if not outputs:
        raise InputError("there are none", key="outputs", hint="say what to keep of each run")
    quantities = {}
    for key, output in by_name("outputs", outputs).items():
        if not isinstance(output, Output):
            raise InputError("must be an Output", key=f"outputs.{key}", value=output)
        if key in ("run", "failed", "message"):
            raise InputError("this name is taken", key="outputs", value=key)
        output.check(problem)
        quantity = core_quantity(problem, output)
        if quantity is None:
            hint = "take given times, or impacts; bs.study reads everything"
            what = "is not read by the core"
            raise InputError(what, key=f"outputs.{key}", value=output.quantity, hint=hint)
        quantities[key] = quantity
    return quantities


def labelled(
    columns: Mapping[str, FloatArray],
    outputs: Mapping[str, Output],
    found: FloatArray,
    failed: list[tuple[int, str]],
) -> xr.Dataset:
    """Return what is kept of runs over ``run``, with the parameters beside it."""
    import xarray as xr

    runs = len(found)
    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = {
        key: ("run", values, {"units": _UNITS.get(key.rpartition(".")[2], "1")})
        for key, values in columns.items()
    }
    place = 0
    for key, output in outputs.items():
        width = output.shape[0] if output.shape else 1
        values = found[:, place : place + width]
        place += width
        if output.shape:
            dimension = f"{key}_{output.dimension}"
            variables[key] = (("run", dimension), values, output.attributes)
            if output.times:
                told = {"units": "s", "long_name": "time"}
                coordinates[dimension] = (dimension, np.array(output.times), told)
        else:
            variables[key] = ("run", values[:, 0], output.attributes)
    has_failed, messages = np.zeros(runs, dtype=bool), np.full(runs, "", dtype=object)
    for run, message in failed:
        has_failed[run], messages[run] = True, message
    # As it is: xarray looks for times among objects in a copy of them.
    told_why = xr.Variable("run", messages, fastpath=True)
    variables |= {"failed": ("run", has_failed), "message": told_why}
    return xr.Dataset(variables, coordinates)
