"""OP4 files, written here from the format's description; the text ones also by pyNastran 1.4."""

from __future__ import annotations

import struct
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bumpstop import InputError
from bumpstop.arguments import FloatArray
from bumpstop.io.matrices.op4 import read_op4

PAIR = np.array([[2.0, -1.0], [-1.0, 3.0]])


def record(ends: str, *parts: bytes) -> bytes:
    data = b"".join(parts)
    length = struct.pack(f"{ends}i", len(data))
    return length + data + length


def binary(
    matrix: FloatArray,
    *,
    ends: str = "<",
    word: int = 4,
    kind: int = 2,
    sparse: str = "",
    name: str = "KAA",
    form: int = 6,
) -> bytes:
    """Return an OP4 file with one matrix; ``sparse`` is "", "small" or "big"."""
    whole = f"{ends}{'i' if word == 4 else 'q'}"

    def words(*numbers: int) -> bytes:
        return b"".join(struct.pack(whole, number) for number in numbers)

    real = f"{ends}f{8 if kind == 2 else word}"
    rows, columns = matrix.shape
    signed = -rows if sparse == "big" else rows
    title = name.ljust(2 * word).encode()
    content = record(ends, words(columns, signed, form, kind), title)
    for number, column in enumerate(matrix.T, start=1):
        filled = np.flatnonzero(column)
        if not len(filled):
            continue
        if not sparse:
            values = column[filled[0] : filled[-1] + 1].astype(real).tobytes()
            head = words(number, int(filled[0]) + 1, len(values) // word)
            content += record(ends, head, values)
            continue
        strings = b""
        for string in np.split(filled, np.flatnonzero(np.diff(filled) > 1) + 1):
            values = column[string].astype(real).tobytes()
            length, row = len(values) // word, int(string[0]) + 1
            strings += (
                words(length + 1, row) if sparse == "big" else words(row + 65536 * (length + 1))
            )
            strings += values
        content += record(ends, words(number, 0, len(strings) // word), strings)
    last = np.ones(1).astype(real).tobytes()
    return content + record(ends, words(columns + 1, 1, len(last) // word), last)


def text(matrix: FloatArray, *, sparse: str = "", name: str = "KAA", form: int = 6) -> str:
    rows, columns = matrix.shape
    signed = -rows if sparse == "big" else rows
    lines = [f"{columns:8d}{signed:8d}{form:8d}{2:8d}{name:8s}1P,3E23.16"]
    for number, column in enumerate(matrix.T, start=1):
        filled = np.flatnonzero(column)
        if not len(filled):
            continue
        if not sparse:
            dense = column[filled[0] : filled[-1] + 1]
            lines += [f"{number:8d}{filled[0] + 1:8d}{len(dense):8d}", *reals(dense)]
            continue
        lines.append(f"{number:8d}{0:8d}{2 * len(filled) + 1:8d}")
        for string in np.split(filled, np.flatnonzero(np.diff(filled) > 1) + 1):
            length, row = 2 * len(string), int(string[0]) + 1
            small = f"{row + 65536 * (length + 1):12d}"
            lines.append(f"{length + 1:8d}{row:8d}" if sparse == "big" else small)
            lines += reals(column[string])
    return "\n".join([*lines, f"{columns + 1:8d}{1:8d}{1:8d}", *reals(np.ones(1))]) + "\n"


def reals(values: FloatArray) -> list[str]:
    words = [f"{value:23.16E}" for value in values]
    return ["".join(words[start : start + 3]) for start in range(0, len(words), 3)]


def read(content: bytes | str) -> dict[str, FloatArray]:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "model.op4"
        file.write_bytes(content.encode() if isinstance(content, str) else content)
        return {name: matrix.to_dense() for name, matrix in read_op4(file).items()}


def random_symmetric(size: int, density: float, seed: int) -> FloatArray:
    random = np.random.default_rng(seed)
    half = random.standard_normal((size, size)) * (random.random((size, size)) < density)
    return half + half.T


@settings(max_examples=60, deadline=None)
@given(
    size=st.integers(1, 9),
    density=st.floats(0.0, 1.0),
    seed=st.integers(0, 2**32 - 1),
    ends=st.sampled_from("<>"),
    word=st.sampled_from([4, 8]),
    sparse=st.sampled_from(["", "small", "big"]),
)
def test_binary_files_arrive_unchanged(
    size: int, density: float, seed: int, ends: str, word: int, sparse: str
) -> None:
    matrix = random_symmetric(size, density, seed)
    content = binary(matrix, ends=ends, word=word, sparse=sparse)
    np.testing.assert_array_equal(read(content)["KAA"], matrix)


@settings(max_examples=60, deadline=None)
@given(
    size=st.integers(1, 9),
    density=st.floats(0.0, 1.0),
    seed=st.integers(0, 2**32 - 1),
    sparse=st.sampled_from(["", "small", "big"]),
)
def test_text_files_arrive_unchanged(size: int, density: float, seed: int, sparse: str) -> None:
    matrix = random_symmetric(size, density, seed)
    np.testing.assert_array_equal(read(text(matrix, sparse=sparse))["KAA"], matrix)


def test_single_precision() -> None:
    np.testing.assert_array_equal(read(binary(PAIR, kind=1))["KAA"], PAIR)


def test_several_matrices_in_one_file() -> None:
    for content in (
        binary(PAIR) + binary(2.0 * PAIR, name="MAA"),
        text(PAIR) + text(2.0 * PAIR, name="MAA"),
    ):
        found = read(content)
        assert list(found) == ["KAA", "MAA"]
        np.testing.assert_array_equal(found["MAA"], 2.0 * PAIR)


def test_one_triangle_of_a_symmetric_matrix_stands_for_both() -> None:
    np.testing.assert_array_equal(read(text(np.tril(PAIR)))["KAA"], PAIR)
    np.testing.assert_array_equal(read(text(np.tril(PAIR), form=1))["KAA"], np.tril(PAIR))


def test_a_sparse_file_by_pynastran() -> None:
    content = (
        "       2       2       6       2KAA     1P,3E23.16\n"
        "       1       0       5\n      327681\n"
        " 2.0000000000000000E+00-1.0000000000000000E+00\n"
        "       2       0       5\n      327681\n"
        "-1.0000000000000000E+00 3.0000000000000000E+00\n"
        "       3       1       1\n 1.0000000000000000E+00\n"
    )
    np.testing.assert_array_equal(read(content)["KAA"], PAIR)


@pytest.mark.parametrize("sparse", ["", "small", "big"])
def test_every_truncation_is_noticed(sparse: str) -> None:
    matrix = random_symmetric(5, 0.6, 3)
    whole = binary(matrix, sparse=sparse)
    for end in range(1, len(whole), 7):
        with pytest.raises(InputError, match=r"model\.op4: "):
            read(whole[:end])
    lines = text(matrix, sparse=sparse).splitlines()
    for stop in range(1, len(lines) - 1):
        with pytest.raises(InputError, match="truncated within matrix 'KAA'"):
            read("\n".join(lines[:stop]) + "\n")


@settings(max_examples=100, deadline=None)
@given(st.binary(min_size=0, max_size=200), st.sampled_from([b"", b"\x18\0\0\0", b"\0\0\0\x18"]))
def test_trash_is_refused_in_one_line(trash: bytes, start: bytes) -> None:
    with pytest.raises(InputError, match=r"model\.op4") as refused:
        read(start + trash)
    assert "\n" not in str(refused.value)


def test_huge_sizes_make_no_room() -> None:
    head = record("<", struct.pack("<4i", 2_000_000_000, 2_000_000_000, 6, 2), b"KAA     ")
    with pytest.raises(InputError, match="announces 2000000000 rows"):
        read(head)
    with pytest.raises(InputError, match="announces 99999999 rows"):
        read("99999999999999990000000600000002KAA     1P,3E23.16\n")


def test_complex_matrices_are_refused() -> None:
    with pytest.raises(InputError, match=r"'KAA' must be real, not complex .got 'type 4'."):
        read("       2       2       6       4KAA     1P,3E23.16\n")


def test_strings_outside_of_the_matrix_are_refused() -> None:
    content = text(PAIR).replace("       1       1       2", "       1       2       2")
    with pytest.raises(InputError, match="rows 2 to 3 of column 1, which is outside"):
        read(content)
