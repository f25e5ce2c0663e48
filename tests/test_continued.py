"""A run that goes on where another one ended, against an unbroken one."""

from dataclasses import replace
from pathlib import Path
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


PLANE = bs.ModalBasis.from_modes(
    frequency=[1.0, 2.0],
    damping=[0.0, 0.5],
    shapes={("P", "dx"): [1.0, 0.0], ("P", "dy"): [0.0, 1.0]},
)
RUBS: dict[str, Any] = {
    "node": "P",
    "normal": (0, 1, 0),
    "stiffness": 1e3,
    "friction": 0.3,
    "tangential_stiffness": 1e3,
}


def pressed(pad: Any, duration: float) -> bs.Problem:
    press = bs.NodalForce("press", node="P", force=(0, -300.0, 0))
    shake = bs.NodalForce("shake", node="P", force=(120.0, 0, 0), time=bs.Harmonic(1.7, sine=1.0))
    start = bs.ModalState(velocity=[0.3, 0.0])
    return bs.Problem(PLANE, laws=[pad], loads=[press, shake], initial=start, duration=duration)


@pytest.mark.parametrize("at", [0.2, 0.3, 0.45, 0.6])
@pytest.mark.parametrize("method", ["exact", "dop853"])
def test_what_rubs_stays_anchored(at: float, method: str) -> None:
    pad: Any = bs.Stop("pad", tangential_damping=3.0, **RUBS)
    if method == "dop853":
        pad = bs.PlaneStop("pad", tangential_damping=3.0, **RUBS)
    options = {} if method == "exact" else {"rtol": 1e-11}
    unbroken = bs.simulate(pressed(pad, 1.5), method, **options)  # type: ignore[arg-type]
    states = {str(s) for s in unbroken.sample("state", "pad", times=np.linspace(0.0, 1.5, 200))}
    assert len(states) > 1
    first = bs.simulate(pressed(pad, at), method, **options)  # type: ignore[arg-type]
    rest = bs.simulate(bs.continued(first, duration=1.5 - at), method, **options)  # type: ignore[arg-type]
    times = np.linspace(0.0, 1.5 - at, 101)
    found, expected = rest.motion(0, times), unbroken.motion(0, at + times)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * np.abs(expected).max())
    np.testing.assert_array_equal(
        rest.sample("state", "pad", times=times[1:]),
        unbroken.sample("state", "pad", times=at + times[1:]),
    )


def test_steps_that_rub_go_on_to_the_bit_but_for_time() -> None:
    pad = bs.Stop("pad", tangential_damping=3.0, **RUBS)
    step = 2.0**-12
    unbroken = bs.simulate(pressed(pad, 1.0), "symplectic_euler", dt=step)
    first = bs.simulate(pressed(pad, 0.5), "symplectic_euler", dt=step)
    rest = bs.simulate(bs.continued(first, duration=0.5), "symplectic_euler", dt=step)
    times = np.arange(0.0, 0.5, 16 * step)
    found, expected = rest.motion(0, times), unbroken.motion(0, 0.5 + times)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_mistakes_are_one_line() -> None:
    run = bs.simulate(whole(0.5))
    with pytest.raises(bs.InputError, match="at: must be within the run"):
        bs.continued(run, duration=1.0, at=0.6)
    with pytest.raises(bs.InputError, match="duration: must be positive"):
        bs.continued(run, duration=0.0)


def test_obstacles_that_move_along_axes_go_on() -> None:
    motion: dict[str, Any] = {
        "dy": bs.Harmonic(4.0, sine=2e-2),
        "dz": [bs.Harmonic(3.0, cosine=1e-2), bs.Polynomial([0.0, 0.01])],
    }
    shapes = {("P", "dy"): [1.0, 0.0], ("P", "dz"): [0.0, 1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[1.0, 2.0], damping=[0.02, 0.02], shapes=shapes)
    hole = bs.CircleStop(
        "hole", node="P", axis=(1, 0, 0), radius=2e-2, stiffness=1e3, motion=motion
    )

    def run(duration: float) -> bs.Response:
        return bs.simulate(bs.Problem(basis, laws=[hole], duration=duration), rtol=1e-11)

    unbroken, first = run(1.5), run(0.7)
    assert len(unbroken.impacts) > 2
    rest = bs.simulate(bs.continued(first, duration=0.8), rtol=1e-11)
    times = np.linspace(0.0, 0.8, 81)
    found, expected = rest.motion(0, times), unbroken.motion(0, 0.7 + times)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * np.abs(expected).max())


