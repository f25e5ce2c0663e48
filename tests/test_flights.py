"""Flights between smooth contacts: closed forms, grazing touches, other integrations, options."""

import math
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.optimize import brentq, minimize_scalar

import bumpstop as bs
from bumpstop.arguments import FloatArray
from tests.laws.round_hole import Hole, free_mass

OMEGA = (20.0, 31.0, 53.0)
"""Angular frequencies in rad/s along x, y and z."""
START = (0.0, 0.6e-3, -0.2e-3)
SPEED = (0.0, 7e-3, 30e-3)


def reach(times: FloatArray) -> FloatArray:
    """How far from the axis a mass that nothing touches is."""
    both = [
        START[axis] * np.cos(OMEGA[axis] * times)
        + SPEED[axis] / OMEGA[axis] * np.sin(OMEGA[axis] * times)
        for axis in (1, 2)
    ]
    return np.hypot(*both)


def farthest(duration: float) -> tuple[float, float]:
    """The instant at which it is farthest from the axis, and how far."""
    times = np.linspace(0.0, duration, int(2000 * duration))
    rough = times[np.argmax(reach(times))]
    step = 2.0 * float(times[1])
    found = minimize_scalar(
        lambda t: -reach(t), bounds=(rough - step, rough + step), options={"xatol": 1e-12}
    )
    return float(found.x), -float(found.fun)


def thrown(law: Any, duration: float, **options: Any) -> bs.Response:
    initial = bs.ModalState(displacement=list(START), velocity=list(SPEED))
    problem = bs.Problem(free_mass(OMEGA), laws=[law], initial=initial, duration=duration)
    return bs.simulate(problem, **{"exact_flights": True, **options})


def octagon(distance: float, stiffness: float) -> bs.PolarStop:
    """A regular profile whose sides are so far from its centre."""
    radius = distance / math.cos(math.pi / 8)
    corners = [(math.pi / 4 * k, radius) for k in range(8)]
    return bs.PolarStop("hole", node="P", axis=(1, 0, 0), profile=corners, stiffness=stiffness)


def test_a_long_flight_is_that_of_mpmath() -> None:
    """Two thousand turns of damped modes under a harmonic load, within a hole they never reach."""
    damping, push, drive = 0.002, 0.3, 47.0
    shapes = {("P", axis): np.eye(3)[n].tolist() for n, axis in enumerate(("dx", "dy", "dz"))}
    basis = bs.ModalBasis.from_modes(
        frequency=[w / (2 * np.pi) for w in OMEGA], damping=[damping] * 3, shapes=shapes
    )
    swing = bs.NodalForce(
        "swing",
        node="P",
        force=(0.0, push, 0.0),
        time=bs.Harmonic(frequency=drive / (2 * np.pi), cosine=1.0),
    )
    hole = bs.CircleStop("hole", node="P", axis=(1, 0, 0), radius=5e-3, stiffness=1e5)
    initial = bs.ModalState(displacement=list(START), velocity=list(SPEED))
    duration = 240.0
    problem = bs.Problem(basis, laws=[hole], loads=[swing], initial=initial, duration=duration)
    found = bs.simulate(problem, exact_flights=True)
    assert found.method == "dop853"
    assert found.steps == 1
    mp.dps = 40
    for time in (0.3, 100.0, duration):
        y = found.sample("displacement", "P", "dy", times=[time])[0]
        omega, rate = mpf(basis.omega2[1]) ** 0.5, mpf(basis.damping[1]) / 2
        turned = mpf(drive / (2 * np.pi)) * 2 * mp.pi
        steady = mpf(push) / (omega**2 - turned**2 + 2j * rate * turned)
        own = mp.sqrt(omega**2 - rate**2)
        at_rest = mpf(START[1]) - steady.real
        moving = mpf(SPEED[1]) - (1j * turned * steady).real
        cos = at_rest * mp.cos(own * time)
        sin = (moving + rate * at_rest) / own * mp.sin(own * time)
        expected = mp.exp(-rate * time) * (cos + sin) + (steady * mp.expj(turned * time)).real
        assert abs(y - float(expected)) < 1e-12 * 1e-3
    assert found.energy_residual < 1e-11


