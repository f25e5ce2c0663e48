"""MED meshes, written here with h5py in the layout that Gmsh 4 and meshio 5 write."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from bumpstop import InputError
from bumpstop.io import LineMesh, read_mesh

STEP = "-0000000000000000001-0000000000000000001"
PLACES = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [1.0, 2.0, 3.5]])
ENDS = np.array([[1, 2], [2, 3], [3, 4]])


def family(parent: Any, number: int, *groups: str) -> None:
    made = parent.create_group(f"FAM_{number}")
    made.attrs["NUM"] = number
    held = made.create_group("GRO")
    held.attrs["NBR"] = len(groups)
    names = held.create_dataset("NOM", (len(groups),), dtype=("i1", (80,)))
    names[()] = [list(group.encode().ljust(80, b"\0")) for group in groups]


def write(path: Path, edit: Callable[[Any], object] = lambda _: None) -> Path:
    with h5py.File(path, "w") as file:
        mesh = file.create_group(f"ENS_MAA/frame/{STEP}")
        nodes = mesh.create_group("NOE")
        places = nodes.create_dataset("COO", data=PLACES.T.ravel())
        places.attrs["NBR"] = len(PLACES)
        nodes.create_dataset("FAM", data=[-1 + 2, 0, 0, 0])
        lines = mesh.create_group("MAI/SE2")
        lines.create_dataset("NOD", data=ENDS.T.ravel())
        lines.create_dataset("FAM", data=[-2, -2, -3])
        points = mesh.create_group("MAI/PO1")
        points.create_dataset("NOD", data=[4])
        points.create_dataset("FAM", data=[-4])
        family(file.create_group("FAS/frame/NOEUD"), 1, "base")
        elements = file.create_group("FAS/frame/ELEME")
        family(elements, -2, "tubes", "all")
        family(elements, -3, "post", "all")
        family(elements, -4, "tip")
        file["FAS/frame"].create_group("FAMILLE_ZERO").attrs["NUM"] = 0
        edit(file)
    return path


def read(tmp_path: Path, edit: Callable[[Any], object] = lambda _: None) -> LineMesh:
    return read_mesh(write(tmp_path / "frame.med", edit))


def test_nodes_lines_and_groups(tmp_path: Path) -> None:
    mesh = read(tmp_path)
    assert mesh.nodes == {
        "base": (0.0, 0.0, 0.0),
        "N2": (1.0, 0.0, 0.0),
        "N3": (1.0, 2.0, 0.0),
        "tip": (1.0, 2.0, 3.5),
    }
    assert mesh.lines == {"M1": ("base", "N2"), "M2": ("N2", "N3"), "M3": ("N3", "tip")}
    assert mesh.line_groups == {"tubes": ("M1", "M2"), "all": ("M1", "M2", "M3"), "post": ("M3",)}
    assert mesh.node_groups == {"base": ("base",), "tip": ("tip",)}


def test_numbers_of_their_own_and_no_families(tmp_path: Path) -> None:
    def edit(file: Any) -> None:
        mesh = file[f"ENS_MAA/frame/{STEP}"]
        mesh["NOE"].create_dataset("NUM", data=[40, 30, 20, 10])
        mesh["MAI/SE2"].create_dataset("NUM", data=[7, 8, 9])
        del file["FAS"]

    mesh = read(tmp_path, edit)
    assert mesh.lines == {"M7": ("N40", "N30"), "M8": ("N30", "N20"), "M9": ("N20", "N10")}
    assert mesh.line_groups == {}


def replace(place: str, data: Any) -> Callable[[Any], None]:
    def edit(file: Any) -> None:
        attributes = dict(file[place].attrs)
        del file[place]
        file.create_dataset(place, data=data).attrs.update(attributes)

    return edit


def huge(file: Any) -> None:
    place = f"ENS_MAA/frame/{STEP}/NOE/COO"
    del file[place]
    file.create_dataset(place, (3 * 10**12,), dtype="f8", chunks=(1024,)).attrs["NBR"] = 10**12


HERE = f"ENS_MAA/frame/{STEP}"
REFUSED: list[tuple[Callable[[Any], object], str]] = [
    (lambda file: file.pop("ENS_MAA"), "is not laid out as a MED file"),
    (lambda file: file.create_group("ENS_MAA/other"), "must have one mesh .got 'frame, other'."),
    (lambda file: file.pop(f"{HERE}/MAI/SE2"), "has no lines between two nodes"),
    (replace(f"{HERE}/MAI/SE2/NOD", [1, 2, 2, 9]), "a line ends at a node that is not there"),
    (replace(f"{HERE}/MAI/SE2/NOD", [1, 2, 3]), "a line ends at a node that is not there"),
    (replace(f"{HERE}/MAI/SE2/NOD", [1, 1]), "line M1 has no length"),
    (replace(f"{HERE}/MAI/PO1/NOD", [0]), "a point is at a node that is not there"),
    (replace(f"{HERE}/NOE/COO", np.zeros(13)), "has 13 coordinates of 4 nodes"),
    (huge, "announces 3,000,000,000,000 numbers"),
    (lambda file: file[f"{HERE}/NOE"].create_dataset("NUM", data=[1, 1, 2, 3]), "there twice"),
]


@pytest.mark.parametrize(("edit", "message"), REFUSED, ids=[line for _, line in REFUSED])
def test_what_is_wrong_is_said_in_one_line(
    tmp_path: Path, edit: Callable[[Any], object], message: str
) -> None:
    with pytest.raises(InputError, match=rf"frame\.med: .*{message}") as refused:
        read(tmp_path, edit)
    assert "\n" not in str(refused.value)


def test_truncated_and_other_files(tmp_path: Path) -> None:
    file = write(tmp_path / "frame.med")
    whole = file.read_bytes()
    for end in (8, 100, len(whole) // 2, len(whole) - 50):
        file.write_bytes(whole[:end])
        with pytest.raises(InputError, match=r"frame\.med: ") as refused:
            read_mesh(file)
        assert "\n" not in str(refused.value)
    file.write_bytes(b"not HDF5 at all")
    with pytest.raises(InputError, match=r"frame\.med: is not a MED file"):
        read_mesh(file)
