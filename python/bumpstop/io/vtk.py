"""VTKHDF: the moving structure in one file, for ParaView and everything else that VTK is in.

Format: "VTKHDF File Format", version 2.0, VTK documentation: poly data that do not change, with
point data at each time step. Written with h5py alone.
"""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING

import h5py
import numpy as np
from scipy.sparse import coo_array

from bumpstop.errors import InputError
from bumpstop.files import written_whole
from bumpstop.io.room import new_hdf5
from bumpstop.io.signals import BLOCK
from bumpstop.laws.coordinate import coordinates_of
from bumpstop.projection import TRANSLATIONS
from bumpstop.sampling import MOTIONS
from bumpstop.structure.drawn import DrawnModel
from bumpstop.structure.model import BeamModel

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.response import Response

__all__ = ["write_vtk"]

CELLS = ("Vertices", "Lines", "Polygons", "Strips")
"""Kinds of cells, in the order of the format."""
PLACES = 200
"""Bytes that say where the data of a step begin."""
FIELDS = (*MOTIONS[:2], "contact_force")


def write_vtk(response: Response, path: str | PathLike[str]) -> None:
    """Write the motion of a structure, tabulated at its response's times, to a VTKHDF file.

    Points are the nodes at rest, lines the beams. At each instant points have the vectors
    ``displacement`` (m; warp by it), ``velocity`` (m/s) and ``contact_force`` (N, what stops and
    other laws push the structure with, friction too). ParaView 5.12 and later play it.

    Parameters
    ----------
    response
        What to write; its basis must know where nodes are.
    path
        The file, by custom ``.vtkhdf``; one of that name is replaced once the new one is
        complete.

    Raises
    ------
    InputError
        If the basis knows no places, or the file cannot be written there.
    """
    nodes, positions = _places(response.problem.basis)
    if response.kept is not None:
        what = "needs the motion of all nodes, and the run has kept that of a few dofs alone"
        hint = "a smaller model or larger steps leave room for all; or write another format"
        raise InputError(what, key="form", value="vtk", hint=hint)
    lines = _lines(response.problem.basis, nodes)
    steps, moved = len(response.instants), 8 * 3 * len(FIELDS) * len(nodes)
    size = steps * (moved + PLACES) + 8 * PLACES * len(nodes)
    with written_whole(path) as part, new_hdf5(part, size) as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([2, 0])
        root.attrs.create("Type", b"PolyData", dtype=h5py.string_dtype("ascii", 8))
        root["NumberOfPoints"] = np.array([len(nodes)])
        root["Points"] = positions
        for kind in CELLS:
            _write_cells(root.create_group(kind), lines if kind == "Lines" else [])
        _write_steps(root.create_group("Steps"), response.times, len(nodes))
        _write_fields(root.create_group("PointData"), response, nodes)


def _places(basis: ModalBasis) -> tuple[list[str], FloatArray]:
    """Return the nodes that move along an axis, or are held, and where they are."""
    model = basis.model
    if not isinstance(model, DrawnModel):
        what = "a basis without a structure has no places that could be drawn"
        raise InputError(what, hint="build it from a structure, or write another format")
    nodes = list(dict.fromkeys(node for node, dof in model.dofs if dof in TRANSLATIONS))
    return nodes, np.array([model.position(node) for node in nodes])


def _lines(basis: ModalBasis, nodes: list[str]) -> list[list[int]]:
    """Return the numbers of the nodes along each beam."""
    model = basis.model
    if not isinstance(model, DrawnModel) or not isinstance(model, BeamModel):
        return []
    number = {node: index for index, node in enumerate(nodes)}
    chains = [model.beam_nodes(line.name) for line in model.lines]
    return [[number[node] for node in chain] for chain in chains]


def _write_cells(group: h5py.Group, cells: list[list[int]]) -> None:
    sizes = [len(cell) for cell in cells]
    group["NumberOfCells"] = np.array([len(cells)])
    group["NumberOfConnectivityIds"] = np.array([sum(sizes)])
    group["Offsets"] = np.cumsum([0, *sizes])
    group["Connectivity"] = np.array([point for cell in cells for point in cell], dtype=np.int64)


def _write_steps(group: h5py.Group, times: FloatArray, points: int) -> None:
    """Say that every step has the same geometry, and where its point data begin."""
    steps = len(times)
    group.attrs["NSteps"] = steps
    group["Values"] = times
    group["NumberOfParts"] = np.ones(steps, dtype=np.int64)
    for name in ("PartOffsets", "PointOffsets"):
        group[name] = np.zeros(steps, dtype=np.int64)
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        group[name] = np.zeros((steps, len(CELLS)), dtype=np.int64)
    begins = group.create_group("PointDataOffsets")
    for field in FIELDS:
        begins[field] = points * np.arange(steps)


def _write_fields(group: h5py.Group, response: Response, nodes: list[str]) -> None:
    shape = (len(response.instants) * len(nodes), 3)
    datasets = [group.create_dataset(field, shape, dtype=np.float64) for field in FIELDS]
    shapes = _shapes(response.problem.basis, nodes)
    block = max(BLOCK // len(nodes), 1)
    for start in range(0, len(response.instants), block):
        times = response.instants[start : start + block]
        rows = slice(start * len(nodes), (start + len(times)) * len(nodes))
        for derivative, dataset in enumerate(datasets[:2]):
            moved = response.motion(derivative, times) @ shapes.T
            if response.problem.supports_move:
                moved += _carried(response, nodes, times, derivative)
            dataset[rows] = moved.reshape(-1, 3)
        datasets[2][rows] = _forces(response, nodes, times).reshape(-1, 3)


def _shapes(basis: ModalBasis, nodes: list[str]) -> FloatArray:
    """Return how far each node moves along each axis with each mode, (3 nodes, modes)."""
    rows = {dof: row for row, dof in enumerate(basis.dofs)}
    axes = [rows.get((node, dof)) for node in nodes for dof in TRANSLATIONS]
    there = [place for place, row in enumerate(axes) if row is not None]
    # As a matrix, since those of large full models are sparse.
    chosen = coo_array(
        (np.ones(len(there)), (there, [row for row in axes if row is not None])),
        shape=(len(axes), len(rows)),
    ).tocsr()
    shapes: FloatArray = chosen @ basis.shapes
    return shapes


def _carried(
    response: Response, nodes: list[str], times: FloatArray, derivative: int
) -> FloatArray:
    """Return the motion with which moving supports carry the nodes, (times, 3 nodes)."""
    from bumpstop.carried import carried_node

    known = set(response.problem.basis.dofs)
    return np.stack(
        [
            carried_node(response.problem, node, dof, times, derivative)
            if (node, dof) in known
            else np.zeros(len(times))
            for node in nodes
            for dof in TRANSLATIONS
        ],
        axis=1,
    )


def _forces(response: Response, nodes: list[str], times: FloatArray) -> FloatArray:
    """Return the forces of the laws on their nodes, friction too, (times, nodes, 3)."""
    forces = np.zeros((len(times), len(nodes), 3))
    for number, law in enumerate(response.problem.laws):
        along = coordinates_of(law, response.problem.basis)
        columns = response.history.law_forces(number, times).T
        for coordinate, values in zip(along, columns, strict=True):
            if coordinate.terms is not None:  # it pushes along no one direction
                continue
            pushed = np.outer(values, coordinate.direction)
            for node, sign in ((coordinate.node, 1.0), (coordinate.other, -1.0)):
                if node in nodes:  # points between nodes are none
                    forces[:, nodes.index(str(node))] += sign * pushed
    return forces
