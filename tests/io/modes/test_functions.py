"""Measured functions of universal files: by hand, and written by pyuff."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import pyuff

from bumpstop import FrequencyResponse, InputError, load_case
from bumpstop.io import read_modes
from bumpstop.io.modes.functions import measured_functions
from bumpstop.io.universal import Units, data_sets, file_units

from ...modal.measured_chain import chain

CODES = {"displacement": 8, "velocity": 11, "acceleration": 12}


def written(file: Path, functions: list[FrequencyResponse], *, even: bool = True) -> Path:
    for function in functions:
        pyuff.UFF(str(file)).write_sets(
            {
                "type": 58,
                "func_type": 4,
                "rsp_node": int(function.response[0]),
                "rsp_dir": 1,
                "ref_node": int(function.reference[0]),
                "ref_dir": 1,
                "data": function.values,
                "x": function.frequency,
                "abscissa_spacing": int(even),
                "abscissa_spec_data_type": 18,
                "ordinate_spec_data_type": CODES[function.kind],
                "orddenom_spec_data_type": 13,
                "binary": 0,
            },
            "add",
        )
    return file


@pytest.mark.parametrize("even", [True, False])
@pytest.mark.parametrize("kind", CODES)
def test_files_written_by_pyuff(tmp_path: Path, kind: str, even: bool) -> None:
    exact = chain(4)
    modes = read_modes(written(tmp_path / "m.uff", exact.functions(kind), even=even))
    np.testing.assert_allclose(modes.frequency, exact.omega / (2.0 * np.pi), rtol=1e-6)
    np.testing.assert_allclose(modes.damping, exact.damping, rtol=1e-4)
    np.testing.assert_allclose(modes.shapes, exact.shapes, atol=1e-4)
    assert modes.dofs == tuple((str(number), "dx") for number in (1, 2, 3, 4))


def test_a_case_file(tmp_path: Path) -> None:
    exact = chain(4)
    written(tmp_path / "m.uff", exact.functions())
    case = tmp_path / "case.toml"
    case.write_text(
        '[modes]\nfile = "m.uff"\nband = [5, "60 Hz"]\ncount = 3\n'
        "[basis]\nmodes = 2\n[run]\nduration = 1.0\n"
    )
    basis = load_case(case).problems["base"].basis
    np.testing.assert_allclose(basis.frequencies, exact.omega[:2] / (2.0 * np.pi), rtol=1e-3)


FENCE = "    -1\n"
NONE = "NONE\n" * 5
DOFS = "    4         0    0         0       NONE         3  -2       NONE        12   6\n"
AXES = "".join(f"{code:10d}    0    0    0 NONE                 NONE\n" for code in (18, 8, 13, 0))
FORM = "         5         2         1  1.00000E+01  5.00000E-01  0.00000E+00\n"
DATA = "  1.00000E+00  2.00000E+00  3.00000E+00 -4.00000E+00\n"
FUNCTION = FENCE + "    58\n" + NONE + DOFS + FORM + AXES + DATA + FENCE


def read(tmp_path: Path, text: str, units: Units | None = None) -> list[FrequencyResponse]:
    file = tmp_path / "m.uff"
    file.write_text(text)
    found = data_sets(file)
    return measured_functions(found, units or file_units(found))


def test_a_function_by_hand(tmp_path: Path) -> None:
    (function,) = read(tmp_path, FUNCTION)
    assert (function.response, function.reference) == (("3", "dy"), ("12", "drz"))
    np.testing.assert_array_equal(function.frequency, [10.0, 10.5])
    np.testing.assert_array_equal(function.values, [-1.0 - 2.0j, -3.0 + 4.0j])


@pytest.mark.parametrize(
    ("form", "even", "data"),
    [
        (2, 1, "  1.00000E+00  3.00000E+00"),
        (2, 0, "  1.00000E+01  1.00000E+00  1.05000E+01  3.00000E+00"),
        (4, 1, "  1.000000000000E+00  3.000000000000D+00"),
        (4, 0, "  1.00000E+01  1.000000000000E+00  1.05000E+01  3.000000000000E+00"),
        (5, 0, "  1.00000E+01  1.00000E+00  0.00000E+00  1.05000E+01  3.00000E+00  0.00000E+00"),
        (6, 1, "".join(f"{x:20.12E}" for x in (1.0, 0.0, 3.0, 0.0))),
        (6, 0, "  1.00000E+01{:20.12E}{:20.12E}\n  1.05000E+01{:20.12E}{:20.12E}"),
    ],
)
def test_all_forms_of_numbers(tmp_path: Path, form: int, even: int, data: str) -> None:
    text = FUNCTION.replace(FORM, f"{form:10d}{2:10d}{even:10d}{FORM[30:]}")
    (function,) = read(tmp_path, text.replace(DATA, data.format(1.0, 0.0, 3.0, 0.0) + "\n"))
    np.testing.assert_array_equal(function.frequency, [10.0, 10.5])
    np.testing.assert_array_equal(function.values, [-1.0, -3.0])


def test_units(tmp_path: Path) -> None:
    """In mm and mN, 1 mm/(mN mm) is 1000 m/(N m); 1 rad/mN is 1000 rad/N."""
    units = Units(length=1e3, force=1e3)
    (function,) = read(tmp_path, FUNCTION, units)
    np.testing.assert_allclose(function.values[0], 1e3 * (-1.0 - 2.0j))
    turned = FUNCTION.replace("3  -2", "3   5").replace("12   6", "12   1")
    (function,) = read(tmp_path, turned, units)
    np.testing.assert_allclose(function.values[0], 1e3 * (1.0 + 2.0j))


def test_what_is_no_response_is_passed_over(tmp_path: Path) -> None:
    coherence = FUNCTION.replace("    4         0", "    6         0")
    assert len(read(tmp_path, coherence + FUNCTION)) == 1


REFUSED = {
    FUNCTION.replace(DATA, DATA[:26] + "\n"): "line 15: data set 58 is truncated: 2 numbers",
    FUNCTION.replace(DATA, ""): "data set 58 is truncated: 0 numbers instead of 4",
    FUNCTION[: FUNCTION.index(FORM)] + FENCE: "line 9: data set 58 is truncated",
    FUNCTION.replace(DATA, "  one\n"): "data set 58 cannot be read here",
    FUNCTION.replace("  2.00000E+00", "          NaN"): "data set 58 must hold finite numbers",
    FUNCTION.replace("    4  ", "    1  "): "holds no frequency response function; .*type 4",
    FUNCTION.replace("    4  ", " four  "): "function type must be a whole number",
    FUNCTION.replace("12   6", " 0   0"): "line 8: data set 58 has no reference node and direction",
    FUNCTION.replace("3  -2", "3   0"): "data set 58 has no response node and direction",
    FUNCTION.replace("        13  ", "         0  "): "is not a displacement, .*8 over 0 by 18",
    FUNCTION.replace("         8  ", "         3  "): "3 over 13 by 18",
    FUNCTION.replace(FORM, FORM.replace("5  ", "7  ", 1)): "no ordinate data type 2, 4, 5 or 6",
    FUNCTION: "the drive point is missing: response and reference 12.drz",
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=list(REFUSED.values()))
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "m.uff"
    file.write_text(text)
    with pytest.raises(InputError, match=rf"m\.uff: .*{message}"):
        read_modes(file)


def test_given_modes_are_not_identified(tmp_path: Path) -> None:
    file = tmp_path / "modes.csv"
    file.write_text("frequency,P.dx\n3.0,1.0\n")
    with pytest.raises(InputError, match=r"modes\.csv: .*band: has nothing to identify"):
        read_modes(file, band=(1.0, 5.0))
