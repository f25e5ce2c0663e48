"""Springs of several slopes: closed forms, an independent integration, energies, bad input."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import bumpstop as bs


def mass_on(
    *laws: bs.SpringLaw, duration: float, velocity: float = 1.0, frequency: float = 0.0
) -> bs.Problem:
    """A mass of 1 kg that moves along x."""
    basis = bs.ModalBasis.from_modes(
        frequency=[frequency], damping=[0.0], shapes={("P", "dx"): [1.0]}
    )
    initial = bs.ModalState(displacement=[0.0], velocity=[velocity])
    return bs.Problem(basis, laws=laws, initial=initial, duration=duration)


def test_bilinear_oscillator_has_two_half_periods() -> None:
    """pi / omega_1 on one side and pi / omega_2 on the other."""
    pad = bs.SpringLaw("pad", node="P", direction=(1, 0, 0), stiffness=(2.5e5, 1e4), breaks=(0.0,))
    soft, hard = math.pi / 100.0, math.pi / 500.0
    response = bs.simulate(mass_on(pad, duration=10.5 * (soft + hard)))
    turns = np.cumsum([soft, hard] * 10)
    assert response.event_table()["time"] == pytest.approx(turns, rel=1e-13)
    middle = np.array([soft / 2, soft + hard / 2])
    x = response.sample("displacement", "P", "dx", times=middle)
    assert x == pytest.approx([1 / 100.0, -1 / 500.0], rel=1e-13)
    assert response.energy_residual < 1e-12
    assert response.impact_table()["stop"] == []


def test_play_is_a_flight() -> None:
    """A mass between two springs with play 2 g: 2 g / v from one to the other."""
    g, speed, omega = 1e-3, 0.5, 300.0
    play = bs.SpringLaw(
        "play",
        node="P",
        direction=(1, 0, 0),
        stiffness=(omega**2, 0.0, omega**2),
        breaks=(-g, g),
    )
    response = bs.simulate(mass_on(play, duration=0.2, velocity=speed))
    times = np.array(response.event_table()["time"])
    assert times[0] == pytest.approx(g / speed, rel=1e-13)
    gaps = np.diff(times)
    assert gaps[::2] == pytest.approx(np.full(len(gaps[::2]), math.pi / omega), rel=1e-11)
    assert gaps[1::2] == pytest.approx(np.full(len(gaps[1::2]), 2 * g / speed), rel=1e-11)


def test_force_and_stored_energy_at_rest_follow_the_curve() -> None:
    curve = [(-2e-3, -300.0), (-1e-3, -50.0), (1e-3, 20.0), (3e-3, 500.0)]
    pad = bs.SpringLaw.through(curve, "pad", node="P", direction=(1, 0, 0))
    x = np.linspace(-3e-3, 4e-3, 29)
    inside = (x > -2e-3) & (x < 3e-3)
    line = np.interp(x, *np.array(curve).T)
    assert pad.force(x)[inside] == pytest.approx(line[inside], rel=1e-12, abs=1e-10)
    assert pad.force([-3e-3])[0] == pytest.approx(-550.0)
    response = bs.simulate(mass_on(pad, duration=0.05, velocity=0.3))
    times = np.linspace(0.0, 0.05, 101)
    motion = response.sample("gap", "pad", times=times)
    assert response.sample("stop_force", "pad", times=times) == pytest.approx(
        -pad.force(motion), rel=1e-11, abs=1e-9
    )
    assert response.energy_residual < 1e-12


@settings(max_examples=15, deadline=None)
@given(
    slopes=st.lists(st.floats(0.0, 4e4), min_size=2, max_size=5),
    ends=st.lists(st.floats(-4e-3, 4e-3), min_size=4, max_size=4, unique=True),
    damping=st.sampled_from([0.0, 5.0]),
    preload=st.floats(-20.0, 20.0),
)
def test_random_springs_against_an_adaptive_integration(
    slopes: list[float], ends: list[float], damping: float, preload: float
) -> None:
    from scipy.integrate import solve_ivp

    breaks = sorted(ends)[: len(slopes) - 1]
    if np.diff(breaks).min(initial=1.0) < 1e-5:
        return
    pad = bs.SpringLaw(
        "pad",
        node="P",
        direction=(1, 0, 0),
        stiffness=slopes,
        breaks=breaks,
        preload=preload,
        damping=damping,
    )
    problem = mass_on(pad, duration=0.2, velocity=0.4, frequency=8.0)
    response = bs.simulate(problem, method="exact")
    assert response.energy_residual < 1e-11
    omega2 = (math.tau * 8.0) ** 2
    times = np.linspace(0.0, 0.2, 21)

    def rates(_: float, y: Any) -> list[float]:
        push = float(pad.force([y[0]])[0]) + damping * y[1]
        return [y[1], -omega2 * y[0] - push]

    solved = solve_ivp(
        rates, (0.0, 0.2), [0.0, 0.4], t_eval=times, rtol=1e-9, atol=1e-12, max_step=1e-3
    )
    x = response.sample("displacement", "P", "dx", times=times)
    assert x == pytest.approx(solved.y[0], abs=1e-5 * np.abs(solved.y[0]).max())


def test_between_two_nodes_it_pulls_on_both() -> None:
    """Two equal masses: their middle goes on, their distance swings with 2 k / m."""
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0, 0.0],
        damping=[0.0, 0.0],
        shapes={("A", "dx"): [1.0, 0.0], ("B", "dx"): [0.0, 1.0]},
    )
    link = bs.SpringLaw(
        "link", node="B", other="A", direction=(1, 0, 0), stiffness=(5e3, 2e4), breaks=(0.0,)
    )
    initial = bs.ModalState(displacement=[0.0, 0.0], velocity=[0.0, 1.0])
    response = bs.simulate(bs.Problem(basis, laws=[link], initial=initial, duration=0.05))
    times = np.linspace(0.0, 0.05, 11)
    a, b = (response.sample("displacement", node, "dx", times=times) for node in "AB")
    assert a + b == pytest.approx(times, rel=1e-13)
    first = math.pi / math.sqrt(2 * 2e4)
    assert response.event_table()["time"][0] == pytest.approx(first, rel=1e-13)
    early = times < first
    assert (b - a)[early] == pytest.approx(np.sin(200.0 * times[early]) / 200.0, abs=1e-15)


def test_fixed_steps_take_it_too() -> None:
    pad = bs.SpringLaw(
        "pad", node="P", direction=(1, 0, 0), stiffness=(9e4, 1e4, 4e4), breaks=(-1e-3, 2e-3)
    )
    problem = mass_on(pad, duration=0.1)
    times = np.linspace(0.0, 0.1, 51)
    exact = bs.simulate(problem, method="exact").motion(0, times=times)
    errors = [
        np.abs(
            bs.simulate(problem, method="central_difference", dt=dt).motion(0, times=times) - exact
        ).max()
        for dt in (4e-5, 2e-5)
    ]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.3)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"stiffness": [1.0, 2.0]}, "stiffness: must have one slope more"),
        ({"breaks": [1.0, 1.0], "stiffness": [1, 2, 3]}, "breaks: must increase"),
        ({"damping": -1.0}, "damping: must not be negative"),
        ({"direction": (0, 0, 0)}, "direction: must not be the zero vector"),
        ({"node": None}, "node: must have a node and its direction, or terms"),
        ({"other": "P"}, "other: must be another node"),
        ({"terms": {("P", "dx"): 1.0}}, "node: is told by the terms already"),
    ],
)
def test_bad_springs(change: dict[str, Any], said: str) -> None:
    good: dict[str, Any] = {"node": "P", "direction": (1, 0, 0), "stiffness": [1.0]}
    with pytest.raises(bs.InputError, match=said):
        bs.SpringLaw("pad", **(good | change))
