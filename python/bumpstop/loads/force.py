"""NodalForce: a force and moment on a node."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, Vector, name, vector
from bumpstop.loads.load import SingleLoad
from bumpstop.loads.time import TimeFunction, time_functions
from bumpstop.projection import ROTATIONS, direction_row
from bumpstop.structure.dofs import DOFS

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.cut import Cut
    from bumpstop.structure.model import LinearModel

__all__ = ["NodalForce"]


@dataclass(frozen=True)
class NodalForce(SingleLoad):
    """A force, and a moment where one is given, on one node from t = 0 on.

    Parameters
    ----------
    name
        What the load is called.
    node
        The node it acts on: a node's name or a point along a beam (``"AB@0.462"``).
    force
        Components along the global axes, in N.
    moment
        Components about the global axes, in N m.
    time
        What both are multiplied by: a function of time, or a list of functions whose sum is
        meant; constant where left out.

    Raises
    ------
    InputError
        If a component is missing or not finite, or something else is no function of time.

    Examples
    --------
    >>> NodalForce("push", node="B", force=(0, -5, 0)).force
    (0.0, -5.0, 0.0)
    """

    name: str
    _: KW_ONLY
    node: str
    force: Vector = (0.0, 0.0, 0.0)
    moment: Vector = (0.0, 0.0, 0.0)
    time: TimeFunction | Sequence[TimeFunction] | None = None

    def __post_init__(self) -> None:
        name("name", self.name)
        name("node", self.node)
        object.__setattr__(self, "force", vector("force", self.force))
        object.__setattr__(self, "moment", vector("moment", self.moment))
        time_functions(self.time)

    @property
    def functions(self) -> tuple[TimeFunction, ...]:
        """The functions of time whose sum it is multiplied by; none where it is constant."""
        return time_functions(self.time)

    def modal_force(self, basis: ModalBasis) -> FloatArray:
        """Return the force on each mode (N,) where the function of time is one.

        Raises
        ------
        InputError
            If the basis has no shape at the node along a component that is not zero.
        """
        force = direction_row(basis, self.node, self.force)
        return force + direction_row(basis, self.node, self.moment, ROTATIONS)

    def nodal_force(self, model: LinearModel) -> FloatArray:
        """Return the force on each dof of a model, (dofs,), where the function of time is one.

        Raises
        ------
        InputError
            If the model has no such node.
        """
        total = np.zeros(len(model.dofs))
        for dof, component in zip(DOFS, (*self.force, *self.moment), strict=True):
            if component != 0.0:
                form = model.displacement_form(self.node, dof)
                np.add.at(total, form.dofs, component * form.weights)
        return total

    def inside(self, cut: Cut) -> FloatArray:
        """Return what it does inside an element, where it acts on a point of it, (r, 1)."""
        weights = dict(zip(DOFS, (*self.force, *self.moment), strict=True))
        return cut.of_point(self.node, weights)[:, np.newaxis]
