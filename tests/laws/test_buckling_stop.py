"""Stops that buckle: closed forms stage by stage, energies, tables, bad input."""

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import bumpstop as bs

from .one_mass import one_mass, runge_kutta
from .stretches import Change, Stretch, in_stretches


def stop(**changes: Any) -> bs.BucklingStop:
    usual: dict[str, Any] = {
        "node": "P",
        "normal": (-1, 0, 0),
        "stiffness": 1.0,
        "critical_force": 1.0,
        "post_force": 0.5,
    }
    return bs.BucklingStop("stop", **usual | changes)


def test_each_stage_is_its_closed_form() -> None:
    """Elastic to pi/6, braked by 0.5 N to x = 4, unloaded at 0.5 N/m, free from x = 3 on."""
    response = bs.simulate(one_mass(stop(), speed=2.0, duration=12.0), "exact")
    turn = np.pi / 6 + 2 * np.sqrt(3)
    free = turn + np.pi / np.sqrt(2)
    times = response.event_table()["time"]
    assert times == pytest.approx([np.pi / 6, turn, free], rel=1e-13)
    x = response.sample("displacement", "P", "dx", times=[np.pi / 12, turn, free, free + 1.0])
    assert x == pytest.approx([2 * np.sin(np.pi / 12), 4.0, 3.0, 3 - 1 / np.sqrt(2)], rel=1e-13)
    lost = response.energy_terms([12.0])["dissipated_stops"][0]
    assert lost == pytest.approx(2.0 - 0.25, rel=1e-13)
    assert response.energy_residual < 1e-13


def test_a_plateau_is_walked_over() -> None:
    """Over 0.6 m at 1 N; it unloads from the plateau along a line to the residual crushing."""
    law = stop(plateau=0.6, unloading_stiffness=1.0)
    speed = np.sqrt(2 * (0.5 + 0.3))
    response = bs.simulate(one_mass(law, speed=speed, duration=6.0), "exact")
    turn = response.sample("displacement", "P", "dx", times=[response.event_table()["time"][1]])
    assert turn[0] == pytest.approx(1.3, rel=1e-13)
    # From (1.3, 1 N) to (0.8, 0): 2 N/m give back 0.25 J.
    end = response.sample("velocity", "P", "dx", times=[6.0])[0]
    assert 0.5 * end**2 == pytest.approx(0.25, rel=1e-12)
    assert response.energy_residual < 1e-13


@pytest.mark.parametrize(
    ("changes", "method"),
    [
        ({"fall": 0.8}, "dop853"),
        ({"fall": 0.8, "plateau": 0.2, "damping": 0.1, "post_damping": 0.2}, "rk54"),
        ({"unloading_stiffness": [(0.2, 0.8), (1.0, 1.6), (3.0, 2.0)]}, "dop853"),
        ({"post_damping": 0.15, "damping": 0.05}, "exact"),
    ],
)
def test_bouncing_between_two_agrees_with_tiny_steps(changes: dict[str, Any], method: str) -> None:
    """A spring pulls the mass back to the stop over and over; a program of its own follows it."""
    law = stop(**changes)
    problem = one_mass(law, place=-1.0, speed=2.2, frequency=0.15, duration=9.0)
    options: dict[str, Any] = {} if method == "exact" else {"rtol": 1e-11}
    response = bs.simulate(problem, method, **options)
    points = np.array(law.unloading)
    start = law.critical_force / law.stiffness
    grid = np.linspace(0.0, 8.0, 80001)
    largest = grid + law.post_force / np.interp(grid, *points.T)
    memory = {"largest": 0.0}

    def loading(s: float) -> float:
        ends = [start + law.plateau, start + law.plateau + law.fall]
        forces = [law.critical_force, law.post_force]
        return float(np.interp(s, ends, forces)) if law.fall else forces[s >= ends[0]]

    def force(x: float, v: float) -> float:
        s, m = x, memory["largest"]
        if m < start and s < start:
            return max(0.0, law.stiffness * s + law.damping * v) if s > 0.0 else 0.0
        if s >= m:
            return max(0.0, loading(s) + law.post_damping * v)
        residual = float(np.interp(m, largest, grid)) if m > largest[0] else 0.0
        if s <= residual:
            return 0.0
        slope = loading(m) / (m - residual)
        return max(0.0, slope * (s - residual) + law.post_damping * v)

    def after(state: list[float]) -> list[float]:
        if state[0] >= start:
            memory["largest"] = max(memory["largest"], state[0])
        return state

    omega = 2 * np.pi * 0.15
    states = np.array(
        runge_kutta(
            lambda _, y: [y[1], -(omega**2) * y[0] - force(y[0], y[1])],
            [-1.0, 2.2],
            9.0,
            9000,
            after,
        )
    )
    x = response.sample("displacement", "P", "dx", times=np.linspace(0.0, 9.0, 91))
    assert np.abs(x - states[::100, 0]).max() < 3e-3
    assert memory["largest"] > start
    assert response.energy_residual < (1e-12 if response.method == "exact" else 1e-7)
    assert len(response.event_table()["time"]) >= 4


