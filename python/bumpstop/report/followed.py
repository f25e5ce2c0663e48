"""The shapes and amplitudes that a drawing follows, of bases and of full models."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.modal.full import FullModel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.report.outline import Outline
    from bumpstop.response import Response

__all__ = ["followed_motion", "known_basis", "unknown_places"]

MOST_SHAPES = 128
"""More than that are drawn by the few that a motion is made of."""
SNAPSHOTS = 400
SEEN = 1e-5
"""Parts of a motion smaller than this, relative to the largest one, are not drawn."""


def followed_motion(
    response: Response, drawing: Outline, times: FloatArray
) -> tuple[Outline, FloatArray]:
    """Return a drawing with the shapes that its points follow, and their amplitudes in time.

    They are the modes and their displacements. Of a full model the motion of few dofs may be known:
    beams that need others stay at rest, and so do other points, in the directions that are not
    known. Where there are many dofs, the shapes are those of a proper orthogonal decomposition of
    the motion (L. Sirovich, Quarterly of Applied Mathematics 45 (1987) 561, the method of
    snapshots).

    Parameters
    ----------
    response
        The run.
    drawing
        Its points.
    times
        In s, (f,).

    Returns
    -------
    drawing, amplitudes
        The latter (f, shapes).
    """
    modal = response.motion(0, times)
    if response.kept is not None:
        shapes = drawing.shapes[:, :, response.kept]
        shapes[unknown_places(response, drawing)] = 0.0
        drawing = replace(drawing, shapes=shapes)
    if modal.shape[1] <= MOST_SHAPES:
        return drawing, modal
    return _decomposed(drawing, modal)


def known_basis(response: Response) -> ModalBasis:
    """Return the basis by the coordinates whose motion a run has kept."""
    basis = response.problem.basis
    if response.kept is None:
        return basis
    assert isinstance(basis, FullModel)  # of no other coordinates are left out
    return basis.only(response.kept)


def unknown_places(response: Response, drawing: Outline) -> NDArray[np.bool_]:
    """Return which motions of a drawing's points a run has not kept, (points, 3), as booleans."""
    if response.kept is None:
        return np.zeros(drawing.shapes.shape[:2], dtype=bool)
    lost = np.ones(drawing.shapes.shape[2], dtype=bool)
    lost[response.kept] = False
    unknown = np.asarray(drawing.shapes[:, :, lost].any(axis=2))
    for first, count in drawing.lines:
        unknown[first : first + count] |= unknown[first : first + count].any()
    return unknown


def _decomposed(drawing: Outline, modal: FloatArray) -> tuple[Outline, FloatArray]:
    points = drawing.shapes.shape[:2]
    shapes = drawing.shapes.reshape(-1, drawing.shapes.shape[2])
    snapshots = shapes @ modal[:: -(-len(modal) // SNAPSHOTS)].T
    found, sizes, _ = np.linalg.svd(snapshots, full_matrices=False)
    found = found[:, : max(int(np.count_nonzero(sizes > SEEN * sizes[0])), 1)]
    drawing = replace(drawing, shapes=found.reshape(*points, -1))
    return drawing, (modal @ shapes.T) @ found
