"""A force that travels along a beam, against Fryba's series for the simply supported one."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import bumpstop as bs

LENGTH, FORCE = 20.0, -5e4
STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
GIRDER = bs.Rectangle(height=0.4, width=0.8)  # the width stands along z
BENDING, LINE = 210e9 * 0.4 * 0.8**3 / 12, 7800.0 * 0.8 * 0.4


def bridge(modes: int = 5) -> bs.ModalBasis:
    """Bending in the plane xz, pinned at both ends."""
    beam = bs.Beam(
        "AB",
        nodes=("A", "B"),
        elements=12,
        material=STEEL,
        section=GIRDER,
        theory="euler_bernoulli",
    )
    model = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)},
        beams=[beam],
        supports=[
            bs.Support(nodes="all", fixed=("dx", "dy", "drx", "drz")),
            bs.Support(nodes=["A", "B"], fixed="dz"),
        ],
    )
    return bs.ModalBasis.from_structure(model, modes=modes)


@pytest.mark.parametrize("speed", [40.0, -40.0])
def test_a_bridge_under_an_axle(speed: float) -> None:
    """Its chapter 1: each mode is driven by a sine while the axle crosses."""
    basis = bridge()
    axle = bs.MovingForce("axle", beam="AB", force=(0, 0, FORCE), speed=speed)
    crossing = LENGTH / 40.0
    response = bs.simulate(bs.Problem(basis, loads=[axle], duration=crossing))
    times = np.linspace(0.0, crossing, 41)
    turn = np.pi * 40.0 / LENGTH
    middle = np.zeros_like(times)
    for j in range(1, 6):
        omega = (j * np.pi / LENGTH) ** 2 * np.sqrt(BENDING / LINE)
        passed = np.sin(j * turn * times) - j * turn / omega * np.sin(omega * times)
        shape = np.sin(j * np.pi / 2)
        middle += 2 * FORCE / (LINE * LENGTH) * passed / (omega**2 - (j * turn) ** 2) * shape
    found = response.sample("displacement", "AB.6", "dz", times=times)
    # 12 elements and their straight lines.
    np.testing.assert_allclose(found, middle, atol=1e-4 * np.abs(middle).max())


def test_it_enters_and_leaves_and_may_change() -> None:
    """A pulsating force, late; the modal equations by a Runge-Kutta scheme."""
    basis = bridge(2)
    wave = bs.Harmonic(6.0, cosine=1.0)
    load = bs.MovingForce("axle", beam="AB", force=(0, 0, FORCE), speed=50.0, enters=0.1, time=wave)
    response = bs.simulate(bs.Problem(basis, loads=[load], duration=0.8))
    shapes = [basis.row(f"AB@{x!r}", "dz") for x in np.linspace(0, LENGTH, 4001).tolist()]
    places = np.linspace(0.0, LENGTH, 4001)

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        at = 50.0 * (t - 0.1)
        force = np.zeros(2)
        if 0.0 <= at <= LENGTH:
            phi = [np.interp(at, places, [shape[n] for shape in shapes]) for n in range(2)]
            force = FORCE * np.cos(12 * np.pi * t) * np.array(phi)
        return np.concatenate([y[2:], force - basis.omega2 * y[:2]])

    times = np.array([0.05, 0.2, 0.4, 0.6, 0.8])
    options: dict[str, Any] = {"rtol": 1e-7, "atol": 1e-12, "max_step": 5e-3}
    found = solve_ivp(rate, (0, 0.8), np.zeros(4), t_eval=times, **options)
    expected = found.y[:2].T
    np.testing.assert_allclose(
        response.motion(0, times), expected, atol=3e-4 * np.abs(expected).max()
    )


@pytest.mark.parametrize(
    ("options", "key", "what"),
    [
        ({"speed": 0.0}, "speed", "must not be zero"),
        ({"beam": "XY"}, "beam", "unknown beam"),
        ({"enters": -1.0}, "enters", "negative"),
        ({"force": (1.0, 2.0)}, "force", "3 numbers"),
    ],
)
def test_mistakes_are_one_line(options: dict[str, Any], key: str, what: str) -> None:
    said: dict[str, Any] = {"beam": "AB", "force": (0, 0, 1.0), "speed": 1.0} | options
    with pytest.raises(bs.InputError, match=what) as caught:
        bs.MovingForce("axle", **said).components(bridge(1))
    assert caught.value.key == key
