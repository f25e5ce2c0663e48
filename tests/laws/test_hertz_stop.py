"""Power-law contacts: an independent integration, release, moving obstacles, bad input."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import bumpstop as bs

STIFFNESS = 3e6


def oscillator(stop: bs.Stop | bs.HertzStop, velocity: list[float], duration: float) -> bs.Problem:
    """Two modes that a stop at P couples; the first is rigid."""
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0, 40.0], damping=[0.0, 0.02], shapes={("P", "dx"): [1.0, 0.7]}
    )
    press = bs.NodalForce("press", node="P", force=(-20.0, 0.0, 0.0))
    initial = bs.ModalState(displacement=[0.0, 1e-3], velocity=velocity)
    return bs.Problem(basis, laws=[stop], loads=[press], initial=initial, duration=duration)


def stop(**changes: Any) -> bs.HertzStop:
    usual: dict[str, Any] = {"node": "P", "normal": (1, 0, 0), "gap": 2e-3, "stiffness": STIFFNESS}
    return bs.HertzStop("wall", **usual | changes)


@pytest.mark.parametrize(("exponent", "damping"), [(1.5, 0.0), (1.5, 0.8), (2.3, 0.3), (1.0, 0.5)])
def test_it_agrees_with_an_integration_by_scipy(exponent: float, damping: float) -> None:
    law = stop(
        exponent=exponent, hunt_crossley=damping, stiffness=STIFFNESS * 30 ** (exponent - 1.5)
    )
    problem = oscillator(law, [-0.6, 0.2], 0.3)
    response = bs.simulate(problem, rtol=1e-12)
    row = np.array([1.0, 0.7])
    omega = np.array([0.0, 80.0 * np.pi])

    def rates(_: float, y: Any) -> Any:
        q, v = y[:2], y[2:]
        force = float(law.force([-(law.gap + row @ q)], rate=float(-(row @ v)))[0])
        return [*v, *(row * (force - 20.0) - omega**2 * q - 0.04 * omega * v)]

    # Segment by segment: SciPy is told where the contacts begin and end.
    ends = [*response.event_table()["time"], problem.duration]
    largest = float(np.max(response.impact_table()["peak_force"]))
    state, start = [0.0, 1e-3, -0.6, 0.2], 0.0
    for end in ends:
        run = solve_ivp(rates, (start, end), state, method="DOP853", rtol=1e-13, atol=1e-16)
        state, start = run.y[:, -1], end
        q = response.history.motion(np.array([end]), 0)[0]
        v = response.history.motion(np.array([end]), 1)[0]
        assert q == pytest.approx(state[:2], rel=1e-9, abs=1e-11)  # of 2 mm
        assert v == pytest.approx(state[2:], rel=1e-8, abs=1e-9)
        force = response.sample("stop_force", "wall", times=[end])[0]
        expected = law.force([-(law.gap + row @ state[:2])], rate=float(-(row @ state[2:])))[0]
        assert force == pytest.approx(expected, abs=1e-8 * largest)
    assert len(ends) > 4
    assert response.energy_residual < 1e-10


def test_an_exponent_of_one_is_a_plain_stop() -> None:
    plain = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=2e-3, stiffness=1e5)
    problems = [
        oscillator(law, [-0.6, 0.2], 0.3) for law in (plain, stop(exponent=1.0, stiffness=1e5))
    ]
    exact, found = bs.simulate(problems[0], "exact"), bs.simulate(problems[1], rtol=1e-12)
    assert found.impact_table()["start"] == pytest.approx(exact.impact_table()["start"], rel=1e-12)
    assert found.impact_table()["impulse"] == pytest.approx(
        exact.impact_table()["impulse"], rel=1e-11
    )


def test_a_structure_that_leaves_faster_than_the_stop_relaxes_is_released() -> None:
    """Another load pulls it out: the force never pulls, and the events say so."""
    basis = bs.ModalBasis.from_modes(frequency=[0.0], damping=[0.0], shapes={("P", "dx"): [1.0]})
    pull = bs.NodalForce("pull", node="P", force=(5e3, 0.0, 0.0))
    initial = bs.ModalState(displacement=[-0.03], velocity=[0.0])
    law = stop(hunt_crossley=0.2)
    problem = bs.Problem(basis, laws=[law], loads=[pull], initial=initial, duration=0.02)
    response = bs.simulate(problem, rtol=1e-11)
    table = response.event_table()
    assert table["after"] == ["released", "open"]
    speed = response.sample("velocity", "P", "dx", times=[table["time"][0]])[0]
    assert speed == pytest.approx(1.0 / 0.2, rel=1e-9)
    assert response.sample("stop_force", "wall", times=np.linspace(0, 0.02, 200)).min() >= 0.0
    assert response.energy_residual < 1e-9


def test_its_obstacle_may_move() -> None:
    """In a frame that flies along, an obstacle of constant speed rests."""
    wall = bs.Polynomial([0.0, 0.5])
    basis = bs.ModalBasis.from_modes(frequency=[0.0], damping=[0.0], shapes={("P", "dx"): [1.0]})
    at = {"rest": (stop(), -0.9), "moving": (stop(motion=wall), -0.4)}
    impacts = {}
    for name, (law, velocity) in at.items():
        initial = bs.ModalState(displacement=[0.0], velocity=[velocity])
        problem = bs.Problem(basis, laws=[law], initial=initial, duration=0.02)
        response = bs.simulate(problem, rtol=1e-12)
        impacts[name] = response.impact_table()
        assert response.energy_residual < 1e-10
    for column in ("start", "end", "closing_speed", "peak_force", "impulse"):
        assert impacts["moving"][column] == pytest.approx(impacts["rest"][column], rel=1e-10)


@given(st.floats(1.0, 3.5), st.floats(0.05, 3.0))
@settings(max_examples=15, deadline=None)
def test_without_damping_the_speed_comes_back(exponent: float, speed: float) -> None:
    basis = bs.ModalBasis.from_modes(frequency=[0.0], damping=[0.0], shapes={("P", "dx"): [1.0]})
    initial = bs.ModalState(displacement=[0.0], velocity=[-speed])
    law = stop(exponent=exponent, stiffness=1e4 * 100**exponent)
    problem = bs.Problem(basis, laws=[law], initial=initial, duration=0.2)
    # The mass flies on for up to 0.6 m, which tolerances are relative to, from depths of 1 mm.
    impacts = bs.simulate(problem, rtol=1e-12).impact_table()
    deepest = ((exponent + 1) * speed**2 / (2 * law.stiffness)) ** (1 / (exponent + 1))
    assert impacts["opening_speed"] == pytest.approx([speed], rel=1e-7)
    assert impacts["peak_force"] == pytest.approx([law.stiffness * deepest**exponent], rel=1e-7)


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ({"exponent": 0.5}, "exponent"),
        ({"exponent": float("nan")}, "exponent"),
        ({"stiffness": 0.0}, "stiffness"),
        ({"hunt_crossley": -0.1}, "hunt_crossley"),
        ({"normal": (0, 0, 0)}, "normal"),
        ({"motion": "up"}, "motion"),
    ],
)
def test_bad_input_is_refused(wrong: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        stop(**wrong)
    assert caught.value.key == key


def test_the_method_for_linear_laws_refuses_it() -> None:
    with pytest.raises(bs.InputError, match=r"'wall'.*power of the depth.*dop853"):
        bs.simulate(oscillator(stop(), [-0.6, 0.2], 0.3), "exact")
