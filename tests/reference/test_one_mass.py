"""The oracle of one mass among stops: against closed forms of its own and against the scan."""

import numpy as np
import pytest

from .one_mass import Mass, OneMass, Wall
from .several.scan import ScanSolution


def test_a_mass_between_springs_swings_half_a_period_on_each() -> None:
    mass = Mass((Wall(1, 0.0, 400.0), Wall(-1, 0.0, 900.0)), duration=3.0, velocity=1.0)
    events = OneMass(mass).events
    halves = np.where(np.arange(len(events) // 2) % 2 == 0, np.pi / 30, np.pi / 20)
    assert len(events) == 46
    assert [e.time for e in events[::2]] == pytest.approx(np.cumsum(halves), rel=1e-14)
    assert [e.time for e in events[1::2]] == pytest.approx(np.cumsum(halves), rel=1e-14)


def test_a_damped_stop_lets_go_when_its_force_vanishes() -> None:
    # x = v / w e^(-a t) sin(w t); the force vanishes where tan(w t) = 2 a w / (a^2 - w^2).
    mass = Mass((Wall(1, 0.0, 400.0, 12.0),), duration=1.0, velocity=-2.0)
    first, second = OneMass(mass).events
    a, w = 6.0, np.sqrt(400.0 - 36.0)
    release = (np.pi - np.arctan2(2 * a * w, w**2 - a**2)) / w
    assert (first.before, first.after) == ("closed", "released")
    assert first.time == pytest.approx(release, rel=1e-14)
    depth = -2 / w * np.exp(-a * release) * np.sin(w * release)
    rate = -2 / w * np.exp(-a * release) * (w * np.cos(w * release) - a * np.sin(w * release))
    assert second.time == pytest.approx(release - depth / rate, rel=1e-13)


def test_an_overdamped_stop_is_left_as_the_exponentials_say() -> None:
    mass = Mass((Wall(1, 0.0, 400.0, 50.0),), duration=1.0, velocity=-2.0)
    first = OneMass(mass).events[0]
    # x = c (e^(-10 t) - e^(-40 t)); its second derivative, the force, vanishes at ln 16 / 30.
    assert first.time == pytest.approx(np.log(16) / 30, rel=1e-14)


@pytest.mark.parametrize(
    "mass",
    [
        Mass((Wall(1, 0.1, 4e2), Wall(-1, 0.2, 9e2, 3.0)), 5.0, velocity=1.0, force=-3.0),
        Mass((Wall(1, -0.01, 4e2), Wall(-1, -0.02, 9e2)), 3.0, velocity=1.0),
        Mass(
            (Wall(1, 0.1, 4e2), Wall(1, 0.2, 9e2, 2.0), Wall(-1, 0.3, 7e2)),
            duration=6.0,
            velocity=5.0,
            omega2=4.0,
            damping=0.1,
        ),
        Mass((Wall(1, 0.0, 400.0, 30.0),), 2.0, displacement=-0.25, velocity=4.0, force=-100.0),
    ],
)
def test_the_scan_agrees(mass: Mass) -> None:
    oracle, scan = OneMass(mass), ScanSolution(mass.several())
    assert [(e.stop, e.after) for e in oracle.events] == [(e.stop, e.after) for e in scan.events]
    times = np.linspace(0.0, mass.duration, 21)
    for left, right in zip(oracle.motion(times), scan.motion(times), strict=True):
        assert left == pytest.approx(right, abs=1e-11 * np.abs(left).max())
