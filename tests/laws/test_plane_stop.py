"""Friction on a plane in two directions: closed forms, SciPy, one direction, bad input."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import bumpstop as bs
from tests.laws.round_hole import free_mass

WEIGHT, STIFFNESS, TANGENTIAL, DAMPING = 10.0, 1e5, 2e5, 100.0
DEPTH = WEIGHT / STIFFNESS


def floor(**changes: Any) -> bs.PlaneStop:
    usual: dict[str, Any] = {
        "node": "P",
        "normal": (0, 0, 1),
        "stiffness": STIFFNESS,
        "friction": 0.3,
        "tangential_stiffness": TANGENTIAL,
        "tangential_damping": DAMPING,
    }
    return bs.PlaneStop("floor", **usual | changes)


def slide(
    law: Any, velocity: tuple[float, float, float], duration: float, *, side: float = 0.0
) -> bs.Response:
    """A block of 1 kg, pressed in by its weight and pushed along y."""
    initial = bs.ModalState(displacement=[0.0, 0.0, -DEPTH], velocity=list(velocity))
    load = bs.NodalForce("load", node="P", force=(0.0, side, -WEIGHT))
    problem = bs.Problem(free_mass(), laws=[law], loads=[load], initial=initial, duration=duration)
    return bs.simulate(problem, rtol=1e-12)


@given(angle=st.floats(-3.0, 3.0))
@settings(max_examples=8, deadline=None)
def test_a_block_slides_straight_whatever_the_direction(angle: float) -> None:
    cos, sin = math.cos(angle), math.sin(angle)
    found = slide(floor(), (0.6 * cos, 0.6 * sin, 0.0), 0.25)
    # The spring is stretched as exp says, and the slider holds when it and the damper can.
    sticks = brentq(
        lambda t: DAMPING * (0.6 - 3.0 * t) - 3.0 * math.exp(-TANGENTIAL / DAMPING * t),
        0.1,
        0.2,
        xtol=1e-15,
    )
    table = found.event_table()
    assert table["after"] == ["stick"]
    assert table["time"] == pytest.approx([sticks], rel=1e-10)
    times = np.linspace(0.0, sticks, 30)
    path = 0.6 * times - 1.5 * times**2
    for dof, part in (("dx", cos), ("dy", sin)):
        sampled = found.sample("displacement", "P", dof, times=times)
        np.testing.assert_allclose(sampled, part * path, rtol=0, atol=1e-11)
    # The stick then springs back, and what is left of the speed swings out on it.
    place = [found.sample("displacement", "P", dof, times=[0.25])[0] for dof in ("dx", "dy")]
    assert math.hypot(*place) == pytest.approx(0.6**2 / 6.0, abs=6.0 / TANGENTIAL)
    assert found.energy_residual < 1e-10


def test_a_force_across_bends_the_path() -> None:
    """Sliding, the block gives way to the slightest force across: SciPy follows it."""
    found = slide(floor(), (0.6, 0.0, 0.0), 0.15, side=1.5)
    assert set(found.event_table()["after"]) <= {"stick", "slip"}

    def rates(_: float, y: Any) -> Any:
        speed, stretch = y[2:4], y[4:]
        held = TANGENTIAL * stretch + DAMPING * speed
        size = np.hypot(*held)
        rub = held * min(1.0, 0.3 * WEIGHT / size) if size > 0.0 else held
        return [*speed, -rub[0], 1.5 - rub[1], *((rub - TANGENTIAL * stretch) / DAMPING)]

    y, at = np.array([0.0, 0.0, 0.6, 0.0, 0.0, 0.0]), 0.0
    for end in [*found.event_table()["time"], 0.15]:
        y = solve_ivp(rates, (at, end), y, method="DOP853", rtol=1e-12, atol=1e-16).y[:, -1]
        at = end
    place = found.history.motion(np.array([0.15]), 0)[0, :2]
    speed = found.history.motion(np.array([0.15]), 1)[0, :2]
    assert place == pytest.approx(y[:2].tolist(), abs=1e-9 * 0.06)
    assert speed == pytest.approx(y[2:4].tolist(), abs=1e-8 * 0.6)
    assert place[1] > 1e-3


def test_a_steady_slide_is_that_of_one_direction() -> None:
    """The exact method's friction has its damper in the stick alone: the start differs a little."""
    one = bs.Stop(
        "floor",
        node="P",
        normal=(0, 0, 1),
        stiffness=STIFFNESS,
        friction=0.3,
        sliding=(1, 0, 0),
        tangential_stiffness=TANGENTIAL,
        tangential_damping=DAMPING,
    )
    both = [slide(law, (0.6, 0.0, 0.0), 0.18) for law in (one, floor())]
    assert [each.method for each in both] == ["exact", "dop853"]
    places = [each.sample("displacement", "P", "dx", times=[0.18])[0] for each in both]
    assert places[1] == pytest.approx(places[0], rel=1e-3)


def test_a_case_file_says_it(tmp_path: Any) -> None:
    path = tmp_path / "case.toml"
    path.write_text(
        """
title = "A block on a floor"
[nodes]
P = [0.0, 0.0, 0.0]
[masses.P]
node = "P"
mass = 1.0
[[supports]]
nodes = ["P"]
fixed = ["drx", "dry", "drz"]
[basis]
modes = 3
rigid_modes = 3
[stops.floor]
node = "P"
normal = [0, 0, 1]
stiffness = 1e5
friction = 0.3
tangential_stiffness = 2e5
sliding = "plane"
[run]
duration = 0.1
"""
    )
    (law,) = bs.load_case(path).problems["base"].laws
    assert isinstance(law, bs.PlaneStop)
    assert law.stick_damping(free_mass()) == pytest.approx(2.0 * math.sqrt(2e5))


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ({"normal": (0, 0, 0)}, "normal"),
        ({"gap": float("inf")}, "gap"),
        ({"friction": -0.1}, "friction"),
        ({"tangential_damping": 0.0}, "tangential_damping"),
        ({"friction": None, "tangential_stiffness": None, "tangential_damping": None}, "friction"),
    ],
)
def test_bad_input_is_refused(wrong: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        floor(**wrong)
    assert caught.value.key == key
