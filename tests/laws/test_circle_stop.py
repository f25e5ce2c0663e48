"""Round obstacles: planes along a radius, closed forms, SciPy, turns of the frame, bad input."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

import bumpstop as bs
from tests.laws.round_hole import Hole, free_mass

SMOOTH = Hole(reach=1e-3, stiffness=1e5)


def run(
    law: bs.Stop | bs.CircleStop,
    velocity: tuple[float, float, float],
    duration: float,
    *,
    displacement: tuple[float, float, float] = (0.0, 0.0, 0.0),
    force: tuple[float, float, float] = (0.0, 0.0, 0.0),
    omega: tuple[float, float, float] = (0.0, 0.0, 0.0),
    rtol: float = 1e-12,
) -> bs.Response:
    initial = bs.ModalState(displacement=list(displacement), velocity=list(velocity))
    loads = [bs.NodalForce("push", node="P", force=force)] if any(force) else []
    problem = bs.Problem(
        free_mass(omega), laws=[law], loads=loads, initial=initial, duration=duration
    )
    return bs.simulate(problem, rtol=rtol)


@pytest.mark.parametrize("damping", [0.0, 40.0])
@pytest.mark.parametrize("angle", [0.0, 0.4, 2.5, -1.1])
def test_along_a_radius_it_is_a_plane(angle: float, damping: float) -> None:
    """The exact method solves that of the plane."""
    cos, sin = math.cos(angle), math.sin(angle)
    omega = (0.0, 30.0, 30.0)
    plane = bs.Stop(
        "hole", node="P", normal=(0, -cos, -sin), gap=1e-3, stiffness=1e5, damping=damping
    )
    ring = Hole(1e-3, 1e5, damping).stop()
    velocity = (0.0, 0.2 * cos, 0.2 * sin)
    exact, found = (run(law, velocity, 0.02, omega=omega) for law in (plane, ring))
    assert exact.method == "exact"
    assert found.method == "dop853"
    assert "round" in found.method_reason
    times = np.linspace(0.0, 0.02, 40)
    for dof in ("dy", "dz"):
        both = [each.sample("displacement", "P", dof, times=times) for each in (exact, found)]
        np.testing.assert_allclose(both[1], both[0], rtol=0, atol=1e-9 * 2e-3)
    one, other = exact.impact_table(), found.impact_table()
    for column in ("start", "end", "peak_force", "impulse", "closing_speed", "opening_speed"):
        assert other[column][0] == pytest.approx(one[column][0], rel=1e-9)
    assert (
        found.event_table()["after"][: 2 + bool(damping)]
        == exact.event_table()["after"][: 2 + bool(damping)]
    )
    assert found.energy_residual < 1e-10


def test_a_mass_runs_round_the_hole_on_a_circle() -> None:
    """Where the push is what turns it, k (r - R) = v^2 / r, the radius stays."""
    radius = 1.2e-3
    speed = math.sqrt(radius * 1e5 * (radius - 1e-3))
    found = run(SMOOTH.stop(), (0.0, 0.0, speed), 0.05, displacement=(0.0, radius, 0.0))
    times = np.linspace(0.0, 0.05, 50)
    turn = speed / radius * times
    for dof, place in (("dy", np.cos(turn)), ("dz", np.sin(turn))):
        sampled = found.sample("displacement", "P", dof, times=times)
        np.testing.assert_allclose(sampled, radius * place, rtol=0, atol=1e-9 * radius)
    assert found.event_count == 0
    assert found.sample("stop_force", "hole", times=times) == pytest.approx(20.0, rel=1e-9)


FRICTION = Hole(
    reach=1e-3,
    stiffness=2e5,
    damping=30.0,
    static=0.5,
    dynamic=0.3,
    tangential_stiffness=1e5,
    tangential_damping=60.0,
)


@pytest.mark.parametrize(
    "hole",
    [FRICTION, FRICTION._replace(static=0.2, dynamic=0.2), FRICTION._replace(damping=0.0)],
)
def test_it_agrees_with_an_integration_by_scipy(hole: Hole) -> None:
    omega, force = np.array([25.0, 60.0, 45.0]), np.array([0.0, 12.0, -6.0])
    start = [0.0, 2e-4, -3e-4, 0.15, 0.35, 0.2]
    found = run(
        hole.stop(),
        (0.15, 0.35, 0.2),
        0.12,
        displacement=(0.0, 2e-4, -3e-4),
        force=(0.0, 12.0, -6.0),
        omega=(25.0, 60.0, 45.0),
    )
    table = found.event_table()
    assert {"stick", "slip", "open"} <= set(table["after"])
    ends = [*table["time"], 0.12]
    motions = hole.follow(found, start, omega, force)
    q = found.history.motion(np.array(ends), 0)
    v = found.history.motion(np.array(ends), 1)
    for place, speed, expected in zip(q, v, motions, strict=True):
        np.testing.assert_allclose(place, expected[:3], rtol=0, atol=1e-8 * 2e-3)
        np.testing.assert_allclose(speed, expected[3:6], rtol=0, atol=1e-8 * 0.5)
    assert found.energy_residual < 1e-9
    assert len(ends) > 10


def test_sliding_along_the_axis_ends_where_the_closed_form_says() -> None:
    """Under a constant weight the spring's stretch grows as exp says, until the slider holds."""
    weight, speed = 10.0, 0.2
    hole = FRICTION._replace(static=0.3)
    depth = weight / hole.stiffness
    found = run(
        hole.stop(),
        (speed, 0.0, 0.0),
        0.15,
        displacement=(0.0, 1e-3 + depth, 0.0),
        force=(0.0, weight, 0.0),
    )
    limit, c = 0.3 * weight, hole.tangential_damping
    pace = hole.tangential_stiffness / c
    sticks = brentq(
        lambda t: c * (speed - limit * t) - limit * math.exp(-pace * t), 1e-3, 0.1, xtol=1e-15
    )
    table = found.event_table()
    assert table["after"] == ["stick"]
    assert table["time"] == pytest.approx([sticks], rel=1e-9)
    times = np.linspace(0.0, sticks, 20)
    expected = speed * times - 0.5 * limit * times**2
    sampled = found.sample("displacement", "P", "dx", times=times)
    np.testing.assert_allclose(sampled, expected, rtol=0, atol=1e-11)
    rubbing = found.contact_forces("hole")
    assert list(rubbing.direction) == ["normal", "around", "axial"]
    assert rubbing.values[10] == pytest.approx([weight, 0.0, -limit], abs=1e-7)
    work = bs.wear_work(found, "hole").work
    assert work == pytest.approx(weight * expected[-1], rel=1e-6)


