"""The proof that no mode is missing among those of a range."""

from __future__ import annotations

import math
from dataclasses import dataclass

__all__ = ["SturmCount"]


@dataclass(frozen=True)
class SturmCount:
    """How many modes lie in a range, told by the inertia of ``K - s M`` at its ends.

    A symmetric matrix has as many negative pivots as negative eigenvalues (Sylvester), so
    that the matrix factored at a point s tells how many ``omega2`` lie below s, whatever an
    iteration has found (B. N. Parlett, The Symmetric Eigenvalue Problem, section 3.3).

    Parameters
    ----------
    count
        Number of modes in the range, all of which were found.
    low, high
        Ends of the range, squared angular frequencies in rad2/s2; infinite where it has none.

    Examples
    --------
    >>> str(SturmCount(count=10, high=1e6))
    '10 modes below 159.155 Hz, none missed: proven by the inertia of K - s M'
    """

    count: int
    low: float = -math.inf
    high: float = math.inf

    def __str__(self) -> str:
        """Say it in a sentence."""
        modes = f"{self.count} mode{'' if self.count == 1 else 's'}"
        if math.isinf(self.low) and math.isinf(self.high):
            return f"all {modes} of the model"
        proof = "none missed: proven by the inertia of K - s M"
        if math.isinf(self.low):
            return f"{modes} below {_frequency(self.high)}, {proof}"
        return f"{modes} from {_frequency(self.low)} to {_frequency(self.high)}, {proof}"


def _frequency(omega2: float) -> str:
    if omega2 < 0.0:
        return f"omega2 = {omega2:.6g} rad2/s2"
    return f"{math.sqrt(omega2) / (2.0 * math.pi):.6g} Hz"
