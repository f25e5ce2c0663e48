from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from bumpstop import InputError
from bumpstop.arguments import FloatArray
from bumpstop.io.matrices.matrix_market import read_matrix_market, write_matrix_market
from bumpstop.structure.given import given_matrix

HEAD = "%%MatrixMarket matrix coordinate real symmetric\n"


def read(tmp_path: Path, text: str) -> FloatArray:
    file = tmp_path / "K.mtx"
    file.write_text(text)
    return read_matrix_market(file).to_dense()


@settings(max_examples=80, deadline=None)
@given(st.integers(1, 12), st.floats(0.0, 1.0), st.integers(0, 2**32 - 1), st.booleans())
def test_what_scipy_writes_is_read(size: int, density: float, seed: int, dense: bool) -> None:
    random = sp.random_array((size, size), density=density, rng=np.random.default_rng(seed))
    with tempfile.TemporaryDirectory() as folder:
        for matrix, symmetry in (
            (random, "general"),
            (random + random.T, "symmetric"),
            (random - random.T, "skew-symmetric"),
        ):
            file = Path(folder) / "K.mtx"
            written = matrix.toarray() if dense else matrix
            scipy.io.mmwrite(file, written, symmetry=symmetry, precision=17)
            np.testing.assert_array_equal(read_matrix_market(file).to_dense(), matrix.toarray())


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 12), st.floats(0.0, 1.0), st.integers(0, 2**32 - 1), st.booleans())
def test_scipy_reads_what_is_written(size: int, density: float, seed: int, skew: bool) -> None:
    random = sp.random_array((size, size), density=density, rng=np.random.default_rng(seed))
    matrix = (random - random.T if skew else random + random.T).tocoo()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "K.mtx"
        write_matrix_market(file, given_matrix("K", matrix), skew=skew)
        np.testing.assert_array_equal(scipy.io.mmread(file).toarray(), matrix.toarray())


def test_comments_blank_lines_and_the_exponents_of_fortran(tmp_path: Path) -> None:
    text = HEAD + "% written by hand\n\n2 2 2\n1 1 1.5D+01\n% half way\n2 1 -2.0d0\n\n"
    np.testing.assert_array_equal(read(tmp_path, text), [[15.0, -2.0], [-2.0, 0.0]])


def test_complex_numbers_without_imaginary_parts_are_real(tmp_path: Path) -> None:
    text = "%%MatrixMarket matrix coordinate complex hermitian\n1 1 1\n1 1 3.0 0.0\n"
    np.testing.assert_array_equal(read(tmp_path, text), [[3.0]])


REFUSED = {
    "": "is empty",
    "1 1 2.0\n": "is not a Matrix Market file",
    "%%MatrixMarket matrix elemental real general\n": "unknown layout",
    "%%MatrixMarket matrix coordinate pattern general\n1 1 1\n1 1\n": "has no real values",
    "%%MatrixMarket matrix coordinate real round\n": "unknown symmetry",
    HEAD: "is truncated: it gives no size",
    HEAD + "2 3 1\n1 1 1.0\n": "is announced as symmetric but is not square",
    HEAD + "two 2 2\n": "the sizes cannot be read",
    HEAD + "2 2\n1 1 1.0\n": "the sizes cannot be read",
    HEAD + "2 2 2\n1 1 1.0\n": "announces 2 entries but holds 1; is it truncated?",
    HEAD + "2 2 1\n1 1 1.0\n2 2 1.0\n": "announces 1 entries but holds 2",
    HEAD + "2 2 2\n1 1 1.0\n2 2\n": "an entry cannot be read",
    HEAD + "2 2 1\n1 1 spring\n": "an entry cannot be read",
    HEAD + "2 2 1\n3 1 1.0\n": r"entry 1 is at \(3, 1\), outside of 2 x 2",
    HEAD + "2 2 1\n1 1\n": r"each entry must have 1 value\(s\), not 0",
    HEAD + "2 2 2\n1 2 1.0\n2 1 1.0\n": "gives entries on both sides",
    HEAD + "999999999999999 999999999999999 1\n1 1 1.0\n": "announces more than 50,000,000 rows",
    HEAD + "2 2 999999999999999\n1 1 1.0\n": "announces 999999999999999 entries but holds 1",
    "%%MatrixMarket matrix array real symmetric\n40000000 40000000\n1.0\n": "is it truncated?",
    "%%MatrixMarket matrix coordinate complex general\n1 1 1\n1 1 3.0 1.0\n": "must be real",
    "\0\1\2": "is a binary file",
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=list(REFUSED.values()))
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"K.mtx: .*{message}"):
        read(tmp_path, text)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"K\.mtx: no such file"):
        read_matrix_market(tmp_path / "K.mtx")
    with pytest.raises(InputError, match="is a folder, not a Matrix Market file"):
        read_matrix_market(tmp_path)
