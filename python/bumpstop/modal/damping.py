"""Modal damping ratios."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray, not_negative, series
from bumpstop.errors import InputError

__all__ = ["damping_ratios"]


def damping_ratios(damping: object, modes: int) -> FloatArray:
    """Return one ratio of critical damping a mode, from one for all or one for each.

    Raises
    ------
    InputError
        If a ratio is negative or not finite, or their number is not that of the modes.

    Examples
    --------
    >>> damping_ratios(0.01, 2), damping_ratios([0.01, 0.02], 2)
    (array([0.01, 0.01]), array([0.01, 0.02]))
    """
    if np.ndim(damping) == 0:  # type: ignore[arg-type]  # object: the check is what is done here
        return np.full(modes, not_negative("damping", damping))
    ratios = series("damping", damping)
    if len(ratios) != modes:
        what = f"must be one number, or one for each of the {modes} modes"
        raise InputError(what, key="damping", value=damping)
    return np.array([not_negative("damping", ratio) for ratio in ratios])
