"""SupportMotion: some supports move, others differently or not at all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, Vector, name
from bumpstop.errors import InputError
from bumpstop.loads.load import ForceComponent
from bumpstop.loads.moving_supports import MovingSupports, Rate
from bumpstop.loads.time import TimeFunction
from bumpstop.projection import TRANSLATIONS
from bumpstop.structure.names import names

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.cut import Cut
    from bumpstop.structure.model import LinearModel

__all__ = ["SupportMotion"]


@dataclass(frozen=True, eq=False)
class SupportMotion(MovingSupports):
    """A translation of some supports; every group that moves differently is a load of its own.

    A support that several of them name moves by their sum.

    The structure follows slowly moving supports by a pseudo-static mode ``psi``: the displacement
    where they move by one, the other supports stay and no load acts. What its inertia adds is
    told by the modes, which feel

        ``-Phi' (M psi a(t) + (C + G) psi v(t) + N psi d(t))``

    with the structure's own dampers C, gyroscopic and circulatory matrices G and N, the supports'
    displacement d, velocity v and acceleration a; damping that modes have by ratios acts on what
    the modes tell. Displacements in results are whole, ``psi d + Phi q``, and so are the distances
    of stops, whose obstacles stand still unless other nodes carry them. Initial states are those
    of ``Phi q``, and so is the kinetic and elastic energy; the work of the loads is that of the
    forces above.

    Parameters
    ----------
    name
        What the load is called.
    nodes
        The nodes that move, held by supports in all directions in which they do.
    acceleration, displacement, time
        As for a `BaseMotion`.

    Raises
    ------
    InputError
        As for a `BaseMotion`.

    References
    ----------
    R. W. Clough, J. Penzien, Dynamics of Structures, 3rd edition, 2003, section 26-3.

    Examples
    --------
    >>> from bumpstop.loads import Harmonic
    >>> wave = Harmonic(2.0, sine=1.0)
    >>> SupportMotion("left", nodes="A", displacement=(0, 1e-3, 0), time=wave).nodes
    ('A',)
    """

    name: str
    _: KW_ONLY
    nodes: str | Sequence[str]
    acceleration: Vector | None = None
    displacement: Vector | None = None
    time: TimeFunction | Sequence[TimeFunction] | None = None

    def __post_init__(self) -> None:
        name("name", self.name)
        object.__setattr__(self, "nodes", names("nodes", self.nodes))
        self._check_motion()

    @property
    def is_absolute(self) -> bool:
        """Whether results are told as seen from the still ground: always."""
        return True

    def field(self, model: LinearModel) -> FloatArray:
        """Return the pseudo-static mode where the function of time is one, (dofs,).

        Raises
        ------
        InputError
            If a node is unknown or not held where it should move, or is joined to others.
        """
        known = self._fields
        if id(model) not in known:
            from bumpstop.modal.pseudo_static import pseudo_static

            known[id(model)] = (model, pseudo_static(model, self._moved(model)))
        return known[id(model)][1]

    def components(self, basis: ModalBasis) -> tuple[ForceComponent, ...]:
        """Return the forces on each mode, each with its functions of time.

        Raises
        ------
        InputError
            If the basis was not made from a structure, or as `field` does.
        """
        model = basis.model
        if model is None:
            hint = "make the basis from a structure"
            raise InputError("the basis has no supports", key="nodes", value=self.nodes, hint=hint)
        field = self.field(model)
        rates = [
            (basis.whole_mass @ field, self.accelerations),
            (model.damping @ field + model.gyroscopic @ field, (Rate(self, 1),)),
            (model.circulatory @ field, (Rate(self, 0),)),
        ]
        return tuple(
            ForceComponent(np.ascontiguousarray(-(basis.shapes.T @ force)), functions)
            for number, (force, functions) in enumerate(rates)
            if number == 0 or force.any()
        )

    def inside(self, cut: Cut) -> FloatArray:
        """Return what inertia does inside an element that is carried along, (r, 3).

        Columns are by displacement, velocity and acceleration of the supports.
        """
        field = self.field(cut.model)[:, np.newaxis]
        by_speed, by_rate = -cut.of_gyration(field), -cut.of_inertia(field)
        return np.hstack([0.0 * by_rate, by_speed, by_rate])

    def _moved(self, model: LinearModel) -> FloatArray:
        """Return the motion of the supports themselves, (dofs,)."""
        following = np.zeros(len(model.dofs), dtype=bool)
        following[model.expansion.rows] = True
        moved = np.zeros(len(model.dofs))
        for node in self.nodes:
            for dof, size in zip(TRANSLATIONS, self.size, strict=True):
                if size == 0.0:
                    continue
                try:
                    form = model.displacement_form(node, dof)
                except InputError as error:
                    what, hint = error.what, error.hint
                    raise InputError(what, key="nodes", value=node, hint=hint) from error
                if len(form.dofs) != 1 or following[form.dofs[0]]:
                    what, hint = f"no support holds its {dof}", "hold the node, then move it"
                    raise InputError(what, key="nodes", value=node, hint=hint)
                moved[form.dofs[0]] = size
        return moved

    @cached_property
    def _fields(self) -> dict[int, tuple[LinearModel, FloatArray]]:
        """Pseudo-static modes found so far, with their models, which keeps the ids from reuse."""
        return {}
