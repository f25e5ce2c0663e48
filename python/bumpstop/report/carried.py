"""What supports that move add to a drawn motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bumpstop.errors import InputError

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.problem import Problem
    from bumpstop.report.outline import Outline

__all__ = ["carried_motion"]


def carried_motion(
    problem: Problem, drawing: Outline, times: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the shapes by which supports carry the points along, and how far in time.

    Nothing where results are told from the supports.

    Parameters
    ----------
    problem
        What was run.
    drawing
        Its points.
    times
        In s, (f,).

    Returns
    -------
    shapes, amplitudes
        (points, 3, loads) and (f, loads); their product is in m.
    """
    count = len(drawing.positions)
    none = np.zeros((count, 3, 0)), np.zeros((len(times), 0))
    if not problem.supports_move or problem.basis.model is None:
        return none
    from bumpstop.loads.moving_supports import MovingSupports

    model = problem.basis.model
    carriers = [
        load for load in problem.loads if isinstance(load, MovingSupports) and load.is_absolute
    ]
    if not carriers:
        return none
    fields = np.stack([load.field(model) for load in carriers], axis=1)
    shapes = np.zeros((count, 3, len(carriers)))
    for point, place in enumerate(drawing.places):
        for axis, dof in enumerate(("dx", "dy", "dz")):
            try:
                shapes[point, axis] = model.displacement_form(place, dof).of(fields)
            except InputError:  # a model need not know every direction
                continue
    travels = [load.travel(problem.duration).at(times, 0) for load in carriers]
    return shapes, np.stack(travels, axis=1)
