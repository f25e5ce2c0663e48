"""Abaqus matrices, by hand from the format's description."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from bumpstop import InputError
from bumpstop.io.matrices.abaqus import read_abaqus
from bumpstop.io.matrices.triplets import FileMatrix

DENSE = [[2.0, -1.0, 0.0], [-1.0, 3.0, 0.5], [0.0, 0.5, 4.0]]
LOWER = """\
1,1, 1,1,  2.000000000000000e+00
2,1, 1,1, -1.000000000000000e+00
2,1, 2,1,  3.000000000000000e+00
10,6, 2,1,  5.000000000000000e-01
10,6, 10,6,  4.000000000000000e+00
"""
UPPER = "1 1 1 1 2.\n1 1 2 1 -1.\n2 1 2 1 3.\n2 1 10 6 .5\n10 6 10 6 4.\n"
BOTH = UPPER + "2 1 1 1 -1.\n10 6 2 1 .5\n"
COORDINATE = "1 1 2.\n2 1 -1.D0\n2 2 3.\n3 2 0.5\n3 3 4.\n"


def read(tmp_path: Path, text: str) -> FileMatrix:
    file = tmp_path / "job_STIF1.mtx"
    file.write_text(text)
    return read_abaqus(file)


@pytest.mark.parametrize("text", [LOWER, UPPER, BOTH, "** made by hand\n" + LOWER])
def test_labels_in_either_triangle_or_both(tmp_path: Path, text: str) -> None:
    matrix = read(tmp_path, text)
    assert matrix.dofs == (("1", "dx"), ("2", "dx"), ("10", "drz"))
    np.testing.assert_array_equal(matrix.matrix.to_dense(), DENSE)


def test_coordinates(tmp_path: Path) -> None:
    matrix = read(tmp_path, COORDINATE)
    assert matrix.dofs is None
    np.testing.assert_array_equal(matrix.matrix.to_dense(), DENSE)


REFUSED = {
    "": "is empty, but should be a matrix$",
    "** nothing\n": "holds no entry",
    "1,1,1,1\n": "line 1: is no entry",
    "1,1,1,1,2.\n2,1,1,1\n": "line 2: is no entry",
    "1,1,1,1,spring\n": "line 1: is no entry",
    "1.5,1,1,1,2.\n": "line 1: is no entry",
    "1,11,1,11,2.\n": "component 11 of node 1 is no displacement or rotation",
    "0 1 2.\n": "has a row or column number that cannot be",
    "9999999999 1 2.\n": "has a row or column number that cannot be",
    "\0": "is a binary file",
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=list(REFUSED.values()))
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"job_STIF1\.mtx: .*{message}"):
        read(tmp_path, text)
