"""Static shapes: how a model bends under forces, moved dofs, or an acceleration of its base.

They stand in for the modes that a basis leaves out, which are too fast to do more than follow
(R. R. Craig and A. J. Kurdila, Fundamentals of Structural Dynamics, 2nd edition, Wiley, 2006,
chapter 17).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.modal.independent import independent_vectors, mass_norms, without
from bumpstop.modal.places import ResolvedPlace, resolved_places
from bumpstop.modal.solve import StaticSolver
from bumpstop.modal.unit_motion import unit_motion
from bumpstop.modal.vectors import RIGID
from bumpstop.structure.dofs import Place
from bumpstop.structure.model import LinearModel
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["StaticShapes"]

BALANCED = 1e-9
"""A load of which less than this is left after inertia has taken its share bends nothing."""
REACHED = 1e-6
"""How exactly a place must move by one, and the others by nothing."""
SINGULAR = 1e-13
"""Singular values below this, relative to the largest, are rounding."""


class StaticShapes:
    """Static shapes of a model, whose stiffness is factorised once for all of them.

    Parameters
    ----------
    model
        The structure.

    Examples
    --------
    A bar of stiffness EA / L = 2.1e9 N/m, pulled at its end.

    >>> from bumpstop import Beam, Material, Rectangle, Structure, Support
    >>> steel = Material(young_modulus=210e9, poisson_ratio=0.0, density=7800.0)
    >>> square = Rectangle(height=0.1, width=0.1)
    >>> bar = Structure(
    ...     nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
    ...     beams=[Beam("AB", nodes=("A", "B"), elements=4, material=steel, section=square)],
    ...     supports=[Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))],
    ... )
    >>> stretch = StaticShapes(bar).attachment([("B", "dx")])
    >>> print(f"{2.1e9 * stretch[bar.dofs.index(('B', 'dx')), 0]:.12f}")
    1.000000000000
    """

    def __init__(self, model: LinearModel) -> None:
        self._model = model

    def attachment(self, places: Sequence[Place], beyond: FloatArray | None = None) -> FloatArray:
        """Return the displacements under a unit force at each place, (dofs, places), in m/N.

        A structure that can move as a rigid body is balanced by the inertia of its rigid
        acceleration (inertia relief); its shapes have no part in rigid motions.

        Parameters
        ----------
        places
            Where the forces act: each a node and a dof, ``("B", "dy")``, or a node and a
            direction, ``("B", (0, 0.6, 0.8))``. A rotation takes a moment of 1 N m.
        beyond
            Modes of the structure of unit modal mass, (dofs, m). With them, what is returned
            is the residual flexibility: the shapes less what the modes give of them. It is
            orthogonal to the modes in mass and stiffness.

        Raises
        ------
        InputError
            If a place is unknown or cannot move.
        """
        found = resolved_places(self._model, places, "places")
        return self.under(np.stack([place.load for place in found], axis=1), beyond)

    def base(self, directions: Sequence[str], beyond: FloatArray | None = None) -> FloatArray:
        """Return the displacements under a unit acceleration of the base: pseudo-modes.

        They are relative to the base; zero where a structure without supports moves along.

        Parameters
        ----------
        directions
            ``dx dy dz``: all supports accelerate by 1 m/s2; ``drx dry drz``: they turn about
            the origin with 1 rad/s2.
        beyond
            As for `attachment`.

        Raises
        ------
        InputError
            If a direction is unknown.
        """
        motions = np.stack([unit_motion(self._model, name) for name in directions], axis=1)
        return self.under(-(self._model.mass @ motions), beyond)

    def constraint(self, places: Sequence[Place]) -> FloatArray:
        """Return the displacements where each place moves by 1 m and the others stay, (dofs, n).

        Parameters
        ----------
        places
            As for `attachment`; none of them may follow from the others.

        Raises
        ------
        InputError
            If a place is unknown, cannot move, or moves with the others.
        """
        return self.held(resolved_places(self._model, places, "places"), "places")

    def held(self, found: Sequence[ResolvedPlace], key: str) -> FloatArray:
        """Return the constraint modes of places, which ``key`` tells errors the list of."""
        forces = np.stack([place.load for place in found], axis=1)
        bent = self.under(forces)
        pushed, moved = _held(forces.T @ bent, forces.T @ self._rigid)
        shapes = bent @ pushed + self._rigid @ moved
        reached = forces.T @ shapes
        wrong = np.abs(reached - np.eye(len(found))).max(axis=0) > REACHED
        if wrong.any():
            label = found[int(wrong.argmax())].label
            what = "cannot move while the other places are held"
            raise InputError(what, key=key, value=label)
        return shapes

    def under(self, loads: FloatArray, beyond: FloatArray | None = None) -> FloatArray:
        """Return the displacements under loads, (dofs, n), with inertia relief.

        Parameters
        ----------
        loads
            One a column, (dofs, n).
        beyond
            As for `attachment`.
        """
        mass, taken = self._model.mass, self._orthonormal(beyond)
        left = self._collect @ (loads - mass @ (taken @ (taken.T @ loads)))
        sizes = np.abs(self._collect @ loads).max(axis=0)
        left[:, np.abs(left).max(axis=0) <= BALANCED * sizes] = 0.0
        shapes = self._model.expansion @ self._solver.solve(left)
        # Twice: once more removes what rounding left.
        return without(taken, without(taken, shapes, mass), mass)

    @cached_property
    def _collect(self) -> SparseMatrix:
        """From loads on all dofs to those on the independent ones."""
        return self._model.expansion.transposed()

    @cached_property
    def _solver(self) -> StaticSolver:
        model = self._model
        return StaticSolver(model.reduced(model.stiffness), model.rigid_shapes())

    @cached_property
    def _rigid(self) -> FloatArray:
        """Rigid motions on all dofs, orthonormal in the mass matrix."""
        model = self._model
        return independent_vectors(model.expansion @ model.rigid_shapes(), model.mass).vectors

    def _orthonormal(self, modes: FloatArray | None) -> FloatArray:
        """Return modes and those rigid motions that are not among them."""
        if modes is None:
            return self._rigid
        mass = self._model.mass
        rest = without(modes, without(modes, self._rigid, mass), mass)
        missing = rest[:, mass_norms(rest, mass) > RIGID]
        return np.hstack([modes, independent_vectors(missing, mass).vectors])


def _held(compliance: FloatArray, rigid: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return forces and rigid motions that move each place by one and keep the others still.

    Forces f in balance, ``rigid' f = 0``, and rigid motions c with ``compliance f + rigid c``
    one at a place and zero at the others; least ones where they are not unique.
    """
    places, motions = rigid.shape
    soft, wide = (np.abs(part).max(initial=0.0) or 1.0 for part in (compliance, rigid))
    system = np.zeros((places + motions, places + motions))
    system[:places, :places] = compliance / soft
    system[:places, places:] = rigid / wide
    system[places:, :places] = rigid.T / wide
    wanted = np.eye(places + motions, places)
    found = np.linalg.lstsq(system, wanted, rcond=SINGULAR)[0]
    return found[:places] / soft, found[places:] / wide
