"""What a user should think twice about before a run: laws too stiff, stops pressed already."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError
from bumpstop.laws.steepness import pressed_coordinates, steepness

if TYPE_CHECKING:
    from bumpstop.loads.time import TimeFunction
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Law, Problem

__all__ = ["contact_warnings", "missing_flexibility"]

_SPOILS = 0.1
"""The share of a contact's own flexibility that the modes left out may have."""
_HARMLESS = 0.03
"""Where the last modes foretell less than this share the structure is not asked: they foretell
more than there is, twice as much along bars and several times as much across beams."""
_LAST = 3
"""The last third of the modes foretells what those beyond them do."""
_LARGEST = 20_000
"""Dofs of structures that are asked: larger ones would take longer than a user waits."""
_PRESSED = 1e-12
"""A depth beside the gap and the motion below which a stop only touches."""


_KNOWN: WeakKeyDictionary[ModalBasis, dict[bytes, float]] = WeakKeyDictionary()
"""How much models give way under forces: many problems of one basis ask alike."""


def contact_warnings(problem: Problem) -> tuple[str, ...]:
    """Return a line for each law that the basis is too soft for, and stop pressed at t = 0."""
    stops = [
        law
        for law in problem.laws
        if isinstance(getattr(law, "gap", None), float) or hasattr(law, "gap_at")
    ]
    return (
        *_too_stiff(problem),
        *_pressed(problem, stops),
        *_out_of_balance(problem),
    )


def missing_flexibility(basis: ModalBasis, laws: Sequence[Law]) -> FloatArray:
    """Return how much more the structure gives way at laws than its basis, (laws,), in m/N.

    Under a unit force along the coordinate of each, balanced by inertia where the structure can
    move as a whole: the static displacement of the model, less that of the basis; of obstacles
    about an axis the larger one of both directions across it.

    Parameters
    ----------
    basis
        A basis that was made from a structure.
    laws
        The laws.
    """
    model = basis.model
    assert model is not None  # as its user promises
    along = [coordinate for law in laws for coordinate in pressed_coordinates(law)]
    forces = [coordinate.nodal_force(model) for coordinate in along]
    known = _KNOWN.setdefault(basis, {})
    new = {force.tobytes(): force for force in forces if force.tobytes() not in known}
    if new:
        from bumpstop.modal.static_shapes import StaticShapes

        columns = np.stack(list(new.values()), axis=1)
        whole = np.einsum("dn,dn->n", columns, StaticShapes(model).under(columns))
        known.update(zip(new, whole.tolist(), strict=True))
    all_of_it = np.array([known[force.tobytes()] for force in forces])
    in_modes = _flexibilities(basis, np.concatenate([_rows(basis, law) for law in laws]))
    missing: FloatArray = np.maximum(all_of_it - in_modes.sum(axis=1), 0.0)
    first = np.cumsum([0, *(len(pressed_coordinates(law)) for law in laws[:-1])])
    softest: FloatArray = np.maximum.reduceat(missing, first)
    return softest


def _rows(basis: ModalBasis, law: Law) -> FloatArray:
    """Return the motion along each coordinate that a law pushes along, (coordinates, N)."""
    several: Any = getattr(law, "rows", None)
    if several is not None:
        rows: FloatArray = several(basis)[: len(pressed_coordinates(law))]
        return rows
    return law.coordinate.row(basis)[np.newaxis]


