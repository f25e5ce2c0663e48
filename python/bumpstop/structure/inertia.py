"""Which dofs a mass matrix gives inertia to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray

__all__ = ["definite_dofs"]

_DEFINITE = 1e-9
"""A matrix of unit diagonal is taken for definite if its eigenvalues are above this."""


def definite_dofs(mass: FloatArray) -> NDArray[np.bool_]:
    """Return the dofs that have inertia in whatever way they move, as far as is plain, (n,).

    Examples
    --------
    >>> definite_dofs(np.diag([2.0, 0.0]))
    array([ True, False])
    >>> definite_dofs(np.array([[1.0, 1.0], [1.0, 1.0]]))  # no inertia against each other
    array([False, False])
    """
    heavy: NDArray[np.bool_] = mass.diagonal() > 0.0
    own = mass[np.ix_(heavy, heavy)]
    scale = 1.0 / np.sqrt(own.diagonal())
    smallest = np.linalg.eigvalsh(own * np.outer(scale, scale)).min(initial=np.inf)
    return heavy if smallest > _DEFINITE else np.zeros_like(heavy)
