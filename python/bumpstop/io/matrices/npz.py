"""Sparse matrices of SciPy (.npz) and dense arrays of NumPy (.npy), read and written."""

from __future__ import annotations

import zipfile
import zlib
from pathlib import Path

import numpy as np

from bumpstop.errors import InputError
from bumpstop.files import written_whole
from bumpstop.io.arrays import UNREADABLE, check_members
from bumpstop.io.reading import in_file, read_content
from bumpstop.structure.given import given_matrix
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["read_npy", "read_npz", "write_npz"]

_KIND = "a sparse matrix of SciPy"


def read_npz(path: Path) -> SparseMatrix:
    """Read what ``scipy.sparse.save_npz`` wrote, in any of its formats.

    Raises
    ------
    InputError
        If the file cannot be read, is truncated, or holds something else.
    """
    from scipy import sparse

    with in_file(path):
        check_members(path, _KIND)
        try:
            matrix = sparse.load_npz(path)
            if matrix.format in ("csr", "csc", "bsr"):
                matrix.check_format(full_check=True)
            return given_matrix("the matrix", matrix)
        except InputError:
            raise
        except (KeyError, ValueError, TypeError, IndexError, OSError) as error:
            what = "is no sparse matrix of SciPy, or is damaged"
            raise InputError(what, hint="write it with scipy.sparse.save_npz") from error
        except (zipfile.BadZipFile, zlib.error, EOFError) as error:
            raise InputError("is truncated or damaged") from error


def read_npy(path: Path) -> SparseMatrix:
    """Read a dense matrix that ``numpy.save`` wrote.

    Raises
    ------
    InputError
        If the file cannot be read, is truncated, or holds something else.
    """
    with in_file(path):
        read_content(path, "an array of NumPy")
        try:
            # Mapped, not read: a header that announces too much is found out at once.
            array = np.load(path, mmap_mode="r", allow_pickle=False)
        except UNREADABLE as error:
            raise InputError("is no array of NumPy, or is truncated") from error
        return given_matrix("the matrix", np.array(array))


def write_npz(path: Path, matrix: SparseMatrix) -> None:
    """Write a matrix for ``scipy.sparse.load_npz``.

    Raises
    ------
    InputError
        If nothing can be written there.
    """
    from scipy import sparse

    with written_whole(path) as part, part.open("wb") as file:
        sparse.save_npz(file, matrix.to_scipy())