@pytest.mark.parametrize("depth", [1e-4, 1e-5, 1e-6])
@pytest.mark.parametrize("method", ["rk32", "dop853", "exprk43"])
def test_grazing_touches_are_not_missed(method: str, depth: float) -> None:
    """Whatever the tolerance: what it rules are contacts."""
    duration = 8.0
    instant, radius = farthest(duration)
    touching = Hole(radius * (1.0 - depth), stiffness=10.0).stop()
    found = thrown(touching, duration, method=method, rtol=1e-3)
    first = found.impact_table()
    assert len(first["start"]) >= 1
    start = brentq(lambda t: reach(t) - radius * (1.0 - depth), instant - 0.02, instant, xtol=1e-14)
    assert first["start"][0] == pytest.approx(start, abs=1e-11)
    missing = Hole(radius * (1.0 + depth), stiffness=10.0).stop()
    away = thrown(missing, duration, method=method, rtol=1e-3)
    assert away.event_count == 0
    assert away.steps == 1


def test_grazing_touches_of_a_polygon_are_not_missed() -> None:
    duration, depth = 8.0, 1e-6
    times = np.linspace(0.0, duration, 160_001)
    normals = [math.pi / 8 + math.pi / 4 * k for k in range(8)]

    def beyond(angle: float, t: Any) -> Any:
        y, z = (
            START[axis] * np.cos(OMEGA[axis] * t)
            + SPEED[axis] / OMEGA[axis] * np.sin(OMEGA[axis] * t)
            for axis in (1, 2)
        )
        return y * math.cos(angle) + z * math.sin(angle)

    largest = 0.0
    for angle in normals:
        rough = times[np.argmax(beyond(angle, times))]
        near = (rough - 1e-3, rough + 1e-3)
        peak = minimize_scalar(
            lambda t, angle=angle: -beyond(angle, t), bounds=near, options={"xatol": 1e-12}
        )
        largest = max(largest, -float(peak.fun))
    touched = thrown(octagon(largest * (1.0 - depth), stiffness=10.0), duration, rtol=1e-3)
    assert len(touched.impact_table()["start"]) >= 1
    missed = thrown(octagon(largest * (1.0 + depth), stiffness=10.0), duration, rtol=1e-3)
    assert len(missed.impact_table()["start"]) == 0


def test_contacts_begin_where_scipy_has_them() -> None:
    """With friction; each flight and each contact integrated anew from switch to switch."""
    hole = Hole(0.5e-3, 2e4, 5.0, 0.4, 0.3, tangential_stiffness=1e4, tangential_damping=8.0)
    found = thrown(hole.stop(), 1.5, rtol=1e-12)
    assert len(found.impact_table()["start"]) > 8
    ends = [*found.event_table()["time"], 1.5]
    motions = hole.follow(found, [*START, *SPEED], np.array(OMEGA), np.zeros(3))
    places = found.history.motion(np.array(ends), 0)
    speeds = found.history.motion(np.array(ends), 1)
    for place, speed, expected in zip(places, speeds, motions, strict=True):
        np.testing.assert_allclose(place, expected[:3], rtol=0, atol=1e-8 * 1e-3)
        np.testing.assert_allclose(speed, expected[3:6], rtol=0, atol=1e-8 * 0.03)
    starts = found.impact_table()["start"][1:]
    for place in found.history.motion(np.array(starts), 0):
        assert np.hypot(*place[1:]) == pytest.approx(0.5e-3, rel=1e-12)
    assert found.energy_residual < 1e-10


