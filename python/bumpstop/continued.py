"""continued: a run goes on where another one ended."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

import numpy as np

from bumpstop.arguments import FloatArray, positive
from bumpstop.errors import InputError
from bumpstop.loads.initial import ModalState
from bumpstop.loads.load import ForceComponent
from bumpstop.loads.shifted import Shifted
from bumpstop.methods import changing_speed

if TYPE_CHECKING:
    from bumpstop.loads.time import TimeFunction
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Law, Load, Problem
    from bumpstop.response import Response
    from bumpstop.structure.model import LinearModel

__all__ = ["LawStates", "continued", "end_state", "started_from"]

LawStates: TypeAlias = tuple[tuple[int, int, float, float], ...]
"""A state of each law: its number, the part of its obstacle and two internal variables."""

_FREE = ("open", "released")
_FORGETFUL = (
    "CircleStop",
    "DamperLaw",
    "ForceRelation",
    "HertzStop",
    "PlaneStop",
    "PolarStop",
    "RigidStop",
    "SpringLaw",
    "Stop",
)
"""Laws whose state follows from the motion, but for friction."""


@dataclass(frozen=True)
class _InMotion(ModalState):
    """A state of another run."""

    may_press: ClassVar[bool] = True
    """Stops may be closed in it."""

    law_states: LawStates | None = None
    """What the laws remember; None where the motion tells it."""


def continued(response: Response, *, duration: float, at: float | None = None) -> Problem:
    """Return the problem of a response from one of its instants on, its loads going on in time.

    The instant is the new problem's t = 0. What laws remember is handed over. Its motion is that of
    an unbroken run but for the rounding of displacement, velocity and shifted times, which impacts
    make grow like any other small difference; it is not the same to the bit. Beyond the end
    of the response, straight lines through functions that need such are drawn anew, within the same
    tolerance.

    Parameters
    ----------
    response
        A response.
    duration
        For how long to go on, in s.
    at
        The instant in s; the end of the response where left out.

    Raises
    ------
    InputError
        If a program outside is a law, which has gone on; if laws remember more than the motion
        tells, such as where what rubs is anchored or how a `HardeningSpring` has yielded, and the
        run was read back from a file or is one of a full model; if supports move and results are
        told from the ground; or if a shaft turns at a speed that changes.

    Examples
    --------
    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[2.0], shapes={("P", "dx"): [1.0]})
    >>> start = bs.ModalState(velocity=[1.0])
    >>> first = bs.simulate(bs.Problem(basis, initial=start, duration=0.25))
    >>> rest = bs.simulate(bs.continued(first, duration=0.25))
    >>> print(f"{rest.sample('displacement', 'P', 'dx', times=[0.25])[0]:.12f}")
    -0.000000000000
    """
    problem = response.problem
    instant = problem.duration if at is None else float(at)
    if not 0.0 <= instant <= problem.duration:
        what = f"must be within the run, 0 to {problem.duration:g} s"
        raise InputError(what, key="at", value=at)
    _refuse_changing_speed(problem)
    motion = [response.motion(order, [instant])[0] for order in (0, 1)]
    place, speed = (problem.basis.amplitudes(each) for each in motion)
    return replace(
        problem,
        loads=[_later(load, instant, problem.duration) for load in problem.loads],
        laws=[_moved_on(law, instant, problem.duration) for law in problem.laws],
        initial=_InMotion(
            displacement=place, velocity=speed, law_states=_law_states(response, instant)
        ),
        duration=positive("duration", duration),
        sample=None,
    )


def end_state(response: Response) -> FloatArray:
    """Return displacement and velocity of the modes at the end of a run, (2, U).

    Raises
    ------
    InputError
        If another run cannot go on from there, or laws remember more than the motion tells.
    """
    for law in response.problem.laws:
        refuse_memory(law)
        _refuse_rubbing(response, law, response.problem.duration)
    initial = continued(response, duration=response.problem.duration).initial
    assert isinstance(initial, _InMotion)
    return np.array([initial.displacement, initial.velocity])


def started_from(problem: Problem, state: FloatArray) -> Problem:
    """Return a problem, its loads from its own t = 0 on, that starts in an `end_state`."""
    displacement, velocity = state
    return replace(problem, initial=_InMotion(displacement=displacement, velocity=velocity))


def refuse_memory(law: Law) -> None:
    """Raise where a law remembers what the motion does not tell, but for friction."""
    if not _is_forgetful(law):
        what = "remembers more than the motion tells, and a new run would forget it"
        raise InputError(what, key=f"{law.table}.{law.name}", value=type(law).__name__)


def _is_forgetful(law: Law) -> bool:
    from bumpstop import laws as known

    # By exact kind: what is made of these may remember more.
    return type(law) in {getattr(known, name) for name in _FORGETFUL}


def _refuse_changing_speed(problem: Problem) -> None:
    turning = changing_speed(problem)
    if turning is not None:
        what, hint = "cannot go on at a speed that changes", "run it in one"
        raise InputError(what, key="rotation", value=turning, hint=hint)


def _law_states(response: Response, instant: float) -> LawStates | None:
    """Return what the laws remember at an instant; None where the motion tells it."""
    problem = response.problem
    remembering = [law for law in problem.laws if _remembers(law)]
    if not remembering:
        return None
    from bumpstop.laws import OutsideProgram

    for law in remembering:
        if isinstance(law, OutsideProgram):
            what = "is a program outside, which has gone on"
            raise InputError(what, key=f"{law.table}.{law.name}", value=type(law).__name__)
    # Runs read back from files have none.
    states: Any = getattr(response.history, "states", None)
    if states is None or problem.basis.unreduced:
        for law in remembering:
            refuse_memory(law)
            _refuse_rubbing(response, law, instant)
        return None
    return tuple(states(instant))


def _remembers(law: Law) -> bool:
    """Return whether a law remembers what the motion does not tell."""
    return not _is_forgetful(law) or getattr(law, "friction", None) is not None


def _refuse_rubbing(response: Response, law: Law, instant: float) -> None:
    """Raise where what rubs is anchored somewhere."""
    if getattr(law, "friction", None) is None:
        return
    state = str(response.sample("state", law.name, times=[instant])[0])
    if not state.startswith(_FREE):
        what = f"rubs at t = {instant:g} s, and a new run would forget where its spring is anchored"
        hint = "go on from an instant at which it is open"
        raise InputError(what, key=f"{law.table}.{law.name}", value=state, hint=hint)


def _moved_on(law: Law, instant: float, drawn: float) -> Law:
    """Return a law whose obstacle goes on from an instant."""
    if not getattr(law, "functions", ()):
        return law
    stop: Any = law

    def later(functions: Sequence[TimeFunction]) -> list[Shifted]:
        return [Shifted(each, instant, drawn) for each in functions]

    along_axes = isinstance(stop.motion, dict)
    motion: Any = (
        {dof: later(functions) for dof, functions in stop.motion.items()}
        if along_axes
        else later(stop.functions)
    )
    moved: Law = replace(stop, motion=motion)
    return moved


def _later(load: Load, instant: float, drawn: float) -> Load:
    if getattr(load, "is_absolute", False):
        what = "cannot go on: results are told from the ground"
        raise InputError(what, key=f"loads.{load.name}", hint='take the frame "relative"')
    return LaterLoad(load, instant, drawn)


@dataclass(frozen=True, eq=False)
class LaterLoad:
    """A load from an instant on.

    Parameters
    ----------
    load
        The load.
    instant
        What is its t = 0, in s.
    drawn
        How long the run was whose straight lines it goes on with, in s.
    """

    load: Load
    instant: float
    drawn: float

    @property
    def name(self) -> str:
        """What the load is called."""
        return self.load.name

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        own = getattr(self.load, "words", type(self.load).__name__)
        return f"{own}, from {self.instant:g} s on"

    def components(self, basis: ModalBasis) -> Sequence[ForceComponent]:
        """Return the forces on each mode, each with its functions of time."""
        return [
            ForceComponent(
                force, tuple(Shifted(each, self.instant, self.drawn) for each in functions)
            )
            for force, functions in self.load.components(basis)
        ]

    def nodal_forces(self, model: LinearModel) -> FloatArray:
        """Return the forces on each dof, one a column, (dofs, n)."""
        forces: Any = getattr(self.load, "nodal_forces", None)
        if forces is None:
            raise InputError("says nothing of its forces on the nodes", key=f"loads.{self.name}")
        return np.asarray(forces(model))