def _too_stiff(problem: Problem) -> Iterator[str]:
    basis = problem.basis
    model = basis.model
    if model is None or not len(basis.omega2) < len(model.free) <= _LARGEST:
        return
    energy = _energy_at_start(problem)
    steep = [(law, steepness(law, energy)) for law in problem.laws]
    doubtful = [(law, slope) for law, slope in steep if _is_doubtful(basis, law, slope)]
    if not doubtful:
        return
    try:
        missing = missing_flexibility(basis, [law for law, _ in doubtful]).tolist()
    except ComputationError:  # a structure that is unstable at rest cannot be asked
        return
    for (law, slope), flexibility in zip(doubtful, missing, strict=True):
        share = slope * flexibility
        if share > _SPOILS:
            kind, mend = ("stop", 'or static_shapes = "stops"')
            if law.table != "stops":
                kind, mend = ("law", "or a static shape at its node")
            yield (
                f"{kind} {law.name!r}: the modes left out would give way {100 * share:.3g} % as "
                f"much as the {kind} itself, and its force is wrong by about as much; take more "
                f"modes, {mend}"
            )


def _energy_at_start(problem: Problem) -> float:
    """Return the kinetic and elastic energy in J of the structure at t = 0."""
    if problem.initial is None:
        return 0.0
    displacement, velocity = problem.initial.modal_state(problem.basis)
    elastic = np.maximum(problem.basis.omega2, 0.0) * displacement**2
    return float(0.5 * (elastic + velocity**2).sum())


def _is_doubtful(basis: ModalBasis, law: Law, slope: float) -> bool:
    """Tell whether the last modes are so soft at a law that those beyond them may matter."""
    if slope == 0.0:
        return False
    modes = len(basis.omega2)
    flexibilities = _flexibilities(basis, _rows(basis, law))
    last = flexibilities[:, modes - max(modes // _LAST, 1) :]
    return bool(slope * modes * last.max() > _HARMLESS)


def _flexibilities(basis: ModalBasis, rows: FloatArray) -> FloatArray:
    """Return what each mode gives way under unit forces along rows, (rows, N), in m/N."""
    bends = basis.omega2 > 0.0
    flexible: FloatArray = np.where(bends, rows**2 / np.where(bends, basis.omega2, 1.0), 0.0)
    return flexible


def _out_of_balance(problem: Problem) -> Iterator[str]:
    """Yield a line for each law with a force at rest that an equilibrium leaves out."""
    if not getattr(problem.initial, "may_press", False) or not hasattr(problem.initial, "laws"):
        return
    initial: Any = problem.initial
    taking_part = {law.name for law in initial.laws}
    for law in problem.laws:
        if law.name not in taking_part and hasattr(law, "static_force"):
            yield (
                f"{law.name!r} takes no part in the equilibrium at the start, and pushes at once "
                "where it has a force there; give it to StaticState(laws=...)"
            )


def _start(basis: ModalBasis, stop: Law, place: FloatArray | None) -> tuple[float, float]:
    """Return the distance of a stop at rest, and by how much it is more at the start."""
    if place is None:
        place = np.zeros(len(basis.omega2))
    at: Any = getattr(stop, "gap_at", None)
    if at is not None:
        rest = at(basis, np.zeros(len(basis.omega2)))
        return rest, at(basis, place) - rest
    gap: Any = getattr(stop, "gap", 0.0)
    functions: Sequence[TimeFunction] = getattr(stop, "functions", ())
    gap -= sum(float(function.at(np.zeros(1))[0]) for function in functions)
    return gap, float(stop.coordinate.row(basis) @ place) if place.any() else 0.0


def _pressed(problem: Problem, stops: Sequence[Law]) -> Iterator[str]:
    """Yield a line for each stop into which the structure reaches at t = 0."""
    if getattr(problem.initial, "may_press", False):
        return
    place = None if problem.initial is None else problem.initial.modal_state(problem.basis)[0]
    for stop in stops:
        gap, moved = _start(problem.basis, stop, place)
        depth = -(gap + moved)
        if depth <= _PRESSED * (abs(gap) + abs(moved)):
            continue
        start = (
            f"its gap of {gap:.6g} m is closed from the start"
            if moved == 0.0
            else f"the structure starts {depth:.6g} m inside its obstacle"
        )
        yield (
            f"stop {stop.name!r}: {start}, and it pushes at once; an equilibrium under the "
            "loads, [initial.static], would start at rest"
        )
