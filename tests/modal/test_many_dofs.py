"""Modes of many dofs, by sparse matrices, against SciPy and closed forms."""

from __future__ import annotations

import subprocess
import sys
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh

from bumpstop import Beam, Material, ModalBasis, Rectangle, Structure, Support
from bumpstop.errors import InputError
from bumpstop.modal.coupled import FEW, MOST_COMPLETE
from bumpstop.modal.eigen import Modes, model_modes
from bumpstop.modal.selection import (
    AllModes,
    LowestModes,
    ModesAround,
    ModesInBand,
)
from bumpstop.structure.dofs import DOFS

Array = NDArray[np.float64]

STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
SQUARE = Rectangle(height=0.05, width=0.05)
FLAT = Rectangle(height=0.05, width=0.03)


def lattice(cells: int, elements: int, section: Rectangle, supports: list[Support]) -> Structure:
    """A cube of beams, stiffly joined."""
    points = [
        (i, j, k) for i in range(cells + 1) for j in range(cells + 1) for k in range(cells + 1)
    ]
    ends = [
        (a, b)
        for a, b in product(points, repeat=2)
        if sum(b) - sum(a) == 1 and sum(abs(x - y) for x, y in zip(a, b, strict=True)) == 1
    ]
    return Structure(
        nodes={label(point): tuple(map(float, point)) for point in points},
        beams=[
            Beam(
                f"{label(a)}-{label(b)}",
                nodes=(label(a), label(b)),
                elements=elements,
                material=STEEL,
                section=section,
            )
            for a, b in ends
        ],
        supports=supports,
    )


def label(point: tuple[int, ...]) -> str:
    return "P" + "".join(map(str, point))


def feet(cells: int) -> list[Support]:
    corners = [label((i, j, 0)) for i in (0, cells) for j in (0, cells)]
    return [Support(nodes=corners, fixed=DOFS)]


def matrices(structure: Structure) -> tuple[Array, Array]:
    stiffness, mass = (
        structure.reduced(m).to_dense() for m in (structure.stiffness, structure.mass)
    )
    return stiffness, mass


def check_shapes(structure: Structure, found: Modes) -> None:
    shapes = found.shapes
    modal_mass = shapes.T @ (structure.mass @ shapes)
    np.testing.assert_allclose(modal_mass, np.eye(len(found.omega2)), atol=1e-12)
    modal_stiffness = shapes.T @ (structure.stiffness @ shapes)
    largest = np.abs(found.omega2).max()
    np.testing.assert_allclose(
        modal_stiffness / largest, np.diag(found.omega2) / largest, atol=1e-9
    )
    assert np.all(shapes.max(axis=0) >= (1.0 - 1e-9) * np.abs(shapes).max(axis=0))


@pytest.fixture(scope="module")
def tower() -> Structure:
    structure = lattice(2, 4, FLAT, feet(2))
    assert len(structure.free) > 2 * FEW
    return structure


@pytest.fixture(scope="module")
def frequencies(tower: Structure) -> Array:
    """All frequencies of the tower in Hz, by LAPACK."""
    omega2: Array = eigh(*matrices(tower), eigvals_only=True)
    return np.sqrt(omega2) / (2.0 * np.pi)


def test_lowest_modes(tower: Structure, frequencies: Array) -> None:
    found = model_modes(tower, LowestModes(25))
    np.testing.assert_allclose(hertz(found), frequencies[:25], rtol=1e-9)
    check_shapes(tower, found)
    sparse = [tower.reduced(m).to_scipy() for m in (tower.stiffness, tower.mass)]
    arpack = np.sort(eigsh(sparse[0], 25, sparse[1], sigma=0.0, return_eigenvectors=False))
    np.testing.assert_allclose(found.omega2, arpack, rtol=1e-9)


def test_modes_of_a_band(tower: Structure, frequencies: Array) -> None:
    low, high = frequencies[40], frequencies[70]
    found = model_modes(tower, ModesInBand(low, high))
    np.testing.assert_allclose(hertz(found), frequencies[40:71], rtol=1e-9)
    check_shapes(tower, found)
    assert str(found.certificate).startswith("31 modes from ")


def test_modes_around_a_frequency(tower: Structure, frequencies: Array) -> None:
    centre = 0.5 * (frequencies[60] + frequencies[61])
    found = model_modes(tower, ModesAround(centre, 8))
    nearest = np.sort(frequencies[np.argsort(np.abs(frequencies**2 - centre**2))[:8]])
    np.testing.assert_allclose(hertz(found), nearest, rtol=1e-9)
    check_shapes(tower, found)


def test_a_shift_on_an_eigenvalue_and_a_band_without_modes(
    tower: Structure, frequencies: Array
) -> None:
    found = model_modes(tower, ModesAround(frequencies[10], 1))
    np.testing.assert_allclose(hertz(found), frequencies[10:11], rtol=1e-9)
    low, high = frequencies[20:22]
    between = ModesInBand(low + 0.1 * (high - low), high - 0.1 * (high - low))
    found = model_modes(tower, between)
    assert found.shapes.shape == (len(tower.dofs), 0)
    assert str(found.certificate).startswith("0 modes from ")


