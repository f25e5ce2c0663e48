"""Null spaces of sparse sums, against singular values and known mechanisms."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from bumpstop import Beam, Material, Rectangle, Structure, Support
from bumpstop.structure.null_combinations import null_combinations
from bumpstop.structure.sparse import SparseMatrix

Array = NDArray[np.float64]

STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = Rectangle(height=0.02, width=0.02)


def sparse(dense: Array) -> SparseMatrix:
    rows, columns = np.nonzero(dense)
    return SparseMatrix.from_triplets(dense.shape, rows, columns, dense[rows, columns])


@pytest.mark.parametrize("size", [1, 7, 40, 130])
@pytest.mark.parametrize("nullity", [0, 1, 3])
def test_against_singular_values(size: int, nullity: int) -> None:
    """Few unknowns are eliminated, many go through the normal matrix."""
    random = np.random.default_rng(size + nullity)
    rank = max(size - nullity, 0)
    sums = random.normal(size=(size + 5, rank)) @ random.normal(size=(rank, size))
    sums /= np.abs(sums).max(initial=1.0)
    found = null_combinations(sparse(sums))
    assert found.shape == (size, size - rank)
    if rank < size:
        assert np.linalg.svd(found, compute_uv=False).min() > 1e-2
        np.testing.assert_allclose(sums @ found, 0.0, atol=1e-13 * np.abs(found).max())


def test_unknowns_that_stand_alone() -> None:
    sums = np.array([[0.0, 2.0, 0.0, 0.0], [0.0, 0.5, 1.0, 0.0]])
    np.testing.assert_array_equal(null_combinations(sparse(sums)), np.eye(4)[:, [0, 3]])


def tower(storeys: int, unbraced: int | None) -> Structure:
    """A tower of pinned bars on four pins, with one storey that may lack its side diagonals."""
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    nodes = {
        f"{level}{corner}": (float(x), float(y), float(level))
        for level in range(storeys)
        for corner, (x, y) in zip("abcd", corners, strict=True)
    }
    pairs = []
    for level in range(storeys):
        for this, following in zip("abcd", "bcda", strict=True):
            if level:
                pairs.append((f"{level}{this}", f"{level}{following}"))
                pairs.append((f"{level - 1}{this}", f"{level}{this}"))
                if level != unbraced:
                    pairs.append((f"{level - 1}{this}", f"{level}{following}"))
        if level:
            pairs.append((f"{level}a", f"{level}c"))
    return Structure(
        nodes=nodes,
        beams=[
            Beam(f"{a}-{b}", nodes=(a, b), elements=1, theory="bar", material=STEEL, section=BAR)
            for a, b in pairs
        ],
        supports=[Support(nodes=[f"0{c}" for c in "abcd"], fixed=("dx", "dy", "dz"))],
    )


@pytest.mark.parametrize("storeys", [4, 60])
@pytest.mark.parametrize(("unbraced", "loose"), [(None, 0), (2, 3)])
def test_a_storey_without_diagonals_lets_what_is_above_move_in_its_plane(
    storeys: int, unbraced: int | None, loose: int
) -> None:
    structure = tower(storeys, unbraced)
    shapes = structure.rigid_shapes()
    assert shapes.shape == (len(structure.free), loose)
    stiffness = structure.reduced(structure.stiffness)
    size = np.abs(stiffness.values).max() * np.abs(shapes).max(initial=0.0)
    assert np.abs(stiffness @ shapes).max(initial=0.0) <= 1e-14 * size
