"""The motion of a full model in a file: that of its independent dofs, or of those kept."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import h5py
import numpy as np

from bumpstop.errors import InputError
from bumpstop.io.columns import numbers
from bumpstop.io.netcdf_format import Variable
from bumpstop.sampling import MOTIONS

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.response import Response
    from bumpstop.structure.sparse import IndexArray

__all__ = ["independent_dofs", "kept_of_file", "motion_names"]

DOF = "independent_dof"
NUMBER = "independent_dof_number"


def independent_dofs(response: Response, motions: list[FloatArray]) -> Iterator[Variable]:
    """Give what a run of a full model knows of its dofs.

    Parameters
    ----------
    response
        The run.
    motions
        Displacement, velocity and acceleration of its coordinates, each (time, kept).
    """
    labels, kept = response.problem.basis.labels, response.kept
    rows = np.arange(len(labels)) if kept is None else kept
    names = np.array([labels[row] for row in rows], dtype=object)
    yield Variable(DOF, (DOF,), names, {"long_name": "node and axis of the independent dof"})
    place = {"long_name": "number of the dof among all independent ones, from 1"}
    yield Variable(NUMBER, (DOF,), rows.astype(np.int64) + 1, place)
    per = ("m or rad", "m/s or rad/s", "m/s2 or rad/s2")
    variables = zip(motion_names(response.problem.basis), MOTIONS, motions, per, strict=True)
    for name, quantity, motion, units in variables:
        # No attribute of units: displacements and rotations have their own.
        told = {"long_name": f"{quantity} of the independent dof, in {units}"}
        yield Variable(name, ("time", DOF), motion, told)


def motion_names(basis: ModalBasis) -> list[str]:
    """Return what the motions of the canonical coordinates are called in a file.

    Examples
    --------
    >>> import bumpstop as bs
    >>> motion_names(bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]}))
    ['modal_displacement', 'modal_velocity', 'modal_acceleration']
    """
    own = "modal" if basis.coordinates is None else "canonical"
    return [f"{'independent' if basis.unreduced else own}_{quantity}" for quantity in MOTIONS]


def kept_of_file(file: h5py.File, basis: ModalBasis) -> IndexArray | None:
    """Return which coordinates of a basis a file has the motion of; None for all.

    Raises
    ------
    InputError
        If the file tells of dofs that the basis has not.
    """
    if not basis.unreduced:
        return None
    kept: IndexArray = numbers(file[NUMBER]).astype(np.intp) - 1
    count = len(basis.omega2)
    known = np.unique(kept[(kept >= 0) & (kept < count)])
    if not np.array_equal(kept, known) or file[motion_names(basis)[0]].shape[1:] != kept.shape:
        what = "are not those of the full model and of its motion"
        raise InputError(what, key=NUMBER, hint="take another copy of the file")
    return None if len(kept) == count else kept
