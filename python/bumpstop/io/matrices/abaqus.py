"""Abaqus matrices (.mtx) as ``*MATRIX GENERATE`` and ``*MATRIX OUTPUT`` write them.

Format: Abaqus Analysis User's Guide, "Generating structural matrices". With FORMAT=MATRIX INPUT
or LABELS each line has the node and dof of the row, those of the column, and the entry; with
FORMAT=COORDINATE it has the numbers of row and column, and the entry. Of a symmetric matrix
one triangle may stand for both.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.io.matrices.triplets import FileMatrix, labelled_matrix, mirrored
from bumpstop.io.reading import MOST_ROWS, in_file, read_lines
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["read_abaqus"]

_LABELS, _COORDINATE = 5, 3


def read_abaqus(path: Path) -> FileMatrix:
    """Read a matrix, with its dofs where the file has labels.

    Raises
    ------
    InputError
        If the file cannot be read, or a line has not three or five numbers.
    """
    with in_file(path):
        numbers = _numbers(read_lines(path, "a matrix"))
        if numbers.shape[1] == _COORDINATE:
            return FileMatrix(_by_place(numbers))
        labels = [(int(node), int(dof)) for node, dof in numbers[:, :4].reshape(-1, 2)]
        return labelled_matrix(labels[::2], labels[1::2], numbers[:, 4].tolist(), symmetric=True)


def _numbers(lines: list[str]) -> FloatArray:
    rows = []
    wanted = 0
    for number, line in enumerate(lines, start=1):
        if not line or line.lstrip().startswith("*"):  # a comment or the keyword of an input file
            continue
        words = line.replace(",", " ").split()
        wanted = wanted or len(words)
        if len(words) != wanted or wanted not in (_LABELS, _COORDINATE):
            hint = "each line must have three or five numbers, always as many"
            raise InputError("is no entry", key=f"line {number}", value=line, hint=hint)
        rows.append(_reals(number, line, words))
    if not rows:
        raise InputError("holds no entry")
    return np.array(rows)


def _reals(number: int, line: str, words: list[str]) -> list[float]:
    try:
        places = [float(int(word)) for word in words[:-1]]
        return [*places, float(words[-1].upper().replace("D", "E"))]
    except ValueError as error:
        raise InputError("is no entry", key=f"line {number}", value=line) from error


def _by_place(numbers: FloatArray) -> SparseMatrix:
    places = numbers[:, :2]
    if places.min() < 1 or places.max() > MOST_ROWS:
        raise InputError("has a row or column number that cannot be")
    rows, columns = (places - 1).astype(np.intp).T
    values = numbers[:, 2]
    if not (np.any(rows < columns) and np.any(rows > columns)):
        rows, columns, values = mirrored(rows, columns, values)
    size = int(places.max())
    return SparseMatrix.from_triplets((size, size), rows, columns, values)
