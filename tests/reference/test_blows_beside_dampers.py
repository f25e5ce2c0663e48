"""Blows on rigid stops that carry the speed past breaks of other laws, against SciPy."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import bumpstop as bs

FREQUENCY = np.array([1.0, 9.3])
RATIO = 0.02
SLOPES = (1.0, 12.0, 3.0)
BREAKS = (-1.0, 2.0)
GAP = 0.5
RESTITUTION = 0.7
STOP = (0.4, 400.0, 30.0)
"""Gap, stiffness and damping of the stop that a blow finds closed."""


def damper_force(v: float) -> float:
    """Return the force at a speed: one slope a segment, zero at rest."""
    below, above = BREAKS
    inside = SLOPES[1] * np.clip(v, below, above)
    return float(-inside - SLOPES[0] * min(v - below, 0.0) - SLOPES[2] * max(v - above, 0.0))


def stop_force(x: float, v: float) -> float:
    """Return what the soft stop pushes back with."""
    gap, stiffness, damping = STOP
    distance = gap - x
    return -max(0.0, -stiffness * distance + damping * v) if distance < 0.0 else 0.0


def by_scipy(times: np.ndarray, laws: tuple[str, ...]) -> tuple[np.ndarray, list[float]]:
    """Return the place of the node, and when it was struck."""
    omega = 2 * np.pi * FREQUENCY

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        q, v = y[:2], y[2:]
        force = 300.0 * np.cos(2 * np.pi * 2.3 * t)
        if "valve" in laws:
            force += damper_force(v.sum())
        if "pad" in laws:
            force += stop_force(q.sum(), v.sum())
        return np.concatenate([v, force - omega**2 * q - 2 * RATIO * omega * v])

    def touch(t: float, y: np.ndarray) -> float:  # noqa: ARG001  # as SciPy calls it
        return float(GAP - y[0] - y[1])

    touch.terminal = True  # type: ignore[attr-defined]  # as SciPy asks
    touch.direction = -1.0  # type: ignore[attr-defined]
    state, begin = np.array([0.1, 0.0, 0.0, 0.0]), 0.0
    found, struck = np.empty(len(times)), []
    while begin < times[-1]:
        part = solve_ivp(
            rates,
            (begin, times[-1]),
            state,
            method="DOP853",
            rtol=1e-12,
            atol=1e-13,
            max_step=1e-3,
            events=touch,
            dense_output=True,
        )
        inside = (times >= begin) & (times <= part.t[-1])
        found[inside] = part.sol(times[inside])[:2].sum(axis=0)
        if part.status == 0:
            break
        begin, state = float(part.t[-1]), part.y[:, -1]
        struck.append(begin)
        # Both modes have a row of one: the impulse turns the speed of the node about.
        state[2:] -= 0.5 * (1.0 + RESTITUTION) * state[2:].sum()
    return found, struck


@pytest.mark.parametrize(
    ("names", "duration"),
    [(("valve",), 0.6), (("pad",), 0.6), (("valve", "pad"), 0.1)],  # before it comes to rest
)
@pytest.mark.parametrize("first", [True, False])
def test_other_laws_follow_the_speed_over_a_blow(
    names: tuple[str, ...], duration: float, first: bool
) -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=FREQUENCY.tolist(), damping=RATIO, shapes={("P", "dx"): [1.0, 1.0]}
    )
    gap, stiffness, damping = STOP
    known: dict[str, Any] = {
        "valve": bs.DamperLaw(
            "valve", node="P", direction=(1, 0, 0), damping=SLOPES, breaks=BREAKS
        ),
        "pad": bs.Stop(
            "pad", node="P", normal=(-1, 0, 0), gap=gap, stiffness=stiffness, damping=damping
        ),
    }
    block = bs.RigidStop("block", node="P", normal=(-1, 0, 0), gap=GAP, restitution=RESTITUTION)
    laws = [known[name] for name in names]
    shake = bs.NodalForce("load", node="P", force=(300.0, 0, 0), time=bs.Harmonic(2.3, cosine=1.0))
    start = bs.ModalState(displacement=[0.1, 0.0])
    problem = bs.Problem(
        basis,
        laws=[block, *laws] if first else [*laws, block],
        loads=[shake],
        initial=start,
        duration=duration,
    )
    response = bs.simulate(problem, "exact")
    times = np.linspace(0.0, duration, 121)
    expected, struck = by_scipy(times, names)
    assert len(struck) > 1
    np.testing.assert_allclose(response.impulses["time"], struck, rtol=0, atol=1e-9)
    found = response.sample("displacement", "P", "dx", times=times)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8)
    assert response.energy_residual < 1e-12
