"""Which number of a problem is out of scale, where the exact method could not finish.

Exponents of one motion that are many orders of magnitude apart cannot be told from each other
in double precision. How many depends on the problem, so nothing is refused beforehand: these
limits only say what to blame once a run has failed. They stand below the ratios from which runs
of the validation case SDNL32 fail: 1.2e12 for a stop's stiffness, 3.6e4 for its damper, 1e4 for
the damping of modes, and 7e9 rad in a run.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop.errors import InputError

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.loads.time import TimeFunction
    from bumpstop.problem import Law, Problem

__all__ = ["out_of_scale", "stiffest", "too_heavy", "too_stiff"]

STIFFEST = 1e10
"""Stiffness of a law beside that of the stiffest mode where it acts."""
MOST_DAMPED = 1e3
"""Ratio of critical damping of a mode, or of a law's damper beside the fastest motion."""
FASTEST = 1e9
"""Angle in rad through which a mode turns in a run."""
CRITICAL = "is {:.2g} times critical"


MOST_TURNS = 1e13
"""Angle in rad through which the motion against a law may turn in a run: its instants are known to
1e-16 of the run. The core refuses what is beyond."""


MOST_FORCE = 1e100
"""Of a load on a mode, beyond which nothing can be meant."""


class _Finding(NamedTuple):
    key: str
    value: object
    ratio: float
    limit: float
    what: str
    hint: str


def out_of_scale(problem: Problem) -> InputError | None:
    """Return what to tell of the number that is furthest out of scale, or None.

    Examples
    --------
    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    >>> wall = bs.Stop("wall", node="P", normal=(1, 0, 0), stiffness=1e30)
    >>> print(out_of_scale(bs.Problem(basis, laws=[wall], duration=1.0)))
    stops.wall.stiffness: is 2.5e+28 times that of the stiffest mode there, more than double \
precision can hold apart (got 1e+30); check the units of the law and of the structure
    """
    with np.errstate(all="ignore"):
        found = [each for each in _findings(problem) if not each.ratio <= each.limit]
    if not found:
        return None
    worst = max(found, key=lambda each: each.ratio / each.limit)
    what = f"{worst.what.format(worst.ratio)}, more than double precision can hold apart"
    return InputError(what, key=worst.key, value=worst.value, hint=worst.hint)


def too_stiff(problem: Problem) -> InputError | None:
    """Return what to tell of a law whose contacts the instants of the run cannot tell, or None.

    Examples
    --------
    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("P", "dx"): [1.0]})
    >>> wall = bs.Stop("wall", node="P", normal=(1, 0, 0), stiffness=1e30)
    >>> print(too_stiff(bs.Problem(basis, laws=[wall], duration=10.0)))
    stops.wall.stiffness: is more than the instants of a run of 10 s can tell, which is \
1e+24 N/m here (got 1e+30); check its unit, or take a rigid stop
    """
    known = stiffest(problem)
    for law in problem.laws:
        most = known.get(law.name)
        if most is None:
            continue
        stiffness = getattr(law, "stiffness", 0.0)
        if np.max(stiffness) > most:
            what = (
                f"is more than the instants of a run of {problem.duration:g} s can tell, "
                f"which is {most:.2g} N/m here"
            )
            hint = "check its unit, or take a rigid stop"
            return InputError(
                what, key=f"{law.table}.{law.name}.stiffness", value=stiffness, hint=hint
            )
    return None


def too_heavy(problem: Problem) -> InputError | None:
    """Return what to tell of a load whose motions leave the range of numbers, or None.

    Examples
    --------
    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    >>> push = bs.NodalForce("push", node="P", force=(1e160, 0, 0))
    >>> print(too_heavy(bs.Problem(basis, loads=[push], duration=1.0)))
    loads.push: pushes too hard to compute with; check the units
    """
    for load in problem.loads:
        with np.errstate(all="ignore"):
            for force, functions in load.components(problem.basis):
                size = _largest(functions, problem.duration) if functions else 1.0
                if not float(np.abs(force).max()) * size < MOST_FORCE:
                    what = "pushes too hard to compute with"
                    return InputError(what, key=f"loads.{load.name}", hint="check the units")
    return None


def _largest(functions: Sequence[TimeFunction], duration: float) -> float:
    """Return a bound of the sum of some functions of time over a run."""
    from bumpstop.loads.time import Harmonic, Polynomial, TimeTable, resolved

    total = 0.0
    for term in resolved(functions, duration):
        match term:
            case Harmonic():
                total += abs(term.cosine) + abs(term.sine)
            case Polynomial():
                powers = duration ** np.arange(len(term.coefficients))
                total += float(np.abs(term.coefficients) @ powers)
            case TimeTable():
                total += float(np.abs(term.values).max())
    return total


def stiffest(problem: Problem) -> dict[str, float]:
    """Return the stiffness in N/m up to which the instants of the run tell contacts, of each stop.

    Those of laws along one coordinate; others have no entry.

    Examples
    --------
    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("P", "dx"): [1.0]})
    >>> wall = bs.Stop("wall", node="P", normal=(1, 0, 0), stiffness=1e6)
    >>> stiffest(bs.Problem(basis, laws=[wall], duration=10.0))
    {'wall': 1e+24}
    """
    most = {}
    for law in problem.laws:
        if getattr(law, "stiffness", None) is not None:
            row = law.coordinate.row(problem.basis)
            with np.errstate(all="ignore"):
                most[law.name] = (MOST_TURNS / problem.duration) ** 2 / float(row @ row)
    return most


def _findings(problem: Problem) -> Iterator[_Finding]:
    basis = problem.basis
    stiffest = float(np.abs(basis.omega2).max())
    for law in problem.laws:
        yield from _of_law(law, law.coordinate.row(basis), stiffest)
    ratio = float(np.abs(basis.damping_ratio).max())
    hint = "it is a ratio of critical damping, not a percentage"
    yield _Finding("basis.damping", ratio, ratio, MOST_DAMPED, CRITICAL, hint)
    fastest = float(np.sqrt(stiffest))
    what = "has a mode that turns through {:.2g} rad in the run"
    hint = "check the units of the structure and the duration"
    told = f"{fastest / (2.0 * np.pi):.3g} Hz"
    yield _Finding("basis", told, fastest * problem.duration, FASTEST, what, hint)


def _of_law(law: Law, row: FloatArray, stiffest: float) -> Iterator[_Finding]:
    """Compare the spring and the damper of a law, where it has them, with the modes there."""
    yields = float(row @ row)
    where = f"{law.table}.{law.name}"
    hint = "check the units of the law and of the structure"
    stiffness, damping = (getattr(law, key, None) for key in ("stiffness", "damping"))
    own = float(np.max(stiffness)) * yields if stiffness is not None else 0.0
    if stiffest:
        what = "is {:.2g} times that of the stiffest mode there"
        yield _Finding(f"{where}.stiffness", stiffness, own / stiffest, STIFFEST, what, hint)
    if damping is not None and (own or stiffest):
        ratio = float(np.max(damping)) * yields / float(np.sqrt(max(own, stiffest)))
        yield _Finding(f"{where}.damping", damping, ratio, MOST_DAMPED, CRITICAL, hint)
