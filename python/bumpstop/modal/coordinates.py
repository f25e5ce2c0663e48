"""The coordinates in which a user gave a basis, beside those in which it is integrated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["UserCoordinates", "scaled_coordinates"]

COMBINED = 1e-9
"""A vector that has less than this of another one, relative to its own, has nothing of it."""


@dataclass(frozen=True, eq=False)
class UserCoordinates:
    """How the vectors that a user gave and the canonical ones are made of each other.

    A displacement is ``vectors @ a = shapes @ q``, with a the amplitudes of the U vectors
    that the user gave and q those of the N canonical ones.

    Parameters
    ----------
    to_canonical
        q = to_canonical @ a, (N, U).
    from_canonical
        a = from_canonical @ q, (U, N); zero in the rows of vectors that depend on others.
    """

    to_canonical: FloatArray
    from_canonical: FloatArray

    def alone(self) -> list[int | None]:
        """Return for each canonical vector which of the user's it is; None for combinations."""
        sizes = np.abs(self.from_canonical)
        made_of = sizes > COMBINED * sizes.max(axis=0)
        return [int(row.argmax()) if np.count_nonzero(row) == 1 else None for row in made_of.T]

    def of(self, kept: Sequence[int]) -> UserCoordinates:
        """Return the same for some of the user's vectors."""
        return UserCoordinates(self.to_canonical[:, kept], self.from_canonical[kept])

    def after(self, count: int) -> UserCoordinates:
        """Return the same with ``count`` vectors before, which are canonical as they are."""
        return UserCoordinates(
            *(_beside(count, matrix) for matrix in (self.to_canonical, self.from_canonical))
        )


def _beside(count: int, matrix: FloatArray) -> FloatArray:
    """Return a block diagonal matrix of a unit matrix and another one."""
    rows, columns = matrix.shape
    both = np.eye(count + rows, count + columns)
    both[count:, count:] = matrix
    return both


def scaled_coordinates(scale: FloatArray) -> UserCoordinates | None:
    """Return the way between vectors and the same ones divided by ``scale``; None where it is 1."""
    if np.all(scale == 1.0):
        return None
    return UserCoordinates(np.diag(scale), np.diag(1.0 / scale))
