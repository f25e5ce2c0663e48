"""Friction and several impacts in Moreau and Jean's time stepping, against closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import bumpstop as bs

GRAVITY = 9.81
FRICTION = 0.3


def block(tilt: float = 0.0, speed: tuple[float, float] = (0.0, 0.0), **law: Any) -> bs.Problem:
    """Return a block of 2 kg on an inclined plane, x down the slope and z off it."""
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0, 0.0],
        damping=0.0,
        modal_mass=2.0,
        shapes={("P", "dx"): [1.0, 0.0], ("P", "dz"): [0.0, 1.0]},
    )
    given: dict[str, Any] = {"gap": 0.0, "restitution": 0.0, "friction": FRICTION}
    plane = bs.RigidStop("plane", node="P", normal=(0, 0, 1), **(given | law))
    pull = 2.0 * GRAVITY * np.array([math.sin(tilt), 0.0, -math.cos(tilt)])
    weight = bs.NodalForce("weight", node="P", force=pull.tolist())
    state = bs.ModalState(displacement=[0.0, 0.0], velocity=list(speed))
    return bs.Problem(basis, laws=[plane], loads=[weight], initial=state, duration=1.0)


def sampled(run: bs.Response, what: str, dof: str, times: Any) -> np.ndarray:
    return run.sample(what, "P", dof, times=np.asarray(times, dtype=float))


def test_a_block_that_slides_stops_where_friction_has_eaten_its_energy() -> None:
    run = bs.simulate(block(speed=(1.5, 0.0)), "moreau_jean", dt=1e-3)
    deceleration = FRICTION * GRAVITY
    stop = 1.5 / deceleration
    late = np.linspace(stop + 2e-3, 1.0, 20)
    assert sampled(run, "displacement", "dx", late) == pytest.approx(
        1.5**2 / (2.0 * deceleration), rel=2e-3
    )
    assert np.abs(sampled(run, "velocity", "dx", late)).max() < 1e-13
    early = np.linspace(0.05, stop - 0.05, 10)
    assert sampled(run, "velocity", "dx", early) == pytest.approx(1.5 - deceleration * early)
    assert run.sample("stop_force", "plane", times=early) == pytest.approx(2.0 * GRAVITY)
    rubbing = run.sample("friction_force", "plane", times=early)
    assert rubbing == pytest.approx(-FRICTION * 2.0 * GRAVITY)
    assert run.sample("friction_force", "plane", times=late) == pytest.approx(0.0, abs=1e-11)
    assert run.energy_residual < 1e-12
    taken = run.energy_terms(np.array([1.0]))["dissipated_stops"]
    assert taken == pytest.approx(1.5**2)


@pytest.mark.parametrize("tilt", [0.1, 0.28, 0.31, 0.8])
def test_a_block_on_a_slope_slides_where_it_is_steeper_than_friction(tilt: float) -> None:
    run = bs.simulate(block(tilt), "moreau_jean", dt=1e-3)
    pull = math.sin(tilt) - FRICTION * math.cos(tilt)
    expected = 0.5 * GRAVITY * max(pull, 0.0)
    assert sampled(run, "displacement", "dx", [1.0]) == pytest.approx(expected, rel=3e-3, abs=1e-13)
    rubbing = run.sample("friction_force", "plane", times=np.array([0.5]))
    most = min(math.sin(tilt), FRICTION * math.cos(tilt))
    assert rubbing == pytest.approx(-2.0 * GRAVITY * most)


@pytest.mark.parametrize("speed", [3.0, 0.4])
def test_an_oblique_impact_slides_or_sticks(speed: float) -> None:
    """The impulse along the plane is at most that off it times the coefficient."""
    problem = block(speed=(speed, -1.0), gap=0.05, restitution=0.5)
    run = bs.simulate(problem, "moreau_jean", dt=1e-4)
    table = run.impact_table()
    after = float(np.asarray(table["start"])[0]) + 1e-3
    closing = float(np.asarray(table["closing_speed"])[0])
    lost = FRICTION * 1.5 * closing
    # The step of the impact holds the weight of the step, too, which rubs.
    expected = max(speed - lost, 0.0)
    assert sampled(run, "velocity", "dx", [after]) == pytest.approx(expected, abs=4e-4)
    assert run.energy_residual < 1e-12


def beam_on_supports(friction: float) -> bs.Problem:
    """Return a rigid bar pressed onto two supports that rub, and pushed along them."""
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0, 0.0, 0.0],
        damping=0.0,
        shapes={
            ("L", "dz"): [0.0, 1.0, -1.0],
            ("L", "dx"): [1.0, 0.0, 0.0],
            ("R", "dz"): [0.0, 1.0, 1.0],
            ("R", "dx"): [1.0, 0.0, 0.0],
        },
    )
    supports = [
        bs.RigidStop(name, node=name, normal=(0, 0, 1), gap=0.0, restitution=0.0, friction=friction)
        for name in ("L", "R")
    ]
    loads = [
        bs.NodalForce("press", node="L", force=(0, 0, -30.0)),
        bs.NodalForce("more", node="R", force=(0, 0, -10.0)),
        bs.NodalForce("push", node="L", force=(10.0, 0, 0)),
    ]
    return bs.Problem(basis, laws=supports, loads=loads, duration=0.5)


@pytest.mark.parametrize("friction", [0.2, 0.4])
def test_two_supports_share_the_friction(friction: float) -> None:
    """Stuck, what each of them takes along the bar is not told by any law: their sum is."""
    run = bs.simulate(beam_on_supports(friction), "moreau_jean", dt=1e-3)
    at = np.array([0.4])
    pushes = np.array([run.sample("stop_force", name, times=at)[0] for name in "LR"])
    assert pushes == pytest.approx([30.0, 10.0])
    rubbing = np.array([run.sample("friction_force", name, times=at)[0] for name in "LR"])
    assert (np.abs(rubbing) <= friction * pushes * (1.0 + 1e-9)).all()
    slides = 40.0 * friction < 10.0
    assert rubbing.sum() == pytest.approx(-8.0 if slides else -10.0)
    moved = run.sample("displacement", "L", "dx", times=at)
    assert moved == pytest.approx(0.5 * 2.0 * 0.16 if slides else 0.0, rel=1e-2, abs=1e-12)


def test_a_ball_between_two_walls_that_meet_is_stopped_by_both_at_once() -> None:
    """In a right-angled corner an impact reaches both walls in one step."""
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0, 0.0], damping=0.0, shapes={("P", "dx"): [1.0, 0.0], ("P", "dy"): [0.0, 1.0]}
    )
    walls = [
        bs.RigidStop(name, node="P", normal=normal, gap=0.1, restitution=0.6)
        for name, normal in (("x", (1, 0, 0)), ("y", (0, 1, 0)))
    ]
    state = bs.ModalState(velocity=[-1.0, -1.0])
    problem = bs.Problem(basis, laws=walls, initial=state, duration=0.2)
    run = bs.simulate(problem, "moreau_jean", dt=1e-3)
    for dof in ("dx", "dy"):
        assert sampled(run, "velocity", dof, [0.15]) == pytest.approx(0.6)


def test_the_exact_method_refuses_rigid_stops_that_rub() -> None:
    with pytest.raises(bs.InputError, match=r"friction at rigid stops.*'plane'.*moreau_jean"):
        bs.simulate(block(), "exact")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"friction": -0.1}, "friction"),
        ({"friction": None, "sliding": (1, 0, 0)}, "belongs to friction"),
        ({"sliding": (0, 0, 1)}, "must not be the normal"),
        ({"friction": {"static": 0.3, "dynamic": 0.2}}, "friction"),
    ],
)
def test_wrong_frictions_are_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(bs.InputError, match=message):
        block(**given)
