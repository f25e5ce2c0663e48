"""Mesh refinement towards the exact Timoshenko beam, hinged at one end and free at the other.

The exact frequencies are zeros of a determinant: the beam's equations in (deflection,
rotation, moment, shear force) are carried along the beam by a matrix exponential, and
moment and shear force must vanish at the free end.
"""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest

from bumpstop import Beam, Material, ModalBasis, Rectangle, Structure, Support

ALLOY = Material(young_modulus=67e9, poisson_ratio=0.3, density=2400.0)
LENGTH = 0.8


def computed(section: Rectangle, elements: int, mode: int) -> float:
    structure = Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)},
        beams=[Beam("AB", nodes=("A", "B"), elements=elements, material=ALLOY, section=section)],
        supports=[
            Support(nodes="all", fixed=("dx", "dz", "drx", "dry")),
            Support(nodes="A", fixed=("dy",)),
        ],
    )
    return float(ModalBasis.from_structure(structure, modes=mode + 1).omega2[mode])


def exact(section: Rectangle, start: float) -> Any:
    """Squared frequency nearest to ``start``, to 30 digits."""
    bending = mp.mpf(ALLOY.young_modulus) * section.inertia_z
    shear = mp.mpf(ALLOY.shear_modulus) * section.area * section.shear_factors[0]
    mass, inertia = ALLOY.density * section.area, ALLOY.density * section.inertia_z

    def at_free_end(omega2: Any) -> Any:
        rates = mp.matrix(
            [
                [0, 1, 0, 1 / shear],
                [0, 0, 1 / bending, 0],
                [0, -inertia * omega2, 0, -1],
                [-mass * omega2, 0, 0, 0],
            ]
        )
        carried = mp.expm(rates * LENGTH)
        return carried[2, 1] * carried[3, 3] - carried[2, 3] * carried[3, 1]

    return mp.findroot(at_free_end, (start, start * (1 + 1e-6)), solver="secant", tol=1e-25)


@pytest.mark.parametrize("mode", [1, 3])
@pytest.mark.parametrize(
    ("height", "elements", "order"),
    [
        pytest.param(0.0008, (4, 8, 16, 32), 4, id="slender: cubic deflections"),
        pytest.param(0.16, (16, 32, 64, 128), 2, id="deep: one shear strain an element"),
    ],
)
def test_frequencies_converge_from_above(
    height: float, elements: tuple[int, ...], order: int, mode: int
) -> None:
    section = Rectangle(height=height, width=0.02)
    values = [computed(section, n, mode) for n in elements]
    with mp.workdps(30):
        limit = exact(section, values[-1])
        errors = np.array([float(value / limit - 1) for value in values])
    assert np.all(errors > 0.0)
    assert errors[-1] < 1e-3
    orders = np.log2(errors[:-1] / errors[1:])
    np.testing.assert_allclose(orders[-2:], order, atol=0.15)


def test_slender_beam_has_the_frequencies_of_bernoulli() -> None:
    """Hinged-free: tan(x) = tanh(x), x = 3.926602 for the first flexible mode."""
    section = Rectangle(height=0.0008, width=0.02)
    factor = 3.926602312047919**4 * ALLOY.young_modulus * section.inertia_z
    expected = factor / (ALLOY.density * section.area * LENGTH**4)
    assert computed(section, 20, 1) == pytest.approx(expected, rel=2e-5)
