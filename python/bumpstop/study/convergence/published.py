r"""Where published values lie: at the computed ones, or at those that these converge to.

Published values :math:`r` are compared with :math:`c + \alpha (v - c)`, which leads from the
computed values :math:`c` at :math:`\alpha = 0` to the converged ones :math:`v` at
:math:`\alpha = 1`. The :math:`\alpha` of least squares, each value weighed by what it may be off,
has the standard error of a regression through the origin. It takes the deviations that are left
for independent of each other, as those of rounded figures are.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["Position", "position_of"]

CONFIDENCE = 0.95
FIRM = 0.5
"""Half an interval up to which values are said to be those at one end of the way."""
FEWEST = 3
"""Values below which nothing is said."""
NEGLIGIBLE = 1e-9
"""Errors, relative to the values, along which nothing can be told apart."""


class Position(NamedTuple):
    """A share of the way from computed (0) to converged values (1)."""

    share: float
    """Where the published values are."""
    error: float
    """Half the interval that holds the true share with a confidence of 95 %."""

    @property
    def is_firm(self) -> bool:
        """Whether the interval is short beside the way.

        Examples
        --------
        >>> Position(0.1, 0.3).is_firm, Position(-0.8, 1.5).is_firm
        (True, False)
        """
        return self.error <= FIRM

    @property
    def verdict(self) -> str:
        """Which values the published ones are: ``computed``, ``converged``, ``either``, ``other``.

        Examples
        --------
        >>> Position(0.1, 0.3).verdict, Position(0.9, 0.3).verdict
        ('computed', 'converged')
        >>> Position(0.6, 0.7).verdict, Position(5.0, 0.3).verdict
        ('either', 'other')
        """
        at_computed = abs(self.share) <= self.error
        at_converged = abs(1.0 - self.share) <= self.error
        if at_computed:
            return "either" if at_converged else "computed"
        return "converged" if at_converged else "other"


def position_of(
    published: FloatArray,
    computed: FloatArray,
    converged: FloatArray,
    allowed: FloatArray,
    uncertainty: FloatArray | float = 0.0,
) -> Position | None:
    """Return where published values lie, or None where nothing can be said.

    Parameters
    ----------
    published, computed, converged
        Values of the same quantities, (n,); those that are not all known do not count.
    allowed
        How far each value may be off, (n,).
    uncertainty
        How far the converged values may be off, (n,).
    """
    from scipy.special import stdtrit

    scale = np.where(allowed > 0.0, allowed, np.abs(published))
    usable = np.isfinite(computed + converged) & (scale > 0.0)
    way = (converged - computed)[usable] / scale[usable]
    gone = (published - computed)[usable] / scale[usable]
    size = np.abs(computed[usable] / scale[usable])
    if len(way) < FEWEST or np.abs(way).max() <= NEGLIGIBLE * size.max():
        return None
    share = float(way @ gone / (way @ way))
    left = gone - share * way
    freedom = len(way) - 1
    error = stdtrit(freedom, (1.0 + CONFIDENCE) / 2.0) * np.sqrt(left @ left / freedom)
    doubt = np.linalg.norm((uncertainty * np.ones(len(scale)))[usable] / scale[usable])
    return Position(share, float(np.hypot(error, doubt) / np.sqrt(way @ way)))
