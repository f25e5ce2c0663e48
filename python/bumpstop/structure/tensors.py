"""Axes and small matrices as users give them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite, vector
from bumpstop.errors import InputError

__all__ = ["Axes", "Rows", "axes_pair", "plain_rows", "square", "symmetric", "unit_axes"]

Axes: TypeAlias = tuple[Vector, Vector]
"""Local x, and a second vector that tells on which side of it local y is."""

Rows: TypeAlias = tuple[tuple[float, ...], ...]
"""A matrix by its rows."""


def axes_pair(key: str, value: object) -> Axes:
    """Return two vectors that tell local axes.

    Raises
    ------
    InputError
        If they are not two vectors, or one is zero or parallel to the other.
    """
    if not isinstance(value, Sequence | np.ndarray) or isinstance(value, str) or len(value) != 2:
        what = "must be two vectors: local x, and one that tells where local y is"
        raise InputError(what, key=key, value=value)
    x, second = vector(key, value[0]), vector(key, value[1])
    across = np.linalg.norm(np.cross(x, second))
    if across <= 1e-6 * np.linalg.norm(x) * np.linalg.norm(second):
        raise InputError("the two vectors must not be zero or parallel", key=key, value=value)
    return x, second


def unit_axes(axes: Axes | None) -> FloatArray:
    """Return the unit vectors of local axes, one a row; the global axes where none are given.

    Examples
    --------
    >>> unit_axes(((0.0, 2.0, 0.0), (1.0, 1.0, 0.0)))
    array([[ 0.,  1.,  0.],
           [ 1.,  0.,  0.],
           [ 0.,  0., -1.]])
    """
    if axes is None:
        return np.eye(3)
    x, second = (np.array(given) for given in axes)
    x = x / np.linalg.norm(x)
    y = second - (second @ x) * x
    y = y / np.linalg.norm(y)
    unit: FloatArray = np.array([x, y, np.cross(x, y)]) + 0.0
    return unit


def square(key: str, value: object, sizes: Sequence[int]) -> Rows:
    """Return the rows of a square matrix of one of the sizes.

    Raises
    ------
    InputError
        If it is not a list of rows of finite numbers, or has another size.
    """
    rows = plain_rows(value)
    size = len(rows)
    if size not in sizes or any(not isinstance(row, list) or len(row) != size for row in rows):
        wanted = " or ".join(f"{size} x {size}" for size in sizes)
        raise InputError(f"must be a matrix of {wanted} numbers", key=key, value=value)
    return tuple(tuple(finite(key, number) for number in plain_rows(row)) for row in rows)


def symmetric(key: str, value: object, sizes: Sequence[int]) -> Rows:
    """Return the rows of a symmetric matrix of one of the sizes.

    Raises
    ------
    InputError
        If it is not a symmetric matrix of finite numbers, or has another size.
    """
    rows = square(key, value, sizes)
    matrix = np.array(rows)
    difference = np.abs(matrix - matrix.T)
    if np.any(difference > 1e-9 * np.abs(matrix).max()):
        i, j = (int(k) for k in np.unravel_index(difference.argmax(), matrix.shape))
        what = "must be symmetric"
        hint = f"row {i + 1}, column {j + 1} has {matrix[i, j]:g}, but mirrored {matrix[j, i]:g}"
        raise InputError(what, key=key, hint=hint)
    return tuple(map(tuple, (0.5 * (matrix + matrix.T)).tolist()))


def plain_rows(value: object) -> list[object]:
    """Return lists in a list, whatever they were; an empty list where it is none."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, str) or not isinstance(value, Sequence):
        return []
    return [plain_rows(row) if isinstance(row, Sequence | np.ndarray) else row for row in value]
