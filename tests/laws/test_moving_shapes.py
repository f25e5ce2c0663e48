"""Obstacles of a shape that move, and stops that rub on a ground which supports leave behind."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.loads.time import TimeFunction
from bumpstop.post.at_obstacle import places_at_obstacle
from bumpstop.post.sliding import sliding_speed

from .round_hole import AXES, free_mass

Motion = Mapping[str, TimeFunction | Sequence[TimeFunction]]

RUBS: dict[str, Any] = {
    "friction": {"static": 0.3, "dynamic": 0.2},
    "tangential_stiffness": 4e4,
    "tangential_damping": 40.0,
}
SQUARE = [((2 * n + 1) * np.pi / 4, np.sqrt(2) * 2e-3) for n in range(4)]


def stop(kind: str, motion: Motion | None = None, **more: Any) -> Any:
    """A stop of one kind around, or in front of, the mass."""
    given: dict[str, Any] = {"node": "P", "stiffness": 2e4, "damping": 3.0, "motion": motion}
    given |= RUBS | more
    if kind == "plane":
        return bs.PlaneStop("it", normal=(0, 1, 0), gap=1e-3, **given)
    around: dict[str, Any] = {"axis": (1, 0, 0), "roll": 0.3}
    if kind == "circle":
        return bs.CircleStop("it", radius=2e-3, **around, **given)
    return bs.PolarStop("it", profile=SQUARE, **around, **given)


def solved(basis: bs.ModalBasis, law: Any, duration: float, **more: Any) -> bs.Response:
    problem = bs.Problem(basis, laws=[law], duration=duration, **more)
    return bs.simulate(problem, "dop853", rtol=1e-10)


@pytest.mark.parametrize("kind", ["circle", "polar", "plane"])
def test_at_constant_speed_it_is_a_still_one_in_its_own_frame(kind: str) -> None:
    speed = np.array([0.05, 0.2, -0.15])
    start = np.array([-0.1, -0.1, 0.3])
    motion = {axis: bs.Polynomial([0.0, v]) for axis, v in zip(AXES, speed, strict=True)}
    duration = 0.06
    moving = solved(
        free_mass(), stop(kind, motion), duration, initial=bs.ModalState(velocity=start)
    )
    still = solved(free_mass(), stop(kind), duration, initial=bs.ModalState(velocity=start - speed))
    times = np.linspace(0.0, duration, 301)
    for axis, v in zip(AXES, speed, strict=True):
        shift = moving.sample("displacement", "P", axis, times=times) - v * times
        expected = still.sample("displacement", "P", axis, times=times)
        np.testing.assert_allclose(shift, expected, rtol=0, atol=1e-9 * 2e-3)
    assert len(still.impacts) > 0
    assert len(moving.impacts) == len(still.impacts)
    np.testing.assert_allclose(moving.impacts["start"], still.impacts["start"], rtol=1e-9)
    # The obstacle does work, which the still one does not.
    assert abs(float(moving.energy["obstacle_work"][-1])) > 1e-4
    assert moving.energy_residual < 1e-8


SHAKE = {
    "dx": [bs.Harmonic(31.0, sine=1e-3)],
    "dy": [bs.Harmonic(17.0, sine=3e-3), bs.Harmonic(23.0, sine=4e-4)],
    "dz": [bs.Harmonic(17.0, cosine=-3e-3)],
}


@pytest.mark.parametrize("kind", ["circle", "polar", "plane"])
@pytest.mark.parametrize("flights", [True, False])
def test_shaken_it_is_a_still_one_on_a_base_that_shakes(kind: str, flights: bool) -> None:
    """With w the obstacle's motion, q - w feels the loads ``(Omega^2 - omega^2) w``."""
    omega = (40.0, 90.0, 130.0)
    basis = free_mass(omega)
    loads, place, speed = [], np.zeros(3), np.zeros(3)
    for n, axis in enumerate(AXES):
        for wave in SHAKE[axis]:
            turn = 2.0 * np.pi * wave.frequency
            factor = turn**2 - omega[n] ** 2
            time = bs.Harmonic(wave.frequency, cosine=factor * wave.cosine, sine=factor * wave.sine)
            force = tuple(np.eye(3)[n])
            loads.append(
                bs.NodalForce(f"{axis} {wave.frequency}", node="P", force=force, time=time)
            )
            place[n] += wave.cosine
            speed[n] += turn * wave.sine
    given_more: dict[str, Any] = {"rtol": 1e-10, "exact_flights": flights}
    duration = 0.15
    moving = bs.simulate(
        bs.Problem(basis, laws=[stop(kind, SHAKE)], duration=duration), "dop853", **given_more
    )
    start = bs.ModalState(displacement=-place, velocity=-speed)
    still = bs.simulate(
        bs.Problem(basis, laws=[stop(kind)], loads=loads, initial=start, duration=duration),
        "dop853",
        **given_more,
    )
    times = np.linspace(0.0, duration, 401)
    assert len(still.impacts) >= 3
    assert len(moving.impacts) == len(still.impacts)
    for column in ("start", "peak_force", "impulse"):
        np.testing.assert_allclose(moving.impacts[column], still.impacts[column], rtol=1e-6)
    largest = np.abs(still.sample("displacement", "P", "dy", times=times)).max()
    for axis in AXES:
        shake = sum(wave.at(times) for wave in SHAKE[axis])
        shift = moving.sample("displacement", "P", axis, times=times) - shake
        expected = still.sample("displacement", "P", axis, times=times)
        np.testing.assert_allclose(shift, expected, rtol=0, atol=1e-6 * largest)
    fastest = sliding_speed(still, 0)(times)
    np.testing.assert_allclose(
        sliding_speed(moving, 0)(times), fastest, rtol=0, atol=1e-5 * fastest.max()
    )
    if kind != "plane":
        # What the obstacle's picture shows is told from its centre.
        path = places_at_obstacle(still, still.problem.laws[0], times)  # type: ignore[arg-type]
        found = places_at_obstacle(moving, moving.problem.laws[0], times)  # type: ignore[arg-type]
        np.testing.assert_allclose(found, path, rtol=0, atol=1e-6 * np.abs(path).max())
    assert moving.energy_residual < 1e-7


