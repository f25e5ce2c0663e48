"""Several stops without dampers: the way back is the way, and the energy stays."""

import numpy as np
import pytest

from .several.laws.rigid_stop import RigidStop
from .several.problem import SeveralStops
from .several.scan import ScanSolution
from .several.undamped import energy_drift, random_undamped, reversed_from
from .several.verdict import EPSILON

EVENTS = 100
IMPACTS = 10_000


@pytest.mark.parametrize("seed", [6, 7, 13, 14, 29, 33, 38])
def test_a_hundred_events_backwards_lead_to_the_start(seed: int) -> None:
    problem = random_undamped(seed, longer=4.0)
    instants = problem.solve().events()["time"]
    assert len(instants) > EVENTS
    problem = problem.but(duration=float(instants[EVENTS]))
    end = np.array([problem.duration])
    forth = problem.solve()
    back = reversed_from(problem, forth.motion(end, 0)[0], forth.motion(end, 1)[0])
    returned = back.solve()
    # What rounding does on the way is undone with the way; what it does on the way back is not.
    judge = ScanSolution(back)
    allowed = 1e-9 + 100 * EPSILON * judge.growth
    lack = returned.motion(end, 0)[0] - problem.displacement
    lack_rate = returned.motion(end, 1)[0] + problem.velocity
    assert np.abs(lack).max() < allowed * judge.sizes[0]
    assert np.abs(lack_rate).max() < allowed * judge.sizes[1]


@pytest.mark.parametrize(("seed", "longer"), [(14, 250.0), (19, 120.0), (38, 220.0)])
def test_ten_thousand_impacts_of_several_stops_keep_the_energy(seed: int, longer: float) -> None:
    problem = random_undamped(seed, longer)
    history = problem.solve()
    stops = range(len(problem.stops))
    assert len(problem.stops) > 2
    assert sum(history.impacts(stop)["start"].size for stop in stops) >= IMPACTS
    assert history.energy_residual() < 1e-11
    times = np.linspace(0.0, problem.duration, 2000)
    drift = energy_drift(problem, history.motion(times, 0), history.motion(times, 1))
    assert drift < 1e-11


@pytest.mark.parametrize(("seed", "duration"), [(0, 1000.0), (3, 650.0)])
def test_ten_thousand_impacts_between_rigid_stops_keep_the_energy(
    seed: int, duration: float
) -> None:
    rng = np.random.default_rng(seed)
    omega, row = np.sort(rng.uniform(5, 60, 4)), rng.normal(size=4)
    history = SeveralStops(
        omega2=omega**2,
        damping=np.zeros(4),
        stops=(),
        others=(RigidStop(row, 0.02, 1.0), RigidStop(-row, 0.03, 1.0)),
        duration=duration,
        displacement=np.zeros(4),
        velocity=rng.normal(size=4),
    ).solve()
    assert sum(history.impacts(stop)["start"].size for stop in (0, 1)) >= IMPACTS
    assert history.energy_residual() < 1e-11
