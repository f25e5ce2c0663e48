"""Files of every format with bytes changed, cut out or doubled: read, or refused in one line."""

from __future__ import annotations

import random
import tempfile
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp

from bumpstop import InputError
from bumpstop.io import read_mesh, read_modes
from bumpstop.io.matrices.dof_map import read_dof_map
from bumpstop.io.matrices.read import read_matrix

from ..modal.measured_chain import chain
from .modes.test_functions import written

MATRIX = np.array([[2.0, -1.0, 0.0], [-1.0, 3.0, 0.5], [0.0, 0.5, 4.0]])
TEXTS: dict[str, tuple[str, Callable[[Path], object]]] = {
    "text.op4": (
        "       2       2       6       2KAA     1P,3E23.16\n       1       0       5\n"
        "      327681\n 2.0000000000000000E+00-1.0000000000000000E+00\n"
        "       2       2       1\n 3.0000000000000000E+00\n"
        "       3       1       1\n 1.0000000000000000E+00\n",
        read_matrix,
    ),
    "cards.pch": ("DMIG,K,0,6,1,0\nDMIG,K,1,1,,1,1,2.5\n,1,6,-1.+3\n", read_matrix),
    "abaqus.mtx": ("1,1, 1,1, 2.0\n2,1, 1,1, -1.0\n2,1, 2,1, 3.0\n", read_matrix),
    "dofs.csv": ("node,dof,x,y,z,fixed\nP,dx,0,1,2,1\nQ,drz,3,4,5,0\n", read_dof_map),
    "modes.csv": ("frequency,damping,P.dx\n3.0,0.01,1.0\n7.5,0.02,0.4\n", read_modes),
    "modes.uff": (
        "    -1\n    55\nNONE\nNONE\nNONE\nNONE\nNONE\n"
        "         1         2         2         8         2         3\n"
        "         2         4         0         1\n"
        "  1.25000E+01  4.00000E+00  1.00000E-02  0.00000E+00\n"
        "        12\n  1.00000E+00 -2.00000E+00  0.00000E+00\n    -1\n",
        read_modes,
    ),
    "mesh.msh": (
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n2 1 0 0\n$EndNodes\n"
        "$Elements\n1\n1 1 2 1 1 1 2\n$EndElements\n",
        read_mesh,
    ),
    "mesh.mail": ("COOR_2D\nA 0 1\nB 2 3\nFINSF\nSEG2\nAB A B\nFINSF\nFIN\n", read_mesh),
}


def write_npz(file: Path) -> None:
    sp.save_npz(file, sp.csc_array(MATRIX), compressed=False)


def write_npy(file: Path) -> None:
    np.save(file, MATRIX)


def write_mtx(file: Path) -> None:
    scipy.io.mmwrite(file, sp.coo_array(MATRIX), symmetry="symmetric")


def write_modes(file: Path) -> None:
    names = {"nodes": np.array(["P"]), "dofs": np.array(["dx"])}
    np.savez(file, frequency=np.array([3.0]), shapes=np.array([[1.0]]), **names)  # type: ignore[arg-type]  # numpy takes every name for an option


def write_functions(file: Path) -> None:
    written(file, chain(2).functions(frequency=np.linspace(1.0, 70.0, 40)))


def write_med(file: Path) -> None:
    with h5py.File(file, "w") as made:
        mesh = made.create_group("ENS_MAA/frame/step")
        mesh.create_dataset("NOE/COO", data=np.arange(6.0)).attrs["NBR"] = 2
        mesh.create_dataset("MAI/SE2/NOD", data=[1, 2])


WRITTEN: dict[str, tuple[Callable[[Path], None], Callable[[Path], object]]] = {
    "scipy.npz": (write_npz, read_matrix),
    "numpy.npy": (write_npy, read_matrix),
    "nist.mtx": (write_mtx, read_matrix),
    "modes.npz": (write_modes, read_modes),
    "functions.uff": (write_functions, read_modes),
    "mesh.med": (write_med, read_mesh),
}


def whole(name: str) -> tuple[bytes, Callable[[Path], object]]:
    if name in TEXTS:
        text, read = TEXTS[name]
        return text.encode(), read
    write, read = WRITTEN[name]
    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder) / name)
        return (Path(folder) / name).read_bytes(), read


def damaged(content: bytes, draw: random.Random) -> bytes:
    start = draw.randrange(len(content))
    end = start + draw.randrange(1, 40)
    kind = draw.randrange(4)
    if kind == 0:
        return content[:start]
    if kind == 1:
        return content[:start] + content[end:]
    if kind == 2:
        return content[:end] + content[start:]
    byte = draw.choice([draw.randrange(256), *b"0123456789 -.eD\n"])
    return content[:start] + bytes([byte]) + content[start + 1 :]


@pytest.mark.parametrize("name", [*TEXTS, *WRITTEN])
def test_damage_is_read_or_refused_in_one_line(tmp_path: Path, name: str) -> None:
    content, read = whole(name)
    file = tmp_path / name
    file.write_bytes(content)
    read(file)
    draw = random.Random(name)
    lines: list[str] = []
    for _ in range(80):
        file.write_bytes(damaged(content, draw))
        try:
            read(file)
        except InputError as error:
            lines.append(str(error))
    assert len(lines) > 15
    assert all(str(file) in line and "\n" not in line for line in lines)
