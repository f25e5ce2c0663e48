"""Friction where the speed of the obstacle, and with it the normal force, jumps."""

from typing import Any

import numpy as np
import pytest

import bumpstop as bs

DURATION = 0.6
ALONG: dict[str, Any] = {"static": 0.4, "dynamic": 0.3}


def pressed(seed: int) -> bs.Problem:
    """A few modes on a damped obstacle whose place goes along straight lines."""
    rng = np.random.default_rng(seed)
    modes = int(rng.integers(2, 5))
    basis = bs.ModalBasis.from_modes(
        frequency=rng.uniform(2.0, 12.0, modes).tolist(),
        damping=0.02,
        shapes={("P", dof): rng.normal(size=modes).tolist() for dof in ("dx", "dy")},
    )
    corners = [0.0, *np.sort(rng.uniform(0.03, 0.5, 5)), DURATION]
    places = [0.0, *rng.uniform(-0.02, 0.03, 6)]
    floor = bs.Stop(
        "floor",
        node="P",
        normal=(1, 0, 0),
        gap=-0.003,
        stiffness=5e3,
        damping=float(rng.choice([20.0, 80.0, 300.0])),
        motion=bs.TimeTable(corners, places, beyond="hold"),
        friction=ALONG,
        sliding=(0, 1, 0),
        tangential_stiffness=3e3,
        tangential_damping=float(rng.choice([0.0, 20.0])),
    )
    shake = bs.NodalForce("f", node="P", force=(5.0, 20.0, 0), time=bs.Harmonic(4.0, sine=1.0))
    return bs.Problem(basis, laws=[floor], loads=[shake], duration=DURATION)


@pytest.mark.filterwarnings("ignore:stop 'floor'")
@pytest.mark.parametrize("seed", range(12))
def test_the_slider_stays_where_the_normal_force_jumps(seed: int) -> None:
    """Small steps, which drag the slider along, come to the motion of located switches."""
    problem = pressed(seed)
    exact, adaptive = bs.simulate(problem, "exact"), bs.simulate(problem, "dop853", rtol=1e-11)
    steps = bs.simulate(problem, "symplectic_euler", dt=4e-6)
    times = np.linspace(0.0, DURATION, 301)
    found = exact.motion(0, times)
    largest = np.abs(found).max()
    np.testing.assert_allclose(adaptive.motion(0, times), found, rtol=0, atol=1e-9 * largest)
    np.testing.assert_allclose(steps.motion(0, times), found, rtol=0, atol=2e-3 * largest)
    assert exact.energy_residual < 1e-12
