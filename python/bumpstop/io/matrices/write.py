"""From a model to files that other programs, and read_matrices, can read."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

import numpy as np

from bumpstop.arguments import Vector, one_of
from bumpstop.errors import InputError
from bumpstop.io.matrices.dof_map import DofMap, write_dof_map
from bumpstop.io.matrices.matrix_market import write_matrix_market
from bumpstop.io.matrices.npz import write_npz
from bumpstop.structure.model import LinearModel
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["write_matrices"]

_FORMS = ("npz", "mtx")
_ALWAYS = ("stiffness", "mass")
_IF_ANY = ("damping", "gyroscopic", "circulatory")
_SKEW = ("gyroscopic", "circulatory")


def write_matrices(
    folder: str | PathLike[str], model: LinearModel, *, form: str = "npz"
) -> dict[str, Path]:
    """Write the matrices of a model and its dof map; return the files by argument.

    ``read_matrices(**write_matrices(folder, model))`` gives the model back. Supports are in the
    dof map. Where dofs follow others (relations, rigid links) the matrices are those of the
    independent dofs, and the others are left out.

    Parameters
    ----------
    folder
        Where to write; made where it is not there.
    model
        A Structure, or Matrices.
    form
        ``"npz"`` for SciPy or ``"mtx"`` for Matrix Market.

    Raises
    ------
    InputError
        If the form is not known, or nothing can be written there.
    """
    one_of("form", form, _FORMS)
    place = _made(Path(folder))
    selects = len(model.expansion.values) == len(model.free)
    wanted = [*_ALWAYS, *(key for key in _IF_ANY if len(getattr(model, key).values))]
    files = {key: place / f"{key}.{form}" for key in wanted}
    for key, file in files.items():
        matrix = getattr(model, key)
        _write(file, matrix if selects else model.reduced(matrix), skew=key in _SKEW)
    files["dofs"] = place / "dofs.csv"
    write_dof_map(files["dofs"], _dof_map(model, selects))
    return files


def _write(file: Path, matrix: SparseMatrix, *, skew: bool) -> None:
    if file.suffix == ".npz":
        write_npz(file, matrix)
    else:
        write_matrix_market(file, matrix, skew=skew)


def _made(folder: Path) -> Path:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot be made: {error.strerror}", file=str(folder)) from error
    return folder


def _dof_map(model: LinearModel, selects: bool) -> DofMap:
    kept = np.arange(len(model.dofs)) if selects else model.free
    held = np.setdiff1d(kept, model.free)
    dofs = [model.dofs[number] for number in kept]
    positions = {node: _position(model, node) for node in dict.fromkeys(node for node, _ in dofs)}
    return DofMap(
        dofs=tuple(dofs),
        positions={node: place for node, place in positions.items() if place is not None},
        fixed=tuple(model.dofs[number] for number in held),
    )


def _position(model: LinearModel, node: str) -> Vector | None:
    try:
        return model.position(node)
    except InputError:
        return None
