"""Obstacles that move: other frames of still ones, and the exponential of the whole."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import bumpstop as bs
from bumpstop.arguments import FloatArray
from bumpstop.loads.time import TimeFunction

ROW = {("P", "dx"): [1.0]}


def ball(frequency: float = 0.0, damping: float = 0.0) -> bs.ModalBasis:
    return bs.ModalBasis.from_modes(frequency=[frequency], damping=[damping], shapes=ROW)


def run(basis: bs.ModalBasis, motion: object, duration: float, **more: object) -> bs.Response:
    """Let a mass move at a wall that it comes to from its left."""
    given = {"gap": 0.3, "stiffness": 5e3, "damping": 0.0} | more
    state = given.pop("initial", None)
    loads = given.pop("loads", ())
    wall = bs.Stop("wall", node="P", normal=(-1, 0, 0), motion=motion, **given)  # type: ignore[arg-type]
    problem = bs.Problem(basis, laws=[wall], loads=loads, initial=state, duration=duration)  # type: ignore[arg-type]
    return bs.simulate(problem)


@pytest.mark.parametrize("damping", [0.0, 4.0])
def test_a_wall_at_constant_speed_is_a_still_one_in_its_own_frame(damping: float) -> None:
    speed = 2.0
    moving = run(ball(), bs.Polynomial([0.0, speed]), 0.4, damping=damping)
    start = bs.ModalState(displacement=[0.0], velocity=[speed])
    still = run(ball(), (), 0.4, damping=damping, initial=start)
    times = moving.times
    shift = moving.displacement("P", "dx").to_numpy() + speed * times
    np.testing.assert_allclose(shift, still.displacement("P", "dx"), rtol=0, atol=1e-14)
    np.testing.assert_allclose(moving.gap("wall"), still.gap("wall"), rtol=0, atol=1e-14)
    force = still.stop_force("wall").to_numpy()
    found = moving.stop_force("wall").to_numpy()
    np.testing.assert_allclose(found, force, rtol=0, atol=1e-11 * force.max())
    for column in ("start", "end", "closing_speed", "opening_speed", "peak_force", "impulse"):
        assert moving.impacts[column][0] == pytest.approx(still.impacts[column][0], rel=1e-12)
    # The wall throws the mass forward: it gives what the mass has then and what the damper took.
    energy = moving.energy
    given = float(energy["obstacle_work"][-1])
    assert given == pytest.approx(speed * float(moving.impacts["impulse"][0]), rel=1e-12)
    assert moving.energy_residual < 1e-13


def test_a_wall_that_shakes_is_a_still_one_on_a_base_that_does() -> None:
    """Between two walls that move as one with a mass on a spring, in the frame of the walls."""
    frequency, size = 2.3, 0.02
    omega = 2.0 * np.pi * frequency
    shake = bs.Harmonic(frequency, sine=size)
    back = bs.Harmonic(frequency, sine=-size)
    basis = ball()

    def walls(forth: object, back: object) -> list[bs.Stop]:
        given = {"node": "P", "stiffness": 5e3, "damping": 3.0, "gap": 0.01}
        return [
            bs.Stop("right", normal=(-1, 0, 0), motion=back, **given),  # type: ignore[arg-type]
            bs.Stop("left", normal=(1, 0, 0), motion=forth, **given),  # type: ignore[arg-type]
        ]

    moving = bs.simulate(bs.Problem(basis, laws=walls(shake, back), duration=3.0))
    inertia = bs.NodalForce(
        "inertia",
        node="P",
        force=(1.0, 0, 0),
        time=bs.Harmonic(frequency, sine=size * omega**2),
    )
    start = bs.ModalState(displacement=[0.0], velocity=[-size * omega])
    still = bs.simulate(
        bs.Problem(basis, laws=walls((), ()), loads=[inertia], initial=start, duration=3.0)
    )
    assert len(still.impacts) > 8
    assert len(moving.impacts) == len(still.impacts)
    shift = moving.displacement("P", "dx").to_numpy() - size * np.sin(omega * moving.times)
    np.testing.assert_allclose(shift, still.displacement("P", "dx"), rtol=0, atol=1e-11)
    assert moving.energy_residual < 1e-11


MOTIONS: dict[str, TimeFunction] = {
    "polynomial": bs.Polynomial([0.3, 0.1, -0.4, 0.3]),
    "harmonic": bs.Harmonic(1.7, cosine=0.02, sine=0.05),
    "table": bs.TimeTable([0.0, 0.3, 0.5, 0.9], [0.0, 0.1, -0.05, 0.1], beyond="hold"),
}
SYSTEM = bs.ModalBasis.from_modes(
    frequency=[1.1, 2.9, 6.0], damping=[0.01, 0.03, 0.0], shapes={("P", "dx"): [1.0, -0.6, 0.4]}
)


def closed_motion(motion: TimeFunction, duration: float) -> np.ndarray:
    """Return the modal state behind a wall that stays closed, by the exponential of all of it."""
    row, k, c = np.array([-1.0, 0.6, -0.4]), 300.0, 5.0
    modes = len(row)
    stiffness = np.diag(SYSTEM.omega2) + k * np.outer(row, row)
    damping = np.diag(SYSTEM.damping) + c * np.outer(row, row)
    matrix = np.zeros((2 * modes + 4, 2 * modes + 4))
    matrix[:modes, modes : 2 * modes] = np.eye(modes)
    matrix[modes : 2 * modes, :modes] = -stiffness
    matrix[modes : 2 * modes, modes : 2 * modes] = -damping
    first = 2 * modes
    # A constant load and the pressed stop are in balance; behind the modes stand w and its rates.
    matrix[modes : 2 * modes, first] = k * row
    matrix[modes : 2 * modes, first + 1] = c * row
    state = np.zeros(2 * modes + 4)
    if isinstance(motion, bs.Harmonic):
        omega = 2.0 * np.pi * motion.frequency
        matrix[first, first + 1], matrix[first + 1, first] = 1.0, -(omega**2)
        state[first : first + 2] = motion.cosine, omega * motion.sine
        return np.asarray(expm(matrix * duration) @ state)
    for order in range(3):
        matrix[first + order, first + order + 1] = 1.0
    if isinstance(motion, bs.Polynomial):
        a, b, c2, d = motion.coefficients
        state[first : first + 4] = a, b, 2.0 * c2, 6.0 * d
        return np.asarray(expm(matrix * duration) @ state)
    assert isinstance(motion, bs.TimeTable)
    times, values = np.asarray(motion.times), np.asarray(motion.values)
    for begin, end, low, high in zip(times[:-1], times[1:], values[:-1], values[1:], strict=True):
        state[first : first + 4] = low, (high - low) / (end - begin), 0.0, 0.0
        state = expm(matrix * (end - begin)) @ state
    state[first : first + 4] = values[-1], 0.0, 0.0, 0.0
    return np.asarray(expm(matrix * (duration - times[-1])) @ state)


@pytest.mark.parametrize("kind", MOTIONS)
def test_a_closed_stop_hands_the_motion_on(kind: str) -> None:
    motion, duration = MOTIONS[kind], 1.3
    stop = bs.Stop(
        "wall", node="P", normal=(-1, 0, 0), gap=-2.0, stiffness=300.0, damping=5.0, motion=motion
    )
    press = bs.NodalForce("press", node="P", force=(600.0, 0, 0))
    response = bs.simulate(bs.Problem(SYSTEM, laws=[stop], loads=[press], duration=duration))
    assert response.history.event_count == 0
    expected = closed_motion(motion, duration)
    found = response.modal_displacement()[-1]
    np.testing.assert_allclose(found, expected[:3], rtol=0, atol=1e-12 * abs(expected[:3]).max())
    assert response.energy_residual < 1e-12
    assert response.motion_error is not None
    assert response.motion_error < 1e-9


@pytest.mark.parametrize("kind", MOTIONS)
def test_the_ledger_closes_over_many_impacts(kind: str) -> None:
    response = run(SYSTEM, MOTIONS[kind], 6.0, gap=0.05, stiffness=2e3)
    if kind != "polynomial":
        assert len(response.impacts) >= 2
    assert response.energy_residual < 1e-11


def test_a_wall_turns_at_a_corner_of_its_table() -> None:
    """Where its speed jumps a damper's force does, and the stop may let go at that instant."""
    motion = bs.TimeTable([0.0, 0.5, 0.6], [0.0, 0.5, -1.0], beyond="hold")
    response = run(ball(), motion, 0.6, damping=30.0, gap=0.4, stiffness=50.0)
    impacts = response.impacts
    assert impacts["start"][0] == pytest.approx(0.4, rel=1e-12)
    assert float(response.stop_force("wall").sel(time=0.51, method="nearest")) == 0.0
    assert response.energy_residual < 1e-12


