"""Meshes of other programs, for the geometry of beams: one file a format."""

from bumpstop.io.meshes.line_mesh import LineMesh
from bumpstop.io.meshes.read import read_mesh

__all__ = ["LineMesh", "read_mesh"]