def problems() -> dict[str, bs.Problem]:
    """What may act in a flight: loads of every kind, moving stops, springs with kinks, coupling."""
    shapes = {("P", "dx"): [1.0, 0.7], ("Q", "dx"): [0.4, -0.9]}
    plain = bs.ModalBasis.from_modes(frequency=[6.0, 21.0], damping=[0.01, 0.02], shapes=shapes)
    wall: dict[str, Any] = {"node": "P", "normal": (-1, 0, 0), "gap": 1e-3, "stiffness": 2e6}
    shaken = bs.HertzStop("wall", **wall)
    moving = bs.HertzStop("wall", **wall, motion=bs.Harmonic(frequency=9.0, sine=2e-4))
    quake = bs.TimeTable(
        times=[0.0, 0.11, 0.2, 0.34, 0.5], values=[0.0, 2.0, -3.0, 1.0, 0.0], beyond="hold"
    )
    pushes = [
        bs.NodalForce("hum", node="Q", force=(4, 0, 0), time=bs.Harmonic(frequency=5.0, sine=1.0)),
        bs.NodalForce("shock", node="P", force=(5, 0, 0), time=quake),
        bs.NodalForce("weight", node="P", force=(1, 0, 0)),
    ]
    kinked = bs.SpringLaw(
        "kinked",
        node="Q",
        direction=(1, 0, 0),
        stiffness=[200.0, 1600.0, 800.0],
        breaks=[0.0, 5e-4],
    )
    dashpot = bs.DamperLaw("dashpot", node="Q", direction=(1, 0, 0), damping=[3.0])
    initial = bs.ModalState(displacement=[0.0, 0.0], velocity=[0.05, 0.02])
    cases: dict[str, tuple[bs.ModalBasis, list[Any], list[Any]]] = {
        "loads": (plain, [shaken], pushes),
        "moving": (plain, [moving], []),
        "springs": (plain, [shaken, kinked, dashpot], pushes),
    }
    return {
        name: bs.Problem(basis, laws=laws, loads=loads, initial=initial, duration=0.6)
        for name, (basis, laws, loads) in cases.items()
    }


@pytest.mark.parametrize("name", ["loads", "moving", "springs"])
def test_flights_are_what_steps_make_of_them(name: str) -> None:
    problem = problems()[name]
    flown, stepped = (
        bs.simulate(problem, "dop853", rtol=1e-12, exact_flights=each) for each in (True, False)
    )
    assert flown.steps < stepped.steps
    assert len(flown.impact_table()["start"]) >= 2
    one, other = flown.event_table(), stepped.event_table()
    assert one["after"] == other["after"]
    assert one["time"] == pytest.approx(other["time"], rel=0, abs=1e-9)
    times = np.linspace(0.0, 0.6, 500)
    for what, largest in (("displacement", 1e-3), ("velocity", 0.1)):
        found, expected = (each.sample(what, "P", "dx", times=times) for each in (flown, stepped))
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * largest)
    energies = [each.at(times).energy for each in (flown, stepped)]
    largest_energy = float(energies[1]["total"].max())
    for column in ("kinetic", "elastic", "dissipated_damping", "load_work", "obstacle_work"):
        found, expected = (each[column].values for each in energies)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * largest_energy)
    assert flown.energy_residual < 1e-10


def test_flights_are_taken_unless_they_are_not_wanted() -> None:
    law = Hole(3e-3, stiffness=1e5).stop()
    flown, stepped = thrown(law, 1.0, exact_flights=None), thrown(law, 1.0, exact_flights=False)
    assert (flown.steps, flown.event_count) == (1, 0)
    assert stepped.steps > 20
    assert stepped.options["exact_flights"] is False


def test_what_is_no_choice_is_refused() -> None:
    law = Hole(3e-3, stiffness=1e5).stop()
    with pytest.raises(bs.InputError, match="exact_flights"):
        thrown(law, 1.0, exact_flights="yes")
    with pytest.raises(bs.InputError, match="exact_flights"):
        thrown(law, 1.0, method="newmark", dt=1e-3, exact_flights=True)
