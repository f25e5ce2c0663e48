"""Wear where supports carry a pipe along an obstacle that stands still."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

import bumpstop as bs

AMPLITUDE, DURATION = 0.01, 2.0
TIMES = np.linspace(0.0, DURATION, 200_001)
WAVE = bs.Harmonic(1.0, sine=1.0)
SWAY = (0, AMPLITUDE, 0)

SUPPORTS = bs.SupportMotion("sway", nodes=("A", "B"), displacement=SWAY, time=WAVE)
GROUND = bs.BaseMotion(displacement=SWAY, time=WAVE, frame="absolute")
SEEN_FROM_THE_BASE = bs.BaseMotion(displacement=SWAY, time=WAVE)


def pressed(load: Any, frame: str = "relative") -> bs.Response:
    """A pipe between two supports that presses on a stop under its middle."""
    steel = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    pipe = bs.Tube(outer_radius=0.03, thickness=0.003)
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (2, 0, 0)},
        beams=[bs.Beam("AB", nodes=("A", "B"), elements=4, material=steel, section=pipe)],
        supports=[
            bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz")),
            bs.Support(nodes="B", fixed=("dx", "dy", "dz")),
        ],
    )
    basis = bs.ModalBasis.from_structure(structure, modes=4, damping=0.02)
    stop = bs.Stop("stop", node="AB@1.0", normal=(0, 0, 1), gap=-1e-4, stiffness=1e5, frame=frame)
    problem = bs.Problem(basis, laws=[stop], loads=[load], duration=DURATION, sample=1e-2)
    with pytest.warns(bs.ModellingWarning):
        return bs.simulate(problem)


def sampled(response: bs.Response, sway: Sequence[float]) -> tuple[Any, Any, Any]:
    """Return force, sliding speed and place by samples, with a motion that the run leaves out."""
    force = response.sample("stop_force", "stop", times=TIMES)
    velocity = [response.sample("velocity", "AB@1.0", dof, times=TIMES) for dof in ("dx", "dy")]
    place = [response.sample("displacement", "AB@1.0", dof, times=TIMES) for dof in ("dy", "dz")]
    omega = 2.0 * np.pi
    velocity[1] = velocity[1] + sway[1] * omega * np.cos(omega * TIMES)
    place[0] = place[0] + sway[1] * np.sin(omega * TIMES)
    return force, np.hypot(*velocity), place


@pytest.mark.parametrize(
    ("load", "frame", "left_out"),
    [
        (SUPPORTS, "relative", (0, 0, 0)),
        (GROUND, "absolute", (0, 0, 0)),
        (SEEN_FROM_THE_BASE, "absolute", SWAY),
        (SEEN_FROM_THE_BASE, "relative", (0, 0, 0)),
    ],
    ids=["supports", "ground", "ground, seen from the base", "obstacle on the base"],
)
def test_work_is_that_of_sliding_past_the_obstacle(
    load: Any, frame: str, left_out: Sequence[float]
) -> None:
    response = pressed(load, frame)
    force, speed, place = sampled(response, left_out)
    found = bs.wear_work(response, "stop")
    assert found.work == pytest.approx(np.trapezoid(force * speed, TIMES), rel=1e-6)
    assert found.distance == pytest.approx(np.trapezoid(speed * (force > 0.0), TIMES), rel=1e-6)
    quarters = bs.work_by_sector(response, "stop", sectors=4, axes=("dy", "dz"))
    assert float(quarters.sum()) == pytest.approx(found.rate, rel=1e-5)
    turned = np.mod(np.arctan2(place[1], place[0]), 2.0 * np.pi)
    sums, _ = np.histogram(turned, bins=4, range=(0.0, 2.0 * np.pi), weights=force * speed)
    step = TIMES[1] - TIMES[0]
    # A sample on the border counts on one side whole.
    limit = 1e-4 * found.rate
    np.testing.assert_allclose(quarters, sums * step / DURATION, atol=limit)


def test_an_obstacle_on_the_base_moves_along() -> None:
    still = bs.wear_work(pressed(SEEN_FROM_THE_BASE, "absolute"), "stop")
    carried = bs.wear_work(pressed(SEEN_FROM_THE_BASE), "stop")
    assert carried.work < 1e-2 * still.work
