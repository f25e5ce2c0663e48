"""Linear forms: a number read from the displacements of a few dofs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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

    @classmethod
    def sum(cls, forms: Sequence[tuple[float, LinearForm]]) -> LinearForm:
        """Return the weighted sum of forms."""
        return cls(
            np.concatenate([np.zeros(0, dtype=np.intp), *(form.dofs for _, form in forms)]),
            np.concatenate([np.zeros(0), *(weight * form.weights for weight, form in forms)]),
        )

    def of(self, field: FloatArray) -> FloatArray:
        """Return the form of a field (dofs,) or of several, (dofs, m)."""
        return self.weights @ field[self.dofs]
