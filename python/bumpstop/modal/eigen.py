"""The modes of a model."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.modal.certificate import SturmCount
from bumpstop.modal.coupled import CoupledModes, coupled_modes
from bumpstop.modal.selected import Range, chosen, range_of
from bumpstop.modal.selection import LowestModes, ModesAround, ModeSelection
from bumpstop.modal.signs import largest_positive
from bumpstop.structure.graph import components
from bumpstop.structure.model import VibratingModel
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["Modes", "model_modes"]


class Modes(NamedTuple):
    """Modes of a model, by their frequencies."""

    omega2: FloatArray
    """Squared angular frequencies in rad2/s2, (N,); exactly zero for rigid modes."""
    shapes: FloatArray
    """One a column, of unit modal mass, on all dofs, (dofs, N)."""
    certificate: SturmCount | None
    """The proof that none is missing; None where rounding is too large for one."""


def model_modes(model: VibratingModel, selection: ModeSelection) -> Modes:
    """Return the modes asked for.

    Rigid modes have ``omega2`` exactly zero and the shapes of exact rigid motions; the
    flexible ones are mass-orthogonal to them. The largest component of each shape is positive.
    Dofs that nothing couples (stretching, twist and bending of a straight beam in its two
    planes) are solved apart, so that modes of equal frequency do not mix. A structure that is
    unstable has negative ``omega2``, which come first.

    Raises
    ------
    InputError
        If there are fewer free dofs than modes, or too many to have all modes of them.
    ComputationError
        If the matrices are too badly conditioned.
    """
    free = len(model.free)
    if free == 0:
        raise InputError("there are none: nothing can move", key="modes", hint="hold fewer dofs")
    if isinstance(selection, LowestModes | ModesAround) and selection.count > free:
        what, hint = "more modes than free dofs", f"the structure has {free} free dofs"
        raise InputError(what, key="modes", value=selection.count, hint=hint)
    stiffness, mass = model.reduced(model.stiffness), model.reduced(model.mass)
    rigid = model.rigid_shapes()
    groups = _uncoupled(stiffness, mass)
    found = [
        coupled_modes(stiffness.restricted(dofs), mass.restricted(dofs), rigid[dofs], selection)
        for dofs in groups
    ]
    shapes, omega2 = _places(found), np.concatenate([modes.omega2 for modes in found])
    order = np.argsort(omega2, kind="stable")
    known = reduce(Range.common, (modes.within for modes in found))
    within = known.common(range_of(selection, omega2[order]))
    order = order[within.holds(omega2[order])]
    kept = order[chosen(selection, omega2[order])]
    certificate = SturmCount(len(order), *within) if all(m.proven for m in found) else None
    together = np.zeros((free, len(kept)))
    for column, (group, number) in enumerate(shapes[kept]):
        together[groups[group], column] = found[group].shapes[:, number]
    return Modes(omega2[kept], largest_positive(model.expansion @ together), certificate)


def _places(found: Sequence[CoupledModes]) -> IndexArray:
    """Return group and number within it of all modes, (modes, 2)."""
    sizes = [len(modes.omega2) for modes in found]
    groups = np.repeat(np.arange(len(sizes)), sizes)
    return np.column_stack([groups, np.concatenate([np.arange(size) for size in sizes])])


def _uncoupled(stiffness: SparseMatrix, mass: SparseMatrix) -> list[IndexArray]:
    """Return the groups of dofs that neither matrix couples to others."""
    rows = np.concatenate([stiffness.rows, mass.rows])
    columns = np.concatenate([stiffness.columns, mass.columns])
    return components(mass.shape[0], rows, columns)
