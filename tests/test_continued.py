"""A run that goes on where another one ended, against an unbroken one."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.loads.time import TimeFunction

BASIS = bs.ModalBasis.from_modes(
    frequency=[3.0, 7.5], damping=[0.01, 0.02], shapes={("P", "dx"): [1.0, 0.4]}
)
KNOTS = np.linspace(0.0, 3.0, 13)
TIMES: list[Any] = [
    bs.Harmonic(2.8, sine=1.0, cosine=0.3),
    bs.Polynomial([0.1, -0.2, 0.05]),
    bs.TimeTable(KNOTS, np.cos(5 * KNOTS), beyond="hold"),
]


def whole(duration: float, **options: Any) -> bs.Problem:
    said: dict[str, Any] = {
        "laws": [
            bs.Stop("guide", node="P", normal=(-1, 0, 0), gap=0.03, stiffness=2e4, damping=10.0),
            bs.Stop(
                "hammer",
                node="P",
                normal=(1, 0, 0),
                gap=0.05,
                stiffness=1e4,
                motion=bs.Harmonic(1.0, sine=0.02),
            ),
        ],
        "loads": [bs.NodalForce("shaker", node="P", force=(15.0, 0, 0), time=TIMES)],
    }
    return bs.Problem(BASIS, **said | options, duration=duration)


@pytest.mark.parametrize("at", [None, 0.77, 1.3])
def test_it_goes_on_as_the_unbroken_run(at: float | None) -> None:
    unbroken = bs.simulate(whole(3.0))
    first = bs.simulate(whole(1.5))
    begin = 1.5 if at is None else at
    rest = bs.simulate(bs.continued(first, duration=3.0 - begin, at=at))
    times = np.linspace(0.0, 3.0 - begin, 301)
    found, expected = rest.motion(0, times), unbroken.motion(0, begin + times)
    np.testing.assert_allclose(found, expected, atol=1e-11 * np.abs(expected).max())
    later = unbroken.event_table()["time"]
    assert rest.event_count == sum(float(time) > begin for time in later) > 2
    (load,) = rest.problem.loads
    assert load.name == "shaker"


def test_pieces_of_pieces() -> None:
    unbroken = bs.simulate(whole(3.0))
    run = bs.simulate(whole(1.0))
    for _ in range(4):
        run = bs.simulate(bs.continued(run, duration=0.5))
    expected = unbroken.sample("displacement", "P", "dx", times=[2.75])
    found = run.sample("displacement", "P", "dx", times=[0.25])
    np.testing.assert_allclose(found, expected, atol=1e-10)


@pytest.mark.parametrize(
    "shaking",
    [
        bs.Expression("exp(-t) * sin(9*t)"),
        bs.Product([bs.Harmonic(3.0, sine=1.0), bs.TimeTable([0, 1, 2], [0, 1, 0], beyond="zero")]),
    ],
)
def test_within_the_first_run_lines_are_those_of_the_first(shaking: TimeFunction) -> None:
    problem = replace(
        whole(2.0), loads=[bs.NodalForce("s", node="P", force=(30, 0, 0), time=shaking)]
    )
    run = bs.simulate(problem)
    rest = bs.simulate(bs.continued(run, at=0.77, duration=1.0))
    again = bs.simulate(bs.continued(rest, at=0.25, duration=0.5))
    times = np.linspace(0.0, 0.5, 101)
    expected = run.motion(0, 1.02 + times)
    largest = np.abs(expected).max()
    np.testing.assert_allclose(rest.motion(0, 0.25 + times), expected, atol=1e-12 * largest)
    np.testing.assert_allclose(again.motion(0, times), expected, atol=1e-12 * largest)


def test_a_contact_that_rubs_is_told() -> None:
    shapes = {("P", "dx"): [1.0, 0.0], ("P", "dy"): [0.0, 1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[1.0, 2.0], damping=[0.0, 0.5], shapes=shapes)
    pad = bs.Stop(
        "pad", node="P", normal=(0, 1, 0), stiffness=1e3, friction=0.3, tangential_stiffness=1e3
    )
    press = bs.NodalForce("press", node="P", force=(0, -300.0, 0))
    start = bs.ModalState(velocity=[0.3, 0.0])
    problem = bs.Problem(basis, laws=[pad], loads=[press], initial=start, duration=0.2)
    run = bs.simulate(problem)
    with pytest.raises(bs.InputError, match=r"stops\.pad: rubs at t = 0\.2 s") as caught:
        bs.continued(run, duration=1.0)
    assert "\n" not in str(caught.value)


def test_mistakes_are_one_line() -> None:
    run = bs.simulate(whole(0.5))
    with pytest.raises(bs.InputError, match="at: must be within the run"):
        bs.continued(run, duration=1.0, at=0.6)
    with pytest.raises(bs.InputError, match="duration: must be positive"):
        bs.continued(run, duration=0.0)


def test_laws_that_remember_are_told() -> None:
    damper = bs.ZenerDamper(
        "damper",
        node="P",
        direction=(1, 0, 0),
        series_stiffness=300.0,
        parallel_stiffness=150.0,
        branch_stiffness=500.0,
        damping=20.0,
        exponent=1.0,
    )
    run = bs.simulate(bs.Problem(BASIS, laws=[damper], duration=0.1))
    with pytest.raises(bs.InputError, match=r"laws\.damper: remembers more than the motion tells"):
        bs.continued(run, duration=1.0)
