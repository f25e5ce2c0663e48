"""Placed: where a component stands in an assembly."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property

from bumpstop.arguments import FloatArray, Vector, vector
from bumpstop.errors import InputError
from bumpstop.modal.substructure.component import Component
from bumpstop.modal.substructure.reduced import ReducedComponent
from bumpstop.modal.substructure.rotation import Turn, rotation_matrix

__all__ = ["Placed"]


@dataclass(frozen=True, eq=False)
class Placed:
    """A reduced component, turned and then moved; it may be placed as often as needed.

    Parameters
    ----------
    component
        What ``craig_bampton`` or ``free_interface`` made of a component.
    at
        Where the origin of the component's own axes goes, in m.
    rotation
        How the component is turned about that origin: a ``Rotation``, or the matrix (3, 3)
        whose columns are the component's own axes. Its own axes are the global ones where
        left out.

    Raises
    ------
    InputError
        If the component is not reduced, or the rotation is none.
    """

    component: ReducedComponent
    _: KW_ONLY
    at: Vector = (0.0, 0.0, 0.0)
    rotation: Turn | None = None

    def __post_init__(self) -> None:
        if isinstance(self.component, Component):
            hint = "reduce it with craig_bampton or free_interface"
            raise InputError("is not reduced yet", key="component", hint=hint)
        if not isinstance(self.component, ReducedComponent):
            raise InputError("must be a reduced component", key="component", value=self.component)
        object.__setattr__(self, "at", vector("at", self.at))
        rotation_matrix("rotation", self.rotation)

    @cached_property
    def axes(self) -> FloatArray:
        """The component's own axes, one a column, (3, 3)."""
        return rotation_matrix("rotation", self.rotation)