def test_a_table_moves_a_hole_through_its_knots() -> None:
    """A hole that is drawn aside carries the mass along: its speed is that of the lines."""
    motion = {"dy": bs.TimeTable([0.0, 0.02, 0.05], [0.0, 0.01, 0.01], beyond="hold")}
    moving = solved(free_mass(), stop("circle", motion, friction=None, **NO_RUB), 0.05)
    # In the frame of the first line the hole is still, and the mass comes at 0.5 m/s.
    start = bs.ModalState(velocity=[0.0, -0.5, 0.0])
    still = solved(free_mass(), stop("circle", friction=None, **NO_RUB), 0.02, initial=start)
    times = np.linspace(0.0, 0.02, 101)
    shift = moving.sample("displacement", "P", "dy", times=times) - 0.5 * times
    expected = still.sample("displacement", "P", "dy", times=times)
    np.testing.assert_allclose(shift, expected, rtol=0, atol=1e-12)
    assert moving.energy_residual < 1e-9


NO_RUB: dict[str, Any] = {"tangential_stiffness": None, "tangential_damping": None}


def carriage() -> bs.ModalBasis:
    """A mass on springs in two directions, and free along the third, held at its foot."""
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "P": (0, 0, 0)},
        masses=[bs.PointMass("p", node="P", mass=2.0)],
        springs=[bs.Spring("all", node="P", other="A", stiffness=(800.0, 1600.0, 2400.0, 0, 0, 0))],
        supports=[bs.Support(nodes=["A"], fixed=["dx", "dy", "dz"])],
    )
    return bs.ModalBasis.from_structure(structure, modes=3, damping=0.02)


WAVE = bs.Harmonic(2.3, sine=1.0)


