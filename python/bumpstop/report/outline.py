"""An outline of a structure: the points at which it is drawn, and from where it is seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.errors import InputError
from bumpstop.structure.drawn import DrawnModel

if TYPE_CHECKING:
    from collections.abc import Iterable

    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis

__all__ = ["UNSEEN", "Outline", "outline", "view_of"]

POINTS_A_BEAM = 80
"""Points along a beam, about: the curve between its nodes is that of the shape functions."""

MOST_POINTS = 2000
"""Points of all beams together; it keeps the page small."""

UNSEEN = 1e-9
"""A mode that moves points by less than this, relative to the others, does so by rounding."""

_AXES = ("dx", "dy", "dz")


@dataclass(frozen=True)
class Outline:
    """Points at which a structure is drawn.

    Attributes
    ----------
    positions
        Where they are at rest, (points, 3), in m.
    shapes
        How they move per unit of each modal displacement, (points, 3, modes).
    lines
        One ``(first point, number of points)`` a beam.
    nodes
        Which point a named node is.
    schematic
        True where the basis knows no geometry and the nodes are placed side by side.
    places
        Name of each point: a node's, or that of a point along a beam.
    """

    positions: FloatArray
    shapes: FloatArray
    lines: list[tuple[int, int]]
    nodes: dict[str, int]
    schematic: bool
    places: list[str]

    @property
    def spatial(self) -> bool:
        """Whether no global plane holds the structure and its motion."""
        return _plane(self.positions, np.abs(self.shapes).max(axis=(0, 2))) is None

    @property
    def seen(self) -> list[bool]:
        """Whether each mode moves a point; one that only twists beams moves none."""
        travel = np.abs(self.shapes).max(axis=(0, 1))
        limit = UNSEEN * max(float(travel.max()), np.finfo(float).tiny)
        return [bool(moved) for moved in travel > limit]


def outline(basis: ModalBasis, extra: Iterable[str] = ()) -> Outline:
    """Return the points at which the structure of a basis is drawn.

    Parameters
    ----------
    basis
        Modes, with or without the structure that they come from.
    extra
        Nodes or points along beams that must be among the points, as those of the stops.
    """
    if isinstance(basis.model, DrawnModel):
        return _from_model(basis, basis.model, extra)
    return _side_by_side(basis)


def view_of(positions: FloatArray, motion: FloatArray) -> FloatArray:
    """Return the projection (2, 3) from global axes to right and up on paper.

    A structure whose extent and motion lie in one global plane is seen at a right angle to
    it, with Z up where there is Z; any other is seen from above at an angle.

    Parameters
    ----------
    positions
        Points, (n, 3), in m.
    motion
        How far anything moves along each global axis, (3,); only the ratios count.

    Examples
    --------
    >>> view_of(np.array([[0.0, 0, 0], [1, 0, 0]]), np.array([0.0, 1.0, 0.0]))
    array([[1., 0., 0.],
           [0., 1., 0.]])
    """
    plane = _plane(positions, motion)
    if plane is not None:
        return np.eye(3)[list(plane)]
    azimuth, elevation = np.radians(-60.0), np.radians(22.0)
    right_axis = [-np.sin(azimuth), np.cos(azimuth), 0.0]
    up_axis = [
        -np.cos(azimuth) * np.sin(elevation),
        -np.sin(azimuth) * np.sin(elevation),
        np.cos(elevation),
    ]
    return np.array([right_axis, up_axis])


def _plane(positions: FloatArray, motion: FloatArray) -> tuple[int, int] | None:
    """Return the two axes of the global plane that holds positions and motion, if one does."""
    interest = np.maximum(_relative(np.ptp(positions, axis=0)), _relative(motion))
    # A stable sort: of axes that are equally dull, Z leaves first, then X beside Y or Z.
    order = np.argsort(-interest, kind="stable")
    if interest[order[2]] >= 0.02:
        return None
    right, up = sorted(order[:2].tolist())
    return right, up


def _side_by_side(basis: ModalBasis) -> Outline:
    names = list(dict.fromkeys(node for node, _ in basis.dofs))
    shapes = np.array([_shape(basis, name) for name in names])
    motion = np.abs(shapes).max(axis=(0, 2))
    along = int(np.argmin(motion))
    positions = np.zeros((len(names), 3))
    positions[:, along] = np.arange(len(names)) * 3.0 * max(float(motion.max()), 1e-300)
    nodes = {name: i for i, name in enumerate(names)}
    return Outline(positions, shapes, [], nodes, True, names)


def _from_model(basis: ModalBasis, model: DrawnModel, extra: Iterable[str]) -> Outline:
    places: list[str] = []
    lines: list[tuple[int, int]] = []
    budget = max(MOST_POINTS // max(len(model.lines), 1), 2)
    for line in model.lines:
        pieces = min(_pieces(line.elements), budget)
        lines.append((len(places), pieces + 1))
        along = np.linspace(0.0, line.length, pieces + 1).tolist()
        places += [f"{line.name}@{distance!r}" for distance in along]
    nodes = {}
    for place in dict.fromkeys([*model.nodes, *extra]):
        nodes[place] = len(places)
        places.append(place)
    positions = np.array([model.position(place) for place in places])
    shapes = np.array([_shape(basis, place) for place in places])
    return Outline(positions, shapes, lines, nodes, False, places)


def _pieces(elements: int) -> int:
    return elements * max(round(POINTS_A_BEAM / elements), 1)


def _shape(basis: ModalBasis, place: str) -> FloatArray:
    """Return how a place moves per modal displacement, (3, modes); 0 where nothing is known."""
    rows = np.zeros((3, len(basis.omega2)))
    for axis, dof in enumerate(_AXES):
        try:
            rows[axis] = basis.row(place, dof)
        except InputError:  # a basis made by hand need not know every direction
            continue
    return rows


def _relative(sizes: FloatArray) -> FloatArray:
    largest = float(sizes.max())
    return sizes / largest if largest > 0.0 else np.zeros(3)
