"""How rounding may grow: matrices that carry perturbations along a run and through its switches.

Rounding enters in every phase, at its start and on the way, so that the sum of ``V V'`` over these
instants is carried, V(t, s) being what becomes at t of a perturbation at s. Its root is the
growth, |V|, relative to the largest displacement and velocity.
"""

import numpy as np

from ..problem import Array
from .flow import Layout

TOUCHING = 2e-13  # of the sizes that a function is the sum of: nothing but rounding


class Perturbations:
    """The sum of ``V V'`` over displacements, velocities and memories."""

    def __init__(self, layout: Layout) -> None:
        """Begin with none."""
        p = layout.problem
        self.layout = layout
        self.sizes = float(np.abs(p.displacement).max()), float(np.abs(p.velocity).max())
        self.blur = np.zeros((layout.inner, layout.inner))
        self.growth = 1.0

    def see(self, track: Array) -> None:
        """Take note of how far and how fast the motion goes."""
        n = self.layout.modes
        reach = max(self.sizes[0], float(np.abs(track[:, :n]).max()))
        speed = max(self.sizes[1], float(np.abs(track[:, n : 2 * n]).max()))
        self.sizes = reach, speed

    def value(self, row: Array, z: Array) -> tuple[float, float]:
        """Return a function's value, and the size below which it is zero."""
        n, size = self.layout.modes, np.abs(z)
        size[:n] = np.maximum(size[:n], self.sizes[0])
        size[n : 2 * n] = np.maximum(size[n : 2 * n], self.sizes[1])
        return float(row @ z), TOUCHING * float(np.abs(row) @ size)

    def carry(self, propagator: Array) -> None:
        """Add a rounding of the motion, and carry all on."""
        inner, n = self.layout.inner, self.layout.modes
        size = np.repeat([size or 1.0 for size in self.sizes], n)
        noise = np.zeros(inner)
        noise[: 2 * n] = size**2
        v = propagator[:inner, :inner]
        self.blur = v @ (self.blur + np.diag(noise)) @ v.T
        variances = np.diag(self.blur)[: 2 * n]
        self.growth = max(self.growth, float(np.sqrt((variances / size**2).sum())))

    def cross(self, jump: Array, fields: tuple[Array, Array], guard: Array, z: Array) -> None:
        """Cross a switch at which the state jumps and the field changes.

        The saltation matrix is ``J + (f+ - J f-) grad g' / (grad g . f-)``; a guard that has
        jumped below zero says nothing of the instant.
        """
        before, after = fields
        saltation = jump.copy()
        value, zero = self.value(guard, z)
        rate, no_rate = float(guard @ before), TOUCHING * float(np.abs(guard) @ np.abs(before))
        if value >= -zero and abs(rate) > no_rate:
            change = after - jump @ before
            saltation += np.outer(change, guard) / rate
        inner = self.layout.inner
        s = saltation[:inner, :inner]
        self.blur = s @ self.blur @ s.T
