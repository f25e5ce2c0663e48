"""BucklingStop: a stop that buckles under a critical force and is crushed beyond it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, ClassVar

from bumpstop.arguments import finite, not_negative, pair, positive
from bumpstop.errors import InputError
from bumpstop.laws.contact import Contact

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["BucklingStop"]


@dataclass(frozen=True)
class BucklingStop(Contact):
    """A stop that is elastic up to a critical force, and is crushed at a lower one then.

    With the distance ``d = gap + normal . (u - u_other)`` and the crushing s = -d the force is
    ``stiffness s + damping s'`` until ``stiffness s`` reaches the critical force. Beyond, it stays
    at that over the plateau, falls to the post-buckling force over the fall, and stays there.
    Where the crushing turns back the stop unloads, to a residual crushing that is the largest one
    less ``post_force / unloading_stiffness``, but not negative, and loads again along the same
    line. ``post_damping`` acts from buckling on. The force never pulls.

    The exact method takes it, unless it falls over a length or has a table of unloading
    stiffnesses; the adaptive ones then do.

    Parameters
    ----------
    name
        What the stop is called in results.
    node
        The node that it stops: a node's name or a point along a beam (``"AB@0.462"``).
    normal
        Direction along which the obstacle pushes the structure, in global axes; any length
        but zero, kept as a unit vector.
    other
        A node that carries the obstacle: the stop acts between the two.
    terms
        Instead of node, normal and other: the weight of each (node, dof) in the distance.
    gap
        Distance in m to the obstacle where the structure is undeformed.
    stiffness
        Contact stiffness in N/m before buckling.
    damping
        Contact damping in N s/m before buckling.
    critical_force
        Force in N at which it buckles.
    post_force
        Force in N at which it is crushed, not above the critical one.
    plateau
        Crushing in m at the critical force.
    fall
        Crushing in m over which the force falls.
    post_damping
        Contact damping in N s/m after buckling.
    unloading_stiffness
        In N/m, from the post-buckling force; a number, or a table of points [residual crushing
        in m, stiffness]. Where left out, ``post_force / (critical_force / stiffness + fall)``: to
        the point at which contact began.
    obstacle
        Shape of the obstacle: ``"plane"``.

    Raises
    ------
    InputError
        If a number is out of its range, or the residual crushing would be negative.

    References
    ----------
    The buckling contact of code_aster's manual R5.06.03.

    Examples
    --------
    A mass of 1 kg at 2 m/s: the stop buckles at pi/6 s and is crushed to 4 m.

    >>> import bumpstop as bs
    >>> stop = BucklingStop("stop", node="P", normal=(-1, 0, 0), stiffness=1.0,
    ...                     critical_force=1.0, post_force=0.5)
    >>> mass = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dx"): [1]})
    >>> start = bs.ModalState(velocity=[2.0])
    >>> response = bs.simulate(bs.Problem(mass, laws=[stop], initial=start, duration=5.0))
    >>> print(*(f"{time:.6f}" for time in response.event_table()["time"]))
    0.523599 3.987700
    """

    internal_variables: ClassVar[tuple[str, ...]] = ("largest_crushing", "residual_crushing")

    _: KW_ONLY
    stiffness: float
    damping: float = 0.0
    critical_force: float
    post_force: float
    plateau: float = 0.0
    fall: float = 0.0
    post_damping: float = 0.0
    unloading_stiffness: float | Sequence[Sequence[float]] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        for key in ("stiffness", "critical_force", "post_force"):
            object.__setattr__(self, key, positive(key, getattr(self, key)))
        for key in ("damping", "plateau", "fall", "post_damping"):
            object.__setattr__(self, key, not_negative(key, getattr(self, key)))
        if self.post_force > self.critical_force:
            what, value = "must not exceed the critical force", self.post_force
            raise InputError(what, key="post_force", value=value)
        self._check_unloading()

    @property
    def unloading(self) -> tuple[tuple[float, float], ...]:
        """The unloading stiffness in N/m by residual crushing in m."""
        match self.unloading_stiffness:
            case None:
                give = self.critical_force / self.stiffness + self.fall
                return ((0.0, self.post_force / give),)
            case float() as stiffness:
                return ((0.0, stiffness),)
            case points:
                return tuple((float(x), float(k)) for x, k in points)

    @property
    def smooth(self) -> str:
        """Why it is not piecewise linear; nothing where it is."""
        if self.fall > 0.0:
            return "what it unloads along depends on how far its force has fallen"
        return "its unloading stiffness is a table" if len(self.unloading) > 1 else ""

    def static_force(self, place: float) -> tuple[float, float]:
        """Return the push in N at rest, ``place`` m along the normal, and its slope in N/m.

        Equilibria are those before buckling: a push beyond the critical force does not grow.
        """
        crushing = -(self.gap + place)
        force = self.stiffness * crushing
        if force >= self.critical_force:
            return self.critical_force, 0.0
        return (force, -self.stiffness) if crushing > 0.0 else (0.0, 0.0)

    def core(self, basis: ModalBasis) -> _core.BucklingStop:
        """Return the stop as the core sees it; see `row`."""
        from bumpstop import _core

        elastic = _core.Stop(self.row(basis), self.gap, self.stiffness, self.damping)
        return _core.BucklingStop(
            elastic,
            self.critical_force,
            self.post_force,
            self.plateau,
            self.fall,
            self.post_damping,
            list(self.unloading),
        )

    def _check_unloading(self) -> None:
        key, value = "unloading_stiffness", self.unloading_stiffness
        if isinstance(value, Sequence):
            points = tuple(pair(f"{key}[{i}]", point) for i, point in enumerate(value))
            if not points:
                raise InputError("must have at least one point", key=key, value=value)
            object.__setattr__(self, key, points)
        elif value is not None:
            object.__setattr__(self, key, finite(key, value))
        for place, stiffness in self.unloading:
            not_negative(f"{key}.residual", place)
            positive(key, stiffness)
        steps = list(zip(self.unloading[:-1], self.unloading[1:], strict=True))
        for (here, stiffness), (there, next_stiffness) in steps:
            if there <= here:
                raise InputError("must go up in residual crushing", key=key, value=value)
            if there - here + self.post_force / next_stiffness <= self.post_force / stiffness:
                what = "rises too steeply: crushing on would leave less behind"
                raise InputError(what, key=key, value=value)
        give = self.post_force / self.unloading[0][1]
        spare = self.critical_force / self.stiffness + self.fall - give
        if spare < -1e-12 * give:
            least = self.post_force / (give + spare)
            what, hint = "would leave a negative residual crushing", f"at least {least:g} N/m"
            raise InputError(what, key=key, value=value, hint=hint)
