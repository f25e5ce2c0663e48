"""UserLaw: a law that its user writes in Python."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite, listed
from bumpstop.errors import InputError
from bumpstop.laws.connection import Connection
from bumpstop.laws.coordinate import Coordinate

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["UserLaw", "checked_directions", "rows_along"]

MOST_DIRECTIONS = 3
STEP = 1e-6
"""Of the displacement, or of a metre at none: half the step of a difference."""


@dataclass(frozen=True)
class UserLaw(Connection):
    """A force along a direction, or along two or three, that a Python function computes.

    With the displacement ``q = direction . (u - u_other)``, its velocity v and the time t in s
    from the start of the run, the force on the node is ``force(q, v, t)`` along the direction, in
    N, and the opposite on the other node. With further directions q and v are arrays, (n,), and so
    is the force. The adaptive methods take it. They ask for the force several times a step, at
    instants that they may try again, so that it must follow from what it is given alone.

    A law with a variable z of its own, such as wear or the pressure in a film, gives its rate
    by ``memory_rate(q, v, t, z)``; all functions are then called with z, too.

    What its force takes from the motion counts as dissipated in the energy ledger; what it gives,
    as dissipated below zero. A problem with such a law cannot be written to a file.

    Parameters
    ----------
    name
        What the law is called in results.
    node
        The node that it acts on: a node's name or a point along a beam (``"AB@0.462"``).
    direction
        Direction along which it acts, in global axes; any length but zero, kept as a unit
        vector.
    other
        The node that it acts against; the ground where left out.
    terms
        Instead of node, direction and other: the weight of each (node, dof) in the displacement.
    further_directions
        One or two more directions along which it acts, between the same nodes.
    force
        ``force(q, v, t)``, or ``force(q, v, t, z)`` with a variable of its own.
    jacobian
        Called as the force is; returns its derivatives by q and by v, two numbers or two
        matrices (n, n). Differences where left out; they decide ties between events only.
    memory_rate
        Rate of the law's own variable, per s.
    memory
        Its value at t = 0.

    Raises
    ------
    InputError
        If something is no function, or the directions are none.

    Examples
    --------
    A spring whose stiffness comes and goes, Mathieu's equation:

    >>> import bumpstop as bs
    >>> from math import cos
    >>> law = UserLaw(
    ...     "spring", node="P", direction=(1, 0, 0),
    ...     force=lambda q, v, t: -(4.0 + 1.6 * cos(4.0 * t)) * q,
    ... )
    >>> mass = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dx"): [1]})
    >>> start = bs.ModalState(displacement=[1e-3])
    >>> response = bs.simulate(bs.Problem(mass, laws=[law], initial=start, duration=20.0))
    >>> response.method, bool(abs(response.sample("displacement", "P", "dx")).max() > 0.02)
    ('dop853', True)
    """

    kind: ClassVar[str] = "law"
    smooth: ClassVar[str] = "its force is a function in Python"
    """Why it is not piecewise linear."""
    flows: ClassVar[bool] = True
    """Its time and its variable are integrated beside the motion."""

    _: KW_ONLY
    force: Callable[..., Any]
    jacobian: Callable[..., Any] | None = None
    memory_rate: Callable[..., Any] | None = None
    memory: float = 0.0
    further_directions: Sequence[Vector] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        for key in ("force", "jacobian", "memory_rate"):
            value = getattr(self, key)
            if not callable(value) and (key == "force" or value is not None):
                raise InputError("must be a function", key=key, value=value)
        object.__setattr__(self, "memory", finite("memory", self.memory))
        further = checked_directions(self, self.further_directions, MOST_DIRECTIONS)
        object.__setattr__(self, "further_directions", further)

    @property
    def internal_variables(self) -> tuple[str, ...]:
        """What it remembers: a memory, where that has a rate."""
        return () if self.memory_rate is None else ("memory",)

    @property
    def static_stiffness(self) -> float:
        """Its stiffness in N/m about no displacement, a scale of what it resists with."""
        return abs(self.static_force(0.0)[1])

    def static_force(self, place: float) -> tuple[float, float]:
        """Return the force in N on the structure, ``place`` m along, at rest, and its slope.

        Raises
        ------
        InputError
            If it acts along several directions, or has a variable of its own.
        """
        if self.further_directions or self.memory_rate is not None:
            what = "has no force at rest that could be balanced"
            hint = "laws of one direction without a variable of their own have"
            raise InputError(what, key="laws", value=self.name, hint=hint)
        step = STEP * (abs(place) or 1.0)
        places = (place - step, place, place + step)
        before, here, after = (float(np.ravel(self.force(x, 0.0, 0.0))[0]) for x in places)
        return here, (after - before) / (2.0 * step)

    def core(self, basis: ModalBasis) -> _core.UserLaw:
        """Return the law as the core sees it; see `row`."""
        from bumpstop import _core

        rows = rows_along(self, self.further_directions, basis)
        single, remembers = len(rows) == 1, self.memory_rate is not None
        slopes = None if self.jacobian is None else _answer(self.jacobian, single, remembers)
        rate = None
        if self.memory_rate is not None:
            rate = _answer(self.memory_rate, single, remembers)
        force = _answer(self.force, single, remembers)
        return _core.UserLaw(self.name, rows, force, slopes, rate, self.memory)


def checked_directions(law: Connection, further: Sequence[Vector], most: int) -> tuple[Vector, ...]:
    """Return the further directions of a law as unit vectors.

    Raises
    ------
    InputError
        If one is no direction, there are more than ``most`` with the first, or the law goes by
        terms.
    """
    given = listed("further_directions", further)
    if given and law.terms is not None:
        what, hint = "do not go with terms", "give a node and its direction"
        raise InputError(what, key="further_directions", value=further, hint=hint)
    if len(given) + 1 > most:
        what = f"must not be more than {most - 1}"
        raise InputError(what, key="further_directions", value=further)
    coordinates = _further(law, given)
    return tuple(coordinate.direction for coordinate in coordinates)


def rows_along(law: Connection, further: Sequence[Vector], basis: ModalBasis) -> list[FloatArray]:
    """Return the displacements along all directions of a law, each (N,)."""
    return [law.row(basis), *(each.row(basis) for each in _further(law, further))]


def _further(law: Connection, directions: Sequence[Vector]) -> list[Coordinate]:
    of = Coordinate.of
    return [of(law.node, "further_directions", each, law.other) for each in directions]


def _answer(function: Callable[..., Any], single: bool, remembers: bool) -> Callable[..., Any]:
    """Return a function of lists, as the core asks; it returns a flat array."""

    def answer(q: list[float], v: list[float], t: float, z: float) -> Any:
        place, speed = (q[0], v[0]) if single else (np.array(q), np.array(v))
        told = function(place, speed, t, z) if remembers else function(place, speed, t)
        return np.asarray(told, dtype=np.float64).ravel()

    return answer
