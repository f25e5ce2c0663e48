"""DMIG cards, by hand from the format's description and by pyNastran 1.4."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from bumpstop import InputError
from bumpstop.io.matrices.dmig import read_dmig
from bumpstop.io.matrices.triplets import FileMatrix

DOFS = (("1", "dx"), ("1", "drz"), ("12", "dy"))
DENSE = np.array([[2.5, -1000.0, 0.0], [-1000.0, 3.0, 0.25], [0.0, 0.25, 4.0]])

SMALL = """\
$ a comment, and cards of other kinds
GRID           1              0.      0.      0.
+              x
DMIG        KAAX       0       6       1       0
DMIG        KAAX       1       1               1       1     2.5
               1       6   -1.+3
DMIG        KAAX       1       6               1       6     3.0
              12       2    .25
DMIG        KAAX      12       2              12       2   4.0E0
ENDDATA
"""
LARGE = """\
DMIG*               KAAX               0               6               2
*                      0               0
DMIG*               KAAX               1               1
*                      1               1 2.500000000D+00
*                      1               6-1.000000000D+03
DMIG*               KAAX               1               6
*                      1               6 3.000000000D+00
*                     12               2 2.500000000D-01
DMIG*               KAAX              12               2
*                     12               2 4.000000000D+00
"""
FREE = """\
DMIG,KAAX,0,6,1,0
DMIG,KAAX,1,1,,1,1,2.5
,1,6,-1000.
DMIG,KAAX,1,6,,1,6,3.
,12,2,.25
DMIG,KAAX,12,2,,12,2,4.
"""


def read(tmp_path: Path, text: str) -> dict[str, FileMatrix]:
    file = tmp_path / "model.pch"
    file.write_text(text)
    return read_dmig(file)


@pytest.mark.parametrize("text", [SMALL, LARGE, FREE], ids=["small", "large", "free"])
def test_fields_of_every_width(tmp_path: Path, text: str) -> None:
    matrix = read(tmp_path, text)["KAAX"]
    assert matrix.dofs == tuple(sorted(DOFS, key=lambda dof: int(dof[0])))
    np.testing.assert_array_equal(matrix.matrix.to_dense(), DENSE)


def test_both_triangles_of_a_square_matrix(tmp_path: Path) -> None:
    text = "DMIG,KAAX,0,1,1,0\nDMIG,KAAX,1,1,,1,1,2.\n,2,1,-1.\nDMIG,KAAX,2,1,,1,1,-1.\n,2,1,3.\n"
    matrix = read(tmp_path, text)["KAAX"].matrix
    np.testing.assert_array_equal(matrix.to_dense(), [[2.0, -1.0], [-1.0, 3.0]])


REFUSED = {
    "": "is empty",
    "GRID,1,,0.,0.,0.\n": "has no DMIG card",
    "DMIG,KAAX,0,6,1,0\n": "matrix 'KAAX' has no entries; is the file truncated?",
    "DMIG,KAAX,0,6,3,0\n": "line 1: matrix 'KAAX' must be real",
    "DMIG,KAAX,1,1,,1,1,2.5\n": "line 1: the matrix 'KAAX' has no header",
    "DMIG,KAAX,0,6,1,0\nDMIG,KAAX,1,1,,1,1,spring\n": "line 2: the card cannot be read",
    "DMIG,KAAX,0,6,1,0\nDMIG,KAAX,1,one,,1,1,2.\n": "line 2: the card cannot be read",
    "DMIG,KAAX,0,6,1,0\nDMIG,KAAX,7,0,,7,0,2.\n": "component 0 of node 7 is no displacement",
    "DMIG\n": "line 1: the card cannot be read|has no DMIG card",
    "DMIG,KAAX\n": "line 1: the card cannot be read",
    "DMIG\0": "is a binary file",
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=list(REFUSED.values()))
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"model\.pch: .*({message})"):
        read(tmp_path, text)
