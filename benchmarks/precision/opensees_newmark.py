"""OpenSees' Newmark method, with the stops as its own gap elements.

OpenSees has masses and springs between dofs, and no modes. In the coordinates ``y = Q q`` of an
orthogonal matrix Q whose first rows are along the rows of the stops, masses stay ones, each stop
sees one dof, and the stiffness is a full matrix, which springs between all pairs of dofs make.
"""

from __future__ import annotations

import numpy as np
import openseespy.opensees as ops

from benchmarks.precision.equations import Equations
from benchmarks.precision.problems import INSTANTS, Watched
from tests.reference.problem import Array

ORTHOGONAL = 1e-9
RIGID = 1e30
"""Force in N at which gap elements yield."""


def fits(problem: Watched) -> bool:
    """Return whether OpenSees has elements for the stops: undamped, rows across each other."""
    rows = _rows(problem)
    products = rows @ rows.T
    products -= np.diag(np.diag(products))
    across = np.abs(products).max(initial=0.0) < ORTHOGONAL * np.square(rows).sum(axis=1).max()
    return bool(across) and all(stop.damping == 0.0 for stop in problem.stops)


def _rows(problem: Watched) -> Array:
    return np.array([stop.row(problem.problem.basis) for stop in problem.stops])


class Newmark:
    """Average acceleration, with Newton's iterations in each step."""

    def __init__(self, problem: Watched) -> None:
        self._problem = problem
        self._equations = Equations(problem)
        rows = _rows(problem)
        self._lengths = np.linalg.norm(rows, axis=1)
        own = rows / self._lengths[:, np.newaxis]
        # The other rows: what is left of unit vectors, by the singular vectors.
        self._turn = np.vstack([own, np.linalg.svd(own)[2][len(own) :]])

    def __call__(self, step: float) -> Array:
        """Run it."""
        equations, turn = self._equations, self._turn
        count = equations.modes
        ops.wipe()
        ops.model("basic", "-ndm", 1, "-ndf", 1)
        ops.node(0, 0.0)
        ops.fix(0, 1)
        for number in range(count):
            ops.node(number + 1, 0.0)
            ops.mass(number + 1, 1.0)
        self._add_springs(turn * equations.omega2 @ turn.T, turn * equations.damping @ turn.T)
        self._add_stops()
        start = np.asarray(equations.start).reshape(2, count) @ turn.T
        for number, (displacement, velocity) in enumerate(start.T.tolist()):
            ops.setNodeDisp(number + 1, 1, displacement, "-commit")
            ops.setNodeVel(number + 1, 1, velocity, "-commit")
        ops.constraints("Plain")
        ops.numberer("Plain")
        ops.system("FullGeneral")
        ops.test("NormDispIncr", 1e-14, 20, 0, 2)
        ops.algorithm("Newton")
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient", "-noWarnings")
        return self._steps(step)

    def _steps(self, step: float) -> Array:
        watched = self._turn @ self._problem.row
        between = round(self._problem.problem.duration / step / INSTANTS)
        found = np.full(INSTANTS, np.nan)
        for instant in range(INSTANTS):
            if ops.analyze(between, step) != 0:
                break
            place = [ops.nodeDisp(number + 1, 1) for number in range(len(watched))]
            found[instant] = watched @ np.array(place)
        return found

    def _add_springs(self, stiffness: Array, damping: Array) -> None:
        """Add a spring between each pair of dofs, and one from each to the ground."""
        count, tag = len(stiffness), 0
        for one in range(count):
            for other in range(one + 1):
                ground = one == other
                pair = [
                    float(matrix[one].sum() if ground else -matrix[one, other])
                    for matrix in (stiffness, damping)
                ]
                tag += 1
                ops.uniaxialMaterial("Elastic", tag, *pair)
                nodes = (0 if ground else other + 1, one + 1)
                ops.element("zeroLength", tag, *nodes, "-mat", tag, "-dir", 1, "-doRayleigh", 0)

    def _add_stops(self) -> None:
        for number, (stop, length) in enumerate(
            zip(self._problem.stops, self._lengths, strict=True)
        ):
            tag = 10_000 + number
            stiffness, gap = stop.stiffness * length**2, stop.gap / length
            ops.uniaxialMaterial("ElasticPPGap", tag, stiffness, -RIGID, -gap)
            ops.element("zeroLength", tag, 0, number + 1, "-mat", tag, "-dir", 1)
