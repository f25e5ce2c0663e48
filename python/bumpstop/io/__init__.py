"""File formats: one file a format.

Names are imported when they are first used: each format brings its own packages.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bumpstop.io.matrices import read_matrices, write_matrices
    from bumpstop.io.meshes import LineMesh, read_mesh
    from bumpstop.io.modes import ModeSet, read_modes

__all__ = [
    "LineMesh",
    "ModeSet",
    "read_matrices",
    "read_mesh",
    "read_modes",
    "write_matrices",
]

_HOME = {
    "LineMesh": "meshes",
    "ModeSet": "modes",
    "read_matrices": "matrices",
    "read_mesh": "meshes",
    "read_modes": "modes",
    "write_matrices": "matrices",
}
"""Where each name lives."""


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
