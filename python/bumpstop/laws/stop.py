"""Stop: unilateral contact of a node with an obstacle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

from bumpstop.arguments import FloatArray, Vector, not_negative, one_of, positive
from bumpstop.errors import InputError
from bumpstop.laws.contact import Contact
from bumpstop.laws.coordinate import Terms

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.laws.friction import Friction
    from bumpstop.loads.time import TimeFunction
    from bumpstop.modal.basis import ModalBasis

__all__ = ["Stop"]


@dataclass(frozen=True)
class Stop(Contact):
    """A spring and damper that push a node back once it has crossed the gap.

    With the distance ``d = gap + normal . (u - u_other)`` of the displacements u of the node
    and of the other one, which is zero for a fixed obstacle, the stop pushes along its normal
    with ``F = max(0, -stiffness d - damping d')`` while d < 0, and not at all while d > 0. It
    never pulls: with damping the force vanishes before the gap opens.

    An obstacle may move: by ``motion`` along its normal, towards the structure, so that ``d = gap
    + normal . u - motion(t)``.

    With friction a spring and a slider act along the obstacle, on the motion x: while the slider
    sticks at its anchor, which is where contact began, with the force ``-tangential_stiffness
    (x - anchor) - tangential_damping x'``. It breaks loose when that exceeds ``static F``, and
    then resists with ``dynamic F`` until it stops.

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
        Instead of node, normal and other: the weight of each (node, dof) in the distance, such
        as ``{("pinion", "drz"): 0.05, ("wheel", "drz"): 0.08}`` for the backlash of gears.
    gap
        Distance in m to the obstacle where the structure is undeformed; a negative gap is a
        stop that presses already.
    stiffness
        Contact stiffness in N/m, positive.
    damping
        Contact damping in N s/m.
    obstacle
        Shape of the obstacle: ``"plane"``.
    motion
        How far the obstacle moves along its normal, in m over time: a `Harmonic`, a `Polynomial`,
        a `TimeTable` without jumps, another function of time, or a list of them, which add up.
    frame
        Where the obstacle stands while supports move: ``"relative"`` to them, or ``"absolute"``,
        still on the ground.
    friction
        Coefficient of friction, or ``{"static": ..., "dynamic": ...}``. With ``"rule":
        "velocity_sign"`` it repeats published results of `symplectic_euler`, which alone takes it:
        what slid slides on, with ``dynamic F`` against the velocity, while the velocity at a step
        has the sign of the step before and is more than 1e-6 m/s; else it sticks, its anchor where
        the last sliding force would be that of the spring, unless that exceeds ``static F``.
    sliding
        Direction along the obstacle in which it rubs, or weights of dofs as in ``terms``; may be
        left out where the modes move the node in one direction only along the obstacle.
    tangential_stiffness
        Stiffness in N/m of the stick, for friction.
    tangential_damping
        Damping in N s/m of the stick.

    Raises
    ------
    InputError
        If a number is out of its range, the normal has no length, the obstacle is unknown, or
        what belongs to friction is there without it.

    References
    ----------
    W. Goldsmith, *Impact*, Arnold, 1960 (the spring and damper are Kelvin-Voigt's).

    Examples
    --------
    >>> Stop("guide", node="P", normal=(-2, 0, 0), gap=1e-3, stiffness=1e6).normal
    (-1.0, 0.0, 0.0)
    """

    _: KW_ONLY
    stiffness: float
    damping: float = 0.0
    motion: TimeFunction | Sequence[TimeFunction] = ()
    frame: str = "relative"
    friction: float | Mapping[str, float | str] | Friction | None = None
    sliding: Vector | Terms | None = None
    tangential_stiffness: float | None = None
    tangential_damping: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "stiffness", positive("stiffness", self.stiffness))
        object.__setattr__(self, "damping", not_negative("damping", self.damping))
        damping = not_negative("tangential_damping", self.tangential_damping)
        object.__setattr__(self, "tangential_damping", damping)
        one_of("frame", self.frame, ("relative", "absolute"))
        self._check_friction()
        if self.motion != ():
            from bumpstop.loads.time import time_functions

            object.__setattr__(self, "motion", time_functions(self.motion, "motion"))

    @property
    def functions(self) -> tuple[TimeFunction, ...]:
        """The functions of time whose sum moves the obstacle."""
        return self.motion  # type: ignore[return-value]  # a tuple once it has been checked

    @property
    def motions(self) -> tuple[tuple[TimeFunction, ...], ...]:
        """The same for each of its coordinates: along the normal alone."""
        return (self.functions,)

    @property
    def stepped(self) -> bool:
        """Whether its state must be told once a step, in order."""
        # A `Friction` once it has been checked.
        return getattr(self.friction, "goes_by_steps", False)

    @property
    def smooth(self) -> str:
        """Why it is not piecewise linear; nothing where it is."""
        return "the velocity at a step tells whether it slides" if self.stepped else ""

    @property
    def internal_variables(self) -> tuple[str, ...]:
        """What it remembers: where its slider stands, with friction."""
        return () if self.friction is None else ("anchor",)

    def sliding_row(self, basis: ModalBasis) -> FloatArray | None:
        """Return the motion along the obstacle, (N,); None without friction.

        Raises
        ------
        InputError
            If no mode moves the node along the obstacle, or in more than one direction and
            none is given.
        """
        if self.friction is None:
            return None
        from bumpstop.laws.friction import sliding_row

        return sliding_row(basis, self.coordinate, self.sliding)

    def static_force(self, place: float) -> tuple[float, float]:
        """Return the push in N at rest, ``place`` m along the normal, and its slope in N/m."""
        distance = self.gap + place
        return (-self.stiffness * distance, -self.stiffness) if distance < 0.0 else (0.0, 0.0)

    def core(self, basis: ModalBasis) -> _core.Stop | _core.FrictionStop:
        """Return the stop as the core sees it; see `row` and `sliding_row`."""
        from bumpstop import _core

        stop = _core.Stop(self.row(basis), self.gap, self.stiffness, self.damping)
        if self.friction is None or self.tangential_stiffness is None:
            return stop
        from bumpstop.laws.friction import Friction, sliding_row

        friction = Friction.of(self.friction)
        return _core.FrictionStop(
            stop,
            sliding_row(basis, self.coordinate, self.sliding),
            friction.static,
            friction.while_sliding,
            self.tangential_stiffness,
            self.tangential_damping,
            friction.goes_by_steps,
        )

    def _check_friction(self) -> None:
        if self.friction is None:
            self._refuse_without_friction()
            return
        from bumpstop.laws.friction import Friction, checked_sliding

        object.__setattr__(self, "friction", Friction.of(self.friction))
        if self.tangential_stiffness is None:
            hint = "a contact that sticks is a spring; take about the contact stiffness"
            raise InputError("friction needs it", key="tangential_stiffness", hint=hint)
        stiffness = positive("tangential_stiffness", self.tangential_stiffness)
        object.__setattr__(self, "tangential_stiffness", stiffness)
        sliding = checked_sliding(self.coordinate, self.sliding)
        object.__setattr__(self, "sliding", sliding)

    def _refuse_without_friction(self) -> None:
        given = {
            "sliding": self.sliding,
            "tangential_stiffness": self.tangential_stiffness,
            "tangential_damping": self.tangential_damping or None,
        }
        for key, value in given.items():
            if value is not None:
                hint = "give the coefficient, friction = 0.2"
                raise InputError("belongs to friction", key=key, value=value, hint=hint)
