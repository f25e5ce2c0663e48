"""Linear forms: a number read from the displacements of a few dofs."""

from __future__ import annotations

from dataclasses import dataclass

from bumpstop.arguments import FloatArray
from bumpstop.structure.sparse import IndexArray

__all__ = ["LinearForm"]


@dataclass(frozen=True, eq=False)
class LinearForm:
    """The weighted sum of a few dofs.

    Parameters
    ----------
    dofs
        Numbers of the dofs, (n,).
    weights
        Weight of each, (n,).
    """

    dofs: IndexArray
    weights: FloatArray

    def of(self, field: FloatArray) -> FloatArray:
        """Return the form of a field (dofs,) or of several, (dofs, m)."""
        return self.weights @ field[self.dofs]
