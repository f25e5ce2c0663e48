"""Gmsh meshes, as Gmsh 4 wrote them (shortened)."""

from __future__ import annotations

from pathlib import Path

import pytest

from bumpstop import InputError
from bumpstop.io import LineMesh, read_mesh

NAMES = '$PhysicalNames\n3\n0 3 "base"\n1 1 "tubes"\n1 2 "post"\n$EndPhysicalNames\n'
V41 = f"""\
$MeshFormat
4.1 0 8
$EndMeshFormat
{NAMES}$Entities
3 2 0 0
1 0 0 0 1 3
2 1 0 0 0
3 1 2 3.5 0
1 0 0 0 1 0 0 1 1 2 1 -2
2 1 0 0 1 2 3.5 1 2 2 2 -3
$EndEntities
$Nodes
4 4 1 4
0 1 0 1
1
0 0 0
0 2 0 1
2
1 0 0
0 3 0 1
3
1 2 3.5
1 1 0 1
4
0.5 0 0
$EndNodes
$Elements
3 4 1 4
0 1 15 1
1 1
1 1 1 2
2 1 4
3 4 2
1 2 1 1
4 2 3
$EndElements
"""
V22 = f"""\
$MeshFormat
2.2 0 8
$EndMeshFormat
{NAMES}$Nodes
4
1 0 0 0
2 1 0 0
3 1 2 3.5
4 0.5 0 0
$EndNodes
$Elements
4
1 15 2 3 1 1
2 1 2 1 1 1 4
3 1 2 1 1 4 2
4 1 2 2 2 2 3
$EndElements
"""


def read(tmp_path: Path, text: str) -> LineMesh:
    file = tmp_path / "frame.msh"
    file.write_text(text)
    return read_mesh(file)


@pytest.mark.parametrize("text", [V41, V22], ids=["4.1", "2.2"])
def test_nodes_lines_and_groups(tmp_path: Path, text: str) -> None:
    mesh = read(tmp_path, text)
    assert mesh.nodes == {
        "base": (0.0, 0.0, 0.0),
        "2": (1.0, 0.0, 0.0),
        "3": (1.0, 2.0, 3.5),
        "4": (0.5, 0.0, 0.0),
    }
    assert mesh.lines == {"2": ("base", "4"), "3": ("4", "2"), "4": ("2", "3")}
    assert mesh.line_groups == {"tubes": ("2", "3"), "post": ("4",)}
    assert mesh.node_groups == {"base": ("base",)}


def test_unsorted_tags_with_gaps(tmp_path: Path) -> None:
    text = V22.replace("\n3 1 2 3.5\n4 0.5", "\n900 1 2 3.5\n4 0.5").replace(
        "2 2 2 3\n", "2 2 2 900\n"
    )
    assert read(tmp_path, text).lines["4"] == ("2", "900")


def test_surfaces_are_passed_over(tmp_path: Path) -> None:
    text = V22.replace("$Elements\n4\n", "$Elements\n5\n5 2 2 9 9 1 2 3\n")
    assert len(read(tmp_path, text).lines) == 3


REFUSED = {
    "": "is empty",
    "nothing\n": "is not a Gmsh mesh: it has no sections",
    V41[:-14]: r"is truncated within \$Elements",
    V41[: V41.index("$Elements")]: r"has no \$Elements",
    V41.replace("4.1 0 8", "3.0 0 8"): "is of no known version of Gmsh .got '3.0 0 8'.",
    V41.replace("4.1 0 8", "4.1 1 8"): "is binary; export it as ASCII",
    V41.replace("4.1 0 8\n", ""): "has an empty section",
    V22.replace("4 0.5 0 0", "2 0.5 0 0"): "node 2 is there twice",
    V22.replace("4 0.5 0 0", "4 0.5 zero 0"): "a number is missing or cannot be read",
    V22.replace("4 0.5 0 0", "4 0.5 0"): "a number is missing or cannot be read",
    V22.replace("4 0.5 0 0", "4 1 0 0"): "line 3 has no length",
    V22.replace("2 2 2 3\n", "2 2 2 7\n"): "line 4 ends at node 7, which is not there",
    V22.replace("$Nodes\n4", "$Nodes\n999999999999"): "announces 999999999999 nodes",
    V41.replace("1 1 1 2\n2 1 4", "1 1 1 99999999\n2 1 4"): "announces 99999999 nodes",
    V41.replace("1 1 1 2\n2 1 4", "1 1 8 2\n2 1 4"): "line 2 has nodes between its ends",
    V22.replace("2 1 2 1 1 1 4", "2 2 2 1 1 1 4")
    .replace("3 1 2 1 1 4 2", "3 2 2 1 1 4 2")
    .replace("4 1 2 2 2 2 3", "4 2 2 2 2 2 3"): "has no lines between two nodes",
    "\0": "is a binary file, not a Gmsh mesh in text form",
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=list(REFUSED.values()))
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"frame\.msh: .*{message}") as refused:
        read(tmp_path, text)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("text", [V41, V22], ids=["4.1", "2.2"])
def test_every_truncation_is_one_line(tmp_path: Path, text: str) -> None:
    lines = text.splitlines()
    for stop in range(1, len(lines) - 1):
        with pytest.raises(InputError, match=r"frame\.msh: "):
            read(tmp_path, "\n".join(lines[:stop]) + "\n")


def test_other_kinds_of_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"frame\.stl: is of no known kind of mesh"):
        read_mesh(tmp_path / "frame.stl")
    with pytest.raises(InputError, match=r"frame\.msh: no such file"):
        read_mesh(tmp_path / "frame.msh")
