"""What stops on obstacles of a shape have: distance, normal and friction in two directions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bumpstop.arguments import FloatArray, Vector, name, not_negative, one_of, positive
from bumpstop.errors import InputError
from bumpstop.laws.coordinate import Coordinate
from bumpstop.laws.friction import Friction
from bumpstop.laws.obstacle_motion import along_axes, along_directions
from bumpstop.projection import TRANSLATIONS, direction_row

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.loads.time import TimeFunction
    from bumpstop.modal.basis import ModalBasis

__all__ = ["ShapedStop"]

ACROSS = 1e-9
"""Components of a direction, relative to its length, that are rounding."""


@dataclass(frozen=True)
class ShapedStop(ABC):
    """A spring and damper behind an obstacle of a shape, which may rub in two directions.

    Each kind says in its own words what its obstacle is.
    """

    table: ClassVar[str] = "stops"
    """Where a problem keeps it, in words for messages."""
    smooth: ClassVar[str]
    """Why it is not piecewise linear."""
    obstacle: ClassVar[str]
    """What its obstacle is, in words for reports."""

    name: str
    _: KW_ONLY
    node: str
    other: str | None = None
    stiffness: float
    damping: float = 0.0
    friction: float | Mapping[str, float | str] | Friction | None = None
    tangential_stiffness: float | None = None
    tangential_damping: float | None = None
    motion: Mapping[str, TimeFunction | Sequence[TimeFunction]] | None = None
    frame: str = "relative"

    def __post_init__(self) -> None:
        name("name", self.name)
        object.__setattr__(self, "stiffness", positive("stiffness", self.stiffness))
        object.__setattr__(self, "damping", not_negative("damping", self.damping))
        one_of("frame", self.frame, ("relative", "absolute"))
        if self.motion is not None:
            object.__setattr__(self, "motion", along_axes(self.motion))
        assert self.coordinate  # checks the nodes
        self._check_friction()

    @property
    def flows(self) -> bool:
        """Whether it follows a rate equation: that of the stretch of its friction."""
        return self.friction is not None

    @property
    def internal_variables(self) -> tuple[str, ...]:
        """What it remembers: the stretch of what rubs, with friction."""
        return () if self.friction is None else ("stretch_around", "stretch_axial")

    @cached_property
    @abstractmethod
    def axes(self) -> FloatArray:
        """The two directions that span the plane of contact, and the one across it, (3, 3)."""

    @cached_property
    def coordinate(self) -> Coordinate:
        """The first coordinate of the plane of contact."""
        return Coordinate.of(self.node, "axis", _plain(self.axes[0]), self.other)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The coordinates that it acts along: two in the plane and, with friction, the axis."""
        node, other = self.coordinate.node, self.coordinate.other
        return tuple(Coordinate(node, _plain(each), other) for each in self._directions)

    @property
    def functions(self) -> tuple[TimeFunction, ...]:
        """All functions of time that move the obstacle."""
        return tuple(function for along in self.motions for function in along)

    @cached_property
    def motions(self) -> tuple[tuple[TimeFunction, ...], ...]:
        """For each of its coordinates the functions of time whose sum moves the obstacle."""
        motion: Any = self.motion or {}
        return along_directions(motion, self._directions)

    @property
    def _directions(self) -> FloatArray:
        return self.axes if self.friction is not None else self.axes[:2]

    def rows(self, basis: ModalBasis) -> FloatArray:
        """Return the motion along each of its coordinates by the modes, (coordinates, N).

        Raises
        ------
        InputError
            If the basis knows no motion of a node, or none in the plane of contact.
        """
        rows = np.array([self._row(basis, each.direction) for each in self.coordinates])
        if not rows[:2].any():
            what = "no mode moves this node across the axis"
            raise InputError(what, key="node", value=self.node)
        return rows

    @abstractmethod
    def origin(self, basis: ModalBasis) -> FloatArray:
        """Return where the node at rest stands, seen from the obstacle, (2,), in m."""

    @abstractmethod
    def shape(self) -> _core.Shape:
        """Return the obstacle as the core sees it."""

    @abstractmethod
    def distances(self, places: FloatArray) -> FloatArray:
        """Return the distances of places in the plane of contact, (n, 2), in m."""

    @abstractmethod
    def normals(self, places: FloatArray) -> FloatArray:
        """Return the directions in which the obstacle pushes at places, (n, 2)."""

    def bend(self, place: FloatArray) -> float:  # noqa: ARG002  # circles ask it
        """Return how the normal turns per m that a place (2,) moves along the obstacle."""
        return 0.0

    def static_push(self, place: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the force at rest in N at a place in the plane, (2,), and its slope, (2, 2)."""
        normal = self.normals(place[np.newaxis])[0]
        depth = max(0.0, -float(self.distances(place[np.newaxis])[0]))
        if depth == 0.0:
            return np.zeros(2), np.zeros((2, 2))
        along = np.outer(normal, normal)
        turning = depth * self.bend(place) * (np.eye(2) - along)
        return self.stiffness * depth * normal, self.stiffness * (turning - along)

    def places(self, basis: ModalBasis, displacement: FloatArray) -> FloatArray:
        """Return where modal displacements (n, N) put the node in the plane, (n, 2), in m."""
        seen: FloatArray = self.origin(basis) + displacement @ self.rows(basis)[:2].T
        return seen

    def gap_at(self, basis: ModalBasis, displacement: FloatArray) -> float:
        """Return the distance in m at a modal displacement (N,) and t = 0."""
        start = np.zeros(1)
        moved = [sum(float(each.at(start)[0]) for each in along) for along in self.motions[:2]]
        return float(self.distances(self.places(basis, displacement[np.newaxis]) - moved)[0])

    def sliding_speeds(
        self, basis: ModalBasis, displacement: FloatArray, velocity: FloatArray
    ) -> FloatArray:
        """Return the speeds along the obstacle, (n,), in m/s.

        From displacements and velocities of the node along the global axes, (n, 3), seen from the
        obstacle.
        """
        a, b = self.normals(self.origin(basis) + displacement @ self.axes[:2].T).T
        first, second, across = self.axes @ velocity.T
        sliding: FloatArray = np.hypot(a * second - b * first, across)
        return sliding

    def stick_damping(self, basis: ModalBasis) -> float:
        """Return the damping in N s/m of a contact that sticks: what is given, or critical damping.

        That is of the tangential stiffness k on the mass that the modes have along the obstacle,
        ``2 sqrt(m k)``, ``1/m`` the sum of the squared modal motions in the direction in which
        that is largest.
        """
        if self.tangential_damping is not None:
            return self.tangential_damping
        mobility = float((self.rows(basis) ** 2).sum(axis=1).max())
        return float(2.0 * np.sqrt((self.tangential_stiffness or 0.0) / mobility))

    def core(self, basis: ModalBasis) -> _core.ShapedStop:
        """Return the stop as the core sees it; see `rows` and `origin`."""
        from bumpstop import _core

        y, z = self.origin(basis).tolist()
        friction = None
        if self.friction is not None and self.tangential_stiffness is not None:
            both, damping = Friction.of(self.friction), self.stick_damping(basis)
            friction = (both.static, both.while_sliding, self.tangential_stiffness, damping)
        rows = list(self.rows(basis))
        return _core.ShapedStop(rows, (y, z), self.shape(), self.stiffness, self.damping, friction)

    def _row(self, basis: ModalBasis, direction: Vector) -> FloatArray:
        """Return the motion along a direction; zero where the basis tells none."""
        row = np.zeros(len(basis.omega2))
        for node, sign in ((self.node, 1.0), (self.other, -1.0)):
            if node is None:
                continue
            known = _known_dofs(basis, node)
            parts = zip(direction, TRANSLATIONS, strict=True)
            along = _plain([part if dof in known else 0.0 for part, dof in parts])
            moved = [
                x * basis.row(node, dof) for x, dof in zip(along, TRANSLATIONS, strict=True) if x
            ]
            if np.any(np.sum(moved, axis=0)):
                row += sign * direction_row(basis, node, along)
        return row

    def _check_friction(self) -> None:
        given = {
            "tangential_stiffness": self.tangential_stiffness,
            "tangential_damping": self.tangential_damping,
        }
        if self.friction is None:
            for key, value in given.items():
                if value is not None:
                    hint = "give the coefficient, friction = 0.2"
                    raise InputError("belongs to friction", key=key, value=value, hint=hint)
            return
        friction = Friction.of(self.friction)
        if friction.goes_by_steps:
            what, hint = "is for a Stop, which rubs along one direction", "leave it out"
            raise InputError(what, key="friction.rule", value=friction.rule, hint=hint)
        object.__setattr__(self, "friction", friction)
        if self.tangential_stiffness is None:
            hint = "a contact that sticks is a spring; take about the contact stiffness"
            raise InputError("friction needs it", key="tangential_stiffness", hint=hint)
        for key, value in given.items():
            if value is not None:
                object.__setattr__(self, key, positive(key, value))


def _plain(direction: FloatArray | Sequence[float]) -> Vector:
    """Return a direction whose components are exactly zero where they are rounding."""
    x, y, z = (float(part) if abs(part) > ACROSS else 0.0 for part in direction)
    return (x, y, z)


def _known_dofs(basis: ModalBasis, node: str) -> tuple[str, ...]:
    """Return the translations of a node that the basis tells.

    Raises
    ------
    InputError
        If it tells none.
    """
    known = []
    for dof in TRANSLATIONS:
        try:
            basis.row(node, dof)
        except InputError as error:
            missing = error
        else:
            known.append(dof)
    if not known:
        raise missing
    return tuple(known)
