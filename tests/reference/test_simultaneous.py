"""Events that fall together: stops hit, left and taken over at one instant."""

import numpy as np
import pytest

from .one_mass import Mass, OneMass, Wall
from .problem import CLOSED, OPEN, Array
from .several.agreement import Agreement, agreement
from .several.problem import SeveralStops, Stop
from .several.scan import Event
from .several.verdict import core_events

EXACT = 1e-11
SHIFTS = [0.0, *(sign * shift for shift in (1e-9, 1e-12, 1e-15) for sign in (1, -1))]


class Rows:
    """An oracle of stops that move as one mass among as many others: ``q = shape x``."""

    def __init__(self, mass: OneMass, shape: Array, copies: list[int]) -> None:
        """Take the events of one mass for the stops that are copies of its walls."""
        self.mass, self.shape = mass, shape
        self.events = [
            Event(event.time, stop, event.before, event.after)
            for event in mass.events
            for stop, wall in enumerate(copies)
            if wall == event.stop
        ]

    def motion(self, times: Array) -> tuple[Array, Array]:
        """Return displacement and velocity, each (time, mode)."""
        displacement, velocity = self.mass.motion(times)
        return displacement * self.shape, velocity * self.shape


def good(result: Agreement) -> bool:
    """Whether everything is right to rounding."""
    errors = (result.event_error, result.state_error, result.energy_residual)
    return result.same_events and max(errors) < EXACT


@pytest.mark.parametrize("count", [2, 16, 64])
@pytest.mark.parametrize("damping", [0.0, 12.0])
def test_many_stops_on_one_point_are_one(count: int, damping: float) -> None:
    mass = Mass((Wall(1, 0.1, 400.0, damping),), 2.0, velocity=-2.0, omega2=25.0)
    part = Stop(np.ones(1), 0.1, 400.0 / count, damping / count)
    together = mass.several().but(stops=(part,) * count)
    assert good(agreement(together, Rows(OneMass(mass), np.ones(1), [0] * count)))


@pytest.mark.parametrize("damping", [0.0, 3.0])
def test_stops_at_mirrored_points_push_together(damping: float) -> None:
    # The odd mode stays at rest, although each stop by itself would move it.
    wall = Wall(1, 0.1, 800.0, 2 * damping)
    mass = Mass((wall,), 4.0, velocity=-2.0, omega2=25.0, damping=0.3)
    mirrored = SeveralStops(
        omega2=np.array([25.0, 121.0]),
        damping=np.array([0.3, 0.1]),
        stops=tuple(Stop(np.array([1.0, s]), 0.1, 400.0, damping) for s in (1.0, -1.0)),
        duration=4.0,
        displacement=np.zeros(2),
        velocity=np.array([-2.0, 0.0]),
    )
    oracle = Rows(OneMass(mass), np.array([1.0, 0.0]), [0, 0])
    assert len(oracle.events) > 10
    assert good(agreement(mirrored, oracle))


@pytest.mark.parametrize("stiffness", [3e3, 3e4, 3e6])
@pytest.mark.parametrize("idle", [0.0, 3.0, 30.0])
@pytest.mark.parametrize("damping", [0.0, 3.0])
@pytest.mark.parametrize("side", [0.3, 0.7])
def test_stops_without_clearance_at_a_mode_at_rest_let_mirrored_ones_switch(
    side: float, damping: float, idle: float, stiffness: float
) -> None:
    # While one of the mirrored stops has switched and the other not yet, the odd mode has a third
    # derivative, to which the two that face each other there would switch for ever.
    wall = Wall(1, 0.1, 800.0, 2 * damping)
    mass = Mass((wall,), 4.0, velocity=-2.0, omega2=25.0, damping=0.3)
    facing = [Stop(np.array([0.0, s]), 0.0, stiffness, idle) for s in (1.3, -1.3)]
    mirrored = [Stop(np.array([1.0, s]), 0.1, 400.0, damping) for s in (side, -side)]
    together = SeveralStops(
        omega2=np.array([25.0, 121.0]),
        damping=np.array([0.3, 0.1]),
        stops=(*facing, *mirrored),
        duration=4.0,
        displacement=np.zeros(2),
        velocity=np.array([-2.0, 0.0]),
    )
    oracle = Rows(OneMass(mass), np.array([1.0, 0.0]), [-1, -1, 0, 0])
    result = agreement(together, oracle)
    assert max(result.state_error, result.energy_residual) < EXACT
    # What the two at rest do is rounding.
    expected = [event.time for event in oracle.events if event.stop == 2]
    assert len(expected) > 5
    for stop in (2, 3):
        found = [event.time for event in result.found if event.stop == stop]
        assert found == pytest.approx(expected, abs=EXACT)


@pytest.mark.parametrize("damping", [0.0, 3.0])
@pytest.mark.parametrize("force", [0.0, -5.0])
def test_one_stop_is_taken_over_by_the_one_across(damping: float, force: float) -> None:
    walls = (Wall(1, 0.0, 400.0, damping), Wall(-1, 0.0, 900.0, damping))
    mass = Mass(walls, duration=4.0, velocity=1.0, force=force)
    result = agreement(mass.several(), oracle := OneMass(mass))
    assert len(oracle.events) > 20
    assert good(result)


def crossed(shift: float) -> tuple[SeveralStops, OneMass, OneMass]:
    """Return two free masses, in turned coordinates: one arrives as the other one leaves."""
    leaves, speed, duration = 0.25 + np.pi / 20, 0.5, 1.0
    first = Mass((Wall(1, 0.5, 400.0),), duration, velocity=-2.0)
    second = Mass((Wall(1, speed * leaves + shift, 900.0),), duration, velocity=-speed)
    turn = np.array([[0.6, 0.8], [-0.8, 0.6]])
    problem = SeveralStops(
        omega2=np.zeros(2),
        damping=np.zeros(2),
        stops=tuple(
            Stop(row, mass.walls[0].gap, mass.walls[0].stiffness)
            for row, mass in zip(turn, (first, second), strict=True)
        ),
        duration=duration,
        displacement=np.zeros(2),
        velocity=turn.T @ [-2.0, -speed],
    )
    return problem, OneMass(first), OneMass(second)


@pytest.mark.parametrize("shift", SHIFTS)
def test_one_stop_opens_while_another_closes(shift: float) -> None:
    problem, *oracles = crossed(shift)
    history = problem.solve()
    for stop, oracle in enumerate(oracles):
        times = np.linspace(0.0, problem.duration, 41)
        distance, rate, _ = history.law_motion(stop, times)
        displacement, velocity = oracle.motion(times)
        gap = problem.stops[stop].gap
        assert distance == pytest.approx(gap + displacement[:, 0], abs=EXACT)
        assert rate == pytest.approx(velocity[:, 0], abs=EXACT)
        events = [event for event in core_events(history) if event.stop == stop]
        assert [event.after for event in events] == [CLOSED, OPEN]
        wanted = [event.time for event in oracle.events]
        assert [event.time for event in events] == pytest.approx(wanted, abs=1e-14)


@pytest.mark.parametrize("shift", SHIFTS)
def test_a_wall_just_behind_another_is_met_just_after_it(shift: float) -> None:
    walls = (Wall(1, 0.5, 400.0), Wall(1, 0.5 + shift, 900.0))
    mass = Mass(walls, 1.0, velocity=-2.0)
    result = agreement(mass.several(), OneMass(mass))
    assert [event.after for event in result.found] == [CLOSED, CLOSED, OPEN, OPEN]
    assert good(result)