@pytest.mark.parametrize("kind", ["circle", "polar", "plane"])
def test_on_the_still_ground_it_is_left_behind_by_supports(kind: str) -> None:
    """Told from the ground, and told from the supports with an obstacle that goes back."""
    size = np.array([6e-3, 4e-3, -5e-3])
    shake = {
        frame: bs.BaseMotion(displacement=tuple(size), time=WAVE, frame=frame)
        for frame in ("absolute", "relative")
    }
    back = {axis: bs.Harmonic(2.3, sine=-s) for axis, s in zip(AXES, size, strict=True)}
    ground = solved(carriage(), stop(kind, frame="absolute"), 1.0, loads=[shake["absolute"]])
    seen = solved(carriage(), stop(kind, back), 1.0, loads=[shake["relative"]])
    assert len(ground.impacts) > 0
    times = np.linspace(0.0, 1.0, 301)
    for axis, s in zip(AXES, size, strict=True):
        relative = ground.sample("displacement", "P", axis, times=times) - s * WAVE.at(times)
        expected = seen.sample("displacement", "P", axis, times=times)
        np.testing.assert_allclose(relative, expected, rtol=0, atol=1e-8 * 6e-3)
    speeds = sliding_speed(ground, 0)(times)
    np.testing.assert_allclose(
        speeds, sliding_speed(seen, 0)(times), rtol=0, atol=1e-7 * speeds.max()
    )


@pytest.mark.parametrize("supports", ["base", "some"])
def test_supports_pull_a_block_along_the_ground_that_it_rubs_on(supports: str) -> None:
    """Solved exactly; against the same mass whose springs are pulled by a load."""
    basis, stiffness, mass = carriage(), 800.0, 2.0
    wave = bs.Harmonic(1.1, sine=4e-2)
    rubs: dict[str, Any] = {
        "node": "P",
        "normal": (0, 1, 0),
        "gap": -2e-3,
        "stiffness": 5e3,
        "friction": {"static": 0.6, "dynamic": 0.4},
        "sliding": (1, 0, 0),
        "tangential_stiffness": 3e4,
        "tangential_damping": 20.0,
    }
    move: Any = {"displacement": (1, 0, 0), "time": wave}
    load = (
        bs.BaseMotion(**move, frame="absolute")
        if supports == "base"
        else bs.SupportMotion("foot", nodes="A", **move)
    )
    pulled = bs.simulate(
        bs.Problem(
            basis, laws=[bs.Stop("floor", **rubs, frame="absolute")], loads=[load], duration=2.0
        ),
        "exact",
    )
    # Springs to a still foot, their damping on the motion that the modes tell.
    omega = np.sqrt(stiffness / mass)
    rate = 2.0 * np.pi * wave.frequency
    damper = 2.0 * 0.02 * omega * mass
    by_spring = bs.NodalForce(
        "spring", node="P", force=(1, 0, 0), time=bs.Harmonic(1.1, sine=stiffness * 4e-2)
    )
    by_damper = bs.NodalForce(
        "damper", node="P", force=(1, 0, 0), time=bs.Harmonic(1.1, cosine=damper * rate * 4e-2)
    )
    # At rest as the supports see it, it starts with their speed.
    start = bs.ModalState(velocity=mass * 4e-2 * rate * basis.row("P", "dx"))
    loaded = bs.simulate(
        bs.Problem(
            basis,
            laws=[bs.Stop("floor", **rubs)],
            loads=[by_spring, by_damper],
            initial=start,
            duration=2.0,
        ),
        "exact",
    )
    times = np.linspace(0.0, 2.0, 401)
    found = pulled.sample("displacement", "P", "dx", times=times)
    expected = loaded.sample("displacement", "P", "dx", times=times)
    assert len({str(s) for s in loaded.sample("state", "floor", times=times)}) >= 3
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11)
    assert pulled.energy_residual < 1e-11


@pytest.mark.parametrize(
    ("motion", "message"),
    [
        (bs.Harmonic(1.0, sine=1.0), r"motion: must say for some of dx, dy, dz"),
        ({}, r"motion: must say for some of dx, dy, dz"),
        ({"rx": bs.Harmonic(1.0, sine=1.0)}, r"motion: must say for some of dx, dy, dz"),
        ({"dy": 3.0}, r"motion\.dy: must be a Harmonic"),
    ],
)
def test_mistakes_are_one_line(motion: Any, message: str) -> None:
    with pytest.raises(bs.InputError, match=message) as caught:
        stop("circle", motion)
    assert "\n" not in str(caught.value)


def test_jumps_are_refused() -> None:
    jump = bs.TimeTable([0.0, 0.1, 0.1, 1.0], [0.0, 0.0, 1e-3, 1e-3], beyond="hold")
    with pytest.raises(bs.InputError, match=r"stops\.it\.motion: must not jump"):
        bs.Problem(free_mass(), laws=[stop("circle", {"dz": jump})], duration=1.0)
