"""Text meshes of code_aster, by hand from the format's description."""

from __future__ import annotations

from pathlib import Path

import pytest

from bumpstop import InputError
from bumpstop.io import LineMesh, read_mesh

MESH = """\
TITRE
a frame % with a comment
FINSF
COOR_3D NBOBJ=4
 N1 0. 0. 0.     N2 1.0D0 0. 0.
 N3 1. 2. 3.5
 N9 7. 7. 7.     % used by nobody
FINSF
SEG2  NOM=INDEFINI
 M1 N1 N2
 M2 N2 N3
FINSF
POI1
 P1 N3
FINSF
TRIA3
 T1 N1 N2 N3
FINSF
GROUP_MA NOM = TUBES
 M1 M2 T1
FINSF
GROUP_MA
 TIP P1
FINSF
GROUP_NO
 BASE N1
FINSF
FIN
whatever follows is not read
"""


def read(tmp_path: Path, text: str) -> LineMesh:
    file = tmp_path / "frame.mail"
    file.write_text(text)
    return read_mesh(file)


def test_nodes_lines_and_groups(tmp_path: Path) -> None:
    mesh = read(tmp_path, MESH)
    assert mesh.nodes == {"BASE": (0.0, 0.0, 0.0), "N2": (1.0, 0.0, 0.0), "TIP": (1.0, 2.0, 3.5)}
    assert mesh.lines == {"M1": ("BASE", "N2"), "M2": ("N2", "TIP")}
    assert mesh.line_groups == {"TUBES": ("M1", "M2")}
    assert mesh.node_groups == {"BASE": ("BASE",), "TIP": ("TIP",)}


def test_a_plane_mesh(tmp_path: Path) -> None:
    mesh = read(tmp_path, "COOR_2D\nA 0 1\nB 2 3\nFINSF\nSEG2\nAB A B\nFINSF\nFIN\n")
    assert mesh.nodes == {"A": (0.0, 1.0, 0.0), "B": (2.0, 3.0, 0.0)}


REFUSED = {
    "": "is empty",
    "nothing here\n": "is truncated within nothing",
    MESH[: MESH.index("GROUP_NO")]: "is truncated: it has no FIN",
    MESH[: MESH.index(" M2 N2 N3")]: "is truncated within SEG2",
    MESH.replace("N3 1. 2. 3.5", "N2 1. 2. 3.5"): "node N2 is there twice",
    MESH.replace("N3 1. 2. 3.5", "N3 1. 2."): "a node must have 4 words",
    MESH.replace("N3 1. 2. 3.5", "N3 1. two 3.5"): "the coordinates of node N3 cannot be read",
    MESH.replace("M2 N2 N3", "M2 N2 N5"): "line M2 ends at node N5, which is not there",
    MESH.replace("M2 N2 N3", "M1 N2 N3"): "line M1 is there twice",
    MESH.replace("M2 N2 N3", "M2 N2 N2"): "line M2 has no length",
    MESH.replace("SEG2", "SEG3"): "has SEG3, lines with a node between their ends",
    MESH.replace("BASE N1", "BASE N8"): "group 'BASE' of nodes holds N8, which is not there",
    MESH.replace("P1 N3\n", "P1 N3 P2\n"): "a point must have 2 words",
    "FIN\n": "has no lines between two nodes",
    "\0": "is a binary file",
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=list(REFUSED.values()))
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"frame\.mail: .*{message}"):
        read(tmp_path, text)
