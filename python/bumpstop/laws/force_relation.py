"""ForceRelation: a force that is a formula of the displacement and the velocity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bumpstop.arguments import FloatArray, finite
from bumpstop.errors import InputError
from bumpstop.laws.connection import Connection
from bumpstop.laws.formula import program

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["ForceRelation"]

STEP = 1e-6
"""Of the displacement, or of a metre at none: half the step of a difference."""


@dataclass(frozen=True)
class ForceRelation(Connection):
    """A force along a direction, as a formula of the motion along it.

    With the displacement ``x = direction . (u - u_other)`` and the velocity v = x' the force on
    the node is ``force(x, v)`` along the direction, and the opposite on the other node: a spring
    is ``"-2e4 * x"``, with its sign. What the force at rest does is stored in the law,
    ``-∫ force(x, 0) dx``, so that it should return to the same; what the velocity adds is
    dissipated. The adaptive methods take it and the schemes of fixed steps; where ``abs``,
    ``sign``, ``step``, ``min`` or ``max`` turn at a straight line in x and v, the former locate
    the instant.

    A relation that is a table is piecewise linear: a `SpringLaw` of the displacement, or a
    `DamperLaw` of the velocity, which the exact method takes, by ``through(points, ...)``.

    Parameters
    ----------
    name
        What the relation is called in results.
    node
        The node that it acts on: a node's name or a point along a beam (``"AB@0.462"``).
    direction
        Direction along which it acts, in global axes; any length but zero, kept as a unit
        vector.
    other
        The node that it acts against; the ground where left out.
    terms
        Instead of node, direction and other: the weight of each (node, dof) in the displacement.
    force
        The formula, in N: numbers, ``x`` in m, ``v`` in m/s, ``+ - * / **``, brackets, ``pi``,
        ``e`` and the functions ``sin cos tan asin acos atan atan2 sinh cosh tanh exp log sqrt abs
        sign step min max``, where ``step(x)`` is 1 from x = 0 on and 0 before.

    Raises
    ------
    InputError
        If the formula is none, has something else in it, or no finite value at rest.

    Examples
    --------
    Duffing's spring takes a mass to and fro in 4 K(k) / sqrt(a + b X^2), K the complete elliptic
    integral of the first kind and k^2 = b X^2 / (2 (a + b X^2)); here 0.536666 s.

    >>> import bumpstop as bs
    >>> hardening = ForceRelation(
    ...     "spring", node="P", direction=(1, 0, 0), force="-100 * x - 2e6 * x**3"
    ... )
    >>> mass = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dx"): [1]})
    >>> start = bs.ModalState(displacement=[5e-3])
    >>> response = bs.simulate(bs.Problem(mass, laws=[hardening], initial=start, duration=1.0))
    >>> print(f"{response.sample('displacement', 'P', 'dx', times=[0.536666])[0]:.6f}")
    0.005000
    """

    kind: ClassVar[str] = "relation"
    smooth: ClassVar[str] = "its force is a formula"
    """Why it is not piecewise linear."""

    _: KW_ONLY
    force: str

    def __post_init__(self) -> None:
        super().__post_init__()
        if not np.isfinite(self.force_at([0.0])).all():
            what = "has no finite value at x = 0, v = 0"
            raise InputError(what, key="force", value=self.force)

    @cached_property
    def _program(self) -> list[float | str]:
        return program(self.force)

    def force_at(
        self, displacement: FloatArray | Sequence[float], velocity: float = 0.0
    ) -> FloatArray:
        """Return the force in N on the node, for displacements in m at a velocity in m/s."""
        from bumpstop import _core

        x = np.asarray(displacement, dtype=np.float64)
        v = np.full(x.size, finite("velocity", velocity))
        relation = _core.ForceRelation(np.zeros(1), self._program)
        return relation.force(x.ravel(), v).reshape(x.shape)

    @property
    def static_stiffness(self) -> float:
        """Its stiffness in N/m about no displacement, a scale of what it resists with."""
        return abs(self.static_force(0.0)[1])

    @property
    def steepest(self) -> float:
        """Its slope in N/m about no displacement: formulas have no largest one."""
        return self.static_stiffness

    def static_force(self, place: float) -> tuple[float, float]:
        """Return the force in N on the structure, ``place`` m along, at rest, and its slope."""
        step = STEP * (abs(place) or 1.0)
        before, here, after = self.force_at([place - step, place, place + step]).tolist()
        return here, (after - before) / (2.0 * step)

    def core(self, basis: ModalBasis) -> _core.ForceRelation:
        """Return the relation as the core sees it; see `row`."""
        from bumpstop import _core

        return _core.ForceRelation(self.row(basis), self._program)
