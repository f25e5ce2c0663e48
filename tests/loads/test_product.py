"""Products of functions of time: exact ones, and straight lines through others."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import bumpstop as bs
from bumpstop.loads.time import TimeFunction

TIMES = np.linspace(0.0, 3.0, 40_009)


def total(functions: Sequence[TimeFunction], times: np.ndarray) -> np.ndarray:
    values: np.ndarray = np.sum([function.at(times) for function in functions], axis=0)
    return values


numbers = st.floats(-3.0, 3.0)
harmonics = st.builds(bs.Harmonic, st.floats(0.1, 20.0), cosine=numbers, sine=numbers)


@given(st.lists(st.lists(harmonics, min_size=1, max_size=3), min_size=2, max_size=3))
def test_harmonics_stay_harmonics(factors: list[list[bs.Harmonic]]) -> None:
    terms = bs.Product(factors).terms(3.0)
    assert all(isinstance(term, bs.Harmonic | bs.Polynomial) for term in terms)
    times = TIMES[::500]
    expected = np.prod([total(factor, times) for factor in factors], axis=0)
    size = np.prod([sum(abs(each.cosine) + abs(each.sine) for each in f) for f in factors])
    assert np.abs(total(terms, times) - expected).max() <= 1e-12 * size


def test_equal_frequencies_leave_a_constant() -> None:
    square = bs.Product([bs.Harmonic(4.0, sine=1.0), bs.Harmonic(4.0, sine=1.0)])
    assert square.terms(1.0)[1] == bs.Polynomial([0.5])


def test_polynomials_stay_polynomials() -> None:
    (term,) = bs.Product([bs.Polynomial([1.0, 2.0]), bs.Polynomial([0.0, 0.0, 3.0])]).terms(1.0)
    assert term == bs.Polynomial([0.0, 0.0, 3.0, 6.0])


RAMP = bs.TimeTable([0.0, 0.7, 2.0], [0.0, 1.0, 0.2], beyond="hold")
BURST = bs.TimeTable([0.31, 1.27], [1.0, 1.0], beyond="zero")


@pytest.mark.parametrize(
    "factors",
    [
        [RAMP, bs.Harmonic(11.0, sine=1.0)],
        [BURST, bs.Harmonic(11.0, cosine=2.0)],
        [BURST, RAMP],
        [RAMP, RAMP],
        [[RAMP, bs.Polynomial([1.0])], bs.Expression("exp(-t)"), bs.Harmonic(3.0, sine=1.0)],
        [bs.Polynomial([0, 0, 0, 1.0]), bs.Polynomial([0, 0, 0, 1.0])],
        [bs.Polynomial([0.0, 1.0]), bs.Sweep((1.0, 20.0), duration=3.0)],
    ],
)
def test_straight_lines_stay_within_the_tolerance(factors: list[Any]) -> None:
    product = bs.Product(factors, tolerance=1e-5)
    (table,) = product.terms(3.0)
    sums = [factor if isinstance(factor, list) else [factor] for factor in factors]
    expected = np.prod([total(factor, TIMES) for factor in sums], axis=0)
    # What the factors' own lines stray adds to it.
    sampled = (bs.Expression, bs.Sweep)
    own = 1e-4 * sum(isinstance(each, sampled) for factor in sums for each in factor)
    largest = np.abs(expected).max()
    assert np.abs(table.at(TIMES) - expected).max() <= (1e-5 + 2 * own) * largest


def test_a_gate_times_lines_is_lines_to_rounding() -> None:
    (table,) = bs.Product([BURST, RAMP]).terms(3.0)
    times = TIMES[(TIMES < 1.27) | (TIMES > 1.27)]
    np.testing.assert_allclose(table.at(times), BURST.at(times) * RAMP.at(times), atol=1e-14)


def test_a_beat_drives_an_oscillator() -> None:
    """The exact method under a product of harmonics, against a Runge-Kutta scheme."""
    basis = bs.ModalBasis.from_modes(frequency=[3.0], damping=0.02, shapes={("P", "dx"): [1.0]})
    wave = bs.Product([bs.Harmonic(3.1, cosine=1.0), bs.Harmonic(0.4, sine=2.0)])
    push = bs.NodalForce("push", node="P", force=(1, 0, 0), time=wave)
    response = bs.simulate(bs.Problem(basis, loads=[push], duration=3.0))
    omega = 2 * np.pi * 3.0

    def rate(t: float, y: np.ndarray) -> list[float]:
        force = np.cos(2 * np.pi * 3.1 * t) * 2.0 * np.sin(2 * np.pi * 0.4 * t)
        return [y[1], force - 0.04 * omega * y[1] - omega**2 * y[0]]

    times = np.linspace(0.0, 3.0, 31)
    found = solve_ivp(rate, (0, 3), [0, 0], "DOP853", t_eval=times, rtol=1e-12, atol=1e-15)
    computed = response.sample("displacement", "P", "dx", times=times)
    np.testing.assert_allclose(computed, found.y[0], atol=1e-10 * np.abs(found.y[0]).max())


def test_an_obstacle_moves_by_a_product() -> None:
    motion: TimeFunction = bs.Product([bs.Harmonic(3.0, sine=1e-3), RAMP])
    basis = bs.ModalBasis.from_modes(frequency=[3.0], shapes={("P", "dx"): [1.0]})
    wall = bs.Stop("wall", node="P", normal=(1, 0, 0), stiffness=1e4, motion=motion)
    response = bs.simulate(bs.Problem(basis, laws=[wall], duration=3.0))
    gap = response.sample("gap", "wall") - response.sample("displacement", "P", "dx")
    np.testing.assert_allclose(gap, -motion.at(response.times), atol=1.01e-7)
    assert response.energy_residual < 1e-10


@pytest.mark.parametrize(
    ("factors", "what"),
    [
        ([bs.Harmonic(1.0)], "two functions of time"),
        ("sin", "two functions of time"),
        ([bs.Harmonic(1.0), 3.0], "must be a Harmonic"),
        ([bs.Harmonic(1.0), []], "must not be empty"),
    ],
)
def test_mistakes_are_one_line(factors: Any, what: str) -> None:
    with pytest.raises(bs.InputError, match=what) as caught:
        bs.Product(factors)
    assert caught.value.key == "factors"
