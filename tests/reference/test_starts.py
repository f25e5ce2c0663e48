"""Starts at which a state has to be decided: touching, without force, while another stop pushes."""

import numpy as np
import pytest

from .one_mass import Mass, OneMass, Wall
from .several.agreement import agreement

EXACT = 1e-11


def check(mass: Mass) -> None:
    """Compare with the oracle; what only says how a run begins is no event."""
    result = agreement(mass.several(), OneMass(mass))
    assert result.same_events
    assert result.event_error < EXACT
    assert result.state_error < EXACT
    assert result.energy_residual < EXACT


@pytest.mark.parametrize("speed", [0.0, 1.0, -1.0])
@pytest.mark.parametrize("force", [-100.0, 100.0, 0.0])
@pytest.mark.parametrize("damping", [0.0, 5.0])
def test_touching_a_wall_while_another_one_pushes(
    speed: float, force: float, damping: float
) -> None:
    # The first wall pushes with 200: under -100 the mass starts upwards, away from the second.
    walls = (Wall(1, 0.0, 400.0), Wall(1, 0.5, 77.0, damping), Wall(-1, -0.5, 50.0, damping))
    check(Mass(walls, 1.0, displacement=-0.5, velocity=speed, force=force))


@pytest.mark.parametrize("damping", [8.0, 32.0, 128.0])
@pytest.mark.parametrize("force", [-1000.0, -100.0, -1.0])
def test_below_a_damped_wall_without_force(damping: float, force: float) -> None:
    # The push -k d - c d' is zero: its derivative decides.
    wall = Wall(1, 0.0, 512.0, damping)
    check(Mass((wall,), 0.5, displacement=-0.25, velocity=128.0 / damping, force=force))


@pytest.mark.parametrize(("force", "moves"), [(100.0, False), (99.0, True), (101.0, True)])
def test_touching_in_balance(force: float, moves: bool) -> None:
    # The stretched spring of the structure pulls with 100 onto the wall.
    mass = Mass((Wall(1, -1.0, 400.0),), 1.0, displacement=1.0, omega2=100.0, force=force)
    check(mass)
    assert (abs(mass.several().solve().motion(np.ones(1), 0)[0, 0] - 1.0) > 1e-3) == moves


@pytest.mark.parametrize("count", [2, 64, 100, 400])
def test_a_start_on_many_walls(count: int) -> None:
    walls = (Wall(1, 0.0, 1.0),) * count
    mass = Mass((Wall(1, 0.0, float(count)),), 5.0, velocity=-1.0, force=-3.0)
    many = Mass(walls, 5.0, velocity=-1.0, force=-3.0)
    times = np.linspace(0.0, 5.0, 21)
    found = many.several().solve().motion(times, 0)
    assert found == pytest.approx(OneMass(mass).motion(times)[0], abs=EXACT)
