"""What a user should think twice about before a run: stops too stiff, or pressed already."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError

if TYPE_CHECKING:
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
    """Return a line for each stop that the basis is too stiff for, or that is pressed at t = 0."""
    stops = [
        law
        for law in problem.laws
        if isinstance(getattr(law, "gap", None), float) or hasattr(law, "gap_at")
    ]
    return (
        *_too_stiff(problem.basis, stops),
        *_pressed(problem, stops),
        *_out_of_balance(problem),
    )


def missing_flexibility(basis: ModalBasis, laws: Sequence[Law]) -> FloatArray:
    """Return how much more the structure gives way at laws than its basis, (laws,), in m/N.

    Under a unit force along the coordinate of each, balanced by inertia where the structure can
    move as a whole: the static displacement of the model, less that of the basis.

    Parameters
    ----------
    basis
        A basis that was made from a structure.
    laws
        The laws.
    """
    model = basis.model
    assert model is not None  # as its user promises
    forces = [law.coordinate.nodal_force(model) for law in laws]
    known = _KNOWN.setdefault(basis, {})
    new = {force.tobytes(): force for force in forces if force.tobytes() not in known}
    if new:
        from bumpstop.modal.static_shapes import StaticShapes

        columns = np.stack(list(new.values()), axis=1)
        whole = np.einsum("dn,dn->n", columns, StaticShapes(model).under(columns))
        known.update(zip(new, whole.tolist(), strict=True))
    all_of_it = np.array([known[force.tobytes()] for force in forces])
    rows = np.stack([law.coordinate.row(basis) for law in laws])
    missing: FloatArray = np.maximum(all_of_it - _flexibilities(basis, rows).sum(axis=1), 0.0)
    return missing


def _too_stiff(basis: ModalBasis, stops: Sequence[Law]) -> Iterator[str]:
    asked = [stop for stop in stops if _is_doubtful(basis, stop)]
    if not asked:
        return
    try:
        missing = missing_flexibility(basis, asked).tolist()
    except ComputationError:  # a structure that is unstable at rest cannot be asked
        return
    for stop, flexibility in zip(asked, missing, strict=True):
        stiffness: Any = getattr(stop, "stiffness", 0.0)
        share = stiffness * flexibility
        if share > _SPOILS:
            yield (
                f"stop {stop.name!r}: the modes left out would give way {100 * share:.3g} % as "
                "much as the stop itself, and its force is wrong by about as much; take more "
                'modes, or static_shapes = "stops"'
            )


def _is_doubtful(basis: ModalBasis, stop: Law) -> bool:
    """Tell whether the last modes are so soft at a stop that those beyond them may matter."""
    stiffness = getattr(stop, "stiffness", None)
    model = basis.model
    if model is None or not isinstance(stiffness, float) or hasattr(stop, "exponent"):
        return False
    modes = len(basis.omega2)
    if not modes < len(model.free) <= _LARGEST:
        return False
    row = stop.coordinate.row(basis)[np.newaxis]
    last = _flexibilities(basis, row)[0, modes - max(modes // _LAST, 1) :]
    return bool(stiffness * modes * last.max() > _HARMLESS)


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
