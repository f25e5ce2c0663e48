"""The spin of a model, told by its gyroscopic matrix."""

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.modal.spin import angular_momentum

STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)


def shaft(end: tuple[float, float, float], spin: float) -> bs.Structure:
    beam = bs.Beam(
        "AB",
        nodes=("A", "B"),
        elements=5,
        material=STEEL,
        section=bs.Circle(radius=0.05),
        spin=spin,
    )
    return bs.Structure(nodes={"A": (0.1, 0.2, 0.3), "B": end}, beams=[beam])


@pytest.mark.parametrize("spin", [0.0, 300.0, -300.0])
def test_angular_momentum_of_a_shaft(spin: float) -> None:
    along = np.array([0.6, 0.0, 0.8])
    model = shaft((0.1 + 0.6, 0.2, 0.3 + 0.8), spin)
    polar = 7800.0 * np.pi * 0.05**4 / 2
    np.testing.assert_allclose(angular_momentum(model), spin * polar * along, atol=1e-9)


def test_angular_momentum_of_a_disc() -> None:
    disc = bs.PointMass("disc", node="B", mass=8.0, inertia=(0.04, 0.02, 0.02), spin=500.0)
    model = bs.Structure(nodes={"B": (1, 2, 3)}, masses=[disc])
    np.testing.assert_allclose(angular_momentum(model), [20.0, 0.0, 0.0], atol=1e-12)
