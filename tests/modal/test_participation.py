"""Effective masses and generalised masses."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import bumpstop as bs
from bumpstop.modal import generalised_mass, participation

ALLOY = bs.Material(young_modulus=67e9, poisson_ratio=0.3, density=2400.0)
BAR = bs.Rectangle(height=0.01, width=0.02)
LENGTH, MASS = 1.5, 2400.0 * 0.01 * 0.02 * 1.5
CLAMP = bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))
PLANE = bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))


def beam(*supports: bs.Support, elements: int = 40) -> bs.Structure:
    member = bs.Beam(
        "AB",
        nodes=("A", "B"),
        elements=elements,
        theory="euler_bernoulli",
        material=ALLOY,
        section=BAR,
    )
    nodes = {"A": (0, 0, 0), "B": (LENGTH, 0, 0)}
    return bs.Structure(nodes=nodes, beams=[member], supports=supports)


def test_effective_masses_of_a_cantilever() -> None:
    """Closed form of Euler and Bernoulli's cantilever: (2 sigma / beta L)^2 of the mass."""
    basis = bs.ModalBasis.from_structure(beam(CLAMP, PLANE), modes=5)
    found = participation(basis, ["dy", "dz"])
    for mode in range(5):
        guess = (mode + 0.5) * math.pi
        root = brentq(lambda x: math.cos(x) + 1 / math.cosh(x), guess - 1, guess + 1, xtol=1e-14)
        sigma = (math.sinh(root) - math.sin(root)) / (math.cosh(root) + math.cos(root))
        assert found.fractions[mode, 0] == pytest.approx((2 * sigma / root) ** 2, rel=1e-4)
    assert found.fractions[0, 0] == pytest.approx(0.6131, abs=1e-4)
    np.testing.assert_array_equal(found.effective_mass[:, 1], 0.0)
    np.testing.assert_allclose(found.total, MASS, rtol=1e-12)


def test_all_effective_masses_add_up_to_what_moves() -> None:
    model = beam(CLAMP, elements=8)
    basis = bs.ModalBasis.from_structure(model, modes="all")
    names = ("dx", "dy", "dz", "drx", "dry", "drz")
    found = participation(basis, names)
    mass = model.reduced(model.mass).to_dense()
    for column, name in enumerate(names):
        x, y, z, rx, ry, rz = (float(name == other) for other in names)
        motion = model.rigid_field(translation=(x, y, z), rotation=(rx, ry, rz))
        load = (model.mass @ motion)[model.free]
        moving = load @ np.linalg.solve(mass, load)
        assert found.effective_mass[:, column].sum() == pytest.approx(moving, rel=1e-9)
        assert 0.9 < found.sums[column] <= 1.0
    assert found.total[4] == pytest.approx(MASS * LENGTH**2 / 3, rel=1e-9)


def test_rigid_modes_take_the_whole_mass() -> None:
    basis = bs.ModalBasis.from_structure(beam(elements=6), modes=9)
    np.testing.assert_allclose(participation(basis).sums, 1.0, rtol=1e-12)
    fractions = participation(basis).fractions
    assert np.abs(fractions[6:]).max() < 1e-20


def test_generalised_masses() -> None:
    """A sine carries half the mass of its beam; a cantilever's mode, one at the tip, a quarter."""
    ends = bs.Support(nodes=["A", "B"], fixed=["dy"])
    sines = bs.ModalBasis.from_structure(beam(PLANE, ends), modes=3)
    # The largest displacement is found on nodes: none is at 1/6 of the length for mode 3.
    np.testing.assert_allclose(generalised_mass(sines)[:2], MASS / 2, rtol=1e-5)
    tip = bs.ModalBasis.from_structure(beam(PLANE, CLAMP), modes=4)
    np.testing.assert_allclose(generalised_mass(tip), MASS / 4, rtol=1e-4)


def test_a_twist_is_counted_by_its_rotation() -> None:
    twisted = bs.ModalBasis.from_structure(
        beam(CLAMP, bs.Support(nodes="all", fixed=("dx", "dy", "dz", "dry", "drz"))), modes=1
    )
    inertia = 2400.0 * (0.01 * 0.02**3 + 0.02 * 0.01**3) / 12 * LENGTH
    assert generalised_mass(twisted)[0] == pytest.approx(inertia / 2, rel=1e-3)


def test_what_has_no_masses_is_refused() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [2.0]})
    with pytest.raises(bs.InputError, match="basis: this basis knows no masses"):
        participation(basis)
    np.testing.assert_array_equal(generalised_mass(basis), [0.25])
    with pytest.raises(bs.InputError, match="unknown direction"):
        participation(bs.ModalBasis.from_structure(beam(CLAMP), modes=1), ["x"])
