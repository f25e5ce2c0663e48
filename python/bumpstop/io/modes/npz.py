"""Modes as arrays of NumPy (.npz).

Arrays: ``frequency`` in Hz, (N,); ``damping``, (N,), 0 where left out; ``modal_mass`` in kg, (N,),
1 where left out; ``nodes`` and ``dofs``, (rows,), texts; ``shapes``, (rows, N).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.io.arrays import read_arrays
from bumpstop.io.modes.mode_set import ModeSet
from bumpstop.io.reading import in_file

__all__ = ["read_mode_arrays"]


def read_mode_arrays(path: Path) -> ModeSet:
    """Read modes from arrays.

    Raises
    ------
    InputError
        If the file cannot be read, an array is missing, or sizes do not fit together.
    """
    with in_file(path):
        arrays = read_arrays(path, "an archive of arrays")
        for name in ("frequency", "nodes", "dofs", "shapes"):
            if name not in arrays:
                hint = f"it holds {', '.join(arrays) or 'nothing'}"
                raise InputError(f"has no array {name!r}", hint=hint)
        modes, rows = arrays["frequency"].size, arrays["nodes"].size
        return ModeSet(
            frequency=_numbers(arrays, "frequency", (modes,)),
            damping=_numbers(arrays, "damping", (modes,), 0.0),
            modal_mass=_numbers(arrays, "modal_mass", (modes,), 1.0),
            dofs=tuple(zip(_texts(arrays, "nodes"), _texts(arrays, "dofs", rows), strict=True)),
            shapes=_numbers(arrays, "shapes", (rows, modes)),
        )


def _numbers(
    arrays: dict[str, Any], name: str, shape: tuple[int, ...], otherwise: float = 0.0
) -> FloatArray:
    array = arrays.get(name, np.full(shape, otherwise))
    if array.dtype.kind not in "fiu" or not np.isfinite(array).all():
        raise InputError("must hold finite numbers", key=name)
    if array.shape != shape:
        raise InputError(f"must have the shape {shape}", key=name, value=array.shape)
    numbers: FloatArray = array.astype(np.float64)
    return numbers


def _texts(arrays: dict[str, Any], name: str, count: int | None = None) -> list[str]:
    array = arrays[name]
    if array.dtype.kind != "U" or array.ndim != 1:
        raise InputError("must be a list of texts", key=name)
    if count is not None and len(array) != count:
        raise InputError(f"must be {count} texts, one a node", key=name, value=len(array))
    return [str(text) for text in array]
