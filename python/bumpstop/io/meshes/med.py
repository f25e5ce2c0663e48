"""MED meshes (.med), the format of Salome and code_aster: HDF5 with a layout of its own.

Layout, as of MED 3 and 4: ``ENS_MAA/<mesh>/<step>`` has ``NOE`` with coordinates ``COO`` and
``MAI/SE2`` with the nodes ``NOD`` of lines, each component after the other; ``FAM`` gives the
family of each, and ``FAS/<mesh>/NOEUD`` and ``ELEME`` the groups of each family.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bumpstop.errors import InputError
from bumpstop.io.meshes.line_mesh import LineMesh, line_mesh
from bumpstop.io.reading import MOST_ROWS, in_file, read_content

__all__ = ["read_med"]

_HDF5 = b"\x89HDF\r\n\x1a\n"


def read_med(path: Path) -> LineMesh:
    """Read the lines (SE2) of a MED file that has one mesh. Nodes are called N1, N2, ...

    Raises
    ------
    InputError
        If the file cannot be read, is truncated, or has no mesh or several.
    """
    import h5py

    with in_file(path):
        if not read_content(path, "a MED file").startswith(_HDF5):
            raise InputError("is not a MED file")
        with h5py.File(path, "r") as file:
            try:
                return _mesh(file)
            except (KeyError, TypeError, AttributeError, IndexError) as error:
                raise InputError("is not laid out as a MED file") from error
            except RuntimeError as error:  # what HDF5 says of damaged indices
                raise InputError("is damaged") from error


def _mesh(file: Any) -> LineMesh:
    meshes = list(file["ENS_MAA"])
    if len(meshes) != 1:
        listed = ", ".join(meshes) or "none"
        raise InputError("must have one mesh", value=listed, hint="export one alone")
    name = meshes[0]
    mesh = file["ENS_MAA"][name]
    if "NOE" not in mesh:
        mesh = mesh[next(iter(mesh))]  # the first step of a mesh that moves
    if "SE3" in mesh.get("MAI", {}) and "SE2" not in mesh["MAI"]:
        what = "has lines with a node between their ends only"
        raise InputError(what, hint="mesh with elements of first order")
    places = _places(mesh["NOE"])
    nodes = [f"N{number}" for number in _numbers(mesh["NOE"], len(places))]
    lines = mesh["MAI"]["SE2"] if "SE2" in mesh.get("MAI", {}) else None
    ends = _ends(lines, len(nodes)) if lines is not None else np.zeros((0, 2), dtype=np.intp)
    names = [f"M{number}" for number in _numbers(lines, len(ends))] if lines is not None else []
    families = file["FAS"][name] if name in file.get("FAS", {}) else {}
    return line_mesh(
        dict(zip(nodes, ((x, y, z) for x, y, z in places.tolist()), strict=True)),
        {line: (nodes[a], nodes[b]) for line, (a, b) in zip(names, ends.tolist(), strict=True)},
        _groups(lines, names, families.get("ELEME", {})) if lines is not None else {},
        _groups(mesh["NOE"], nodes, families.get("NOEUD", {}))
        | _point_groups(mesh.get("MAI", {}), nodes, families.get("ELEME", {})),
    )


def _array(group: Any, name: str) -> NDArray[Any]:
    data = group[name]
    if data.size > MOST_ROWS:
        raise InputError(f"{data.name} announces {data.size:,} numbers")
    return np.asarray(data).ravel()


def _places(nodes: Any) -> NDArray[np.float64]:
    """Return the coordinates (nodes, 3); of plane meshes z is zero."""
    numbers = _array(nodes, "COO").astype(np.float64)
    count = int(nodes["COO"].attrs["NBR"])
    if count < 1 or len(numbers) % count or not 1 <= len(numbers) // count <= 3:
        raise InputError(f"has {len(numbers)} coordinates of {count} nodes")
    places = np.zeros((count, 3))
    places[:, : len(numbers) // count] = numbers.reshape(-1, count).T
    return places


def _ends(lines: Any, nodes: int) -> NDArray[np.intp]:
    """Return the numbers of the ends of each line, counted from 0, (lines, 2)."""
    numbers = _array(lines, "NOD").astype(np.intp)
    if len(numbers) % 2 or numbers.min(initial=1) < 1 or numbers.max(initial=1) > nodes:
        raise InputError("a line ends at a node that is not there")
    return numbers.reshape(2, -1).T - 1


def _numbers(group: Any, count: int) -> list[int]:
    """Return the numbers of nodes or elements; 1, 2, ... where the file gives none."""
    if "NUM" not in group:
        return list(range(1, count + 1))
    numbers: list[int] = _array(group, "NUM").tolist()
    if len(numbers) != count or len(set(numbers)) != count:
        raise InputError("numbers of nodes or lines are missing or there twice")
    return numbers


def _groups(things: Any, names: list[str], families: Any) -> dict[str, list[str]]:
    """Return the names of what is in each group."""
    if "FAM" not in things:
        return {}
    groups_of = {int(family.attrs["NUM"]): _group_names(family) for family in families.values()}
    groups: dict[str, list[str]] = {}
    for name, family in zip(names, _array(things, "FAM").tolist(), strict=False):
        for group in groups_of.get(family, []):
            groups.setdefault(group, []).append(name)
    return groups


def _point_groups(elements: Any, nodes: list[str], families: Any) -> dict[str, list[str]]:
    """Return the nodes of each group of point elements (PO1)."""
    if "PO1" not in elements:
        return {}
    numbers = _array(elements["PO1"], "NOD").astype(np.intp)
    if numbers.min(initial=1) < 1 or numbers.max(initial=1) > len(nodes):
        raise InputError("a point is at a node that is not there")
    return _groups(elements["PO1"], [nodes[number - 1] for number in numbers], families)


def _group_names(family: Any) -> list[str]:
    if "GRO" not in family:
        return []
    rows = family["GRO"]["NOM"][()]
    return [
        np.asarray(row, dtype=np.int8).tobytes().partition(b"\0")[0].decode("utf-8").strip()
        for row in rows
    ]
