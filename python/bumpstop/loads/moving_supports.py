"""What motions of supports have in common: they carry the structure along."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from bumpstop.arguments import FloatArray, Vector, vector
from bumpstop.errors import InputError
from bumpstop.loads.time import Polynomial, Term, TimeFunction, resolved, time_functions

if TYPE_CHECKING:
    from bumpstop.loads.travel import Travel
    from bumpstop.structure.model import LinearModel

__all__ = ["MovingSupports", "Rate"]


class MovingSupports(ABC):
    """Supports move by a vector times a function of time, and carry the structure along.

    The whole motion is that by which all is carried, a field times the function of time, and the
    one seen from there, which the modes tell.
    """

    name: str
    acceleration: Vector | None
    displacement: Vector | None
    time: TimeFunction | Sequence[TimeFunction] | None

    @property
    @abstractmethod
    def is_absolute(self) -> bool:
        """Whether results are told as seen from the still ground."""

    @abstractmethod
    def field(self, model: LinearModel) -> FloatArray:
        """Return how all dofs are carried where the function of time is one, (dofs,)."""

    def travel(self, duration: float) -> Travel:
        """Return the function of time that the field is multiplied by, and its derivatives.

        Raises
        ------
        InputError
            If it is a displacement along straight lines, or an acceleration of high degree.
        """
        from bumpstop.loads.travel import Travel

        terms: tuple[Term, ...] = resolved(time_functions(self.time), duration)
        if self.displacement is not None:
            return Travel.displaced(terms)
        return Travel.accelerated(terms or (Polynomial([1.0]),), duration)

    @property
    def size(self) -> Vector:
        """The vector that the supports' displacement or acceleration is a multiple of."""
        size = self.acceleration if self.displacement is None else self.displacement
        assert size is not None  # checked when it was made
        return size

    @property
    def accelerations(self) -> tuple[TimeFunction, ...]:
        """The functions of time whose sum multiplies the acceleration; none for a constant."""
        return time_functions(self.time) if self.displacement is None else (Rate(self, 2),)

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        kind, unit = (
            ("acceleration", "m/s²") if self.displacement is None else ("displacement", "m")
        )
        return f"{kind} ({', '.join(f'{part:g}' for part in self.size)}) {unit}"

    def _check_motion(self) -> None:
        """Check what is said of the motion, once all is known."""
        given = [key for key in ("acceleration", "displacement") if getattr(self, key) is not None]
        if len(given) != 1:
            what = "must be given, or a displacement, and not both"
            raise InputError(what, key="acceleration")
        object.__setattr__(self, given[0], vector(given[0], getattr(self, given[0])))
        time_functions(self.time)
        if self.displacement is not None and self.time is None:
            what, hint = "must say how the displacement changes", "such as Harmonic(5.0, sine=1.0)"
            raise InputError(what, key="time", hint=hint)


@dataclass(frozen=True, eq=False)
class Rate:
    """A derivative of the function of time by which supports move.

    Parameters
    ----------
    motion
        Whose it is.
    derivative
        0 for the displacement, 1 for the velocity, 2 for the acceleration.
    """

    motion: MovingSupports
    derivative: int

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        return f"derivative {self.derivative} of the motion of {self.motion.name}"

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s."""
        return self.motion.travel(float(times.max(initial=0.0))).at(times, self.derivative)

    def terms(self, duration: float) -> tuple[Term, ...]:
        """Return the terms whose sum it is over a run."""
        functions = self.motion.travel(duration).derivatives[self.derivative]
        return tuple(term for function in functions for term in function.terms(duration))
