"""The sign of a shape, which nothing else determines."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["largest_positive"]


def largest_positive(shapes: FloatArray) -> FloatArray:
    """Return shapes with the largest component positive; the first of equals decides."""
    sizes = np.abs(shapes)
    largest = np.argmax(sizes >= (1.0 - 1e-9) * sizes.max(axis=0), axis=0)
    signs: FloatArray = np.sign(shapes[largest, np.arange(shapes.shape[1])])
    return shapes * signs