ALONG: dict[str, Any] = {"node": "P", "direction": (1, 0, 0)}
REMEMBERING: list[Any] = [
    bs.ZenerDamper(
        "law",
        series_stiffness=300.0,
        parallel_stiffness=150.0,
        branch_stiffness=500.0,
        damping=20.0,
        exponent=0.5,
        **ALONG,
    ),
    bs.HardeningSpring("law", curve=[(5e-3, 2.0), (2e-2, 4.0)], **ALONG),
    bs.HardeningSpring("law", curve=[(5e-3, 2.0), (2e-2, 4.0)], hardening="kinematic", **ALONG),
    bs.UserLaw(
        "law",
        force=lambda q, v, t, z: -z * q - 3.0 * t,  # noqa: ARG005  # laws are told their speed
        memory_rate=lambda q, v, t, z: 50.0 * abs(v) - z,  # noqa: ARG005
        **ALONG,
    ),
]


@pytest.mark.parametrize("law", REMEMBERING, ids=lambda law: type(law).__name__)
@pytest.mark.parametrize("at", [0.11, 0.25, 0.4])
def test_laws_that_remember_go_on(law: Any, at: float) -> None:
    shake = bs.NodalForce("s", node="P", force=(20.0, 0, 0), time=bs.Harmonic(2.6, sine=1.0))

    def problem(duration: float) -> bs.Problem:
        return bs.Problem(BASIS, laws=[law], loads=[shake], duration=duration)

    unbroken = bs.simulate(problem(1.0), rtol=1e-11)
    first = bs.simulate(problem(at), rtol=1e-11)
    rest = bs.simulate(bs.continued(first, duration=1.0 - at), rtol=1e-11)
    times = np.linspace(0.0, 1.0 - at, 51)
    found, expected = rest.motion(0, times), unbroken.motion(0, at + times)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * np.abs(expected).max())
    forces = unbroken.sample("stop_force", "law", times=at + times)
    np.testing.assert_allclose(
        rest.sample("stop_force", "law", times=times), forces, rtol=0, atol=1e-7 * abs(forces).max()
    )


FORCE = bs.Output(quantity="stop_force", stop="pad", times=[0.1])


def test_what_cannot_be_handed_over_is_told(tmp_path: Path) -> None:
    run = bs.simulate(bs.Problem(BASIS, laws=[REMEMBERING[0]], duration=0.1))
    run.to_netcdf(tmp_path / "run.nc")
    with pytest.raises(bs.InputError, match=r"laws\.law: remembers more than the motion tells"):
        bs.continued(bs.read_netcdf(tmp_path / "run.nc"), duration=1.0)
    rubbing = bs.simulate(pressed(bs.Stop("pad", **RUBS), 0.2))
    rubbing.to_netcdf(tmp_path / "rubbing.nc")
    with pytest.raises(bs.InputError, match=r"stops\.pad: rubs at t = 0\.2 s") as caught:
        bs.continued(bs.read_netcdf(tmp_path / "rubbing.nc"), duration=1.0)
    assert "\n" not in str(caught.value)
    program = bs.OutsideProgram("outside", exchange=lambda step, q, v: 0.0, **ALONG)  # noqa: ARG005
    told = bs.simulate(bs.Problem(BASIS, laws=[program], duration=0.1), "symplectic_euler", dt=1e-3)
    with pytest.raises(bs.InputError, match=r"laws\.outside: is a program outside"):
        bs.continued(told, duration=1.0)
    with pytest.raises(bs.InputError, match="which a batch does not"):
        bs.batch(bs.continued(rubbing, duration=0.5), {"loads": [1.0]}, {"f": FORCE})
