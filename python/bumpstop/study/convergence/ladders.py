"""The three ladders: smaller steps, more modes, more elements.

They are taken one after the other, so that the errors add up: what the steps do is told with the
case's modes and mesh; what the modes left out would do, on the case's mesh; what the mesh does,
with all modes of each mesh, or the most that are taken and the static shapes of the stops.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import count, takewhile
from typing import Any, NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError, InputError
from bumpstop.methods import FIXED_STEP_METHODS, POINTS_PER_PERIOD, RTOL
from bumpstop.modal.selection import LowestModes, ModesAround, ModeSelection, ModesInBand
from bumpstop.study.convergence.finer import Document, has_beams, with_modes, with_static_shapes
from bumpstop.study.convergence.limits import extrapolated, orders_towards
from bumpstop.study.convergence.model import BEST_RTOL, Model, Result
from bumpstop.study.convergence.result import Ladder, Rung

__all__ = ["Limits", "basis_ladder", "mesh_ladder", "remedy", "time_ladder"]

EXACT = "exact"
ALL = "all modes"
POINTS = "points_per_period"
MADE_FINER = {"dt": "steps of", "rtol": "tolerances of", POINTS: "points per period of"}
OF_PARTS = "all modes of the parts as they are reduced, whose own modes are not refined"
MOST_DOFS = 50_000
"""Independent dofs of the finest mesh."""


class Limits(NamedTuple):
    """How far refinement goes."""

    levels: int
    """How often steps, and the elements' size, are halved."""
    modes: int
    """The most modes: all of a model that has no more."""


def time_ladder(
    model: Model, own: Result, best: Result, options: Mapping[str, Any], levels: int
) -> Ladder:
    """Return the error of the method of time integration, against the best method.

    Parameters
    ----------
    model
        The variant.
    own, best
        What its method and the best method give.
    options
        Options of its method: the step, the points of a period, or the tolerance.
    levels
        How often the step is halved, the points of a period are doubled, or the tolerance made
        ten times finer.
    """
    response, limit = own.response, best.values
    if response is None or best.response is None:
        return _unknown("time", len(limit), "nothing is simulated", 0.0)
    if response.method == EXACT:
        told = "none beyond rounding: the exact method has no time steps"
        return _unknown("time", len(limit), told, 0.0)
    key, sizes = _finer_steps(response.method, options, levels)
    finer = (model.as_given(response.method, **{**options, key: size}).values for size in sizes[1:])
    rungs = [
        Rung(f"{size:.4g}", size if key == POINTS else 1.0 / size, values)
        for size, values in zip(sizes, [own.values, *finer], strict=True)
    ]
    told = f"{MADE_FINER[key]} {_listed(rungs)}{' s' if key == 'dt' else ''}"
    return Ladder(
        part="time",
        rungs=tuple(rungs),
        error=own.values - limit,
        uncertainty=np.zeros(len(limit)),
        order=_order([*rungs, Rung(best.response.method, np.inf, limit)]),
        told=f"{told}, and the {best.response.method} method",
    )


def _finer_steps(method: str, options: Mapping[str, Any], levels: int) -> tuple[str, list[float]]:
    """Return what is made finer, and its values from that of the case on."""
    if method in FIXED_STEP_METHODS:
        return "dt", [options["dt"] / 2**level for level in range(levels + 1)]
    if method == "adaptive_central_difference":
        points = options.get(POINTS, POINTS_PER_PERIOD)
        return POINTS, [points * 2**level for level in range(levels + 1)]
    rtol = options.get("rtol", RTOL)
    tolerances = (rtol / 10**level for level in range(levels + 1))
    return "rtol", [*takewhile(lambda each: each >= BEST_RTOL, tolerances)] or [rtol]


def basis_ladder(model: Model, best: Result, limits: Limits) -> tuple[Ladder, Result]:
    """Return the error of the modes left out on the case's mesh, and the richest basis' result."""
    values = len(best.checks)
    if best.response is None:
        told = "none: frequencies do not depend on how many modes there are"
        return _unknown("basis", values, told, 0.0), best
    try:
        rich, told = _richest(model, best.vectors, max(limits.modes, 2 * best.vectors))
    except ComputationError as error:
        return _unknown("basis", values, f"not refined: {error.__cause__}"), best
    complete = told in (ALL, OF_PARTS)
    if rich.vectors <= best.vectors:
        if complete:
            return _unknown("basis", values, f"none: the basis has {told}", 0.0), best
        return _unknown("basis", values, "not refined: it has no more modes"), best
    results = [*_coarser(model, best, limits, rich.vectors), rich]
    rungs = tuple(Rung(str(each.vectors), each.vectors, each.values) for each in results)
    own = results.index(best)
    doubt = np.abs(rich.values - rungs[-2].values)
    ladder = Ladder(
        part="basis",
        rungs=rungs,
        error=best.values - rich.values,
        uncertainty=np.zeros(len(doubt)) if complete else doubt,
        order=_order(rungs[own:]),
        told=f"{_listed(rungs)} vectors, the last with {told}",
        start=own,
    )
    return ladder, rich