def test_a_free_lattice_has_six_exact_rigid_modes() -> None:
    structure = lattice(2, 3, SQUARE, [])
    found = model_modes(structure, LowestModes(20))
    np.testing.assert_array_equal(found.omega2[:6], 0.0)
    strain = structure.stiffness @ found.shapes[:, :6]
    assert np.abs(strain).max() < 1e-13 * np.abs(structure.stiffness.values).max()
    expected = eigh(*matrices(structure), eigvals_only=True)[6:20]
    np.testing.assert_allclose(found.omega2[6:], expected, rtol=1e-7)
    check_shapes(structure, found)
    # A band from zero has them too, one above zero has not.
    band = model_modes(structure, ModesInBand(0.0, float(hertz(found)[9]) * 1.01))
    assert np.count_nonzero(band.omega2 == 0.0) == 6
    band = model_modes(structure, ModesInBand(0.1, float(hertz(found)[9]) * 1.01))
    np.testing.assert_allclose(band.omega2, found.omega2[6 : 6 + len(band.omega2)], rtol=1e-10)


def test_the_symmetry_of_a_cube_makes_equal_frequencies() -> None:
    """A free cube of square bars: no mode of a multiple frequency is missing."""
    structure = lattice(2, 3, SQUARE, [])
    found = model_modes(structure, LowestModes(60))
    expected = eigh(*matrices(structure), eigvals_only=True)[6:60]
    np.testing.assert_allclose(found.omega2[6:], expected, rtol=1e-7)
    gaps = np.diff(found.omega2[6:]) / found.omega2[7:]
    assert np.count_nonzero(gaps < 1e-9) > 20
    check_shapes(structure, found)


def test_a_long_beam_keeps_its_relative_accuracy() -> None:
    """The clamped beam of Euler and Bernoulli, slender, cut in a thousand elements."""
    length, section = 20.0, Rectangle(height=0.01, width=0.01)
    structure = Structure(
        nodes={"A": (0, 0, 0), "B": (length, 0, 0)},
        beams=[Beam("AB", nodes=("A", "B"), elements=1000, material=STEEL, section=section)],
        supports=[
            Support(nodes="all", fixed=("dx", "dz", "drx", "dry")),
            Support(nodes="A", fixed=("dy", "drz")),
        ],
    )
    found = model_modes(structure, LowestModes(3))
    roots = np.array([1.875104068711961, 4.694091132974175, 7.854757438237613])
    stiffness = STEEL.young_modulus * section.inertia_z / (STEEL.density * section.area)
    expected = np.sqrt(stiffness) * (roots / length) ** 2 / (2.0 * np.pi)
    # Shear and rotary inertia: less than (7.85 h / L)^2 / 12 * 4.
    np.testing.assert_allclose(hertz(found), expected, rtol=6e-6)


@pytest.mark.parametrize("scale", [1e-6, 1e4])
def test_any_size(scale: float) -> None:
    section = Rectangle(height=0.05 * scale, width=0.03 * scale)
    model = lattice(2, 4, FLAT, feet(2))
    scaled = Structure(
        nodes={node: tuple(scale * x for x in place) for node, place in model.nodes.items()},
        beams=[
            Beam(b.name, nodes=b.nodes, elements=4, material=STEEL, section=section)
            for b in model.beams
        ],
        supports=model.supports,
    )
    found, same = model_modes(scaled, LowestModes(5)), model_modes(model, LowestModes(5))
    np.testing.assert_allclose(hertz(found) * scale, hertz(same), rtol=1e-10)
    assert found.certificate is not None


def test_the_certificate_says_what_was_proven(tower: Structure) -> None:
    found = model_modes(tower, LowestModes(10))
    certificate = found.certificate
    assert certificate is not None
    assert certificate.count == 10
    assert found.omega2[9] < certificate.high
    assert str(certificate).endswith("Hz, none missed: proven by the inertia of K - s M")
    assert ModalBasis.from_structure(tower, modes=10).sturm == certificate


def test_all_modes_of_too_many_dofs() -> None:
    structure = lattice(5, 4, FLAT, feet(5))
    with pytest.raises(InputError, match=rf"all modes cannot be had.*{MOST_COMPLETE}"):
        model_modes(structure, AllModes())


PRINT_BITS = """
import numpy as np, hashlib
from tests.modal.test_many_dofs import lattice, feet, FLAT
from bumpstop.modal.eigen import model_modes
from bumpstop.modal.selection import LowestModes
found = model_modes(lattice(2, 4, FLAT, feet(2)), LowestModes(12))
print(hashlib.sha256(found.omega2.tobytes() + found.shapes.tobytes()).hexdigest())
"""


def test_the_same_bits_in_every_process() -> None:
    command = [sys.executable, "-c", PRINT_BITS]
    root = Path(__file__).parents[2]
    first, second = (subprocess.check_output(command, cwd=root) for _ in range(2))
    assert first == second


def hertz(found: Modes) -> Array:
    frequencies: Array = np.sqrt(found.omega2) / (2.0 * np.pi)
    return frequencies
