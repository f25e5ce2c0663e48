"""NodalState: displacements and velocities of nodes at t = 0."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, finite, series
from bumpstop.errors import InputError
from bumpstop.structure.dofs import Dof

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.model import LinearModel

__all__ = ["NodalState"]

_TOLD = 0.01
"""The share of a field beyond the basis, in the norm of the mass matrix, that is told."""


@dataclass(frozen=True, eq=False)
class NodalState:
    """Displacements and velocities of dofs, projected on the basis with the mass matrix.

    Parameters
    ----------
    displacement, velocity
        Values by (node, dof), zero where nothing is said; or one for each of the model's dofs,
        (dofs,). In m and rad, m/s and rad/s.

    Raises
    ------
    InputError
        If a number is not finite.

    Examples
    --------
    >>> NodalState(velocity={("B", "dy"): 0.2}).velocity
    {('B', 'dy'): 0.2}
    """

    _: KW_ONLY
    displacement: Mapping[Dof, float] | FloatArray | None = None
    velocity: Mapping[Dof, float] | FloatArray | None = None

    def __post_init__(self) -> None:
        for key in ("displacement", "velocity"):
            given = getattr(self, key)
            if isinstance(given, Mapping):
                values = {dof: finite(key, value) for dof, value in given.items()}
                object.__setattr__(self, key, values)
            elif given is not None:
                object.__setattr__(self, key, np.array(series(key, given)))

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        given = [key for key in ("displacement", "velocity") if getattr(self, key) is not None]
        return f"given {' and '.join(given) or 'state'} of nodes"

    def modal_state(self, basis: ModalBasis) -> tuple[FloatArray, FloatArray]:
        """Return modal displacement and velocity, each (N,).

        Raises
        ------
        InputError
            If the basis was not made from a structure, a node is unknown, or what is held
            would move.
        """
        displacement, velocity = (
            basis.project_field(self._field(key, basis)) for key in ("displacement", "velocity")
        )
        return displacement, velocity

    def remarks(self, basis: ModalBasis) -> tuple[str, ...]:
        """Return a line for each field of which the basis holds too little."""
        told = []
        for key in ("displacement", "velocity"):
            field = self._field(key, basis)
            assert basis.model is not None  # asked for by the field
            given = float(field @ (basis.model.mass @ field))
            held = basis.project_field(field)
            lost = given - float(held @ held)
            if lost > _TOLD * given:
                share = f"{100.0 * lost / given:.3g} %"
                told.append(
                    f"{share} of the initial {key} is lost, weighed by the masses: "
                    "the basis cannot follow it; more modes hold more of it"
                )
        return tuple(told)

    def _field(self, key: str, basis: ModalBasis) -> FloatArray:
        model = basis.model
        if model is None:
            hint = "give a ModalState, or make the basis from a structure"
            raise InputError("needs a basis computed from a structure", key=key, hint=hint)
        given = getattr(self, key)
        field = self._placed(key, given, model) if isinstance(given, Mapping) else given
        if field is None:
            return np.zeros(len(model.dofs))
        if len(field) != len(model.dofs):
            what = f"must have a value for each of the {len(model.dofs)} dofs"
            raise InputError(what, key=key, value=f"{len(field)} values")
        held = np.ones(len(field), dtype=bool)
        held[model.expansion.rows] = False
        if field[held].any():
            node, dof = model.dofs[int(np.flatnonzero(held & (field != 0.0))[0])]
            raise InputError("is held at zero", key=key, value=f"{node} {dof}")
        return np.asarray(field)

    def _placed(self, key: str, given: Mapping[Dof, float], model: LinearModel) -> FloatArray:
        field = np.zeros(len(model.dofs))
        for (node, dof), value in given.items():
            try:
                form = model.displacement_form(node, dof)
            except InputError as error:
                raise InputError(error.what, key=key, value=(node, dof), hint=error.hint) from error
            if len(form.dofs) != 1:
                what = "must be at a node of the mesh, not between two"
                raise InputError(what, key=key, value=node)
            field[form.dofs[0]] = value
        return field
