"""CircleStop: unilateral contact with a round obstacle."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bumpstop.arguments import FloatArray, not_negative, one_of, positive
from bumpstop.errors import InputError
from bumpstop.laws.around_axis import StopAroundAxis

if TYPE_CHECKING:
    from bumpstop import _core

__all__ = ["CircleStop"]

POINTS = 181
"""Points of a circle where it is drawn."""


@dataclass(frozen=True)
class CircleStop(StopAroundAxis):
    """A round obstacle: a tube in its hole, a shaft in its ring, or one tube beside another.

    In the plane across the axis the node is at p, seen from the circle's centre. Inside a circle
    its distance is ``d = radius - body_radius - |p|``, outside ``d = |p| - radius - body_radius``.
    While d < 0 the stop pushes along the radius with ``F = max(0, -stiffness d - damping d')``.

    With friction a spring and a damper side by side, and a slider behind them, act around the
    circle and along the axis. They would carry ``w = tangential_stiffness s +
    tangential_damping v`` with the stretch s and the sliding speed v; the slider holds up to
    ``|w| = static F`` and slides with ``dynamic F`` along w until nothing of its speed is left.
    The stretch turns with the point of contact and begins at zero with every contact.

    Without friction, damping or a contact in two directions at once a stop of this kind is that
    of a plane. The adaptive methods take it.

    Parameters
    ----------
    name
        What the stop is called in results.
    node
        The node that it stops: a node's name or a point along a beam (``"AB@0.462"``).
    axis
        Axis of the hole or the tube, in global axes; any length but zero, kept as a unit vector.
    roll
        Angle in rad by which the first direction of the plane is turned about the axis, from the
        part of the global y axis across it (of the z axis where the axis is along y).
    other
        A node that carries the obstacle: the stop acts between the two.
    centre
        Place of the circle's centre at rest, from the node, in m. Where left out it is the node's
        own place; with ``other`` that of the other node.
    radius
        Radius of the hole, or of the other body, in m.
    body_radius
        Radius in m of the body at the node.
    side
        ``"inside"`` the circle or ``"outside"`` of it.
    stiffness
        Contact stiffness in N/m, positive.
    damping
        Contact damping in N s/m.
    friction
        Coefficient of friction, or ``{"static": ..., "dynamic": ...}``.
    tangential_stiffness
        Stiffness in N/m of a contact that sticks, for friction.
    tangential_damping
        Damping in N s/m of a contact that sticks, positive; where left out critical damping of
        the sticking contact, see `stick_damping`.
    motion
        How the obstacle moves: for some of ``"dx"``, ``"dy"`` and ``"dz"`` the functions of time
        whose sum moves it along that global axis, in m.
    frame
        ``"relative"`` to supports that move, which then carry the obstacle, or ``"absolute"``: it
        stands still on the ground.

    Raises
    ------
    InputError
        If a number is out of its range, the axis has no length, there is no room for the body, or
        what belongs to friction is there without it.

    References
    ----------
    Spring, damper and limit are those of the shocks and friction of code_aster's manual
    R5.06.03.

    Examples
    --------
    A tube of 1 kg in a hole that is 1 mm wider, thrown along its radius.

    >>> import bumpstop as bs
    >>> shapes = {("P", "dy"): [1.0, 0.0], ("P", "dz"): [0.0, 1.0]}
    >>> tube = bs.ModalBasis.from_modes(frequency=[0, 0], damping=[0, 0], shapes=shapes)
    >>> hole = bs.CircleStop("hole", node="P", axis=(1, 0, 0), radius=10.5e-3, body_radius=10e-3,
    ...                      stiffness=1e6)
    >>> thrown = bs.ModalState(velocity=[0.3, 0.4])
    >>> run = bs.simulate(bs.Problem(tube, laws=[hole], initial=thrown, duration=6e-3))
    >>> impact = run.impact_table()
    >>> run.method, f"{impact['start'][0]:.6f} s", f"{impact['peak_force'][0]:.4f} N"
    ('dop853', '0.001000 s', '500.0000 N')
    """

    smooth: ClassVar[str] = "its obstacle is round"
    obstacle: ClassVar[str] = "circle"

    _: KW_ONLY
    radius: float
    body_radius: float = 0.0
    side: str = "inside"

    def __post_init__(self) -> None:
        super().__post_init__()
        one_of("side", self.side, ("inside", "outside"))
        object.__setattr__(self, "radius", positive("radius", self.radius))
        object.__setattr__(self, "body_radius", not_negative("body_radius", self.body_radius))
        if self.reach <= 0.0:
            what = "leaves no room for the body: it must be less than the circle's radius"
            hint = f"the radius is {self.radius:g} m; without clearance take a link"
            raise InputError(what, key="body_radius", value=self.body_radius, hint=hint)

    @property
    def reach(self) -> float:
        """Radius in m of the circle that the node may not cross."""
        sign = 1.0 if self.side == "outside" else -1.0
        return self.radius + sign * self.body_radius

    def shape(self) -> _core.Shape:
        """Return the obstacle as the core sees it."""
        from bumpstop import _core

        return _core.Shape.circle(self.reach, self.side == "inside")

    def outline(self) -> FloatArray:
        """Return points of the circle that the node may reach, closed, (n, 2), in m."""
        turn = np.linspace(0.0, 2.0 * np.pi, POINTS)
        return self.reach * np.stack([np.cos(turn), np.sin(turn)], axis=1)

    def distances(self, places: FloatArray) -> FloatArray:
        """Return the distances of places in the plane of contact, (n, 2), in m."""
        apart = self.reach - np.hypot(*places.T)
        return np.asarray(apart if self.side == "inside" else -apart)

    def bend(self, place: FloatArray) -> float:
        """Return how the normal turns per m that a place (2,) moves along the circle."""
        sign = 1.0 if self.side == "outside" else -1.0
        return sign / max(float(np.hypot(*place)), np.finfo(float).tiny)

    def normals(self, places: FloatArray) -> FloatArray:
        """Return the directions in which the obstacle pushes at places, (n, 2)."""
        length = np.maximum(np.hypot(*places.T), np.finfo(float).tiny)[:, np.newaxis]
        sign = 1.0 if self.side == "outside" else -1.0
        return np.asarray(sign * places / length)
