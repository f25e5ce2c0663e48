"""From files to Matrices."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io.matrices.abaqus import read_abaqus
from bumpstop.io.matrices.dmig import read_dmig
from bumpstop.io.matrices.dof_map import DofMap, read_dof_map
from bumpstop.io.matrices.matrix_market import BANNER, read_matrix_market
from bumpstop.io.matrices.npz import read_npy, read_npz
from bumpstop.io.matrices.op4 import read_op4
from bumpstop.io.matrices.triplets import FileMatrix
from bumpstop.io.matrices.units import matrix_in_si, places_in_si
from bumpstop.io.reading import in_file
from bumpstop.structure.dofs import Dof
from bumpstop.structure.matrices import ACCURACY, Matrices
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["MatrixSet", "read_matrices", "read_matrix", "read_matrix_set"]

AnyPath = str | PathLike[str]


def read_matrices(
    *,
    stiffness: AnyPath,
    mass: AnyPath,
    damping: AnyPath | None = None,
    gyroscopic: AnyPath | None = None,
    circulatory: AnyPath | None = None,
    dofs: AnyPath | None = None,
    fixed: Sequence[Dof] = (),
    accuracy: float = ACCURACY,
    length: float = 1.0,
    force: float = 1.0,
) -> Matrices:
    """Read the matrices of a structure from files of another program.

    Formats are told by the ends of the names: ``.mtx`` (Matrix Market or Abaqus), ``.npz`` (SciPy),
    ``.npy`` (NumPy), ``.op4`` (Nastran OUTPUT4), ``.pch .bdf .dat .nas`` (Nastran DMIG). Of a file
    with several matrices one is chosen by name: ``"model.op4#KAA"``.

    Parameters
    ----------
    stiffness, mass, damping, gyroscopic, circulatory
        The files; those that are left out are zero.
    dofs
        A dof map (``.csv``). Formats that name their dofs, DMIG and Abaqus, do without;
        it then adds coordinates.
    fixed
        Node and dof of what is held at zero, beside what the dof map says.
    accuracy
        How exact the entries are; see ``Matrices``.
    length, force
        Units of the files in m and N, where they are not SI: 1e-3 and 1 for mm, N and t. Time
        is in s, and mass in what follows from these.

    Raises
    ------
    InputError
        If a file is missing, truncated or in another format, or the matrices do not fit
        together; the message names the file.
    """
    paths = {
        "stiffness": stiffness,
        "mass": mass,
        "damping": damping,
        "gyroscopic": gyroscopic,
        "circulatory": circulatory,
    }
    files = {key: path for key, path in paths.items() if path is not None}
    given = read_matrix_set(files, dofs).in_si(length=length, force=force)
    return given.model(fixed=fixed, accuracy=accuracy)


@dataclass(frozen=True, eq=False)
class MatrixSet:
    """Matrices from files, on the same dofs, before anything is held.

    Parameters
    ----------
    matrices
        By argument of ``Matrices``.
    dof_map
        What their rows are.
    files
        Where each came from, the dof map too.
    """

    matrices: Mapping[str, SparseMatrix]
    dof_map: DofMap
    files: Mapping[str, str]

    def in_si(self, *, length: float, force: float) -> MatrixSet:
        """Return the same in SI units; ``length`` and ``force`` are those of the files, in m and N.

        Raises
        ------
        InputError
            If a unit is not positive.
        """
        dofs = self.dof_map.dofs
        return MatrixSet(
            {
                key: matrix_in_si(matrix, dofs, length=length, force=force)
                for key, matrix in self.matrices.items()
            },
            places_in_si(self.dof_map, length),
            self.files,
        )

    def model(self, *, fixed: Sequence[Dof] = (), accuracy: float = ACCURACY) -> Matrices:
        """Return the model, with some dofs held beside those that the dof map tells.

        Raises
        ------
        InputError
            If the matrices do not make a model; the message names the file.
        """
        try:
            return Matrices(
                **self.matrices,
                dofs=self.dof_map.dofs,
                positions=self.dof_map.positions or None,
                fixed=tuple(dict.fromkeys([*self.dof_map.fixed, *fixed])),
                accuracy=accuracy,
            )
        except InputError as error:
            first = (error.key or "").partition("[")[0].partition(".")[0]
            source = {**self.files, "positions": self.files["dofs"]}.get(first)
            raise error.located(file=source) from error


def read_matrix_set(files: Mapping[str, AnyPath], dofs: AnyPath | None) -> MatrixSet:
    """Read matrices, by argument of ``Matrices``, and the dof map where there is one.

    Raises
    ------
    InputError
        If a file is missing, truncated or in another format, or sizes do not fit together.
    """
    names = {key: str(path) for key, path in files.items()}
    read = {key: read_matrix(path) for key, path in names.items()}
    dof_map = read_dof_map(Path(dofs)) if dofs is not None else _named_dofs(names, read)
    return MatrixSet(
        matrices={key: _ordered(names[key], matrix, dof_map) for key, matrix in read.items()},
        dof_map=dof_map,
        files={**names, "dofs": str(dofs) if dofs is not None else names["stiffness"]},
    )


def read_matrix(path: AnyPath) -> FileMatrix:
    """Read one matrix; ``"model.op4#KAA"`` names one of several in a file.

    Raises
    ------
    InputError
        If the file cannot be read, its kind is not known, or it has no such matrix.
    """
    text, _, name = str(path).partition("#")
    file = Path(text)
    with in_file(file):
        kind = file.suffix.lower()
        if kind in _SEVERAL:
            return _chosen(_SEVERAL[kind](file), name)
        if kind not in _SINGLE:
            hint = "known: " + ", ".join([*_SINGLE, *_SEVERAL])
            raise InputError("is of no known kind of matrix", value=file.suffix, hint=hint)
        if name:
            raise InputError("has only one matrix", value=name, hint="leave out what follows '#'")
        return _SINGLE[kind](file)


def _read_mtx(path: Path) -> FileMatrix:
    """Read what is called ``.mtx`` by NIST and by Abaqus alike."""
    with path.open("rb") as file:
        is_matrix_market = file.read(len(BANNER)).lower() == BANNER.encode()
    return FileMatrix(read_matrix_market(path)) if is_matrix_market else read_abaqus(path)


def _read_op4(path: Path) -> dict[str, FileMatrix]:
    return {name: FileMatrix(matrix) for name, matrix in read_op4(path).items()}


_SINGLE: Mapping[str, Callable[[Path], FileMatrix]] = {
    ".mtx": _read_mtx,
    ".npz": lambda path: FileMatrix(read_npz(path)),
    ".npy": lambda path: FileMatrix(read_npy(path)),
}
_SEVERAL: Mapping[str, Callable[[Path], dict[str, FileMatrix]]] = {
    ".op4": _read_op4,
    ".pch": read_dmig,
    ".bdf": read_dmig,
    ".dat": read_dmig,
    ".nas": read_dmig,
}


def _chosen(matrices: dict[str, FileMatrix], name: str) -> FileMatrix:
    if not matrices:
        raise InputError("holds no matrix")
    if not name and len(matrices) == 1:
        return next(iter(matrices.values()))
    if not name:
        hint = "say which after '#': " + ", ".join(matrices)
        raise InputError(f"holds {len(matrices)} matrices", hint=hint)
    if name not in matrices:
        raise InputError("has no such matrix", value=name, hint=did_you_mean(name, matrices))
    return matrices[name]


def _named_dofs(files: Mapping[str, str], read: Mapping[str, FileMatrix]) -> DofMap:
    """Return all dofs that the files name, by number of node."""
    dofs: set[Dof] = set()
    for key, matrix in read.items():
        if matrix.dofs is None:
            hint = "give a dof map: a table with columns node and dof"
            raise InputError("does not say what its rows are", file=files[key], hint=hint)
        dofs.update(matrix.dofs)
    return DofMap(tuple(sorted(dofs, key=lambda dof: (int(dof[0]), dof[1]))))


def _ordered(file: str, read: FileMatrix, dof_map: DofMap) -> SparseMatrix:
    """Return a matrix with its rows in the order of the dof map."""
    if read.dofs is None:
        size = len(dof_map.dofs)
        if read.matrix.shape != (size, size):
            rows, columns = read.matrix.shape
            what = f"is {rows} x {columns}, but there are {size} dofs"
            raise InputError(what, file=file, hint="is the dof map another model's?")
        return read.matrix
    number = {dof: row for row, dof in enumerate(dof_map.dofs)}
    for dof in read.dofs:
        if dof not in number:
            raise InputError("has a dof that the dof map has not", file=file, value=".".join(dof))
    places = np.array([number[dof] for dof in read.dofs], dtype=np.intp)
    matrix = read.matrix
    shape = (len(number), len(number))
    return SparseMatrix.from_triplets(
        shape, places[matrix.rows], places[matrix.columns], matrix.values
    )
