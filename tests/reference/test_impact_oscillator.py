"""The impact oscillator of Shaw and Holmes (1983): orbits, stability, grazing, period doubling."""

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.optimize import brentq

from .impact_oscillator import (
    Orbit,
    Oscillator,
    elastic_orbit,
    flight,
    grazing_forcing,
    rigid_orbit,
)
from .problem import Array
from .several.laws.rigid_stop import RigidStop
from .several.problem import SeveralStops, Stop
from .several.verdict import core_events

LITERATURE = 1e-8  # what is asked for
EXACT = 1e-11

# Each with a guess of instant and speed of closing, length of contact and speed of leaving.
ORBITS = {
    "soft stop": (Oscillator(0.1, 1.0, 1.0, spring=10.0), (0.3, 1.7, 0.8, 1.7)),
    "below resonance": (Oscillator(0.05, 1.0, 0.8, spring=100.0), (7.69, 1.53, 0.31, 1.53)),
    "above resonance": (Oscillator(0.05, 1.0, 1.5, spring=30.0), (0.18, 5.97, 0.56, 5.97)),
    "nearly rigid": (Oscillator(0.05, 1.0, 0.8, spring=1e8), (7.795, 1.7248, np.pi / 1e4, 1.7248)),
    "unstable": (Oscillator(0.05, 6.0, 2.3, spring=200.0), (1.24, 1.87, 0.19, 1.86)),
}


RIGID = [
    (Oscillator(0.05, 1.0, 0.8, restitution=0.8), (7.70, 1.84)),
    (Oscillator(0.05, 2.0, 1.5, restitution=0.7), (0.33, 4.76)),
    (Oscillator(0.05, 6.0, 2.3, restitution=0.8), (1.30, 2.07)),
]


def orbit(name: str) -> Orbit:
    """Return one of the orbits."""
    oscillator, guess = ORBITS[name]
    return elastic_orbit(oscillator, guess, periods=1)


def section(of: Orbit) -> tuple[float, float, float]:
    """Return the middle of the flight: instant, position and velocity."""
    with mp.workdps(30):
        whole = of.periods * of.oscillator.period
        left = of.start + of.contact
        half = (whole - of.contact) / 2
        x, v = flight(of.oscillator).after(left, mpf(1), -of.leaving, half)
        return float(left + half), float(x), float(v)


def driven(o: Oscillator, start: float, x: float, v: float, duration: float) -> SeveralStops:
    """Return the oscillator from an instant on, driven by a mode that it does not act back on."""
    w, row = o.frequency, np.array([-1.0, 0.0])
    return SeveralStops(
        omega2=np.array([1.0, w**2]),
        damping=np.array([2 * o.damping, 0.0]),
        stops=() if o.spring is None else (Stop(row, 1.0, o.spring),),
        others=() if o.spring is not None else (RigidStop(row, 1.0, o.restitution),),
        duration=duration,
        displacement=np.array([x, o.forcing / w * np.sin(w * start)]),
        velocity=np.array([v, o.forcing * np.cos(w * start)]),
        coupling=np.array([[0.0, -1.0], [0.0, 0.0]]),
    )


def carried(o: Oscillator, start: float, state: Array, periods: int = 1) -> Array:
    """Return the state some periods later, as the core has it."""
    duration = periods * 2 * np.pi / o.frequency
    history = driven(o, start, state[0], state[1], duration).solve()
    end = np.array([duration])
    return np.array([history.motion(end, order)[0, 0] for order in (0, 1)])


def slopes(o: Oscillator, start: float, state: Array) -> Array:
    """Return the derivative of that by central differences of the fourth order."""
    columns = []
    for direction in np.eye(2):
        h = 1e-4 * direction
        near = carried(o, start, state + h) - carried(o, start, state - h)
        far = carried(o, start, state + 2 * h) - carried(o, start, state - 2 * h)
        columns.append((8 * near - far) / 12e-4)
    return np.array(columns).T


@pytest.mark.parametrize("name", ORBITS)
def test_the_orbit_closes(name: str) -> None:
    known = orbit(name)
    assert known.is_possible()
    start, x, v = section(known)
    periods = 5 if name != "unstable" else 2
    history = driven(
        known.oscillator, start, x, v, periods * float(known.oscillator.period)
    ).solve()
    impacts = history.impacts(0)
    n = np.arange(periods)
    first = float(known.start + known.oscillator.period) - start
    wanted = first + n * float(known.oscillator.period)
    assert impacts["start"] == pytest.approx(wanted, abs=EXACT)
    assert impacts["end"] - impacts["start"] == pytest.approx(float(known.contact), abs=EXACT)
    assert np.abs(impacts["closing_speed"]) == pytest.approx(float(known.speed), abs=EXACT)
    assert np.abs(impacts["opening_speed"]) == pytest.approx(float(known.leaving), abs=EXACT)
    after = carried(known.oscillator, start, np.array([x, v]), periods)
    assert after == pytest.approx([x, v], abs=EXACT)


@pytest.mark.parametrize("name", ORBITS)
def test_the_orbit_is_as_stable_as_its_multipliers_say(name: str) -> None:
    known = orbit(name)
    start, x, v = section(known)
    multipliers = np.linalg.eigvals(slopes(known.oscillator, start, np.array([x, v])))
    assert np.sort_complex(multipliers) == pytest.approx(known.multipliers, abs=LITERATURE)
    assert (np.abs(known.multipliers).max() < 1) == (name != "unstable")


