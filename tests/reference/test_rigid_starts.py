"""Rigid stops at the start, in the bound of the motion's error, and with many modes."""

from dataclasses import replace

import numpy as np
import pytest

from .several.laws.rigid_stop import RigidStop
from .several.laws.stop import Stop
from .several.loads import Table
from .several.problem import SeveralStops
from .several.scan import ScanSolution
from .several.verdict import compare

ONE = np.ones(1)
GRAVITY = 9.81


def test_a_stop_beside_a_rigid_one_that_carries_all_is_not_closed() -> None:
    """Without the reaction the weight would press on it."""
    problem = SeveralStops(
        omega2=0 * ONE,
        damping=0 * ONE,
        stops=(Stop(ONE, 0.0, 1e4),),
        others=(RigidStop(ONE, 0.0, 0.5),),
        duration=1.0,
        displacement=0 * ONE,
        velocity=0 * ONE,
        force=-GRAVITY * ONE,
    )
    history = problem.solve()
    assert history.law_states(0, np.array([0.0, 0.5])) == ["open", "open"]
    assert history.impacts(0)["start"].size == 0
    assert history.law_forces(1, np.array([0.0, 0.5]))[:, 0] == pytest.approx(GRAVITY)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.8])
def test_the_bound_of_the_motions_error_holds_for_a_bouncing_ball(restitution: float) -> None:
    problem = SeveralStops(
        omega2=0 * ONE,
        damping=0 * ONE,
        stops=(),
        others=(RigidStop(ONE, 1.0, restitution),),
        duration=3.0,
        displacement=0 * ONE,
        velocity=0 * ONE,
        force=-GRAVITY * ONE,
    )
    history = problem.solve()
    bound = history.motion_error
    assert bound is not None
    assert bound < 1e-12
    fall = np.sqrt(2 / GRAVITY)
    speed = restitution * np.sqrt(2 * GRAVITY)
    later = np.linspace(0.0, 2 * speed / GRAVITY, 9)
    found = history.motion(fall + later, 0)[:, 0]
    expected = -1.0 + speed * later - GRAVITY * later**2 / 2
    # Two phases, and the instant between them.
    assert np.abs(found - expected).max() <= 3 * bound


def string(modes: int, rows: int) -> SeveralStops:
    """Return a plucked string of many modes among rigid stops, one of them leaning on it."""
    number = np.arange(1.0, modes + 1.0)
    places = np.linspace(0.2, 0.7, rows)
    shape = np.sqrt(2) * np.sin(np.pi * np.outer(places, number))
    stops = tuple(RigidStop(row, 2e-4, 0.6) for row in shape)
    lifted = Table(shape[0], np.array([0.0, 0.05, 0.1]), np.array([-300.0, -300.0, 300.0]))
    return SeveralStops(
        omega2=(np.pi * number * 20.0) ** 2,
        damping=0.02 * np.pi * number * 20.0,
        stops=(),
        others=stops,
        duration=0.1,
        displacement=np.zeros(modes),
        velocity=-0.5 / number**2,
        loads=(lifted,),
    )


@pytest.mark.parametrize(("modes", "rows"), [(10, 2), (50, 1), (50, 3)])
def test_many_modes_rebound_and_rest(modes: int, rows: int) -> None:
    problem = string(modes, rows)
    verdict = compare(problem, ScanSolution(problem, 1e5))
    assert verdict.events > 1
    assert verdict.difference is None or verdict.undecidable
    assert verdict.excess < 1.0


def test_a_resolution_out_of_its_range_is_refused() -> None:
    from bumpstop import _core

    for resolution in (0.0, 1e-14, 2.0, float("nan")):
        with pytest.raises(_core.CoreError, match="resolution"):
            _core.RigidStop(ONE, 0.0, 0.5, resolution)


def test_the_core_rests_where_a_load_in_time_presses_only_for_a_while() -> None:
    """Pressed, let go with a force that grows evenly, and lifted off at its zero."""
    stop = RigidStop(ONE, 0.0, 0.3)
    problem = SeveralStops(
        omega2=0 * ONE,
        damping=0 * ONE,
        stops=(),
        others=(stop,),
        duration=2.0,
        displacement=0 * ONE,
        velocity=0 * ONE,
        loads=(Table(ONE, np.array([0.0, 2.0]), np.array([-1.0, 1.0])),),
    )
    history = problem.solve()
    events = history.events()
    assert events["time"][-1] == pytest.approx(1.0, rel=1e-14)
    assert history.motion(np.array([2.0]), 0)[0, 0] == pytest.approx(1 / 6, rel=1e-12)
    softer = replace(problem, others=(), stops=(Stop(ONE, 0.0, 1e12),))
    assert softer.solve().motion(np.array([2.0]), 0)[0, 0] == pytest.approx(1 / 6, rel=1e-4)