@pytest.mark.parametrize(
    "changes",
    [
        {"fall": 0.8},
        {"fall": 0.5, "plateau": 0.3},
        {"unloading_stiffness": [(0.2, 0.8), (1.0, 1.6), (3.0, 2.0)]},
        {"fall": 0.4, "unloading_stiffness": [(0.0, 0.9), (0.7, 1.4)]},
    ],
)
def test_force_and_motion_are_those_of_scipy(changes: dict[str, Any]) -> None:
    """Each stage by SciPy at 1e-12, from event to event; residual crushings by a root finder."""
    law = stop(**changes)
    problem = one_mass(law, place=-1.0, speed=2.2, frequency=0.15, duration=9.0)
    omega, points = 2 * np.pi * 0.15, np.array(law.unloading)
    start = law.critical_force / law.stiffness
    ends = [start, start + law.plateau, start + law.plateau + law.fall]

    def residual(largest: float) -> float:
        def excess(p: float) -> float:
            return float(p + law.post_force / np.interp(p, *points.T) - largest)

        return 0.0 if excess(0.0) >= 0.0 else float(brentq(excess, 0.0, largest, xtol=1e-15))

    def stretch(force: Any, *changes: Change) -> Stretch:
        return Stretch(lambda _, y: [y[1], -(omega**2) * y[0] - force(y[0])], [*changes])

    def falling(s: float) -> float:
        fallen = law.critical_force - law.post_force
        return law.critical_force - fallen * (s - ends[1]) / law.fall

    def loading(s: float) -> Stretch:
        force: Any = falling
        kink = ends[2]
        if s < ends[1] - 1e-9:
            force, kink = (lambda _: law.critical_force), ends[1]
        elif s >= ends[2] - 1e-9:
            force, kink = (lambda _: law.post_force), np.inf
        turn = Change(lambda y: y[1], -1.0, lambda y: unloading(y[0], force(y[0])))
        if not np.isfinite(kink):
            return stretch(force, turn)
        return stretch(force, turn, Change(lambda y: y[0] - kink, 1.0, lambda y: loading(y[0])))

    def unloading(largest: float, top: float) -> Stretch:
        left = residual(largest)
        on = Change(lambda y: y[0] - largest, 1.0, lambda y: loading(y[0]))
        off = Change(lambda y: y[0] - left, -1.0, lambda _: free(largest, top))
        return stretch(lambda s: top * (s - left) / (largest - left), on, off)

    def free(largest: float, top: float) -> Stretch:
        left = residual(largest)
        on = Change(lambda y: y[0] - left, 1.0, lambda _: unloading(largest, top))
        return stretch(lambda _: 0.0, on)

    elastic = stretch(
        lambda s: law.stiffness * s, Change(lambda y: y[0] - start, 1.0, lambda y: loading(y[0]))
    )
    first = stretch(lambda _: 0.0, Change(lambda y: y[0], 1.0, lambda _: elastic))
    times = np.linspace(0.0, 9.0, 91)
    x, _ = in_stretches(first, [-1.0, 2.2], times).T
    response = bs.simulate(problem, "dop853", rtol=1e-12)
    found = response.sample("displacement", "P", "dx", times=times)
    assert np.abs(found - x).max() < 1e-8 * np.abs(x).max()
    acceleration = response.sample("acceleration", "P", "dx", times=times)
    force = -response.sample("stop_force", "stop", times=times)
    assert np.abs(acceleration + omega**2 * found - force).max() < 1e-9
    assert len(response.event_table()["time"]) >= 4


def test_fixed_steps_come_to_the_same() -> None:
    problem = one_mass(stop(), speed=2.0, duration=8.0)
    for method in ("symplectic_euler", "central_difference", "devogelaere"):
        response = bs.simulate(problem, method, dt=2e-4)
        x = response.sample("displacement", "P", "dx", times=[3.9877])[0]
        assert x == pytest.approx(4.0, abs=2e-3), method


def test_auto_says_why_it_steps() -> None:
    response = bs.simulate(one_mass(stop(fall=0.1), speed=0.2, duration=1.0))
    assert response.method == "dop853"
    assert "how far its force has fallen" in response.method_reason


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ({"critical_force": 0.0}, "critical_force"),
        ({"post_force": 1.5}, "post_force"),
        ({"plateau": -1.0}, "plateau"),
        ({"unloading_stiffness": 0.4}, "unloading_stiffness"),
        ({"unloading_stiffness": [(0.0, 1.0), (0.0, 2.0)]}, "unloading_stiffness"),
        ({"unloading_stiffness": [(0.0, 0.6), (0.1, 9.0)]}, "unloading_stiffness"),
        ({"post_damping": -0.1}, "post_damping"),
        ({"obstacle": "circle"}, "obstacle"),
    ],
)
def test_bad_input_is_refused(wrong: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        stop(**wrong)
    assert caught.value.key == key
