"""Matrices of other programs: read into a model, and written for them; one file a format."""

from bumpstop.io.matrices.read import read_matrices
from bumpstop.io.matrices.write import write_matrices

__all__ = ["read_matrices", "write_matrices"]
