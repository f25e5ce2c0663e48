"""converge: from a case to the errors of its results."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from bumpstop.arguments import count, one_of, positive
from bumpstop.errors import InputError
from bumpstop.io.case.build import Builder
from bumpstop.methods import METHODS, OPTIONS
from bumpstop.modal.selection import AllModes, LowestModes
from bumpstop.study.convergence.ladders import (
    EXACT,
    Limits,
    basis_ladder,
    mesh_ladder,
    remedy,
    time_ladder,
)
from bumpstop.study.convergence.model import BEST_RTOL, Model
from bumpstop.study.convergence.result import Convergence, VariantConvergence

if TYPE_CHECKING:
    from bumpstop.io.case import Case

__all__ = ["converge"]


def converge(
    case: Case,
    *,
    method: str | None = None,
    dt: float | None = None,
    rtol: float | None = None,
    levels: int = 3,
    most_modes: int = 200,
    progress: Callable[[str], None] | None = None,
) -> Convergence:
    """Find how wrong the reference quantities of a case are, and why.

    The error of each is split in three, each part by refinement: of time integration (zero for
    the exact method), of the modes left out (up to all modes of the case's mesh), and of the
    mesh (more elements in each beam, all modes of each mesh). The parts add up.

    Parameters
    ----------
    case
        A case from a file, with references.
    method, dt, rtol
        How to integrate time, and the step in s or the relative tolerance, instead of as the case
        says.
    levels
        How often steps and elements are halved.
    most_modes
        The most modes of a refined model; one that has more takes so many, and the static
        shapes of its stops.
    progress
        Called with a few words before each part.

    Raises
    ------
    InputError
        If the case has no references, its modes come from elsewhere, or a model cannot be made
        or integrated as asked.
    ComputationError
        If a computation could not be finished.

    Examples
    --------
    >>> import bumpstop as bs
    >>> found = bs.converge(bs.load_case("cases/sdnl32/case.toml"))
    >>> stiff = found.variants["stiff"]
    >>> stiff.largest, stiff.position.verdict
    ('basis', 'computed')
    """
    if method is not None:
        one_of("method", method, METHODS)
    asked = {"dt": dt, "rtol": rtol}
    own = {key: positive(key, value) for key, value in asked.items() if value is not None}
    limits = Limits(count("levels", levels), count("most_modes", most_modes))
    _check(case)
    builder = Builder(case.path.parent)
    tell = progress or (lambda _: None)
    variants = {}
    for name in case.bases:
        if case.references[name]:
            model = Model(case, name, builder)
            variants[name] = _variant(model, name, _method(case, name, method, own), limits, tell)
    return Convergence(case, variants)


def _check(case: Case) -> None:
    """Raise where there is nothing to be refined, or nothing to be watched meanwhile."""
    if not case.documents:
        raise InputError("must be a case from a file", key="case", hint="load_case gives one")
    file = str(case.path)
    if not any(case.references.values()):
        what = "is missing: its values are what is refined"
        raise InputError(what, file=file, key="references", hint="add [[references]]")
    for document in case.documents.values():
        if document["basis"].get("model") == "full":
            what = "a full model has no modes whose number could be refined"
            hint = 'ask a variant with model = "modal"'
            raise InputError(what, file=file, key="basis.model", hint=hint)
        if "modes" in document:
            what = "modes of a file cannot be refined, neither their number nor their mesh"
            hint = "build the structure, or take its [matrices]"
            raise InputError(what, file=file, key="modes", hint=hint)
        _check_damping(case, file)


def _check_damping(case: Case, file: str) -> None:
    for variant, document in case.documents.items():
        listed = isinstance(document["basis"].get("damping"), list)
        selection = Model(case, variant, Builder(case.path.parent)).selection
        if listed and not isinstance(selection, LowestModes | AllModes):
            what = "ratios listed mode by mode tell nothing of modes beyond a band"
            hint = "give one ratio, a rule, or a number of modes"
            raise InputError(what, file=file, key="basis.damping", hint=hint)


def _method(
    case: Case, variant: str, method: str | None, asked: Mapping[str, float]
) -> tuple[str, dict[str, Any]]:
    """Return the method of a variant and its options."""
    if variant not in case.methods:
        return "auto", {}
    own, options = case.methods[variant]
    chosen = method or own
    given = dict(options) | dict(asked)
    return chosen, {key: value for key, value in given.items() if key in OPTIONS[chosen]}


def _variant(
    model: Model,
    name: str,
    method: tuple[str, dict[str, Any]],
    limits: Limits,
    tell: Callable[[str], None],
) -> VariantConvergence:
    chosen, options = method
    tell(f"{name}: time")
    own = model.as_given(chosen, **options)
    is_exact = own.response is None or own.response.method == EXACT
    best = own if is_exact else model.as_given("auto", rtol=BEST_RTOL)
    time = time_ladder(model, own, best, options, limits.levels)
    tell(f"{name}: basis")
    basis, rich = basis_ladder(model, best, limits)
    shaped = remedy(model, best, rich)
    tell(f"{name}: mesh")
    return VariantConvergence(
        name=name,
        vectors=own.vectors,
        response=own.response,
        checks=own.checks,
        time=time,
        basis=basis,
        mesh=mesh_ladder(model, best, rich, limits),
        remedy=shaped,
    )
