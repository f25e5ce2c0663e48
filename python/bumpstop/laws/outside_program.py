"""OutsideProgram: a force that another program computes, step by step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bumpstop.arguments import Vector
from bumpstop.errors import InputError
from bumpstop.laws.connection import Connection
from bumpstop.laws.user_law import checked_directions, rows_along

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["OutsideProgram"]

MOST_DIRECTIONS = 2


@dataclass(frozen=True)
class OutsideProgram(Connection):
    """A force that comes from outside once a step, such as that of a bearing program.

    ``symplectic_euler`` takes it. At the start of each step, in order, the function is told the
    number of the step, the displacement ``q = direction . (u - u_other)`` and its velocity, and
    answers with the force on the node over that step, in N. So the program behind it may have a
    state of its own, and go by the same step. Steps are marched in stretches: it is asked for up
    to 64 steps beyond the end, too. Of a program that is a generator, give its ``send``; of one
    that reads and writes lines, a `PipedProgram`.

    What is read of the response later, asks the program nothing. What its force takes from the
    motion counts as dissipated in the energy ledger. A problem with such a law cannot be written to
    a file, and is run once: the program behind it has gone on.

    Parameters
    ----------
    name
        What the program is called in results.
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
        One more direction along which it acts, between the same nodes; displacement, velocity and
        force are then arrays, (2,).
    exchange
        ``exchange(step, q, v)``, the steps counted from 0.

    Raises
    ------
    InputError
        If something is no function, or the directions are none.

    Examples
    --------
    A valve that opens half a second after it was passed, whatever happens since:

    >>> import bumpstop as bs
    >>> class Valve:
    ...     passed = None
    ...     def __call__(self, step, q, v):
    ...         if self.passed is None and q > 0.1:
    ...             self.passed = step
    ...         return -2.0 if self.passed is not None and step >= self.passed + 500 else 0.0
    >>> law = OutsideProgram("valve", node="P", direction=(1, 0, 0), exchange=Valve())
    >>> mass = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dx"): [1]})
    >>> start = bs.ModalState(velocity=[1.0])
    >>> problem = bs.Problem(mass, laws=[law], initial=start, duration=1.0)
    >>> response = bs.simulate(problem, "symplectic_euler", dt=1e-3)
    >>> force = response.sample("stop_force", "valve", times=[0.599, 0.603])
    >>> [float(f) for f in force]
    [0.0, -2.0]
    """

    kind: ClassVar[str] = "program"
    smooth: ClassVar[str] = "a program outside computes its force"
    """Why it is not piecewise linear."""
    stepped: ClassVar[bool] = True
    """It is asked once a step, in order."""

    _: KW_ONLY
    exchange: Callable[..., Any]
    further_directions: Sequence[Vector] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        if not callable(self.exchange):
            raise InputError("must be a function", key="exchange", value=self.exchange)
        further = checked_directions(self, self.further_directions, MOST_DIRECTIONS)
        object.__setattr__(self, "further_directions", further)

    def core(self, basis: ModalBasis) -> _core.OutsideProgram:
        """Return the program as the core sees it; see `row`."""
        from bumpstop import _core

        rows = rows_along(self, self.further_directions, basis)
        exchange, single = self.exchange, len(rows) == 1

        def answer(step: int, q: list[float], v: list[float]) -> Any:
            place, speed = (q[0], v[0]) if single else (np.array(q), np.array(v))
            return np.asarray(exchange(step, place, speed), dtype=np.float64).ravel()

        return _core.OutsideProgram(self.name, rows, answer)
