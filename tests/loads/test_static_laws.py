"""Equilibria with laws other than stops and springs, against closed forms."""

from typing import Any

import numpy as np
import pytest

import bumpstop as bs

OMEGA2 = 100.0
BASIS = bs.ModalBasis.from_modes(
    frequency=[np.sqrt(OMEGA2) / (2 * np.pi)], damping=[0.0], shapes={("P", "dx"): [1.0]}
)
AT: dict[str, Any] = {"node": "P", "direction": (1, 0, 0)}
CURVE = [(1e-3, 1.0), (3e-3, 2.0), (1.0, 2.0)]


def held(law: Any, force: float) -> float:
    """Return where a force holds the mass against its spring and a law."""
    push = bs.NodalForce("push", node="P", force=(force, 0, 0))
    return float(bs.StaticState(loads=[push], laws=[law]).modal_state(BASIS)[0][0])


@pytest.mark.parametrize("place", [-0.03, 0.02, 0.4])
def test_relations_and_functions_of_a_user(place: float) -> None:
    force = OMEGA2 * place + 50.0 * place + 2e4 * place**3
    relation = bs.ForceRelation("law", force="-50 * x - 2e4 * x**3 - 3 * v", **AT)
    assert held(relation, force) == pytest.approx(place, rel=1e-11)
    user = bs.UserLaw("law", force=lambda q, v, _: -50.0 * q - 2e4 * q**3 - v, **AT)
    assert held(user, force) == pytest.approx(place, rel=1e-11)


@pytest.mark.parametrize(
    ("place", "tension"), [(5e-4, 0.5), (2e-3, 1.5), (-2e-3, -1.5), (-5e-4, -0.5)]
)
def test_plastic_springs_are_pulled_once(place: float, tension: float) -> None:
    law = bs.HardeningSpring("law", curve=CURVE, **AT)
    force = OMEGA2 * place + tension
    assert held(law, force) == pytest.approx(place, rel=1e-11)
    push = bs.NodalForce("push", node="P", force=(force, 0, 0))
    start = bs.StaticState(loads=[push], laws=[law])
    problem = bs.Problem(BASIS, laws=[law], loads=[push], initial=start, duration=1.0)
    motion = bs.simulate(problem).motion()  # the run starts with what the pull has left
    assert np.abs(motion - place).max() < 1e-11 * abs(place)


def test_dampers_push_with_what_they_have_at_no_speed() -> None:
    law = bs.DamperLaw("law", damping=(20.0,), offset=4.0, **AT)
    assert held(law, 10.0) == pytest.approx(6.0 / OMEGA2, rel=1e-12)


def test_laws_without_a_force_at_rest_are_refused() -> None:
    film = bs.UserLaw(
        "film", force=lambda *told: -told[3], memory_rate=lambda *told: told[0] - told[3], **AT
    )
    zener = bs.ZenerDamper("zener", series_stiffness=1.0, branch_stiffness=1.0, damping=1.0, **AT)
    for law in (film, zener):
        with pytest.raises(bs.InputError, match="no force at rest"):
            held(law, 1.0)


def test_what_is_left_out_is_told() -> None:
    law = bs.ForceRelation("law", force="-50 * x", **AT)
    push = bs.NodalForce("push", node="P", force=(1.0, 0, 0))
    alone = bs.StaticState(loads=[push])
    problem = bs.Problem(BASIS, laws=[law], initial=alone, duration=1.0)
    assert any("takes no part" in line for line in problem.warnings)
    together = bs.StaticState(loads=[push], laws=[law])
    problem = bs.Problem(BASIS, laws=[law], initial=together, duration=1.0)
    assert problem.warnings == ()


def test_rigid_stops_do_not_move() -> None:
    with pytest.raises(bs.InputError, match="rigid stops do not move"):
        bs.RigidStop(
            "wall",
            node="P",
            normal=(1, 0, 0),
            restitution=0.5,
            motion=bs.Harmonic(1.0, sine=1e-3),  # type: ignore[arg-type]
        )
