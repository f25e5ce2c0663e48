"""Coulomb friction of a stop along one direction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from bumpstop.arguments import FloatArray, Vector, did_you_mean, not_negative, one_of
from bumpstop.errors import InputError
from bumpstop.laws.contact import FRICTION_KEYS, SLIDING_RULES
from bumpstop.laws.coordinate import Coordinate, Terms, unit
from bumpstop.projection import TRANSLATIONS

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis

__all__ = [
    "Friction",
    "checked_sliding",
    "component_row",
    "sliding_coordinate",
    "sliding_row",
]

ONE_DIRECTION = 1e-9
"""Motions across the only direction that is not theirs, relative to those along it."""


@dataclass(frozen=True)
class Friction:
    """Coefficients of friction, and what tells that a contact slides on.

    Parameters
    ----------
    static
        Ratio of tangential to normal force above which the contact breaks loose.
    dynamic
        Ratio while it slides, at most the static one; the same where left out.
    rule
        ``"slider"``: it slides on while its slider moves on, as the law of friction has it.
        ``"velocity_sign"``: while a step finds the velocity with the sign of the step before, and
        sticks then to where the last sliding force would be that of its spring. This is defined
        from step to step alone, for results published so: see `Stop`.

    Raises
    ------
    InputError
        If a coefficient is negative, the dynamic one exceeds the static one, or the rule is
        unknown.

    References
    ----------
    code_aster, validation test SDND100A, whose values the second rule repeats.

    Examples
    --------
    >>> Friction(0.3).while_sliding
    0.3
    """

    static: float
    dynamic: float | None = None
    rule: str = "slider"

    def __post_init__(self) -> None:
        one_of("friction.rule", self.rule, SLIDING_RULES)
        static = not_negative("friction.static", self.static)
        dynamic = self.dynamic
        if dynamic is not None:
            dynamic = not_negative("friction.dynamic", dynamic)
        if dynamic is not None and dynamic > static:
            hint = f"the static one is {static:g}"
            what = "must not exceed the static coefficient"
            raise InputError(what, key="friction.dynamic", value=dynamic, hint=hint)
        object.__setattr__(self, "static", static)
        object.__setattr__(self, "dynamic", dynamic)

    @property
    def while_sliding(self) -> float:
        """The coefficient while it slides."""
        return self.static if self.dynamic is None else self.dynamic

    @property
    def goes_by_steps(self) -> bool:
        """Whether its rule is defined from step to step alone."""
        return self.rule != "slider"

    @classmethod
    def of(cls, value: object) -> Self:
        """Return the friction that a number, a mapping or a friction says."""
        if isinstance(value, cls):
            return value
        if not isinstance(value, Mapping):
            return cls(not_negative("friction", value))
        for key in value:
            if key not in FRICTION_KEYS:
                raise InputError(
                    "is nothing of friction",
                    key=f"friction.{key}",
                    hint=did_you_mean(key, FRICTION_KEYS),
                )
        if "static" not in value:
            raise InputError("must have a static coefficient", key="friction", value=dict(value))
        return cls(**value)


def checked_sliding(contact: Coordinate, sliding: object) -> Vector | Terms | None:
    """Return a direction of sliding as a unit vector, or as checked weights of dofs.

    Raises
    ------
    InputError
        If it is no direction, or the normal of the contact.
    """
    if sliding is None:
        return None
    if isinstance(sliding, Mapping):
        return Coordinate.of(None, "sliding", None, terms=sliding).terms
    direction = unit("sliding", sliding)
    tangent(contact.direction, direction)
    return direction


def sliding_row(
    basis: ModalBasis, contact: Coordinate, sliding: Vector | Terms | None
) -> FloatArray:
    """Return the motion along the obstacle per unit of each modal displacement, (N,).

    Parameters
    ----------
    basis
        The modes.
    contact
        The coordinate of the distance.
    sliding
        A direction, of which the part along the obstacle counts; a sum of dofs; or None where
        the modes move the node along the obstacle in one direction only, which is taken.

    Raises
    ------
    InputError
        If nothing moves along the obstacle, or in more than one direction and none is given.
    """
    row = sliding_coordinate(basis, contact, sliding).row(basis)
    if not row.any():
        raise _no_sliding()
    return row


def _no_sliding() -> InputError:
    what = "no mode moves this node along the obstacle"
    return InputError(what, key="friction", hint="leave the friction out")


def sliding_coordinate(
    basis: ModalBasis, contact: Coordinate, sliding: Vector | Terms | None
) -> Coordinate:
    """Return the coordinate of the motion along the obstacle; see `sliding_row`."""
    if isinstance(sliding, Mapping):
        return Coordinate.of(None, "sliding", None, terms=sliding)
    if sliding is None:
        return Coordinate(contact.node, _only_direction(basis, contact), contact.other)
    return Coordinate(contact.node, tangent(contact.direction, sliding), contact.other)


def tangent(normal: Vector, sliding: object) -> Vector:
    """Return the unit vector of a direction's part across the normal."""
    direction = np.array(unit("sliding", sliding))
    across = direction - np.dot(direction, normal) * np.asarray(normal)
    if np.linalg.norm(across) < ONE_DIRECTION:
        raise InputError("must not be the normal", key="sliding", value=sliding)
    return unit("sliding", across)


def _only_direction(basis: ModalBasis, contact: Coordinate) -> Vector:
    """Return the one direction along the obstacle in which there is any motion."""
    if contact.terms is not None:
        hint = "give it, as the distance is, by the weights of dofs"
        raise InputError("must be told where there are terms", key="sliding", hint=hint)
    shapes = np.array([component_row(basis, contact, dof) for dof in TRANSLATIONS])
    normal = np.asarray(contact.direction)
    whole = np.linalg.norm(shapes)
    shapes -= np.outer(normal, normal @ shapes)
    directions, sizes, _ = np.linalg.svd(shapes, full_matrices=False)
    if sizes[0] <= ONE_DIRECTION * whole:
        raise _no_sliding()
    if (sizes[1:] > ONE_DIRECTION * sizes[0]).any():
        hint = "friction acts along one direction: say which, such as sliding = [1, 0, 0]"
        what = "the node can move along the obstacle in more than one direction"
        raise InputError(what, key="sliding", hint=hint)
    main = directions[:, 0]
    main *= np.sign(main[np.argmax(np.abs(main))]) * (np.abs(main) > ONE_DIRECTION)
    x, y, z = main.tolist()
    return (x, y, z)


def component_row(basis: ModalBasis, contact: Coordinate, dof: str) -> FloatArray:
    """Return the motion along one axis; zero where the basis tells none."""
    row = np.zeros(len(basis.omega2))
    for node, sign in ((contact.node, 1.0), (contact.other, -1.0)):
        if node is not None:
            try:
                row += sign * basis.row(node, dof)
            except InputError:
                continue
    return row
