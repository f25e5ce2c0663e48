"""Every format that a structure can come from, with every defect: one line and status 2."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp

from bumpstop.arguments import FloatArray
from bumpstop.cli import main

from .matrices import test_op4 as op4
from .meshes import test_gmsh as gmsh
from .meshes import test_med as med
from .modes import test_uff as uff
from .test_damaged_files import TEXTS

STIFFNESS = np.array([[3.0, -1.0, 0.0], [-1.0, 3.0, -1.0], [0.0, -1.0, 2.0]])
MASS = np.diag([2.0, 1.0, 1.5])
DOFS = "node,dof\n1,dx\n2,dx\n3,dx\n"
MATRICES = '[matrices]\nstiffness = "K{end}"\nmass = "M{end}"\n[basis]\nmodes = 2\n'

Defect = Callable[[FloatArray], FloatArray]
Refused = Callable[[str, str], str]


def matrix_market(matrix: FloatArray) -> bytes:
    file = io.BytesIO()
    scipy.io.mmwrite(file, sp.coo_array(matrix), symmetry="general")
    return file.getvalue()


def scipy_npz(matrix: FloatArray) -> bytes:
    file = io.BytesIO()
    sp.save_npz(file, sp.csc_array(matrix))
    return file.getvalue()


def numpy_npy(matrix: FloatArray) -> bytes:
    file = io.BytesIO()
    np.save(file, matrix)
    return file.getvalue()


def entries(matrix: FloatArray, line: str) -> bytes:
    places = [(i, j) for i, j in np.ndindex(matrix.shape) if matrix[i, j] != 0.0]
    lines = [line.format(i=i + 1, j=j + 1, value=float(matrix[i, j])) for i, j in places]
    return "".join(lines).encode()


def dmig(matrix: FloatArray) -> bytes:
    return b"DMIG,K,0,1,2,0\n" + entries(matrix, "DMIG,K,{j},1,,{i},1,{value!r}\n")


NAMELESS: dict[str, tuple[str, Callable[[FloatArray], bytes]]] = {
    "matrix market": (".mtx", matrix_market),
    "scipy": (".npz", scipy_npz),
    "numpy": (".npy", numpy_npy),
    "op4 text": (".op4", lambda matrix: op4.text(matrix, form=1).encode()),
    "op4 binary": (".op4", lambda matrix: op4.binary(matrix, form=1)),
}
"""Formats whose rows have no names, and that tell how long they are."""
FORMATS = NAMELESS | {
    "dmig": (".pch", dmig),
    "abaqus": (".mtx", lambda matrix: entries(matrix, "{i},1, {j},1, {value!r}\n")),
}


@pytest.fixture
def refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Refused:
    """Ask for the modes of a case that is wrong, and return the line about one of its files."""

    def line(case: str, file: str) -> str:
        (tmp_path / "case.toml").write_text(case)
        status = main(["modes", str(tmp_path / "case.toml"), "--json"])
        said = capsys.readouterr()
        assert (status, said.out) == (2, "")
        assert said.err.startswith(f"error: {tmp_path / file}: ")
        assert said.err.endswith("\n")
        assert said.err.count("\n") == 1
        return said.err

    return line


def write(folder: Path, name: str, **changes: bytes) -> str:
    """Write a model in one of the formats, some of its files as given; return its case file."""
    end, written = FORMATS[name]
    files = {"K": written(STIFFNESS), "M": written(MASS)} | changes
    for key, content in files.items():
        (folder / f"{key}{end}").write_bytes(content)
    if name not in NAMELESS:
        return MATRICES.format(end=end)
    (folder / "dofs.csv").write_text(DOFS)
    return MATRICES.format(end=end).replace("[basis]", 'dofs = "dofs.csv"\n[basis]')


def changed(row: int, column: int, value: float, mirror: float) -> Defect:
    def edit(matrix: FloatArray) -> FloatArray:
        edited = matrix.copy()
        edited[row, column] = value
        edited[column, row] = mirror
        return edited

    return edit


@pytest.mark.parametrize("name", FORMATS)
def test_whole_files_are_read(
    tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "case.toml").write_text(write(tmp_path, name))
    assert main(["modes", str(tmp_path / "case.toml")]) == 0
    expected = np.sqrt(np.linalg.eigvals(np.linalg.solve(MASS, STIFFNESS)).real.min()) / (2 * np.pi)
    assert f"{expected:.6g}" in capsys.readouterr().out


WRONG: dict[str, tuple[Defect, str]] = {
    "not a number": (changed(1, 1, np.nan, np.nan), ""),
    "infinite": (changed(1, 1, np.inf, np.inf), ""),
    "not symmetric": (changed(0, 1, -0.5, -0.25), "must be symmetric, but is "),
    "zero": (lambda matrix: 0.0 * matrix, ""),
}


@pytest.mark.parametrize("defect", WRONG)
@pytest.mark.parametrize("key", ["K", "M"])
@pytest.mark.parametrize("name", FORMATS)
def test_matrices_that_are_none_of_a_structure(
    tmp_path: Path, refused: Refused, name: str, key: str, defect: str
) -> None:
    edit, expected = WRONG[defect]
    end, written = FORMATS[name]
    wrong = edit(STIFFNESS if key == "K" else MASS)
    # A body that nothing holds has no stiffness: the line says how to announce it.
    is_free = (key, defect) == ("K", "zero") and name in NAMELESS
    file = "case.toml" if is_free else f"{key}{end}"
    assert expected in refused(write(tmp_path, name, **{key: written(wrong)}), file)


@pytest.mark.parametrize("shape", [(2, 2), (4, 4), (2, 3), (3, 2)])
@pytest.mark.parametrize("name", NAMELESS)
def test_matrices_of_another_size(
    tmp_path: Path, refused: Refused, name: str, shape: tuple[int, int]
) -> None:
    end, written = FORMATS[name]
    line = refused(write(tmp_path, name, M=written(np.eye(*shape))), f"M{end}")
    assert f"is {shape[0]} x {shape[1]}, but there are 3 dofs" in line


@pytest.mark.parametrize("defect", [b"", b"\n", b"no matrix at all\n", bytes(range(256))])
@pytest.mark.parametrize("name", FORMATS)
def test_files_that_hold_something_else(
    tmp_path: Path, refused: Refused, name: str, defect: bytes
) -> None:
    refused(write(tmp_path, name, K=defect), f"K{FORMATS[name][0]}")


@pytest.mark.parametrize("part", [0.15, 0.4, 0.65, 0.9])
@pytest.mark.parametrize("name", NAMELESS)
def test_files_that_end_early(tmp_path: Path, refused: Refused, name: str, part: float) -> None:
    end, written = FORMATS[name]
    content = written(STIFFNESS)
    refused(write(tmp_path, name, K=content[: int(part * len(content))]), f"K{end}")


@pytest.mark.parametrize("name", ["dmig", "abaqus"])
def test_a_line_that_ends_early(tmp_path: Path, refused: Refused, name: str) -> None:
    """These formats do not say how long they are: what shows is a line with a part missing."""
    end, written = FORMATS[name]
    content = written(STIFFNESS)
    refused(write(tmp_path, name, K=content[: content.rindex(b",") - 1]), f"K{end}")


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        ("", "is empty"),
        ("node,dof\n", "holds no dof"),
        ("node,dof\n1,dx\n1,dx\n3,dx\n", "line 3: this dof is there twice"),
        ("node,dof\n1,dx\n2,ux\n3,dx\n", "line 3: unknown dof"),
        ("node,dof\n1,dx\n2\n", "line 3: has 1 fields instead of 2"),
        ("node,dof,x,y,z\n1,dx,0,0,nan\n", "line 2: z must be a number"),
        ("node,dof,x,y,z\n1,dx,0,0,0\n1,dy,0,0,1\n", "line 3: node '1' is at another place"),
        ("knot,dof\n1,dx\n", "has no column 'node'"),
    ],
)
def test_dof_maps(tmp_path: Path, refused: Refused, table: str, expected: str) -> None:
    case = write(tmp_path, "scipy")
    (tmp_path / "dofs.csv").write_text(table)
    assert expected in refused(case, "dofs.csv")


MODES = '[modes]\nfile = "{file}"\n[basis]\nmodes = 1\n'
TABLE = TEXTS["modes.csv"][0]


def npz(**changes: object) -> bytes:
    file = io.BytesIO()
    given = {"frequency": [3.0], "nodes": ["P"], "dofs": ["dx"], "shapes": [[1.0]]} | changes
    np.savez(file, **{key: np.array(value) for key, value in given.items()})  # type: ignore[arg-type]  # numpy takes every name for an option
    return file.getvalue()


SOURCES: dict[str, list[bytes]] = {
    "modes.csv": [
        b"",
        TABLE.split("\n")[0].encode(),
        TABLE.replace("3.0", "nan").encode(),
        TABLE.replace("3.0", "-3.0").encode(),
        TABLE.replace("0.4", "much").encode(),
        TABLE.replace(",0.4", "").encode(),
        TABLE.replace("frequency", "period").encode(),
    ],
    "modes.npz": [
        b"",
        npz()[:100],
        npz(frequency=[np.nan]),
        npz(frequency=[-1.0]),
        npz(frequency=[]),
        npz(shapes=[[1.0, 2.0]]),
        npz(shapes=[[np.inf]]),
        npz(nodes=["P", "Q"]),
        npz(dofs=["ux"]),
    ],
    "modes.uff": [
        b"",
        uff.MODE[:300].encode(),
        uff.MODE.rstrip().removesuffix("-1").encode(),
        uff.MODE.replace("1.25000E+01", "        NaN").encode(),
        uff.MODE.replace("1.25000E+01", "    unknown").encode(),
    ],
}


@pytest.mark.parametrize(
    ("file", "content"), [(file, content) for file, many in SOURCES.items() for content in many]
)
def test_modes(tmp_path: Path, refused: Refused, file: str, content: bytes) -> None:
    (tmp_path / file).write_bytes(content)
    refused(MODES.format(file=file), file)


MESH = """
[mesh]
file = "{file}"
[mesh.beams.{group}]
material = "steel"
section = "bar"
[materials.steel]
young_modulus = 210e9
poisson_ratio = 0.3
density = 7800.0
[sections.bar]
shape = "circle"
radius = 0.01
[basis]
modes = 1
"""
MAIL = TEXTS["mesh.mail"][0]


def med_file(folder: Path, **data: object) -> bytes:
    """Return a MED mesh with the coordinates or the ends of its lines changed."""
    whole = med.write(folder / "whole.med")
    with h5py.File(whole, "r+") as file:
        for name, values in data.items():
            place = f"ENS_MAA/frame/{med.STEP}/" + {"COO": "NOE/COO", "NOD": "MAI/SE2/NOD"}[name]
            del file[place]
            file[place] = values
            if name == "COO":
                file[place].attrs["NBR"] = 4
    return whole.read_bytes()


MESHES: dict[str, list[str]] = {
    "v22.msh": [
        "",
        gmsh.V22[: len(gmsh.V22) // 2],
        gmsh.V22.replace("4 0.5 0 0", "4 nan 0 0"),
        gmsh.V22.replace("4 0.5 0 0", "4 0.5 0"),
        gmsh.V22.replace("4 0.5 0 0", "1 0.5 0 0"),
        gmsh.V22.replace("3 1 2 1 1 4 2", "3 1 2 1 1 4 9"),
        gmsh.V22.replace("2.2 0 8", "1.0 0 8"),
        gmsh.V22.replace("$Elements\n4\n", "$Elements\n9\n"),
    ],
    "v41.msh": [
        gmsh.V41[: len(gmsh.V41) // 2],
        gmsh.V41[: -len("$EndElements\n")],
        gmsh.V41.replace("0.5 0 0", "0.5 inf 0"),
        gmsh.V41.replace("4 2 3", "4 2 8"),
    ],
    "mesh.mail": [
        "",
        MAIL[: len(MAIL) // 2],
        MAIL.removesuffix("FIN\n"),
        MAIL.replace("2 3", "2 nan"),
        MAIL.replace("AB A B", "AB A C"),
        MAIL.replace("B 2 3", "A 2 3"),
    ],
}


@pytest.mark.parametrize(
    ("file", "text"), [(file, text) for file, many in MESHES.items() for text in many]
)
def test_meshes(tmp_path: Path, refused: Refused, file: str, text: str) -> None:
    (tmp_path / file).write_text(text)
    refused(MESH.format(file=file, group="tubes"), file)


@pytest.mark.parametrize(
    "data",
    [
        {"COO": [np.nan, *range(11)]},
        {"COO": list(range(7))},
        {"NOD": [1, 2, 3, 2, 3, 9]},
        {"NOD": [1, 2, 3]},
        {"NOD": []},
    ],
)
def test_med_meshes(tmp_path: Path, refused: Refused, data: dict[str, object]) -> None:
    (tmp_path / "mesh.med").write_bytes(med_file(tmp_path, **data))
    refused(MESH.format(file="mesh.med", group="tubes"), "mesh.med")


@pytest.mark.parametrize("part", [0.0, 0.3, 0.9])
def test_med_meshes_that_end_early(tmp_path: Path, refused: Refused, part: float) -> None:
    content = med_file(tmp_path)
    (tmp_path / "mesh.med").write_bytes(content[: int(part * len(content))])
    refused(MESH.format(file="mesh.med", group="tubes"), "mesh.med")