def test_a_contact_that_sticks_swings_on_its_spring_and_damper() -> None:
    hole = Hole(1e-3, 1e5, 0.0, 0.9, 0.9, tangential_stiffness=4e4, tangential_damping=80.0)
    found = run(
        hole.stop(),
        (0.0, 0.0, 0.0),
        0.05,
        displacement=(0.0, 1e-3 + 1e-4, 0.0),
        force=(2.0, 10.0, 0.0),
    )
    times = np.linspace(0.0, 0.05, 60)
    rate, omega = 40.0, math.sqrt(4e4 - 1600.0)
    swing = np.exp(-rate * times) * (np.cos(omega * times) + rate / omega * np.sin(omega * times))
    sampled = found.sample("displacement", "P", "dx", times=times)
    np.testing.assert_allclose(sampled, 2.0 / 4e4 * (1.0 - swing), rtol=0, atol=1e-13)
    assert found.event_count == 0
    assert found.energy_residual < 1e-9


@given(angle=st.floats(-3.0, 3.0), roll=st.floats(-3.0, 3.0))
@settings(max_examples=6, deadline=None)
def test_it_is_the_same_in_every_direction(angle: float, roll: float) -> None:
    cos, sin = math.cos(angle), math.sin(angle)

    def turned(y: float, z: float) -> tuple[float, float, float]:
        return (0.0, cos * y - sin * z, sin * y + cos * z)

    both = [
        run(
            FRICTION.stop(roll=by),
            at(0.3, 0.2),
            0.05,
            displacement=at(4e-4, 0.0),
            force=at(9.0, 2.0),
        )
        for at, by in (((lambda y, z: (0.0, y, z)), 0.0), (turned, roll))
    ]
    tables = [each.impact_table() for each in both]
    assert len(tables[0]["start"]) > 2
    for column in ("start", "peak_force", "impulse"):
        assert tables[1][column] == pytest.approx(tables[0][column], rel=1e-7)
    y, z = (both[0].sample("displacement", "P", dof, times=[0.05])[0] for dof in ("dy", "dz"))
    found = [both[1].sample("displacement", "P", dof, times=[0.05])[0] for dof in ("dy", "dz")]
    assert found == pytest.approx(turned(float(y), float(z))[1:], abs=1e-9 * 1e-2)


