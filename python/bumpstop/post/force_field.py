"""ForceField: forces on all dofs, shapes in space times functions of time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.loads.time import resolved

if TYPE_CHECKING:
    from bumpstop.loads.time import TimeFunction
    from bumpstop.structure.cut import Cut

__all__ = ["ForceField", "Sizes", "spread", "sums"]

Sizes = Callable[[FloatArray], FloatArray]
"""Some functions of time, (time, m), at some times in s."""


class ForceField(NamedTuple):
    """Forces of one kind: fields of all dofs times functions of time."""

    kind: str
    """``load``, ``law``, ``damping`` (gyroscopic and circulatory forces too) or ``elastic``."""
    fields: FloatArray
    """In N and N m where the functions are one, (dofs, m)."""
    sizes: Sizes
    """The functions, (time, m), at some times in s."""
    inside: Callable[[Cut, FloatArray], FloatArray] | None = None
    """What they do at a place inside an element whose ends are held, (r, time), at some times."""


def spread(
    parts: Callable[[Cut], FloatArray], sizes: Sizes
) -> Callable[[Cut, FloatArray], FloatArray]:
    """Return what fields that keep their places do inside an element, of (r, m) where one."""

    def inside(cut: Cut, times: FloatArray) -> FloatArray:
        found = parts(cut)
        if not found.any():
            return np.zeros((len(found), len(times)))
        return found @ sizes(times).T

    return inside


def sums(functions: Sequence[Sequence[TimeFunction]], duration: float) -> Sizes:
    """Return the sums of some functions of time; of none, the constant one."""
    # A function without terms, the whirl of a shaft whose speed changes, is read as it is.
    terms = [(resolved(each, duration) or each) if each else None for each in functions]

    def sizes(times: FloatArray) -> FloatArray:
        ones = np.ones(len(times))
        columns = [
            ones if each is None else sum((term.at(times) for term in each), 0.0 * ones)
            for each in terms
        ]
        return np.stack(columns, axis=1)

    return sizes
