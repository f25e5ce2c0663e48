"""Friction by the sign of the velocity at steps, against a plain loop of the published rule."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import bumpstop as bs

OMEGA = np.array([2.0, 3.0]) * 2 * np.pi
STEP = 1e-3
FLOOR: dict[str, Any] = {
    "node": "P",
    "normal": (0, 0, 1),
    "stiffness": 2e3,
    "damping": 4.0,
    "friction": {"static": 0.4, "dynamic": 0.3, "rule": "velocity_sign"},
    "tangential_stiffness": 3e3,
    "tangential_damping": 5.0,
}


def bouncing(**changes: Any) -> bs.Problem:
    """A mass that hops on a floor while a spring pulls it along."""
    basis = bs.ModalBasis.from_modes(
        frequency=[2.0, 3.0],
        damping=[0.0, 0.0],
        shapes={("P", "dz"): [1.0, 0.0], ("P", "dx"): [0.0, 1.0]},
    )
    weight = bs.NodalForce("weight", node="P", force=(0, 0, -9.81))
    start = bs.ModalState(displacement=[0.02, 0.05], velocity=[0.0, -0.3])
    floor = bs.Stop("floor", **FLOOR | changes)
    return bs.Problem(basis, laws=[floor], loads=[weight], initial=start, duration=1.5)


def published_loop(steps: int) -> np.ndarray:
    """Return height and place at every step: the rule as it is published, line by line."""
    x, v = np.array([0.02, 0.05]), np.array([0.0, -0.3])
    path, touching = [x.copy()], False
    last_force = last_place = last_speed = 0.0
    sticks = False
    for _ in range(steps):
        push = max(0.0, -2e3 * x[0] - 4.0 * v[0]) if x[0] < 0.0 else 0.0
        rub = 0.0
        if push > 0.0:
            if not touching:
                last_force, last_place, last_speed, sticks = 0.0, x[1], 0.0, False
            slides = not sticks and v[1] * last_speed >= 0.0 and abs(v[1]) > 1e-6
            if not slides:
                rub = last_force - 3e3 * (x[1] - last_place) - 5.0 * v[1]
                sticks = abs(rub) <= 0.4 * push
            if slides or not sticks:
                sticks = False
                rub = -np.copysign(0.3 * push, v[1])
                last_force, last_place = rub, x[1]
            last_speed = v[1]
        touching = push > 0.0
        v = v + STEP * (np.array([push - 9.81, rub]) - OMEGA**2 * x)
        x = x + STEP * v
        path.append(x.copy())
    return np.array(path)


def test_steps_are_those_of_the_published_rule() -> None:
    response = bs.simulate(bouncing(), "symplectic_euler", dt=STEP)
    times = STEP * np.arange(1500)
    found = np.column_stack(
        [response.sample("displacement", "P", dof, times=times) for dof in ("dz", "dx")]
    )
    expected = published_loop(1499)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10 * np.abs(expected).max())
    states = set(map(str, response.sample("state", "floor", times=times)))
    assert {"open", "stick", "slip forward", "slip back"} <= states


@pytest.mark.parametrize("at", [0.2, 0.7])
def test_another_run_goes_on_with_what_it_remembers(at: float) -> None:
    whole = bs.simulate(bouncing(), "symplectic_euler", dt=STEP)
    first = bs.simulate(replace(bouncing(), duration=at), "symplectic_euler", dt=STEP)
    rest = bs.simulate(bs.continued(first, duration=0.5), "symplectic_euler", dt=STEP)
    times = STEP * np.arange(1, 500)
    np.testing.assert_allclose(
        rest.motion(0, times), whole.motion(0, at + times), rtol=0, atol=1e-11
    )


@pytest.mark.parametrize(
    ("method", "options"),
    [
        ("auto", {}),
        ("exact", {}),
        ("dop853", {}),
        ("newmark", {"dt": STEP}),
        ("central_difference", {"dt": STEP}),
    ],
)
def test_other_methods_refuse_it(method: str, options: dict[str, float]) -> None:
    with pytest.raises(bs.InputError, match=r"'floor'.*once a step.*symplectic_euler") as caught:
        bs.simulate(bouncing(), method, **options)  # type: ignore[arg-type]
    assert "\n" not in str(caught.value)


def test_what_is_refused() -> None:
    with pytest.raises(bs.InputError, match=r"friction\.rule: .*velocity_sign"):
        bs.Friction(0.3, rule="velocity")
    with pytest.raises(bs.InputError, match=r"friction\.rules: is nothing of friction"):
        bouncing(friction={"static": 0.3, "rules": "slider"})
    with pytest.raises(bs.InputError, match=r"friction\.rule: is for a Stop"):
        bs.PlaneStop(
            "pad",
            node="P",
            normal=(0, 0, 1),
            stiffness=1e3,
            tangential_stiffness=1e3,
            friction={"static": 0.3, "rule": "velocity_sign"},
        )
