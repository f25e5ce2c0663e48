"""Polygonal obstacles: planes, many sides, corners, bad input."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import bumpstop as bs
from tests.laws.round_hole import free_mass

STIFFNESS = 1e5


def regular(sides: int, inner: float = 1e-3, turned: float = 0.0) -> list[tuple[float, float]]:
    """Corners of a regular polygon about a circle."""
    outer = inner / math.cos(math.pi / sides)
    return [(turned + 2.0 * math.pi * n / sides, outer) for n in range(sides)]


def stop(profile: Any, **changes: Any) -> bs.PolarStop:
    usual: dict[str, Any] = {"node": "P", "axis": (1, 0, 0), "stiffness": STIFFNESS}
    return bs.PolarStop("hole", profile=profile, **usual | changes)


def run(
    laws: list[Any],
    velocity: tuple[float, float, float],
    *,
    displacement: tuple[float, float, float] = (0.0, 0.0, 0.0),
    duration: float = 0.05,
) -> bs.Response:
    initial = bs.ModalState(displacement=list(displacement), velocity=list(velocity))
    problem = bs.Problem(
        free_mass((0.0, 40.0, 40.0)), laws=laws, initial=initial, duration=duration
    )
    return bs.simulate(problem, rtol=1e-12)


@pytest.mark.parametrize("damping", [0.0, 30.0])
def test_a_square_is_four_planes(damping: float) -> None:
    planes = [
        bs.Stop(name, node="P", normal=normal, gap=1e-3, stiffness=STIFFNESS, damping=damping)
        for name, normal in {
            "top": (0, -1, 0),
            "foot": (0, 1, 0),
            "left": (0, 0, 1),
            "right": (0, 0, -1),
        }.items()
    ]
    square = stop(regular(4, turned=math.pi / 4.0), damping=damping)
    at: dict[str, Any] = {"displacement": (0.0, 3e-4, -1e-4), "duration": 0.15}
    exact, found = (run(laws, (0.0, 0.2, 0.011), **at) for laws in (planes, [square]))
    assert exact.method == "exact"
    assert len(exact.impact_table()["start"]) > 3
    times = np.linspace(0.0, 0.15, 50)
    for dof in ("dy", "dz"):
        both = [each.sample("displacement", "P", dof, times=times) for each in (exact, found)]
        np.testing.assert_allclose(both[1], both[0], rtol=0, atol=1e-8 * 2e-3)
    starts = np.sort(exact.impact_table()["start"])
    assert found.impact_table()["start"] == pytest.approx(starts, rel=1e-8)
    assert found.energy_residual < 1e-9


def test_many_sides_are_a_circle() -> None:
    circle = bs.CircleStop("hole", node="P", axis=(1, 0, 0), radius=1e-3, stiffness=STIFFNESS)
    times = np.linspace(0.0, 0.02, 30)
    start: dict[str, Any] = {"displacement": (0.0, 2e-4, -3e-4), "duration": 0.02}
    found = {
        name: run([law], (0.0, 0.2, 0.1), **start).sample("displacement", "P", "dz", times=times)
        for name, law in {"round": circle, 90: stop(regular(90)), 720: stop(regular(720))}.items()
    }
    errors = [np.abs(found[sides] - found["round"]).max() for sides in (90, 720)]
    assert errors[0] < 3e-6
    assert errors[1] < 0.1 * errors[0]


def test_a_mass_that_is_pressed_past_a_corner() -> None:
    """Of a regular polygon the depth is the same on both sides of a corner, its slope is not."""
    sides = regular(6)
    found = run([stop(sides)], (0.0, 0.4, 1.0), displacement=(0.0, 9e-4, -3e-4), duration=0.004)
    events = found.event_table()
    assert "corner" in events["guard"]
    states = [str(found.sample("state", "hole", times=[0.0])[0]), *events["after"]]
    assert any(state.startswith("closed") for state in states)

    def rates(_: float, y: Any) -> Any:
        """From any sector: the one that the place is in."""
        place = y[:2]
        side = math.floor(math.atan2(place[1], place[0]) / (math.pi / 3.0))
        outwards = np.array(
            [math.cos((side + 0.5) * math.pi / 3.0), math.sin((side + 0.5) * math.pi / 3.0)]
        )
        depth = max(0.0, outwards @ place - 1e-3)
        return [*y[2:], *(-1600.0 * place - STIFFNESS * depth * outwards)]

    y, at = np.array([9e-4, -3e-4, 0.4, 1.0]), 0.0
    for end in [*events["time"], 0.004]:
        y = solve_ivp(rates, (at, end), y, method="DOP853", rtol=1e-11, atol=1e-14).y[:, -1]
        at = end
    place = [found.sample("displacement", "P", dof, times=[0.004])[0] for dof in ("dy", "dz")]
    assert place == pytest.approx(y[:2].tolist(), abs=1e-7 * 1e-3)
    assert found.energy_residual < 1e-9


@given(angle=st.floats(-3.0, 3.0))
@settings(max_examples=6, deadline=None)
def test_a_profile_turns_with_the_roll(angle: float) -> None:
    corners = [(0.1, 1.2e-3), (1.7, 1.0e-3), (3.0, 1.5e-3), (4.4, 1.1e-3)]
    cos, sin = math.cos(angle), math.sin(angle)
    both = [
        run([stop(corners, roll=roll)], velocity, duration=0.12)
        for roll, velocity in (
            (0.0, (0.0, 0.2, 0.1)),
            (angle, (0.0, 0.2 * cos - 0.1 * sin, 0.2 * sin + 0.1 * cos)),
        )
    ]
    tables = [each.impact_table() for each in both]
    assert len(tables[0]["start"]) > 2
    for column in ("start", "peak_force", "impulse"):
        assert tables[1][column] == pytest.approx(tables[0][column], rel=1e-7)


def test_two_planes_and_rows_of_nodes_in_a_case_file(tmp_path: Any) -> None:
    path = tmp_path / "case.toml"
    path.write_text(
        """
