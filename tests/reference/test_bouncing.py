"""Bouncing: a ball on a spring for ever, on a damped stop down to rest, a body on several stops."""

import numpy as np
import pytest
from mpmath import mp, mpf

from .one_mass import DIGITS, Mass, OneMass, Wall
from .problem import CLOSED, OPEN, StopProblem
from .several.agreement import agreement
from .several.problem import SeveralStops, Stop
from .several.scan import ScanSolution
from .several.verdict import core_events

EXACT = 1e-11
GRAVITY = 9.81


@pytest.mark.parametrize("stiffness", [1e3, 1e6, 1e9])
def test_the_instants_of_a_ball_on_a_spring(stiffness: float) -> None:
    """Falls of ``sqrt(2 h / g)``, contacts of ``2 (pi / 2 + atan(g / (w v))) / w``, in turn."""
    height, impacts = 0.5, 1000
    with mp.workdps(DIGITS):
        fall, rate = mp.sqrt(2 * mpf(height) / mpf(GRAVITY)), mp.sqrt(mpf(stiffness))
        contact = 2 * (mp.pi / 2 + mp.atan(1 / (rate * fall))) / rate
        starts = [fall + n * (2 * fall + contact) for n in range(impacts)]
        wanted = np.array([[float(start), float(start + contact)] for start in starts])
    mass = Mass((Wall(1, height, stiffness),), float(wanted[-1, 1]) + 0.1, force=-GRAVITY)
    history = mass.several().solve()
    found = [event.time for event in core_events(history)]
    assert found == pytest.approx(wanted.ravel(), rel=1e-12)
    assert history.energy_residual() < EXACT


@pytest.mark.parametrize(
    ("stiffness", "damping"), [(1e3, 8.0), (1e4, 8.0), (1e6, 200.0), (1e6, 1500.0), (1e4, 300.0)]
)
def test_a_ball_comes_to_rest_on_a_damped_stop(stiffness: float, damping: float) -> None:
    """After the last bounce, which is not higher than the static depth, it is not left again."""
    mass = Mass((Wall(1, 0.1, stiffness, damping),), 8.0, force=-GRAVITY)
    oracle = OneMass(mass)
    result = agreement(mass.several(), oracle)
    assert oracle.events[-1].after == CLOSED
    assert result.same_events
    assert result.event_error < EXACT
    assert result.state_error < EXACT
    assert result.energy_residual < EXACT


def static(problem: StopProblem) -> list[float]:
    """Return where the forces and the closed stop are in balance."""
    with mp.workdps(DIGITS):
        row = mp.matrix([mpf(float(r)) for r in problem.row])
        matrix = mp.diag([mpf(float(w)) for w in problem.omega2])
        matrix += mpf(problem.stiffness) * row * row.T
        push = mp.matrix([mpf(float(f)) for f in problem.force])
        push -= mpf(problem.stiffness) * mpf(problem.gap) * row
        return [float(q) for q in mp.lu_solve(matrix, push)]


@pytest.mark.parametrize("stop_damping", [0.0, 0.5, 20.0])
def test_a_flexible_structure_comes_to_rest_on_its_stop(stop_damping: float) -> None:
    omega = np.array([0.0, 20.0, 64.0])
    problem = StopProblem(
        omega2=omega**2,
        damping=np.array([0.5, 2.0, 6.0]),
        row=np.array([1.0, -0.5, 0.7]),
        stiffness=1e3,
        stop_damping=stop_damping,
        gap=0.01,
        velocity=np.array([-1.0, 0.7, 0.3]),
        force=np.array([-30.0, 3.0, 0.0]),
        duration=80.0,
    )
    history = problem.solve()
    events = core_events(history)
    assert events
    assert events[-1].after == CLOSED
    end = np.array([problem.duration])
    assert history.motion(end, 0)[0] == pytest.approx(static(problem), rel=1e-12)
    assert np.abs(history.motion(end, 1)).max() < 1e-11
    assert history.energy_residual() < EXACT


@pytest.mark.parametrize("lean", [0.0, 0.3])
def test_a_body_clatters_on_two_stops_until_it_lies(lean: float) -> None:
    """Heave and pitch of a plate that falls on stops under its ends, both damped."""
    stops = tuple(Stop(np.array([1.0, end]), 0.02, 4e3, 2.0) for end in (1.0, -1.4))
    plate = SeveralStops(
        omega2=np.zeros(2),
        damping=np.zeros(2),
        stops=stops,
        duration=30.0,
        displacement=np.zeros(2),
        velocity=np.array([0.0, lean]),
        force=np.array([-GRAVITY, 0.0]),
    )
    history = plate.solve()
    events = core_events(history)
    scan = ScanSolution(plate)
    for stop in (0, 1):
        after = [event.after for event in scan.events if event.stop == stop]
        assert [event.after for event in events if event.stop == stop] == after
        assert after[-1] == CLOSED
        assert after.count(OPEN) > 3
    assert len(events) == len(scan.events)
    rows = np.array([stop.row for stop in stops])
    pushes = np.linalg.solve(rows.T, -plate.force)
    rest = np.linalg.solve(rows, -0.02 - pushes / 4e3)
    assert history.motion(np.array([30.0]), 0)[0] == pytest.approx(rest, rel=1e-11)
    assert history.energy_residual() < EXACT


def test_every_flight_and_contact_has_a_step_that_certifies_it() -> None:
    stop = Stop(np.array([1.0]), 0.0, 4e3, 0.0)
    ball = SeveralStops(
        omega2=np.array([30.0]),
        damping=np.zeros(1),
        stops=(stop,),
        duration=50.0,
        displacement=np.array([0.1]),
        velocity=np.zeros(1),
        force=np.array([-GRAVITY]),
    )
    history = ball.solve()
    assert len(core_events(history)) > 100
    assert history.steps > len(core_events(history))