@pytest.mark.parametrize("name", ORBITS)
def test_newtons_method_on_the_core_finds_the_orbit(name: str) -> None:
    known = orbit(name)
    start, x, v = section(known)
    state = np.array([x, v]) + np.array([1e-2, -2e-2])
    for _ in range(6):
        lack = carried(known.oscillator, start, state) - state
        state = state - np.linalg.solve(slopes(known.oscillator, start, state) - np.eye(2), lack)
    assert state == pytest.approx([x, v], abs=LITERATURE)


@pytest.mark.parametrize(("frequency", "damping"), [(0.7, 0.05), (1.0, 0.05), (1.6, 0.1), (3.0, 0)])
def test_the_grazing_bifurcation(frequency: float, damping: float) -> None:
    """The steady motion meets the stop from the forcing on at which its amplitude is the gap."""

    def meets(forcing: float) -> float:
        o = Oscillator(damping, forcing, frequency, spring=100.0)
        with mp.workdps(30):
            x, v = (float(value) for value in flight(o).steady(mpf(0)))
        return 1.0 if core_events(driven(o, 0.0, x, v, float(o.period)).solve()) else -1.0

    known = grazing_forcing(Oscillator(damping, 1.0, frequency))
    found = brentq(meets, 0.99 * known, 1.01 * known, xtol=1e-14)
    assert found == pytest.approx(known, rel=1e-11)


def test_the_period_doubles_where_a_multiplier_is_minus_one() -> None:
    oscillator, guess = ORBITS["unstable"]

    def known(frequency: float) -> Orbit:
        return elastic_orbit(oscillator.but(frequency=frequency), guess, periods=1)

    def beyond(frequency: float) -> float:
        return float(known(frequency).multipliers[0].real) + 1.0

    critical = brentq(beyond, 2.26, 2.3, xtol=1e-13)

    def found(frequency: float) -> float:
        start, x, v = section(known(frequency))
        o = oscillator.but(frequency=frequency)
        multipliers = np.linalg.eigvals(slopes(o, start, np.array([x, v])))
        return float(np.sort_complex(multipliers)[0].real) + 1.0

    assert brentq(found, critical - 1e-3, critical + 1e-3, xtol=1e-12) == pytest.approx(
        critical, abs=LITERATURE
    )


@pytest.mark.parametrize(("oscillator", "guess"), RIGID)
def test_a_rigid_stop_takes_its_part_of_the_area_of_states(
    oscillator: Oscillator, guess: tuple[float, float]
) -> None:
    """The determinant of the monodromy matrix is ``e^2 exp(-2 a T)``: the reference's own check."""
    known = rigid_orbit(oscillator, guess, periods=1)
    assert known.is_possible()
    lost = np.exp(-2 * oscillator.damping * float(oscillator.period))
    area = np.prod(known.multipliers)
    assert area == pytest.approx(oscillator.restitution**2 * lost, rel=1e-14)


@pytest.mark.parametrize(("oscillator", "guess"), RIGID)
def test_the_orbit_of_a_rigid_stop_closes(
    oscillator: Oscillator, guess: tuple[float, float]
) -> None:
    known = rigid_orbit(oscillator, guess, periods=1)
    start, x, v = section(known)
    period, periods = float(oscillator.period), 2
    history = driven(oscillator, start, x, v, periods * period).solve()
    impacts = history.impacts(0)
    first = (float(known.start) - start) % period
    wanted = first + period * np.arange(periods)
    assert impacts["start"] == pytest.approx(wanted, abs=EXACT)
    assert np.abs(impacts["closing_speed"]) == pytest.approx(float(known.speed), abs=EXACT)
    assert np.abs(impacts["opening_speed"]) == pytest.approx(float(known.leaving), abs=EXACT)
    after = carried(oscillator, start, np.array([x, v]), periods)
    assert after == pytest.approx([x, v], abs=EXACT)


@pytest.mark.parametrize(("oscillator", "guess"), RIGID)
def test_the_orbit_of_a_rigid_stop_is_as_stable_as_its_multipliers_say(
    oscillator: Oscillator, guess: tuple[float, float]
) -> None:
    known = rigid_orbit(oscillator, guess, periods=1)
    start, x, v = section(known)
    multipliers = np.linalg.eigvals(slopes(oscillator, start, np.array([x, v])))
    assert np.sort_complex(multipliers) == pytest.approx(known.multipliers, abs=LITERATURE)


def test_a_very_stiff_spring_is_a_rigid_stop_without_loss() -> None:
    oscillator = Oscillator(0.05, 1.0, 0.8)
    rigid = rigid_orbit(oscillator, (7.8, 1.72), periods=1)
    for spring in (1e8, 1e12):
        guess = (float(rigid.start), float(rigid.speed), np.pi / spring**0.5, float(rigid.speed))
        stiff = elastic_orbit(oscillator.but(spring=spring), guess, periods=1)
        assert float(stiff.speed) == pytest.approx(float(rigid.speed), abs=3 / spring**0.5)
        assert stiff.multipliers == pytest.approx(rigid.multipliers, abs=3 / spring**0.5)