title = "Guides along a beam"
[nodes]
A = [0.0, 0.0, 0.0]
B = [1.0, 0.0, 0.0]
[materials.steel]
young_modulus = "210 GPa"
poisson_ratio = 0.3
density = 7800.0
[sections.rod]
shape = "circle"
radius = "10 mm"
[beams.AB]
nodes = ["A", "B"]
elements = 6
material = "steel"
section = "rod"
[[supports]]
nodes = ["A"]
fixed = ["dx", "dy", "dz", "drx", "dry", "drz"]
[[supports]]
nodes = "all"
fixed = ["dx", "drx"]
[basis]
modes = 6
[stops.guide]
nodes = ["AB.3", "B"]
obstacle = "two_planes"
normal = [0, 1, 0]
gap = "12 mm"
half_thickness = "10 mm"
stiffness = 1e5
[stops.hole]
nodes = ["AB.3", "B"]
obstacle = "polar"
axis = [1, 0, 0]
profile = [["0 deg", "3 mm"], ["120 deg", "3 mm"], ["240 deg", "3 mm"]]
stiffness = 1e5
[run]
duration = "10 ms"
"""
    )
    laws = bs.load_case(path).problems["base"].laws
    names = [law.name for law in laws]
    planes = ["guide.AB.3+", "guide.AB.3-", "guide.B+", "guide.B-"]
    assert names == [*planes, "hole.AB.3", "hole.B"]
    facing = [law for law in laws if isinstance(law, bs.Stop)]
    assert [law.gap for law in facing] == pytest.approx([2e-3] * 4)
    assert facing[1].normal == (-0.0, -1.0, -0.0)
    assert laws[-1].coordinate.node == "B"


@pytest.mark.parametrize(
    ("profile", "key"),
    [
        ([(0.0, 1.0), (1.0, 1.0)], "profile"),
        ([(0.0, 1.0), (2.0, 1.0), (1.0, 1.0), (4.0, 1.0)], "profile[1]"),
        ([(0.0, 1.0), (1.0, 1.0), (5.0, 1.0)], "profile[1]"),
        ([(0.0, 1.0), (1.0, 1.0), (2.0, 1.0)], "profile[2]"),
        ([(0.0, 1.0), (2.0, 0.0), (4.0, 1.0)], "profile[1]"),
        ([(0.0, 1.0), (2.0, 1.0), (4.0, 1.0), (7.0, 1.0)], "profile[3]"),
        ("round", "profile"),
    ],
)
def test_bad_profiles_are_refused(profile: Any, key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        stop(profile)
    assert caught.value.key == key


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        ("", "axis: is missing"),
        ("axis = [1, 0, 0]", "radius: is missing"),
        ("axis = [1, 0, 0]\ngap = 1e-3\nradius = 1e-3", "gap: is told by the radii already"),
        ("axis = [1, 0, 0]\ngap = 1e-3\nnormal = [0, 1, 0]", "normal: is of no use to a circle"),
        ("axis = [1, 0, 0]\ngap = 1e-3\nexponent = 1.5", "exponent: is of no use to a circle"),
    ],
)
def test_keys_that_do_not_go_together_are_told(tmp_path: Any, lines: str, told: str) -> None:
    path = tmp_path / "case.toml"
    path.write_text(
        f"""
title = "A hole"
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
[stops.hole]
node = "P"
obstacle = "circle"
stiffness = 1e5
{lines}
[run]
duration = 1.0
"""
    )
    with pytest.raises(bs.InputError) as caught:
        bs.load_case(path)
    assert f"stops.hole.{told}" in str(caught.value)
