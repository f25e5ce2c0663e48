"""Entries of a matrix as files list them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["FileMatrix", "labelled_matrix", "mirrored"]


class FileMatrix(NamedTuple):
    """A matrix from a file, and the dofs of its rows where the format names them."""

    matrix: SparseMatrix
    dofs: tuple[Dof, ...] | None = None


def mirrored(
    rows: IndexArray, columns: IndexArray, values: FloatArray, sign: float = 1.0
) -> tuple[IndexArray, IndexArray, FloatArray]:
    """Return the triplets of both triangles from those of one.

    Raises
    ------
    InputError
        If there are entries on both sides of the diagonal.
    """
    if np.any(rows < columns) and np.any(rows > columns):
        raise InputError("is announced as symmetric but gives entries on both sides")
    off = rows != columns
    return (
        np.concatenate([rows, columns[off]]),
        np.concatenate([columns, rows[off]]),
        np.concatenate([values, sign * values[off]]),
    )


def labelled_matrix(
    rows: Sequence[tuple[int, int]],
    columns: Sequence[tuple[int, int]],
    values: Sequence[float],
    *,
    symmetric: bool,
) -> FileMatrix:
    """Return the matrix of entries that are placed by node numbers and components.

    Parameters
    ----------
    rows, columns
        Number of the node and of the component (1 to 6) of each entry.
    values
        The entries.
    symmetric
        Whether one triangle stands for both; both may be there all the same.

    Raises
    ------
    InputError
        If a component is not 1 to 6.
    """
    labels = sorted({*rows, *columns})
    for node, component in labels:
        if not 1 <= component <= len(DOFS):
            what = f"component {component} of node {node} is no displacement or rotation"
            raise InputError(what, hint="components 1 to 6 are read")
    number = {label: index for index, label in enumerate(labels)}
    places = (
        np.array([number[label] for label in rows], dtype=np.intp),
        np.array([number[label] for label in columns], dtype=np.intp),
        np.array(values, dtype=np.float64),
    )
    one_sided = not (np.any(places[0] < places[1]) and np.any(places[0] > places[1]))
    if symmetric and one_sided:
        places = mirrored(*places)
    dofs = tuple((str(node), DOFS[component - 1]) for node, component in labels)
    return FileMatrix(SparseMatrix.from_triplets((len(dofs), len(dofs)), *places), dofs)