CORNERS = np.array([0.0, 0.05, 0.06, 0.2, 0.3, 0.6])
PLACES = np.array([0.0, 0.02, 0.012, 0.012, 0.03, 0.0])


def shaken_by_scipy(times: FloatArray, gap: float, stiffness: float, damping: float) -> FloatArray:
    """Return where the ball is whose wall has a constant speed between corners."""
    omega, ratio = 2 * np.pi * 3.0, 0.02
    found, state = np.empty_like(times), np.zeros(2)
    for (start, end), (here, there) in zip(pairwise(CORNERS), pairwise(PLACES), strict=True):
        speed = (there - here) / (end - start)

        def rates(
            t: float, y: FloatArray, start: float = start, here: float = here, speed: float = speed
        ) -> list[float]:
            x, v = y
            # The wall is on the right: what comes to it moves ahead.
            distance = gap - x - (here + speed * (t - start))
            push = max(0.0, -stiffness * distance + damping * (v + speed))
            force = -push if distance < 0.0 else 0.0
            return [v, force - omega**2 * x - 2 * ratio * omega * v]

        part = solve_ivp(
            rates,
            (start, end),
            state,
            method="DOP853",
            rtol=1e-11,
            atol=1e-13,
            max_step=2e-4,
            dense_output=True,
        )
        inside = (times >= start) & (times <= end)
        found[inside] = part.sol(times[inside])[0]
        state = part.y[:, -1]
    return found


