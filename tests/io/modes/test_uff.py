"""Universal files: by hand from the format's description, and written by pyuff."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import pyuff

from bumpstop import InputError
from bumpstop.io import ModeSet, read_modes

UNITS_MM = """\
    -1
   164
         5mm (milli newton)           2
  1.0000000000000000D+03  1.0000000000000000D+03  1.0000000000000000D+00
  2.7314999999999998D+02
    -1
"""
MODE = """\
    -1
    55
NONE
NONE
NONE
NONE
NONE
         1         2         3         8         2         6
         2         4         0         1
  1.25000E+01  4.00000E+00  1.00000E-02  0.00000E+00
        12
  1.00000E+00 -2.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  5.00000E-01
         3
  0.00000E+00  2.50000E-01  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00
    -1
"""


def read(tmp_path: Path, text: str) -> ModeSet:
    file = tmp_path / "modes.uff"
    file.write_text(text)
    return read_modes(file)


def test_a_real_mode(tmp_path: Path) -> None:
    modes = read(tmp_path, MODE)
    assert modes.dofs == (("3", "dy"), ("12", "dx"), ("12", "dy"), ("12", "drz"))
    np.testing.assert_array_equal(modes.shapes[:, 0], [0.25, 1.0, -2.0, 0.5])
    basis = modes.basis()
    np.testing.assert_allclose(basis.frequencies, [12.5])
    np.testing.assert_array_equal(basis.damping_ratio, [0.01])
    np.testing.assert_array_equal(basis.row("12", "dy"), [-1.0])


def test_units(tmp_path: Path) -> None:
    """In mm and mN a modal mass of 4 is 4 kg, and 0.5 rad/mm are 500 rad/m."""
    modes = read(tmp_path, UNITS_MM + MODE)
    assert modes.modal_mass is not None
    np.testing.assert_allclose(modes.modal_mass, [4.0])
    np.testing.assert_allclose(modes.shapes[:, 0], [0.25, 1.0, -2.0, 500.0])
    tonnes = UNITS_MM.replace("03  1.0000000000000000D+03", "03  1.0000000000000000D+00")
    heavy = read(tmp_path, tonnes + MODE)
    assert heavy.modal_mass is not None
    np.testing.assert_allclose(heavy.modal_mass, [4000.0])


def test_a_dof_that_was_not_measured_is_not_at_rest(tmp_path: Path) -> None:
    basis = read(tmp_path, MODE).basis()
    with pytest.raises(InputError, match="no mode shape for this dof"):
        basis.row("3", "dz")


def test_hysteretic_damping_counts_half(tmp_path: Path) -> None:
    text = MODE.replace("1.00000E-02  0.00000E+00", "0.00000E+00  4.00000E-02")
    np.testing.assert_allclose(read(tmp_path, text).damping, [0.02])


def test_modes_without_modal_mass_ask_for_one(tmp_path: Path) -> None:
    modes = read(tmp_path, MODE.replace("4.00000E+00  1.0", "0.00000E+00  1.0"))
    with pytest.raises(InputError, match="modal_mass: is missing; the file does not tell"):
        modes.basis()
    np.testing.assert_array_equal(modes.basis(modal_mass=1.0).row("12", "dy"), [-2.0])


def test_what_pyuff_writes_is_read(tmp_path: Path) -> None:
    random = np.random.default_rng(5)
    nodes = np.array([1, 4, 7])
    shapes = random.uniform(0.5, 2.0, (6, 3, 4))
    file = tmp_path / "modes.uff"
    writer = pyuff.UFF(str(file))
    for number in range(4):
        writer.write_sets(
            {
                "type": 55,
                "analysis_type": 2,
                "data_ch": 3,
                "spec_data_type": 8,
                "load_case": 0,
                "mode_n": number + 1,
                "freq": 3.0 + number,
                "modal_m": 2.0,
                "modal_damp_vis": 0.01 * number,
                "node_nums": nodes,
                **{f"r{i + 1}": shapes[i, :, number] for i in range(6)},
            },
            "add",
        )
    modes = read_modes(file)
    assert len(modes.dofs) == 18
    np.testing.assert_allclose(modes.frequency, [3.0, 4.0, 5.0, 6.0])
    np.testing.assert_allclose(modes.damping, [0.0, 0.01, 0.02, 0.03])
    expected = shapes.transpose(1, 0, 2).reshape(18, 4)
    np.testing.assert_allclose(modes.shapes, expected, rtol=1e-5)


def complex_mode(tmp_path: Path, *, phase: complex, skew: complex = 1.0) -> ModeSet:
    """Write a mode of 10 Hz and 2 %, of modal mass 3, whose shape is turned by a phase."""
    omega, ratio, mass = 2.0 * np.pi * 10.0, 0.02, 3.0
    damped = omega * np.sqrt(1.0 - ratio**2)
    shape = np.array([1.0, -0.5]) * phase
    file = tmp_path / "complex.uff"
    pyuff.UFF(str(file)).write_sets(
        {
            "type": 55,
            "analysis_type": 3,
            "data_ch": 2,
            "spec_data_type": 8,
            "load_case": 0,
            "mode_n": 1,
            "eig": complex(-ratio * omega, damped),
            "modal_a": 2j * damped * mass * phase**2,
            "modal_b": 0j,
            "node_nums": np.array([1, 2]),
            "r1": shape * np.array([1.0, skew]),
            "r2": 0.0 * shape,
            "r3": 0.0 * shape,
        },
        "add",
    )
    return read_modes(file)


@pytest.mark.parametrize("phase", [1.0, 1j, np.exp(0.7j), 4.0 * np.exp(-2.0j)])
def test_a_complex_mode_in_phase_is_real(tmp_path: Path, phase: complex) -> None:
    modes = complex_mode(tmp_path, phase=phase)
    np.testing.assert_allclose(modes.frequency, [10.0], rtol=1e-5)
    np.testing.assert_allclose(modes.damping, [0.02], rtol=1e-5)
    basis = modes.basis()
    np.testing.assert_allclose(
        np.abs(basis.row("1", "dx")), np.array([1.0 / np.sqrt(3.0)]), rtol=1e-5
    )


def test_a_complex_mode_out_of_phase_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"mode 1 is complex: \d+% of it moves out of phase"):
        complex_mode(tmp_path, phase=1.0, skew=1j)


REFUSED = {
    "": "is empty",
    "nothing here\n": "is not a universal file: it has no data set",
    MODE[:-7]: "is truncated within the data set that begins at line 2",
    UNITS_MM: "holds no mode; modes are data sets 55, measured functions 58, and it has 164",
    "    -1\n    58\nNONE\n    -1\n": "data set 58 is truncated",
    "    -1\n    -1\n": "a data set must begin with its number",
    MODE.replace("  5.00000E-01\n", "\n"): "line 14: data set 55 cannot be read here",
    MODE.replace("        12\n", "    twelve\n"): "line 11: data set 55 cannot be read",
    MODE.replace(
        "         8         2         6\n", "         8         2         4\n"
    ): "4 values",
    MODE.replace("         3\n  0.0", "        12\n  0.0"): "gives node 12 twice",
    MODE[: MODE.index("        12")] + "    -1\n": "a mode has no node",
    MODE[: MODE.index("  1.25")] + "    -1\n": "data set 55 is truncated",
    "\0\1": "is a binary file",
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=list(REFUSED.values()))
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"modes\.uff: .*{message}"):
        read(tmp_path, text)
