"""What is just touched at the start is decided with the stops that press already."""

import numpy as np

from bumpstop import _core

STIFFNESS = np.array([1e3, 4e3])
PRELOAD = 10.0  # N, of the first stop; the force is 1 N the other way


def test_a_preloaded_stop_pushes_the_mass_into_the_one_that_it_touches() -> None:
    stops = [
        _core.Stop(np.array([1.0]), -PRELOAD / STIFFNESS[0], STIFFNESS[0], 0.0),
        _core.Stop(np.array([-1.0]), 0.0, STIFFNESS[1], 0.0),
    ]
    omega = np.sqrt(STIFFNESS.sum())
    zero = np.zeros(1)
    history = _core.simulate(
        _core.System(zero, zero),
        stops,
        _core.Forcing(np.array([-1.0])),
        zero,
        zero,
        np.pi / omega,
        "exact",
    )
    assert history.event_count == 0
    times = np.linspace(0.0, np.pi / omega, 9)
    motion = (PRELOAD - 1.0) / omega**2 * (1.0 - np.cos(omega * times))
    for law, (distance, force) in enumerate(
        [(motion - PRELOAD / STIFFNESS[0], PRELOAD - STIFFNESS[0] * motion), (-motion, None)]
    ):
        found, _, pushed = history.law_motion(law, times)
        np.testing.assert_allclose(found, distance, rtol=0, atol=1e-17)
        expected = STIFFNESS[1] * motion if force is None else force
        np.testing.assert_allclose(pushed, expected, rtol=1e-14, atol=1e-14)
