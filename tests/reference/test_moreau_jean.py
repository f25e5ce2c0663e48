"""Moreau and Jean's time stepping against closed forms and the exact method."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import bumpstop as bs

GRAVITY = 9.81


def ball(restitution: float, height: float = 1.0, **more: Any) -> bs.Problem:
    """Return a ball of 2 kg that falls onto a floor."""
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0], damping=0.0, modal_mass=2.0, shapes={("P", "dz"): [1.0]}
    )
    floor = bs.RigidStop("floor", node="P", normal=(0, 0, 1), gap=height, restitution=restitution)
    weight = bs.NodalForce("weight", node="P", force=(0, 0, -2.0 * GRAVITY))
    return bs.Problem(basis, laws=[floor], loads=[weight], **({"duration": 1.2} | more))


def numbers(run: bs.Response) -> dict[str, np.ndarray]:
    """Return the columns of the table of impacts that are numbers."""
    table = run.impact_table()
    return {name: np.array(table[name], dtype=float) for name in table if name != "stop"}


def test_a_ball_bounces_as_its_restitution_says() -> None:
    run = bs.simulate(ball(0.8), "moreau_jean", dt=1e-4)
    table = numbers(run)
    fall = math.sqrt(2.0 / GRAVITY)
    closings = [fall, fall * (1.0 + 2.0 * 0.8)]
    assert np.abs(table["start"][:2] - closings).max() < 3e-4
    assert np.abs(table["closing_speed"][:2] - GRAVITY * fall * np.array([1.0, 0.8])).max() < 3e-3
    assert np.abs(table["opening_speed"] / table["closing_speed"] - 0.8).max() < 1e-9
    impulses = 2.0 * table["closing_speed"] * 1.8
    assert np.abs(table["impulse"] / impulses - 1.0).max() < 1e-3
    # A floor gives back the energy of the speed that the ball leaves it with.
    assert table["energy_returned"] == pytest.approx(table["opening_speed"] ** 2, rel=1e-2)
    assert run.energy_residual < 1e-9


def test_its_error_is_of_first_order() -> None:
    times = np.linspace(0.0, 1.2, 61)
    exact = bs.simulate(ball(0.8)).sample("displacement", "P", "dz", times=times)
    errors = []
    for dt in (8e-4, 2e-4, 5e-5):
        run = bs.simulate(ball(0.8), "moreau_jean", dt=dt)
        errors.append(np.abs(run.sample("displacement", "P", "dz", times=times) - exact).max())
    assert errors[0] < 8e-3
    # By four a step; the instant within a step at which the floor is met adds or takes some.
    assert errors[2] < errors[0] / 6.0


def test_a_ball_that_does_not_bounce_rests_under_its_weight() -> None:
    run = bs.simulate(ball(0.0), "moreau_jean", dt=1e-4)
    late = np.linspace(0.6, 1.2, 50)
    assert np.abs(run.sample("gap", "floor", times=late)).max() < 1e-3
    assert np.abs(run.sample("velocity", "P", "dz", times=late)).max() < 1e-12
    assert np.allclose(run.sample("stop_force", "floor", times=late), 2.0 * GRAVITY)
    assert set(run.sample("state", "floor", times=late)) == {"resting"}
    table = numbers(run)
    fall = math.sqrt(2.0 / GRAVITY)
    assert len(table["start"]) == 1
    rest = 2.0 * GRAVITY * (1.2 - fall)
    assert table["impulse"][0] == pytest.approx(2.0 * GRAVITY * fall + rest, rel=1e-3)


def test_an_impulse_goes_through_a_row_of_balls() -> None:
    # Three equal balls in touch; the first is thrown at them: the last flies off (Newton's cradle
    # of two impacts one after the other, for the balls have gaps).
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0] * 3,
        damping=0.0,
        shapes={(f"P{i}", "dx"): np.eye(3)[i].tolist() for i in range(3)},
    )
    stops = [
        bs.RigidStop(
            f"s{i}", node=f"P{i + 1}", other=f"P{i}", normal=(1, 0, 0), gap=0.1, restitution=1.0
        )
        for i in range(2)
    ]
    start = bs.ModalState(velocity=[1.0, 0.0, 0.0])
    problem = bs.Problem(basis, laws=stops, initial=start, duration=0.5)
    run = bs.simulate(problem, "moreau_jean", dt=1e-3)
    speeds = [run.sample("velocity", f"P{i}", "dx", times=[0.5])[0] for i in range(3)]
    assert np.allclose(speeds, [0.0, 0.0, 1.0], atol=1e-12)


def test_two_floors_at_one_place_share_what_they_push() -> None:
    problem = ball(0.0)
    (floor,) = problem.laws
    assert isinstance(floor, bs.RigidStop)
    twin = bs.RigidStop("twin", node="P", normal=(0, 0, 1), gap=1.0, restitution=0.0)
    both = ball(0.0)
    both = bs.Problem(both.basis, laws=[floor, twin], loads=both.loads, duration=both.duration)
    run = bs.simulate(both, "moreau_jean", dt=1e-3)
    assert abs(run.sample("velocity", "P", "dz", times=[1.2])[0]) < 1e-9


def test_a_bar_between_a_rigid_wall_and_a_soft_stop_tends_to_the_exact_motion() -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0, 40.0, 95.0],
        damping=[0.0, 0.02, 0.02],
        shapes={("A", "dx"): [1.0, -0.8, 0.5], ("B", "dx"): [1.0, 0.9, 0.4]},
    )
    laws: list[Any] = [
        bs.RigidStop("wall", node="B", normal=(-1, 0, 0), gap=2e-3, restitution=0.5),
        bs.Stop("pad", node="A", normal=(1, 0, 0), gap=1e-3, stiffness=3e4, damping=5.0),
    ]
    start = bs.ModalState(velocity=[0.4, 0.05, 0.0])
    problem = bs.Problem(basis, laws=laws, initial=start, duration=0.03)
    times = np.linspace(0.0, 0.03, 61)
    exact = bs.simulate(problem)
    true = exact.sample("displacement", "A", "dx", times=times)
    errors = []
    for dt in (4e-5, 1e-5, 2.5e-6):
        run = bs.simulate(problem, "moreau_jean", dt=dt)
        found = run.sample("displacement", "A", "dx", times=times)
        errors.append(np.abs(found - true).max() / np.abs(true).max())
        assert run.energy_residual < 40.0 * dt / 1e-3
    assert errors[2] < 5e-3
    assert errors[2] < errors[0] / 4.0


def test_more_of_the_end_takes_energy_from_high_modes() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[100.0], damping=0.0, shapes={("P", "dx"): [1.0]})
    problem = bs.Problem(basis, initial=bs.ModalState(velocity=[1.0]), duration=0.1)
    kinds = {
        theta: bs.simulate(problem, "moreau_jean", dt=1e-3, theta=theta) for theta in (0.5, 0.8)
    }
    totals = {
        theta: run.energy_terms()["kinetic"][-1] + run.energy_terms()["elastic"][-1]
        for theta, run in kinds.items()
    }
    assert totals[0.5] == pytest.approx(0.5, rel=1e-9)
    assert totals[0.8] < 0.1


def test_other_methods_say_who_takes_rigid_stops() -> None:
    with pytest.raises(bs.InputError, match="exact and moreau_jean do"):
        bs.simulate(ball(0.5), "newmark", dt=1e-4)
    with pytest.raises(bs.InputError, match=r"must be from 0\.5 to 1"):
        bs.simulate(ball(0.5), "moreau_jean", dt=1e-4, theta=0.3)
