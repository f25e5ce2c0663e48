"""Rigid motions in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["direction_words", "names_words", "rigid_words"]

_STRAIGHT = 1e-7
"""Directions and points that differ by less, relative to the size, are the same."""


def rigid_words(
    translation: FloatArray, rotation: FloatArray, names: Sequence[str], positions: FloatArray
) -> str:
    """Return what a small rigid motion is.

    Parameters
    ----------
    translation
        Motion of the origin, (3,).
    rotation
        Angle about each global axis, (3,).
    names, positions
        Nodes and where they are in m, (nodes, 3); one that stays in place is named.

    Examples
    --------
    >>> nodes, places = ("A", "B"), np.array([[1.0, 0.0, 0.0], [3.0, 0.0, 0.0]])
    >>> rigid_words(np.array([0.0, -1.0, 0.0]), np.array([0.0, 0.0, 1.0]), nodes, places)
    'rotation about z through A'
    >>> rigid_words(np.array([3.0, 4.0, 0.0]), np.zeros(3), nodes, places)
    'translation along (0.6, 0.8, 0)'
    """
    size = np.abs(positions).max(initial=0.0) or 1.0
    angle = float(np.linalg.norm(rotation))
    if angle * size <= _STRAIGHT * float(np.linalg.norm(translation)):
        return f"translation along {direction_words(translation)}"
    axis = rotation / angle
    advance = float(axis @ translation) / angle
    point = np.cross(rotation, translation) / angle**2
    point[np.abs(point) <= _STRAIGHT * size] = 0.0
    distances = np.linalg.norm(np.cross(positions - point, axis), axis=1)
    on_axis = np.flatnonzero(distances <= _STRAIGHT * size)
    place = names[on_axis[0]] if len(on_axis) else _numbers_words(point)
    words = f"{direction_words(axis)} through {place}"
    if abs(advance) > _STRAIGHT * size:
        return f"screw along {words}, {advance:.3g} m a radian"
    return f"rotation about {words}"


def direction_words(direction: FloatArray) -> str:
    """Return an axis by its letter, or the unit vector.

    >>> direction_words(np.array([0.0, -2.0, 0.0]))
    'y'
    """
    unit = direction / np.linalg.norm(direction)
    for letter, component in zip("xyz", unit, strict=True):
        if abs(component) >= 1.0 - _STRAIGHT:
            return letter
    significant = np.where(np.abs(unit) > _STRAIGHT, unit, 0.0)
    first = significant[np.flatnonzero(significant)[0]]
    return _numbers_words(significant * np.sign(first))


def names_words(names: Sequence[str], longest: int = 4) -> str:
    """Return a list of nodes; those inside beams are counted, where there are others.

    >>> names_words(["A", "AB.1", "AB.2", "B"]), names_words(["AB.1"])
    ('A, B and 2 more', 'AB.1')
    """
    own = [name for name in names if "." not in name] or names
    shown = own[:longest]
    more = len(names) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "")


def _numbers_words(vector: FloatArray) -> str:
    return f"({', '.join(f'{component + 0.0:.4g}' for component in vector)})"
