"""OP4 files in binary form: records of Fortran, each between two copies of its length."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.io.matrices.op4_columns import Op4Matrix, small_string

__all__ = ["Order", "binary_order", "read_binary"]


class Order(NamedTuple):
    """How numbers are laid down."""

    ends: str
    """``"<"`` for little-endian, ``">"`` for big-endian."""
    word: int
    """Bytes of a word: 4, or 8 where Nastran runs with 64-bit integers."""

    @property
    def integer(self) -> str:
        """Type of a whole number, as NumPy names it."""
        return f"{self.ends}i{self.word}"


def binary_order(content: bytes) -> Order | None:
    """Return how numbers are laid down; None for a file that does not begin as a binary one."""
    for ends in "<>":
        for word in (4, 8):
            if content[:4] == struct.pack(f"{ends}i", 6 * word):
                return Order(ends, word)
    return None


def read_binary(content: bytes, order: Order) -> list[Op4Matrix]:
    """Return the matrices of an OP4 file in binary form.

    Raises
    ------
    InputError
        If a record cannot be read, or the file ends within a matrix.
    """
    records = _records(content, order)
    matrices = []
    for record in records:
        matrix = _header(record, order)
        _read_columns(matrix, records, order)
        matrices.append(matrix)
    return matrices


def _records(content: bytes, order: Order) -> Iterator[bytes]:
    place = 0
    while place < len(content):
        start = content[place : place + 4]
        length = struct.unpack(f"{order.ends}i", start)[0] if len(start) == 4 else -1
        end = place + 4 + length
        if length < 0 or content[end : end + 4] != start:
            raise InputError(f"is truncated or damaged at byte {place}")
        yield content[place + 4 : end]
        place = end + 4


def _header(record: bytes, order: Order) -> Op4Matrix:
    if len(record) != 6 * order.word:
        raise InputError(f"a matrix must begin with {6 * order.word} bytes, not {len(record)}")
    columns, rows, form, kind = np.frombuffer(record, order.integer, 4).tolist()
    name = record[4 * order.word :].decode("latin-1")
    return Op4Matrix(columns, rows, form, kind, name)


def _read_columns(matrix: Op4Matrix, records: Iterator[bytes], order: Order) -> None:
    for record in records:
        if len(record) < 3 * order.word:
            break
        column, row, words = np.frombuffer(record, order.integer, 3).tolist()
        if column > matrix.shape[1]:
            return
        data = record[3 * order.word :][: words * order.word]
        if row > 0:
            matrix.add(column, row, _reals(matrix, data, order))
        else:
            _add_strings(matrix, column, data, order)
    raise InputError(f"is truncated within matrix {matrix.name!r}")


def _add_strings(matrix: Op4Matrix, column: int, data: bytes, order: Order) -> None:
    place = 0
    announced = 2 if matrix.big else 1
    while place + announced * order.word <= len(data):
        words = np.frombuffer(data, order.integer, announced, place).tolist()
        row, length = (words[1], words[0] - 1) if matrix.big else small_string(words[0])
        place += announced * order.word
        end = place + length * order.word
        if length <= 0 or end > len(data):
            raise InputError(f"a string of column {column} of {matrix.name!r} is damaged")
        matrix.add(column, row, _reals(matrix, data[place:end], order))
        place = end


def _reals(matrix: Op4Matrix, data: bytes, order: Order) -> FloatArray:
    # In words of 8 bytes single and double precision take the same room.
    size = 8 if matrix.kind == 2 else order.word
    if len(data) % size:
        raise InputError(f"a column of {matrix.name!r} is damaged")
    return np.frombuffer(data, f"{order.ends}f{size}").astype(np.float64)
