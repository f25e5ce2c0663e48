"""Motions of the supports."""

import numpy as np
import pytest

import bumpstop as bs


def mast() -> bs.ModalBasis:
    """Two masses on a chain of springs along x, held at its foot."""
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0), "C": (2, 0, 0)},
        masses=[bs.PointMass("b", node="B", mass=2.0), bs.PointMass("c", node="C", mass=1.0)],
        springs=[
            bs.Spring("low", node="B", other="A", stiffness=800.0),
            bs.Spring("high", node="C", other="B", stiffness=300.0),
        ],
        supports=[
            bs.Support(nodes=["A"], fixed=["dx", "dy", "dz"]),
            bs.Support(nodes=["B", "C"], fixed=["dy", "dz"]),
        ],
    )
    return bs.ModalBasis.from_structure(structure, modes=2, damping=0.02)


def test_modal_forces_are_participation_factors() -> None:
    basis = mast()
    shapes = np.array([basis.row(node, "dx") for node in ("B", "C")])
    expected = -3.0 * shapes.T @ np.array([2.0, 1.0])
    motion = bs.BaseMotion(acceleration=(3.0, 7.0, 0.0))
    np.testing.assert_allclose(motion.modal_force(basis), expected, rtol=1e-12)


def test_a_shaken_chain_follows_its_frequency_response() -> None:
    """After the free motion has died out, against the direct solution on the dofs."""
    basis = mast()
    wave = bs.Harmonic(2.0, cosine=1.0, sine=-0.5)
    shake = bs.BaseMotion(acceleration=(0.7, 0, 0), time=wave)
    response = bs.simulate(bs.Problem(basis, loads=[shake], duration=200.0))
    stiffness = np.array([[1100.0, -300.0], [-300.0, 300.0]])
    mass = np.diag([2.0, 1.0])
    omega = 4.0 * np.pi
    shapes = np.array([basis.row(node, "dx") for node in ("B", "C")])
    damping = mass @ shapes @ np.diag(basis.damping) @ shapes.T @ mass
    dynamic = stiffness + 1j * omega * damping - omega**2 * mass
    amplitude = np.linalg.solve(dynamic, -mass @ np.ones(2) * 0.7 * (1.0 + 0.5j))
    times = np.linspace(199.0, 200.0, 41)
    for number, node in enumerate(("B", "C")):
        found = response.at(times).displacement(node, "dx").to_numpy()
        expected = (amplitude[number] * np.exp(1j * omega * times)).real
        np.testing.assert_allclose(found, expected, atol=1e-11 * abs(amplitude).max())


def test_masses_are_needed() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[3.0], shapes={("P", "dx"): [1.0]})
    with pytest.raises(bs.InputError, match=r"loads\.base_motion\.acceleration: needs the masses"):
        bs.Problem(basis, loads=[bs.BaseMotion(acceleration=(1, 0, 0))], duration=1.0)
