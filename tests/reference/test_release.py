"""A damped stop lets go before its gap opens, and may take hold again before it has."""

import numpy as np
import pytest

from .comparison import measured
from .one_mass import Mass, OneMass, Wall
from .precise import PreciseSolution
from .problem import CLOSED, OPEN, RELEASED
from .random_problems import random_problem
from .several.agreement import Agreement, agreement

EXACT = 1e-11
BITS = [0.0, *(sign * bit for bit in (1e-3, 1e-9, 1e-12) for sign in (1, -1))]


def good(result: Agreement) -> bool:
    errors = (result.event_error, result.state_error, result.energy_residual)
    return result.same_events and max(errors) < EXACT


def drawn_up(damping: float, force: float, speed: float, depth: float = 0.25) -> Mass:
    """Return a mass below a damped wall, drawn up at a speed relative to that of no force."""
    wall = Wall(1, 0.0, 400.0, damping)
    velocity = depth * 400.0 / damping * speed
    return Mass((wall,), 0.5, displacement=-depth, velocity=velocity, force=force)


@pytest.mark.parametrize("damping", [1.0, 10.0, 30.0, 100.0])
@pytest.mark.parametrize("force", [-1000.0, -100.0, -1.0])
@pytest.mark.parametrize("speed", [0.5, 1.001, 1.5, 4.0])
def test_a_mass_drawn_up_from_below(damping: float, force: float, speed: float) -> None:
    mass = drawn_up(damping, force, speed)
    assert good(agreement(mass.several(), OneMass(mass)))


def test_every_sequence_of_states_is_among_these() -> None:
    ends = {
        (speed, force): [e.after for e in OneMass(drawn_up(30.0, force, speed)).events][:2]
        for speed in (0.5, 1.001, 4.0)
        for force in (-1000.0, -1.0)
    }
    assert ends[1.001, -1000.0][0] == CLOSED  # takes hold again
    assert ends[4.0, -1.0][0] == OPEN  # is left without a force
    assert ends[0.5, -1.0] == [RELEASED, OPEN]


@pytest.mark.parametrize("bit", BITS)
@pytest.mark.parametrize("damping", [10.0, 30.0, 100.0])
@pytest.mark.parametrize("force", [-1000.0, -100.0, -1.0])
def test_a_start_with_hardly_any_force_below_the_wall(
    bit: float, damping: float, force: float
) -> None:
    mass = drawn_up(damping, force, 1.0 + bit)
    result = agreement(mass.several(), OneMass(mass))
    assert result.state_error < EXACT
    assert result.energy_residual < EXACT
    if bit:
        assert result.same_events


@pytest.mark.parametrize("damping", [1.0, 20.0, 200.0])
@pytest.mark.parametrize("force", [0.0, -3.0])
def test_between_two_damped_walls(damping: float, force: float) -> None:
    walls = (Wall(1, 0.05, 400.0, damping), Wall(-1, 0.05, 900.0, 0.7 * damping))
    mass = Mass(walls, 5.0, velocity=10.0, force=force)
    assert good(agreement(mass.several(), OneMass(mass)))


@pytest.mark.parametrize("damping", [3.0, 30.0])
def test_a_released_wall_is_held_again_by_a_second_one_behind(damping: float) -> None:
    # The stiff wall behind throws the mass back so fast that the damped one cannot follow.
    walls = (Wall(1, 0.0, 100.0, damping), Wall(1, 0.05, 1e5), Wall(-1, 0.1, 1e3, damping))
    mass = Mass(walls, 3.0, velocity=-5.0, force=-20.0)
    result = agreement(mass.several(), OneMass(mass))
    assert any((e.before, e.after) == (RELEASED, CLOSED) for e in result.found)
    assert good(result)


@pytest.mark.parametrize("seed", [44, 81, 304, 411, 1182, 1310, 1888, 2683])
def test_flexible_structures_take_hold_again(seed: int) -> None:
    problem = random_problem(seed)
    oracle = PreciseSolution(problem)
    assert (RELEASED, CLOSED) in [event[1:] for event in oracle.events]
    result = measured(problem, oracle, np.linspace(0.0, problem.duration, 25), 1.0)
    assert result.same_events
    assert result.event_error < EXACT
    assert result.state_error < EXACT
