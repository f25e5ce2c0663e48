"""Readings that take several instants at once, against single ones and against each other."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bumpstop as bs

MODES = 9
ROW = np.cos(1.3 * np.arange(1, MODES + 1))
GAP, STIFFNESS, DAMPING = 1e-3, 1e5, 30.0


@pytest.fixture(scope="module")
def run() -> bs.Response:
    """Nine modes that a moving stop is hammered by: more than two blocks of four instants."""
    modes = np.arange(1, MODES + 1)
    basis = bs.ModalBasis.from_modes(
        frequency=(10.0 * modes**1.2).tolist(), damping=0.01, shapes={("P", "dx"): ROW.tolist()}
    )
    stop = bs.Stop(
        "bed",
        node="P",
        normal=(-1, 0, 0),
        gap=GAP,
        stiffness=STIFFNESS,
        damping=DAMPING,
        motion=bs.Harmonic(7.0, sine=2e-4),
    )
    shaken = bs.NodalForce("f", node="P", force=(40.0, 0, 0), time=bs.Harmonic(9.0, sine=1.0))
    thrown = bs.ModalState(velocity=[0.1] * MODES)
    return bs.simulate(
        bs.Problem(basis, laws=[stop], loads=[shaken], initial=thrown, duration=0.5, sample=1.7e-3)
    )


@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_modes_do_not_depend_on_the_other_instants(run: bs.Response, derivative: int) -> None:
    together = run.motion(derivative)
    for number, time in enumerate(run.times[::7]):
        np.testing.assert_array_equal(together[7 * number], run.motion(derivative, [time])[0])


def test_velocities_are_slopes_of_displacements(run: bs.Response) -> None:
    step, times = 1e-7, run.times[3:-3]
    slopes = (run.motion(0, times + step) - run.motion(0, times - step)) / (2.0 * step)
    speeds = run.motion(1, times)
    # Where the stop switches within the step the acceleration jumps.
    assert_allclose(slopes, speeds, atol=1e-5 * np.abs(speeds).max())


def test_a_force_is_that_of_the_motion_of_all_modes(run: bs.Response) -> None:
    moved, rate = (
        2e-4 * np.sin(14.0 * np.pi * run.times),
        28e-4 * np.pi * np.cos(14.0 * np.pi * run.times),
    )
    distance = GAP - run.motion(0) @ ROW - moved
    speed = -run.motion(1) @ ROW - rate
    assert_allclose(run.sample("gap", "bed"), distance, atol=1e-15)
    pushes = run.sample("state", "bed") == "closed"
    assert 20 < pushes.sum() < len(pushes) - 20
    force = np.where(pushes, -STIFFNESS * distance - DAMPING * speed, 0.0)
    found = run.sample("stop_force", "bed")
    assert_allclose(found, force, atol=1e-12 * np.abs(force).max())
    forces = run.history.law_forces(0, run.times)[:, 0]
    np.testing.assert_array_equal(forces, found)
