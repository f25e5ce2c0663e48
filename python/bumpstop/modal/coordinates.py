"""The coordinates in which a user gave a basis, beside those in which it is integrated."""

from __future__ import annotations

from dataclasses import dataclass

from bumpstop.arguments import FloatArray

__all__ = ["UserCoordinates"]


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