def two_bodies(law: bs.Stop | bs.CircleStop, velocity: list[float]) -> bs.Response:
    """Bodies of 1 kg and 0.25 kg that fly, 30 mm from each other."""
    shapes = {("A", "dy"): [1.0, 0, 0, 0], ("A", "dz"): [0, 1.0, 0, 0]}
    shapes |= {("B", "dy"): [0, 0, 2.0, 0], ("B", "dz"): [0, 0, 0, 2.0]}
    basis = bs.ModalBasis.from_modes(frequency=[0.0] * 4, damping=[0.0] * 4, shapes=shapes)
    initial = bs.ModalState(velocity=velocity)
    problem = bs.Problem(basis, laws=[law], initial=initial, duration=0.03)
    return bs.simulate(problem, rtol=1e-12)


def test_two_tubes_side_by_side() -> None:
    """Head on they are planes, and off the line of their centres both momenta stay."""
    tubes = bs.CircleStop(
        "tubes",
        node="A",
        other="B",
        axis=(1, 0, 0),
        centre=(0, 0.03, 0),
        radius=0.015,
        body_radius=0.01,
        side="outside",
        stiffness=1e6,
    )
    plane = bs.Stop("tubes", node="A", other="B", normal=(0, -1, 0), gap=5e-3, stiffness=1e6)
    exact, found = (two_bodies(law, [1.0, 0, 0, 0]) for law in (plane, tubes))
    one, other = exact.impact_table(), found.impact_table()
    for column in ("start", "end", "peak_force", "impulse"):
        assert other[column] == pytest.approx(one[column], rel=1e-9)
    oblique = two_bodies(tubes, [1.0, 0.6, 0.0, 0.0])
    impact = oblique.impact_table()
    assert len(impact["start"]) == 1
    before, after = (oblique.history.motion(np.array([t]), 1)[0] for t in (0.0, 0.03))
    mass = np.array([1.0, 1.0, 0.5, 0.5])
    for first in (0, 1):
        assert (mass * after)[first::2].sum() == pytest.approx((mass * before)[first::2].sum())
    assert 0.5 * after @ after == pytest.approx(0.5 * before @ before, rel=1e-10)


