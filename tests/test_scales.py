"""Numbers out of all scale: what the exact method returns is right, and the rest is refused."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import bumpstop as bs

MODES = ((1.0, 2.3, 4.1), (1.0, 0.7, -0.4), (-1.0, 0.3, 0.1))
"""Angular frequencies, what the stop sees of the shapes, and velocities at the start."""


def swung(
    stiffness: float,
    modes: int = 1,
    damping: float = 0.0,
    gap: float = 0.5,
    length: float = 1.0,
    time: float = 1.0,
    duration: float = 20.0,
) -> bs.Problem:
    """Return modes that swing against a stop, in other units of length and time."""
    omega, seen, speeds = (np.array(column[:modes]) for column in MODES)
    basis = bs.ModalBasis.from_modes(
        frequency=list(omega / (2.0 * np.pi * time)),
        damping=[damping] * modes,
        shapes={("P", "dx"): list(seen)},
    )
    return bs.Problem(
        basis,
        laws=[bs.Stop("wall", node="P", normal=(1, 0, 0), gap=gap * length, stiffness=stiffness)],
        initial=bs.ModalState(velocity=list(speeds * length / time)),
        duration=duration * time,
    )


def told(problem: bs.Problem) -> bs.Response | str:
    """Run a problem; return its response, or the line with which it is refused."""
    try:
        response = bs.simulate(problem)
    except (bs.InputError, bs.ComputationError) as error:
        line = str(error)
        assert "\n" not in line
        return line
    assert np.isfinite(response.sample("modal_displacement")).all()
    assert response.energy_residual <= 1e-6
    return response


@pytest.mark.parametrize("modes", [1, 2, 3])
@pytest.mark.parametrize("exponent", [12, 18, 21, 25, 30, 40, 100, 150, 200, 300])
def test_stops_of_any_stiffness(exponent: int, modes: int) -> None:
    outcome = told(swung(10.0**exponent, modes, damping=0.01 * (modes == 3)))
    if exponent <= 21:
        assert isinstance(outcome, bs.Response)
    if exponent >= 25:
        assert isinstance(outcome, str)
        for word in ("stops.wall.stiffness", "1e+" + str(exponent), "N/m here"):
            assert word in outcome


def test_a_structure_that_hardly_resists_rebounds_as_masses_do() -> None:
    """Modes 1e18 times softer than their stop, against an adaptive method."""
    basis = bs.ModalBasis.from_modes(
        frequency=[1e-9, 2e-9, 5e-9], shapes={("P", "dx"): [1.0, 0.7, -0.4]}
    )
    stop = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=0.01, stiffness=2e3)
    thrown = bs.ModalState(velocity=[-1.0, 0.3, 0.1])
    problem = bs.Problem(basis, laws=[stop], initial=thrown, duration=0.2)
    times = np.linspace(0.0, 0.2, 50)
    exact = bs.simulate(problem).sample("modal_displacement", times=times)
    followed = bs.simulate(problem, method="dop853", rtol=1e-12).sample(
        "modal_displacement", times=times
    )
    np.testing.assert_allclose(exact, followed, rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("exponent", [4, 8, 12])
def test_a_stiff_stop_turns_the_velocity_like_a_rigid_one(exponent: int) -> None:
    """After a time ``pi / sqrt(1 + k)`` in contact, in which a spring of k loses nothing."""
    k = 10.0**exponent
    problem = swung(k, gap=0.0, duration=3.0)
    table = bs.simulate(problem).impact_table()
    assert table["end"][0] == pytest.approx(math.pi / math.sqrt(1.0 + k), rel=1e-13)
    assert table["opening_speed"][0] == pytest.approx(1.0, rel=1e-13)


@settings(max_examples=10, deadline=None, derandomize=True)
@given(st.integers(-120, 120), st.integers(-30, 30))
def test_units_make_no_difference(length: int, time: int) -> None:
    """Lengths and times in units that are powers of two: the same motion, to the last bit."""
    unit, tick = 2.0**length, 2.0**time
    plain = bs.simulate(swung(900.0, 3))
    scaled = bs.simulate(swung(900.0 / tick**2, 3, length=unit, time=tick))
    starts = [np.array(response.impact_table()["start"]) for response in (scaled, plain)]
    np.testing.assert_allclose(starts[0] / tick, starts[1], rtol=1e-12)
    np.testing.assert_allclose(
        scaled.sample("modal_displacement") / unit,
        plain.sample("modal_displacement"),
        rtol=0,
        atol=1e-11,
    )


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    stiffness=st.integers(-300, 300),
    gap=st.integers(-300, 300),
    length=st.integers(-200, 200),
    time=st.integers(-100, 100),
    modes=st.integers(1, 3),
)
def test_numbers_of_any_scale_are_followed_or_refused(
    stiffness: int, gap: int, length: int, time: int, modes: int
) -> None:
    try:
        problem = swung(10.0**stiffness, modes, 0.0, 10.0**gap, 10.0**length, 10.0**time)
    except bs.InputError:
        return
    told(problem)
