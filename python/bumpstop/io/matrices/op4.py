"""Nastran OP4 files: matrices that OUTPUT4 wrote, as text or binary, sparse or dense."""

from __future__ import annotations

from pathlib import Path

from bumpstop.errors import InputError
from bumpstop.io.matrices.op4_binary import binary_order, read_binary
from bumpstop.io.matrices.op4_text import read_text
from bumpstop.io.reading import in_file, read_content, read_lines
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["read_op4"]

_KIND = "an OP4 file"


def read_op4(path: Path) -> dict[str, SparseMatrix]:
    """Read all real matrices of a file, by name.

    Raises
    ------
    InputError
        If the file cannot be read, is not in this format, is truncated, or is not real.
    """
    with in_file(path):
        content = read_content(path, _KIND)
        order = binary_order(content)
        matrices = read_binary(content, order) if order else read_text(read_lines(path, _KIND))
        if not matrices:
            raise InputError("holds no matrix")
        return {matrix.name: matrix.assembled() for matrix in matrices}
