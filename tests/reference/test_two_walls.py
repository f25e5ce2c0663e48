"""A mass between walls: clearances down to none, preload, contacts that last hardly any time."""

import numpy as np
import pytest

from .one_mass import Mass, OneMass, Wall
from .several.agreement import agreement
from .several.verdict import core_events

EXACT = 1e-11


def check(mass: Mass, events: int) -> None:
    """Compare with the oracle, which must have so many events at least."""
    oracle = OneMass(mass)
    assert len(oracle.events) >= events
    result = agreement(mass.several(), oracle)
    assert result.same_events
    assert result.event_error < 1e-14
    assert result.state_error < EXACT
    assert result.energy_residual < EXACT


def test_without_a_gap_the_period_is_half_of_each() -> None:
    # 2000 half swings: pi / 30 on one spring, pi / 20 on the other.
    walls = (Wall(1, 0.0, 400.0), Wall(-1, 0.0, 900.0))
    mass = Mass(walls, duration=1000 * np.pi / 12 + 0.01, velocity=1.0)
    history = mass.several().solve()
    events = core_events(history)
    n = np.arange(1, 2001)
    wanted = (n + 1) // 2 * (np.pi / 30) + n // 2 * (np.pi / 20)
    assert len(events) == 4000
    for part in (events[::2], events[1::2]):
        assert [event.time for event in part] == pytest.approx(wanted, rel=1e-12)
    assert history.energy_residual() < 1e-11


@pytest.mark.parametrize("gap", [0.0, 1e-15, 1e-9, 1e-3])
@pytest.mark.parametrize("damping", [0.0, 2.0])
def test_the_smaller_the_gap_the_shorter_the_flight(gap: float, damping: float) -> None:
    walls = (Wall(1, gap, 400.0, damping), Wall(-1, gap, 900.0, damping))
    check(Mass(walls, 4.0, velocity=1.0, force=-3.0), events=30)


@pytest.mark.parametrize("preload", [1e-15, 1e-9, 1e-3, 0.02, 1.0])
def test_a_clamp_holds_until_one_side_lets_go(preload: float) -> None:
    walls = (Wall(1, -preload, 400.0), Wall(-1, -preload, 900.0))
    check(Mass(walls, 2.0, velocity=1.0), events=0 if preload == 1.0 else 20)


@pytest.mark.parametrize("preload", [1e-9, 1e-3, 1.0])
@pytest.mark.parametrize("damping", [0.0, 3.0])
def test_a_mass_at_rest_in_a_clamp_stays(preload: float, damping: float) -> None:
    # In balance, 400 a = 800 b, and exactly so.
    walls = (Wall(1, -2 * preload, 400.0, damping), Wall(-1, -preload, 800.0, damping))
    history = Mass(walls, 5.0, omega2=3.0).several().solve()
    times = np.linspace(0.0, 5.0, 11)
    assert core_events(history) == []
    assert np.abs(history.motion(times, 0)).max() < 1e-15 * preload
    for law in (0, 1):
        assert history.law_motion(law, times)[2] == pytest.approx(800.0 * preload, rel=1e-14)


@pytest.mark.parametrize("stiffness", [1e6, 1e10, 1e14, 1e18])
def test_contacts_that_last_hardly_any_time(stiffness: float) -> None:
    walls = (Wall(1, 0.1, stiffness), Wall(-1, 0.2, 3 * stiffness))
    check(Mass(walls, 4.0, velocity=2.0), events=40)


@pytest.mark.parametrize("damping", [0.0, 5.0])
def test_walls_behind_each_other(damping: float) -> None:
    walls = (Wall(1, 0.1, 4e2), Wall(1, 0.15, 9e2, damping), Wall(1, 0.15, 5e2), Wall(-1, 0.3, 7e2))
    check(Mass(walls, 4.0, velocity=5.0, omega2=4.0, damping=0.01), events=60)


@pytest.mark.parametrize(
    ("speed", "force"), [(1.0, 0.0), (-1.0, 0.0), (0.0, 5.0), (0.0, -5.0), (0.0, 0.0)]
)
@pytest.mark.parametrize("damping", [0.0, 2.0])
def test_a_start_on_both_walls(speed: float, force: float, damping: float) -> None:
    walls = (Wall(1, 0.0, 400.0, damping), Wall(-1, 0.0, 900.0, damping))
    moves = bool(speed or force)
    check(Mass(walls, 1.0, velocity=speed, force=force), events=int(speed != 0) * 8)
    assert moves or not Mass(walls, 1.0).several().solve().motion(np.ones(1), 0).any()
