"""SmoothPieces: a function along a line that is smooth between given places."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from bumpstop.arguments import FloatArray

__all__ = ["SmoothPieces"]

_POINTS = 14
"""In each piece: exact for the cubics of even elements, and for tapered ones to rounding."""


class SmoothPieces:
    """A function followed by one Chebyshev polynomial in each piece.

    It is asked for at the points of each piece once, all of them inside the piece, and is then
    known at any number of places.

    Parameters
    ----------
    function
        Gives an array of any one shape for a place.
    edges
        Where pieces begin and end, ascending, (pieces + 1,).

    References
    ----------
    L. N. Trefethen, Approximation Theory and Approximation Practice, SIAM, 2013, chapters 3 and 4.

    Examples
    --------
    >>> bent = SmoothPieces(lambda x: np.array([abs(x - 1.0)]), [0.0, 1.0, 3.0])
    >>> bent.at(np.array([0.5, 2.5])).round(12).tolist()
    [[0.5], [1.5]]
    """

    def __init__(
        self, function: Callable[[float], FloatArray], edges: Sequence[float] | FloatArray
    ) -> None:
        self._edges = np.asarray(edges, dtype=np.float64)
        points = chebyshev.chebpts1(_POINTS)
        waves = chebyshev.chebvander(points, _POINTS - 1).T * (2.0 / _POINTS)
        waves[0] *= 0.5
        self._coefficients: list[FloatArray] = []
        for left, right in pairwise(self._edges.tolist()):
            places = left + 0.5 * (right - left) * (1.0 + points)
            values = np.stack([function(place) for place in places.tolist()])
            self._coefficients.append(np.tensordot(waves, values, axes=1))

    def at(self, places: FloatArray) -> FloatArray:
        """Return its values at some places, (n, ...); an inner edge belongs to what is before."""
        own = np.searchsorted(self._edges, places, side="left") - 1
        own = np.clip(own, 0, len(self._coefficients) - 1)
        left, right = self._edges[own], self._edges[own + 1]
        waves = chebyshev.chebvander(2.0 * (places - left) / (right - left) - 1.0, _POINTS - 1)
        found = np.zeros((len(places), *self._coefficients[0].shape[1:]))
        for number, coefficients in enumerate(self._coefficients):
            found[own == number] = np.tensordot(waves[own == number], coefficients, axes=1)
        return found
