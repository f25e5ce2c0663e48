"""The forces of shafts that turn: gyroscopic moments, and those of the angular acceleration."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.post.force_field import ForceField, spread
from bumpstop.turning import accelerated, acceleration_field

if TYPE_CHECKING:
    from bumpstop.loads.shaft_rotation import ShaftRotation
    from bumpstop.response import Response
    from bumpstop.structure.cut import Cut

__all__ = ["turning_fields"]


def turning_fields(
    response: Response, gyroscopic: FloatArray, rotation: ShaftRotation | None
) -> Iterator[ForceField]:
    """Yield the forces -G u' at the speed of each instant, and those of its change.

    ``gyroscopic`` has -G Phi at the speed that the structure was made with, (dofs, N).
    """
    shapes = response.problem.basis.shapes

    def by_speed(times: FloatArray) -> FloatArray:
        speeds = response.motion(1, times)
        if rotation is None:
            return speeds
        return speeds * (rotation.speed_at(times) / rotation.spin)[:, np.newaxis]

    yield ForceField("damping", gyroscopic, by_speed, spread(partial(_gyration, shapes), by_speed))
    if rotation is None or rotation.constant_speed is not None:
        return
    turning = rotation

    def by_acceleration(times: FloatArray) -> FloatArray:
        return response.motion(0, times) * turning.acceleration_at(times)[:, np.newaxis]

    basis = response.problem.basis
    field = acceleration_field(basis, turning)
    if field.any():
        # Of one plane's motion the gyroscopic moments are about the axis of the other alone.
        moved = accelerated(basis, turning) / turning.spin
        inside = spread(partial(_gyration, moved), by_acceleration)
        yield ForceField("damping", -field, by_acceleration, inside)


def _gyration(shapes: FloatArray, cut: Cut) -> FloatArray:
    """Return what gyroscopic moments do inside an element by the speeds of the modes, (r, N)."""
    return -cut.of_gyration(shapes)
