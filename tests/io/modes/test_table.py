from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bumpstop import InputError, ModesAround, ModesInBand
from bumpstop.io import ModeSet, read_modes

TABLE = """\
# measured on the shaker
frequency,damping,modal_mass,P.dx,tip.left.drz
3.0,0.01,4.0,2.0,0.5
7.5,0.02,1.0,0.4,-1
"""


def read(tmp_path: Path, text: str) -> ModeSet:
    file = tmp_path / "modes.csv"
    file.write_text(text)
    return read_modes(file)


def test_a_line_a_mode(tmp_path: Path) -> None:
    modes = read(tmp_path, TABLE)
    assert modes.dofs == (("P", "dx"), ("tip.left", "drz"))
    basis = modes.basis()
    np.testing.assert_allclose(basis.frequencies, [3.0, 7.5])
    np.testing.assert_array_equal(basis.damping_ratio, [0.01, 0.02])
    np.testing.assert_array_equal(basis.row("P", "dx"), [1.0, 0.4])
    np.testing.assert_array_equal(basis.row("tip.left", "drz"), [0.25, -1.0])


def test_what_is_left_out(tmp_path: Path) -> None:
    modes = read(tmp_path, "P.dy;frequency\n1;5\n2;4\n")
    basis = modes.basis(modes=1, damping=0.03)
    np.testing.assert_allclose(basis.frequencies, [4.0])
    np.testing.assert_array_equal(basis.damping_ratio, [0.03])
    np.testing.assert_array_equal(basis.row("P", "dy"), [2.0])


@pytest.mark.parametrize(
    ("modes", "expected"),
    [
        (2, [3.0, 4.0]),
        (ModesInBand(4.0, 7.0), [4.0, 7.0]),
        (ModesAround(6.0, 2), [4.0, 7.0]),
        ("all", [3.0, 4.0, 7.0, 9.0]),
    ],
)
def test_some_of_the_modes(modes: Any, expected: list[float], tmp_path: Path) -> None:
    table = "frequency,modal_mass,P.dx\n9,1,9\n4,1,4\n3,1,3\n7,1,7\n"
    basis = read(tmp_path, table).basis(modes=modes)
    np.testing.assert_allclose(basis.frequencies, expected)
    np.testing.assert_array_equal(basis.row("P", "dx"), expected)


def test_a_users_own_modal_mass(tmp_path: Path) -> None:
    basis = read(tmp_path, TABLE).basis(modal_mass=[16.0, 4.0])
    np.testing.assert_array_equal(basis.row("P", "dx"), [0.5, 0.2])


def test_what_the_file_has_not_is_refused_by_name(tmp_path: Path) -> None:
    basis = read(tmp_path, TABLE).basis()
    with pytest.raises(InputError, match=r"no mode shape at this node .got 'Q'."):
        basis.row("Q", "dx")
    with pytest.raises(InputError, match=r"no mode shape for this dof .got 'dy'.; known at"):
        basis.row("P", "dy")
    with pytest.raises(InputError, match=r"modes: more modes than the file has .got 3."):
        read(tmp_path, TABLE).basis(modes=3)


REFUSED = {
    "": "is empty",
    "frequency,P.dx\n": "holds no mode",
    "damping,P.dx\n1,1\n": "has no column 'frequency'",
    "frequency,damping\n1,1\n": "has no shapes",
    "frequency,P.dx,P.dx\n1,1,1\n": "this column is there twice .got 'P.dx'.",
    "frequency,P.ux\n1,1\n": "unknown column .got 'P.ux'.; did you mean 'P.dx'",
    "frequency,P\n1,1\n": "unknown column .got 'P'.",
    "frequency,P.dx\n1,1\n2\n": "line 3: has 1 fields instead of 2; is the file truncated",
    "frequency,P.dx\n1,one\n": "line 2: P.dx must be a number .got 'one'.",
    "frequency,P.dx\n1,inf\n": "line 2: P.dx must be a number",
    "\0": "is a binary file",
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=list(REFUSED.values()))
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"modes\.csv: .*{message}"):
        read(tmp_path, text)


def test_other_kinds_of_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"modes\.txt: is of no known kind of modes"):
        read_modes(tmp_path / "modes.txt")
    with pytest.raises(InputError, match=r"modes\.csv: no such file"):
        read_modes(tmp_path / "modes.csv")
