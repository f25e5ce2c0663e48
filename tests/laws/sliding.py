"""Dry friction by an algorithm of its own: a slider that is dragged, in small explicit steps.

Central differences in time; at each step the elastic trial force of the stick is brought back to
the cone (return mapping, as in J. C. Simo and T. J. R. Hughes, *Computational Inelasticity*, 1998,
section 1.4), so that nothing is said of states or guards.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["Rubbing"]


@dataclass(frozen=True)
class Rubbing:
    """Modes on one stop with friction, without dampers in the stop."""

    omega2: FloatArray
    damping: FloatArray
    normal: FloatArray
    tangent: FloatArray
    gap: float
    stiffness: float
    tangential_stiffness: float
    friction: float

    def motion(
        self, q: FloatArray, v: FloatArray, force: FloatArray, dt: float, steps: int
    ) -> FloatArray:
        """Return the modal displacements at every step, (steps + 1, modes)."""
        half = 0.5 * self.damping * dt
        slider: float | None = None

        def pushes(q: FloatArray) -> FloatArray:
            nonlocal slider
            distance = self.gap + self.normal @ q
            if distance >= 0.0:
                slider = None
                return force
            push = -self.stiffness * distance
            x = float(self.tangent @ q)
            reach = float(self.friction * push / self.tangential_stiffness)
            place = x if slider is None else min(max(slider, x - reach), x + reach)
            slider = place
            rub = -self.tangential_stiffness * (x - place)
            return force + self.normal * push + self.tangent * rub

        path = np.empty((steps + 1, len(q)))
        acceleration = pushes(q) - self.damping * v - self.omega2 * q
        before, now = q - dt * v + 0.5 * dt**2 * acceleration, q
        path[0] = q
        for step in range(steps):
            pull = pushes(now) - self.omega2 * now
            following = (2.0 * now - (1.0 - half) * before + dt**2 * pull) / (1.0 + half)
            before, now = now, following
            path[step + 1] = now
        return path