@pytest.mark.parametrize("damping", [5.0, 20.0, 60.0, 200.0])
@pytest.mark.parametrize("method", ["exact", "dop853", "flights"])
def test_a_stop_that_lets_go_where_the_wall_turns_does_not_come_back(
    damping: float, method: str
) -> None:
    """At a corner of the table the force of its damper jumps below zero."""
    motion = bs.TimeTable(CORNERS, PLACES, beyond="hold")
    wall = bs.Stop(
        "wall",
        node="P",
        normal=(-1, 0, 0),
        gap=-0.005,
        stiffness=2e3,
        damping=damping,
        motion=motion,
    )
    # A smooth law that is never reached leaves flights to the exact method.
    far = bs.HertzStop("far", node="P", normal=(1, 0, 0), gap=9.0, stiffness=1e5)
    problem = bs.Problem(
        ball(3.0, 0.02), laws=[wall, far] if method == "flights" else [wall], duration=0.6
    )
    response = (
        bs.simulate(problem, "exact")
        if method == "exact"
        else bs.simulate(problem, "dop853", rtol=1e-10)
    )
    times = np.linspace(0.0, 0.6, 121)
    expected = shaken_by_scipy(times, -0.005, 2e3, damping)
    found = response.sample("displacement", "P", "dx", times=times)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def test_what_cannot_move_is_refused() -> None:
    jump = bs.TimeTable([0.0, 0.1, 0.1, 1.0], [0.0, 0.0, 1.0, 1.0], beyond="hold")
    with pytest.raises(bs.InputError, match=r"motion: must not jump"):
        run(ball(), jump, 1.0)
    with pytest.raises(bs.InputError, match=r"motion: must not jump"):
        run(ball(), bs.TimeTable([0.0, 1.0], [0.0, 1.0], beyond="zero"), 1.0)
    with pytest.raises(bs.InputError, match=r"motion: must be a Harmonic"):
        run(ball(), 3.0, 1.0)
    with pytest.raises(bs.InputError, match=r"stops.wall.motion: does not cover the run"):
        run(ball(), bs.TimeTable([0.0, 1.0], [0.0, 1.0]), 2.0)
