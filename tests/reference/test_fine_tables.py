"""Tables whose knots lie far closer than the periods of the modes."""

import numpy as np
import pytest

from bumpstop import _core

from .fixed_point import states
from .problem import Array
from .several.loads import Table
from .several.problem import SeveralStops, Stop

KNOTS = 100_000
CLOSED = 1e-11
"""How well the energy ledger closes."""


def noise(count: int) -> Array:
    return np.random.default_rng(5).normal(size=count)


def modal(frequencies: list[float], ratios: list[float]) -> tuple[Array, Array]:
    omega = 2.0 * np.pi * np.array(frequencies)
    return omega**2, 2.0 * np.array(ratios) * omega


def worst(history: _core.History, expected: Array, times: Array) -> float:
    """Return the largest error of any mode, relative to the largest of its motion."""
    found = np.hstack([history.motion(times, order) for order in (0, 1)])
    return float((abs(found - expected) / abs(expected).max(axis=0)).max())


@pytest.mark.parametrize(
    ("frequency", "rate"), [(0.1, 4096), (1.0, 1024), (50.0, 1024), (50.0, 16384)]
)
def test_white_noise_of_many_knots(frequency: float, rate: int) -> None:
    """The motion at a hundred thousand knots, and the ledger."""
    omega2, damping = modal([frequency], [0.02])
    values, times = noise(KNOTS), np.arange(KNOTS) / rate
    expected = states(np.diag(omega2), np.diag(damping), (np.ones(1), np.zeros(1)), values, rate)
    shaken = SeveralStops(
        omega2=omega2,
        damping=damping,
        stops=(),
        duration=times[-1],
        displacement=np.zeros(1),
        velocity=np.zeros(1),
        loads=(Table(np.ones(1), times, values, False),),
    )
    history = shaken.solve()
    assert worst(history, expected, times) < 2e-13
    assert history.energy_residual() < 2e-13


def test_modes_of_all_kinds_under_one_table() -> None:
    """Without stiffness, coasting, slow, overdamped, nearly critical, and much faster."""
    frequencies = [0.0, 0.0, 1e-3, 0.1, 1.0, 1.0, 7.0, 50.0, 700.0, 4000.0]
    ratios = [0.0, 0.0, 0.01, 0.0, 3.0, 1.0, 40.0, 0.01, 0.02, 0.05]
    omega2, damping = modal(frequencies, ratios)
    damping[1] = 0.3
    values, rate = noise(300), 2048
    times = np.arange(len(values)) / rate
    one = np.ones(len(omega2))
    load = np.ones(1), np.zeros(1)
    alone = [
        states(np.diag([w2]), np.diag([c]), load, values, rate)
        for w2, c in zip(omega2, damping, strict=True)
    ]
    expected = np.hstack([np.hstack([mode[:, [order]] for mode in alone]) for order in (0, 1)])
    shaken = SeveralStops(
        omega2=omega2,
        damping=damping,
        stops=(),
        duration=times[-1],
        displacement=0.0 * one,
        velocity=0.0 * one,
        loads=(Table(one, times, values, False),),
    )
    history = shaken.solve()
    assert worst(history, expected, times) < 1e-12
    assert history.energy_residual() < CLOSED


@pytest.mark.parametrize(("stiffness", "damper"), [(40.0, 0.0), (40.0, 3.0), (3e3, 20.0)])
def test_an_obstacle_that_is_told_by_a_fine_table(stiffness: float, damper: float) -> None:
    """Behind a stop that never opens: a load ``k w + c w'`` along its row."""
    row = np.array([1.0, -0.6, 0.8])
    omega2, damping = modal([0.1, 1.0, 50.0], [0.02, 0.02, 0.02])
    walk = 1e-3 * noise(20_000).cumsum()
    walk -= walk[0]
    rate, depth = 1024, 2.0
    times = np.arange(len(walk)) / rate
    expected = states(
        np.diag(omega2) + stiffness * np.outer(row, row),
        np.diag(damping) + damper * np.outer(row, row),
        (stiffness * row, damper * row),
        walk,
        rate,
    )
    # Pressed so far into the stop that it stays closed, by the force that keeps it there.
    still = _core.Forcing(-stiffness * depth * row)
    history = _core.simulate(
        _core.System(omega2, damping),
        [_core.Stop(row, -depth, stiffness, damper)],
        still.with_motions([], [], [((0, 0), times, walk, True)]),
        np.zeros(3),
        np.zeros(3),
        float(times[-1]),
        "exact",
    )
    assert history.event_count == 0
    # The stop's force and the one that presses it are large beside what is left of both.
    assert worst(history, expected, times) < 1e-11
    assert history.energy_residual() < CLOSED


def between(times: Array, values: Array, parts: int) -> tuple[Array, Array]:
    """Return the same lines with so many knots for one."""
    share = np.arange(parts) / parts
    fine = [np.append((a[:-1, None] + np.diff(a)[:, None] * share), a[-1]) for a in (times, values)]
    return fine[0], fine[1]


@pytest.mark.parametrize("seed", range(6))
def test_knots_that_turn_nothing_change_nothing(seed: int) -> None:
    """Impacts of a structure under a table and under one with 64 knots on each of its lines."""
    random = np.random.default_rng(seed)
    omega2, damping = modal([0.3, 1.1, 6.0, 40.0], [0.02, 0.01, 0.03, 0.01])
    rows = random.normal(size=(2, 4))
    times = np.arange(41) / 8
    values = np.round(256 * random.normal(size=41)) / 256
    shaken = SeveralStops(
        omega2=omega2,
        damping=damping,
        stops=(Stop(rows[0], 0.02, 900.0, 2.0), Stop(rows[1], 0.05, 5e4, 0.0)),
        duration=times[-1],
        displacement=np.zeros(4),
        velocity=np.zeros(4),
        loads=(Table(np.array([1.0, 0.7, 2.0, 3.0]), times, values, False),),
    )
    dense = Table(shaken.loads[0].shape, *between(times, values, 64), False)
    plain, knotted = shaken.solve(), shaken.but(loads=(dense,)).solve()
    events, same = plain.events(), knotted.events()
    # Later impacts are what rounding has become.
    first = slice(8)
    assert plain.event_count >= 8
    assert events["law"][first] == same["law"][first]
    assert same["time"][first] == pytest.approx(events["time"][first], rel=0, abs=1e-11)
    assert knotted.energy_residual() < CLOSED