def test_a_tube_within_a_tube_and_a_case_file_agree(tmp_path: Any) -> None:
    """The shell is far heavier than the tube in it, which is at its place."""
    path = tmp_path / "case.toml"
    path.write_text(
        """
title = "A tube in a sleeve"
[nodes]
T = [0.0, 0.0, 0.0]
S = [0.0, 0.2e-3, 0.0]
[masses.tube]
node = "T"
mass = 1.0
[masses.sleeve]
node = "S"
mass = 1e9
[[supports]]
nodes = ["T", "S"]
fixed = ["dx", "drx", "dry", "drz"]
[basis]
modes = 4
rigid_modes = 4
[stops.hole]
node = "T"
other = "S"
obstacle = "circle"
axis = [1, 0, 0]
radius = "11 mm"
body_radius = "10 mm"
stiffness = "100 kN/m"
[initial]
translation = { velocity = [0.0, 0.3, 0.0], nodes = ["T"] }
[run]
duration = "10 ms"
rtol = 1e-12
"""
    )
    case = bs.load_case(path)
    problem = case.problems["base"]
    found = bs.simulate(problem, rtol=1e-12)
    impacts = found.impact_table()
    assert impacts["start"] == pytest.approx([1.2e-3 / 0.3], rel=1e-9)
    assert impacts["peak_force"] == pytest.approx([0.3 * math.sqrt(1e5)], rel=1e-8)


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.2])
def test_a_tube_lies_on_the_floor_of_its_hole(angle: float) -> None:
    """It rests where the weight has pressed it in, and stays there when the run begins."""
    weight = (0.0, 12.0 * math.cos(angle), 12.0 * math.sin(angle))
    law = FRICTION.stop(centre=(0.0, 2e-4, -1e-4))
    load = bs.NodalForce("weight", node="P", force=weight)
    basis = free_mass()
    start = bs.StaticState(loads=[load], laws=[law])
    place = start.modal_state(basis)[0]
    reach = 1e-3 + 12.0 / FRICTION.stiffness
    expected = [0.0, 2e-4 + reach * math.cos(angle), -1e-4 + reach * math.sin(angle)]
    assert place.tolist() == pytest.approx(expected, abs=1e-12)
    problem = bs.Problem(basis, laws=[law], loads=[load], initial=start, duration=0.01)
    found = bs.simulate(problem)
    assert found.history.motion(np.array([0.01]), 0)[0] == pytest.approx(expected, abs=1e-12)
    assert found.sample("stop_force", "hole", times=[0.01]) == pytest.approx([12.0], rel=1e-9)


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ({"radius": 0.0}, "radius"),
        ({"body_radius": 2e-3}, "body_radius"),
        ({"body_radius": -1e-3}, "body_radius"),
        ({"side": "above"}, "side"),
        ({"axis": (0, 0, 0)}, "axis"),
        ({"stiffness": -1.0}, "stiffness"),
        ({"other": "P"}, "other"),
        ({"friction": 0.2}, "tangential_stiffness"),
        ({"tangential_stiffness": 1e5}, "tangential_stiffness"),
        (
            {"friction": 0.2, "tangential_stiffness": 1e5, "tangential_damping": 0.0},
            "tangential_damping",
        ),
        ({"centre": (0, 1)}, "centre"),
    ],
)
def test_bad_input_is_refused(wrong: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        SMOOTH.stop(**wrong)
    assert caught.value.key == key


def test_a_node_outside_its_hole_is_told() -> None:
    law = SMOOTH.stop(centre=(0, 5e-3, 0))
    problem = bs.Problem(free_mass(), laws=[law], duration=1e-3)
    assert problem.warnings == (
        "stop 'hole': its gap of -0.004 m is closed from the start, and it pushes at once; an "
        "equilibrium under the loads, [initial.static], would start at rest",
    )


def test_the_damping_of_the_stick_is_critical_where_it_is_left_out() -> None:
    law = FRICTION.stop(tangential_damping=None)
    assert law.stick_damping(free_mass()) == pytest.approx(2.0 * math.sqrt(1e5))


@pytest.mark.parametrize("method", ["newmark", "hht", "trbdf2", "devogelaere"])
def test_classical_schemes_take_it_without_friction(method: str) -> None:
    """With smaller steps they come to where the adaptive method is."""
    problem = bs.Problem(
        free_mass((0.0, 40.0, 40.0)),
        laws=[Hole(1e-3, 1e5, 30.0).stop()],
        initial=bs.ModalState(displacement=[0.0, 2e-4, 0.0], velocity=[0.0, 0.2, 0.1]),
        duration=0.05,
    )

    def place(response: bs.Response) -> float:
        return float(response.sample("displacement", "P", "dz", times=[0.05])[0])

    wanted = place(bs.simulate(problem, rtol=1e-11))
    errors = [abs(place(bs.simulate(problem, method, dt=dt)) - wanted) for dt in (4e-5, 1e-5)]
    assert errors[1] < 0.1 * errors[0] < 1e-7


@pytest.mark.parametrize("method", ["newmark", "central_difference"])
def test_friction_in_two_directions_is_for_adaptive_methods(method: str) -> None:
    problem = bs.Problem(free_mass(), laws=[FRICTION.stop()], duration=1e-3)
    with pytest.raises(bs.InputError, match=r"'hole'.*round.*dop853"):
        bs.simulate(problem, method, dt=1e-6)


def test_the_method_for_linear_laws_refuses_it() -> None:
    problem = bs.Problem(free_mass(), laws=[SMOOTH.stop()], duration=1e-3)
    with pytest.raises(bs.InputError, match=r"'hole'.*round.*dop853"):
        bs.simulate(problem, "exact")
