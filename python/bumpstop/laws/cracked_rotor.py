"""CrackedRotor: a crack across a shaft that turns."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar, TypeAlias

import numpy as np

from bumpstop.arguments import FloatArray, Vector, listed, name, one_of, pair
from bumpstop.errors import InputError
from bumpstop.laws.around_axis import plane_axes
from bumpstop.laws.coordinate import Coordinate, unit
from bumpstop.loads.shaft_rotation import ShaftRotation
from bumpstop.projection import ROTATIONS

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["CrackedRotor"]

INTERPOLATIONS = ("spline", "linear")
Points: TypeAlias = Sequence[tuple[float, float]]
_TURN = 2.0 * math.pi
_LEAST = 4
"""Points that a cubic spline around a turn needs to be one."""
_FORMULA_POINTS = 1440
"""Points of a formula that the spline runs through, four in each degree."""


@dataclass(frozen=True)
class CrackedRotor:
    """A hinge between two nodes of a shaft whose stiffness depends on where it is bent to.

    With the rotations D of the node against the other about the two axes y, z across the shaft,
    and the shaft's angle g, the rotations seen from the shaft are ``l2 = cos g Dy + sin g Dz``
    and ``l3 = -sin g Dy + cos g Dz``, of the direction ``phi = atan2(l2, l3)``. The moments
    that resist are ``m2 = K l2 + K' l3 / 2`` and ``m3 = K l3 - K' l2 / 2``, turned back: with the
    derivative K' of the stiffness K(phi), the gradient of the energy ``K |D|^2 / 2``. All other
    motions between the nodes are for the structure to hold. The adaptive methods take it.

    Parameters
    ----------
    name
        What the crack is called in results.
    node
        The node on one side.
    other
        The node on the other side; the ground where left out.
    rotation
        How the shaft turns.
    stiffness
        K in N m/rad: points (phi, K), phi in rad and ascending within one turn, through which a
        periodic cubic spline runs; or a formula in ``phi``.
    derivative
        K' in N m/rad2, as points or a formula; that of the spline of K where left out, with which
        the energy is conserved but for the drive.
    axis
        Direction of the shaft. The axis y across is the part of the global y axis across it, or
        that of the z axis where these are one; z is the axis times it.
    interpolation
        Between points: ``"spline"``, or ``"linear"`` for straight lines, as code_aster has it,
        which need a ``derivative`` of their own.

    Raises
    ------
    InputError
        If the stiffness is not positive, points are out of order or too few, a formula is none or
        does not repeat itself after a turn, or the axis has no length.

    References
    ----------
    S. Andrieux, C. Vare, A 3D cracked beam model with unilateral contact. Application to rotors,
    *European Journal of Mechanics A/Solids* 21 (2002), 793-810.

    Examples
    --------
    A crack that opens once a turn:

    >>> import bumpstop as bs
    >>> crack = CrackedRotor(
    ...     "crack", node="P", rotation=bs.ShaftRotation(5.0),
    ...     stiffness="200 + 50 * sin(phi)", axis=(1, 0, 0),
    ... )
    >>> crack.stiffness_at([0.0, 1.5707963267948966]).round(9).tolist()
    [200.0, 250.0]
    """

    table: ClassVar[str] = "laws"
    kind: ClassVar[str] = "crack"
    smooth: ClassVar[str] = "its stiffness goes with the direction of its bending"
    """Why it is not piecewise linear."""
    flows: ClassVar[bool] = True
    """It keeps the time by a rate equation."""
    flows_in_steps: ClassVar[bool] = True
    """Nothing switches by it: explicit steps follow it, too."""
    internal_variables: ClassVar[tuple[str, ...]] = ("bending_direction",)

    name: str
    _: KW_ONLY
    node: str
    other: str | None = None
    rotation: ShaftRotation
    stiffness: Points | str
    derivative: Points | str | None = None
    axis: Vector = (1.0, 0.0, 0.0)
    interpolation: str = "spline"

    def __post_init__(self) -> None:
        name("name", self.name)
        name("node", self.node)
        if self.other is not None and name("other", self.other) == self.node:
            raise InputError("must be another node", key="other", value=self.other)
        if not isinstance(self.rotation, ShaftRotation):
            raise InputError("must be a ShaftRotation", key="rotation", value=self.rotation)
        object.__setattr__(self, "axis", unit("axis", self.axis))
        for key in ("stiffness", "derivative"):
            value = getattr(self, key)
            if value is not None and not isinstance(value, str):
                object.__setattr__(self, key, _points(key, value))
        one_of("interpolation", self.interpolation, INTERPOLATIONS)
        if self.interpolation == "linear" and self.derivative is None:
            hint = "straight lines have none that is continuous"
            raise InputError("is missing", key="derivative", hint=hint)
        angles, values = _told("stiffness", self.stiffness)
        if values.min() <= 0.0:
            at = int(np.argmin(values))
            hint = f"at phi = {angles[at]:.6g} rad"
            raise InputError("must be positive", key="stiffness", value=values[at], hint=hint)
        _ = self._slope

    @property
    def coordinate(self) -> Coordinate:
        """The rotation about the first axis across the shaft."""
        return self.coordinates[0]

    @cached_property
    def coordinates(self) -> list[Coordinate]:
        """The rotations about both axes across the shaft."""
        return [self._about(direction) for direction in plane_axes(self.axis)[:2].tolist()]

    @property
    def extremes(self) -> tuple[float, float]:
        """The least and the largest stiffness among its points, in N m/rad."""
        values = _told("stiffness", self.stiffness)[1]
        return float(values.min()), float(values.max())

    def stiffness_at(self, angles: Sequence[float] | FloatArray) -> FloatArray:
        """Return K in N m/rad for directions phi in rad."""
        return _at(self._spline, np.asarray(angles, dtype=np.float64))

    def derivative_at(self, angles: Sequence[float] | FloatArray) -> FloatArray:
        """Return K' in N m/rad2 for directions phi in rad, as the law has it."""
        return _at(self._slope, np.asarray(angles, dtype=np.float64))

    def core(self, basis: ModalBasis) -> _core.CrackedRotor:
        """Return the crack as the core sees it.

        Raises
        ------
        InputError
            If the basis does not tell how the nodes turn, or no mode bends the crack.
        """
        from bumpstop import _core

        first, second = (coordinate.row(basis) for coordinate in self.coordinates)
        if not (first.any() or second.any()):
            raise InputError("no mode bends this crack", key="node", value=self.node)
        stiffness, derivative = (
            (breaks.tolist(), cubics.tolist()) for breaks, cubics in (self._spline, self._slope)
        )
        return _core.CrackedRotor((first, second), stiffness, derivative, self.rotation.core)

    @cached_property
    def _spline(self) -> tuple[FloatArray, FloatArray]:
        return self._through(*_told("stiffness", self.stiffness))

    @cached_property
    def _slope(self) -> tuple[FloatArray, FloatArray]:
        if self.derivative is not None:
            return self._through(*_told("derivative", self.derivative))
        breaks, cubics = self._spline
        slopes = np.zeros_like(cubics)
        slopes[:, :3] = cubics[:, 1:] * [1.0, 2.0, 3.0]
        return breaks, slopes

    def _through(self, angles: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the breaks of a function through points, and the cubic from each on."""
        return (
            _lines(angles, values) if self.interpolation == "linear" else _periodic(angles, values)
        )

    def _about(self, direction: Vector) -> Coordinate:
        """Return the rotation of the node against the other about a direction."""
        parts = [(dof, part) for dof, part in zip(ROTATIONS, direction, strict=True) if part != 0.0]
        terms = {(self.node, dof): part for dof, part in parts}
        if self.other is not None:
            terms |= {(self.other, dof): -part for dof, part in parts}
        return Coordinate.of(None, "direction", None, None, terms)


def _points(key: str, value: object) -> tuple[tuple[float, float], ...]:
    """Return points that ascend within one turn; one at the end that repeats the first is left."""
    points = tuple(
        pair(f"{key}[{number}]", point) for number, point in enumerate(listed(key, value))
    )
    if points and math.isclose(points[-1][0] - points[0][0], _TURN):
        if points[-1][1] != points[0][1]:
            what = "must be the same after a full turn"
            raise InputError(what, key=key, value=points[-1][1], hint=f"it was {points[0][1]:g}")
        points = points[:-1]
    if len(points) < _LEAST:
        what = f"must have at least {_LEAST} points around the turn"
        raise InputError(what, key=key, value=len(points))
    for number, (before, after) in enumerate(pairwise(points)):
        if after[0] <= before[0]:
            what = "must come at a larger angle than the one before it"
            raise InputError(what, key=f"{key}[{number + 1}]", value=after[0])
    if points[-1][0] - points[0][0] > _TURN:
        raise InputError("must lie within one turn", key=key, value=points[-1][0])
    return points


def _told(key: str, value: Points | str) -> tuple[FloatArray, FloatArray]:
    """Return the angles and values that a table or a formula tells."""
    if not isinstance(value, str):
        angles, values = np.array(value).T
        return angles, values
    from bumpstop.loads.expression import formula_in

    angles = np.linspace(0.0, _TURN, _FORMULA_POINTS + 1)
    with np.errstate(all="ignore"):
        values = np.broadcast_to(formula_in("phi", value, key)(angles), angles.shape)
    if not np.isfinite(values).all():
        at = angles[np.argmin(np.isfinite(values))]
        raise InputError("has no finite value", key=key, value=f"phi = {at:.6g} rad")
    if not math.isclose(values[0], values[-1], rel_tol=1e-9, abs_tol=1e-9 * np.abs(values).max()):
        what, hint = "must be the same after a full turn", "such as sin(phi)"
        raise InputError(what, key=key, value=value, hint=hint)
    return angles[:-1], np.asarray(values[:-1])


def _periodic(angles: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the breaks of a periodic cubic spline and the coefficients of powers from each on.

    The slopes at the breaks solve the cyclic equations of equal second derivatives on both sides
    (C. de Boor, A Practical Guide to Splines, Springer, 2001, chapter 4).
    """
    width = np.diff(np.append(angles, angles[0] + _TURN))
    rise = (np.roll(values, -1) - values) / width
    before = np.roll(width, 1)
    count = len(angles)
    matrix = np.zeros((count, count))
    row = np.arange(count)
    matrix[row, row] = 2.0 * (width + before)
    matrix[row, row - 1] += width
    matrix[row, (row + 1) % count] += before
    slope = np.linalg.solve(matrix, 3.0 * (before * rise + width * np.roll(rise, 1)))
    ahead = np.roll(slope, -1)
    second = (3.0 * rise - 2.0 * slope - ahead) / width
    third = (slope + ahead - 2.0 * rise) / width**2
    return angles, np.stack([values, slope, second, third], axis=1)


def _lines(angles: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the same for straight lines around a turn."""
    width = np.diff(np.append(angles, angles[0] + _TURN))
    nothing = np.zeros(len(angles))
    rise = (np.roll(values, -1) - values) / width
    return angles, np.stack([values, rise, nothing, nothing], axis=1)


def _at(spline: tuple[FloatArray, FloatArray], angles: FloatArray) -> FloatArray:
    """Return the values of a periodic spline."""
    breaks, cubics = spline
    within = breaks[0] + np.mod(angles - breaks[0], _TURN)
    place = np.searchsorted(breaks, within, side="right") - 1
    since = within - breaks[place]
    values: FloatArray = sum(cubics[place, power] * since**power for power in range(4))
    return values