def mesh_ladder(model: Model, best: Result, rich: Result, limits: Limits) -> Ladder:
    """Return the error of the mesh, with the richest basis of each, or of parts the case's own."""
    if not has_beams(model.document):
        return _unknown("mesh", len(rich.checks), "not refined: the case has no beams of its own")
    own = best if "parts" in model.document else rich
    rungs = [Rung("1", 1, _comparable(own))]
    ended = ""
    for level in range(1, limits.levels + 1):
        finer = model.finer(2**level)
        if finer.free > MOST_DOFS:
            ended = f"a finer one has more than {MOST_DOFS:,} dofs"
            break
        try:
            found = _of_mesh(finer, own, limits)
        except ComputationError as error:
            ended = f"{finer.factor} for one: {error.__cause__}"
            break
        rungs.append(Rung(str(finer.factor), finer.factor, _comparable(found)))
    if len(rungs) == 1:
        return _unknown("mesh", len(rich.checks), f"not refined: {ended}")
    limit = extrapolated(np.array([rung.values for rung in rungs]))
    return Ladder(
        part="mesh",
        rungs=tuple(rungs),
        error=rungs[0].values - limit.values,
        uncertainty=limit.uncertainty,
        order=limit.order,
        told=f"{_listed(rungs)} elements in the place of one{ended and f'; {ended}'}",
    )


def remedy(model: Model, best: Result, rich: Result) -> Ladder | None:
    """Return the basis with the static shapes of the stops, where it has stops and no shapes."""
    shaped = with_static_shapes(model.document)
    if shaped is None or rich is best:
        return None
    found = model.solved(shaped, "with static shapes")
    unknown = np.full(len(rich.checks), np.nan)
    return Ladder(
        part="basis",
        rungs=(Rung(str(found.vectors), found.vectors, found.values),),
        error=found.values - rich.values,
        uncertainty=unknown,
        order=unknown,
        told='static_shapes = "stops"',
    )


def _of_mesh(finer: Model, own: Result, limits: Limits) -> Result:
    """Return what another mesh gives, with a basis like that of the case's mesh."""
    if own.response is None or "parts" in finer.document:
        return finer.solved(finer.document, f"{finer.factor} elements for one")
    return _richest(finer, own.vectors // 2, max(limits.modes, own.vectors))[0]


def _richest(model: Model, least: int, most: int) -> tuple[Result, str]:
    """Return what the best basis of a mesh gives that can be computed, and which it is.

    All modes, or so many and the static shapes of the stops; half as many where these cannot be
    computed, and so on.
    """
    *hopes, last = _bases(model, least, most)
    for document, told in hopes:
        with suppress(ComputationError):
            return model.solved(document, f"{model.factor} elements for one, {told}"), told
    document, told = last
    return model.solved(document, f"{model.factor} elements for one, {told}"), told


def _bases(model: Model, least: int, most: int) -> Iterator[tuple[Document, str]]:
    """Yield the bases to be tried, the best first, and what they are."""
    document = model.document
    whole = OF_PARTS if "parts" in document else ALL
    if model.free <= most:
        listed = isinstance(document["basis"].get("damping"), list)
        yield with_modes(document, model.free if listed else "all"), whole
    shaped = with_static_shapes(document)
    beside = "" if shaped is None else " and the static shapes of the stops"
    for number in takewhile(lambda number: number >= least, (most // 2**k for k in count())):
        if number < model.free:
            yield with_modes(shaped or document, number), f"{number} modes{beside}"


def _coarser(model: Model, best: Result, limits: Limits, largest: int) -> Iterator[Result]:
    """Yield results of half the modes, of the case's, of twice and four times as many, ..."""
    selection = model.selection
    if isinstance(selection, LowestModes) and selection.count > 1:
        fewer = with_modes(model.document, selection.count // 2)
        with suppress(InputError):  # a reference is of a mode beyond these
            yield model.solved(fewer, "half the modes")
    yield best
    known = best.vectors
    for level in count(1):
        more, number = _enlarged(selection, 2**level)
        if more is None or number >= min(model.free, limits.modes):
            return
        found = model.solved(with_modes(model.document, more), f"modes = {more}")
        if found.vectors >= largest:
            return
        if found.vectors > known:  # a wider band need not hold more
            yield found
            known = found.vectors


def _enlarged(selection: ModeSelection, factor: int) -> tuple[Any, int]:
    """Return a larger selection as ``[basis]`` has it, and how many modes it asks for.

    None where there are no more; a band asks for no number.
    """
    match selection:
        case LowestModes(number):
            return number * factor, number * factor
        case ModesInBand(low, high):
            return {"band": [low, high * factor]}, 0
        case ModesAround(frequency, number):
            return {"around": frequency, "count": number * factor}, number * factor
    return None, 0


def _comparable(result: Result) -> FloatArray:
    """Return values that other meshes have, too; NaN for amplitudes of modes, which have signs."""
    amplitudes = [check.quantity.startswith("modal_") for check in result.checks]
    return np.where(amplitudes, np.nan, result.values)


def _order(rungs: Sequence[Rung]) -> FloatArray:
    """Return the orders at which rungs approach the last of them."""
    *coarser, last = rungs
    if len(coarser) < 3:
        return np.full(len(last.values), np.nan)
    return orders_towards(
        last.values, [rung.size for rung in coarser], np.array([rung.values for rung in coarser])
    )


def _unknown(part: str, values: int, told: str, error: float = np.nan) -> Ladder:
    """Return the ladder of what was not refined, with the error that is known without."""
    return Ladder(
        part=part,
        error=np.full(values, error),
        uncertainty=np.full(values, error),
        order=np.full(values, np.nan),
        told=told,
    )


def _listed(rungs: Sequence[Rung]) -> str:
    return ", ".join(rung.label for rung in rungs)
