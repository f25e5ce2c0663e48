"""Motions followed up and down in the core: Shaw and Holmes' impact oscillator and its orbits."""

import numpy as np
import pytest

import bumpstop as bs
from tests.reference.impact_oscillator import Oscillator, elastic_orbit, grazing_forcing

FREQUENCY, DAMPING, SPRING = 0.8, 0.05, 100.0
PERIOD = 2.0 * np.pi / FREQUENCY
LATEST = 8
KEPT = {
    "speed": bs.Output(quantity="closing_speed", stop="wall", latest=LATEST),
    "impacts": bs.Output(quantity="impacts"),
    "end": bs.Output(quantity="displacement", node="P", dof="dx", statistic="last"),
}


def oscillator(periods: int = 400, *, forcing: float = 1.0) -> bs.Problem:
    """Return ``x'' + 2 a x' + x = b cos(w t)`` below a stop at x = 1."""
    unit = 1.0 / (2.0 * np.pi)
    shapes = {("P", "dx"): [1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[unit], damping=DAMPING, shapes=shapes)
    wall = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=1.0, stiffness=SPRING)
    load = bs.NodalForce(
        "load", node="P", force=(forcing, 0, 0), time=bs.Harmonic(FREQUENCY * unit, cosine=1.0)
    )
    return bs.Problem(basis, laws=[wall], loads=[load], duration=periods * PERIOD)


def test_the_branch_of_period_one_is_that_of_the_closed_form() -> None:
    forcing = np.array([0.9, 0.95, 1.0, 1.05, 1.1])
    found = bs.follow(oscillator(), {"loads": forcing}, KEPT)
    assert not found.failed.any()
    guess = (7.69, 1.53, 0.31, 1.53)
    for number, b in enumerate(forcing):
        known = elastic_orbit(Oscillator(DAMPING, b, FREQUENCY, spring=SPRING), guess, periods=1)
        if np.abs(known.multipliers).max() > 0.95:
            continue
        speeds = found.speed.isel(run=number).values
        assert speeds == pytest.approx(np.full((2, LATEST), float(known.speed)), rel=1e-9)


def test_no_impacts_below_grazing_on_the_way_up() -> None:
    grazing = grazing_forcing(Oscillator(DAMPING, 1.0, FREQUENCY))
    # A step of the forcing makes a transient of its size, which must not reach the stop.
    below = [0.4, 0.5, 0.6, 0.7, 0.78, 0.85, 0.9, 0.94, 0.965, 0.98, 0.988, 0.993]
    forcing = grazing * np.array([*below, 1.005])
    impacts = bs.follow(oscillator(200), {"loads": forcing}, KEPT).impacts.sel(way="up")
    assert impacts.values[:-1].tolist() == [0] * len(below)
    assert impacts.values[-1] > 50


def test_each_run_starts_where_the_one_before_it_ended() -> None:
    problem, gaps = oscillator(20), np.array([1.0, 0.8, 0.6])
    found = bs.follow(problem, {"stops.wall.gap": gaps}, KEPT)
    for way, order in (("up", gaps), ("down", gaps[::-1])):
        initial = None
        for gap in order:
            (wall,), number = problem.laws, int(np.flatnonzero(gaps == gap)[0])
            assert isinstance(wall, bs.Stop)
            stop = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=gap, stiffness=SPRING)
            again = bs.Problem(
                problem.basis,
                laws=[stop],
                loads=problem.loads,
                initial=initial,
                duration=problem.duration,
            )
            response = bs.simulate(again, method="exact")
            late = response.impacts["closing_speed"].to_numpy()[-LATEST:]
            one = found.sel(way=way).isel(run=number)
            assert one.speed.values == pytest.approx(late, rel=1e-9)
            place, speed = (response.motion(d, [problem.duration])[0] for d in (0, 1))
            assert float(one.end) == pytest.approx(place[0], rel=1e-9)
            initial = bs.ModalState(displacement=place, velocity=speed)


def test_the_pace_of_loads_is_their_frequency() -> None:
    """A linear oscillator, at whose resonance the pace leads past."""
    problem = oscillator(60, forcing=0.01)
    pace = np.array([0.5, 0.9, 1.4])
    found = bs.follow(problem, {"loads.pace": pace}, KEPT)
    omega = pace * FREQUENCY
    reply = 0.01 / (1.0 - omega**2 + 2j * DAMPING * omega)
    left = np.exp(-DAMPING * 60 * 2 * np.pi / omega)
    # What is left of the transient, and the rounding of sixty periods.
    lacks = np.abs(found.end.sel(way="up").values - reply.real)
    assert np.all(lacks < 2.0 * left * np.abs(reply).max() + 1e-13)


def test_a_diagram_of_both_ways() -> None:
    loads = np.linspace(0.5, 1.5, 3)
    found = bs.follow(oscillator(30), {"loads": loads}, KEPT)
    up, down = bs.bifurcation_diagram(found, "speed").data
    for trace, way in ((up, "up"), (down, "down")):
        assert trace.x.tolist() == np.repeat(loads, LATEST).tolist()
        known = found.speed.sel(way=way).values.ravel()
        assert np.array_equal(np.isnan(trace.y), np.isnan(known))
    with pytest.raises(bs.InputError, match="did you mean 'speed'"):
        bs.bifurcation_diagram(found, "sped")


def test_no_bit_depends_on_the_threads() -> None:
    problem, varied = oscillator(30), {"loads": np.linspace(0.5, 2.0, 5)}
    one, two = (bs.follow(problem, varied, KEPT, workers=workers) for workers in (1, 2))
    assert np.array_equal(one.speed, two.speed, equal_nan=True)
    assert np.array_equal(one.end, two.end)


def test_a_run_that_fails_is_left_out_of_the_chain() -> None:
    problem = oscillator(5)
    found = bs.follow(problem, {"loads": [1.0, np.nan, 1.5]}, KEPT)
    without = bs.follow(problem, {"loads": [1.0, 1.5]}, KEPT)
    assert found.failed.values.tolist() == [[False, True, False]] * 2
    assert np.array_equal(found.end.values[:, [0, 2]], without.end.values)


def test_the_last_impacts_of_a_response_are_those_of_the_core() -> None:
    problem = oscillator(30)
    found = bs.batch(problem, {"loads": [1.0]}, KEPT)
    assert KEPT["speed"].value(bs.simulate(problem, method="exact")) == pytest.approx(
        found.speed.values[0], rel=1e-12
    )


def test_refuses() -> None:
    problem = oscillator(5)
    with pytest.raises(bs.InputError, match="is that of the run before"):
        bs.follow(problem, {"initial.velocity": [1.0]}, KEPT)
    with pytest.raises(bs.InputError, match="belongs to quantities of impacts"):
        bs.Output(quantity="displacement", node="P", dof="dx", latest=3)
    with pytest.raises(bs.InputError, match="one of several ways"):
        bs.Output(quantity="closing_speed", stop="wall", statistic="last", latest=3)
