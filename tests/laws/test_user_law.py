"""Laws by Python functions, and programs outside: against laws of the house, and their errors."""

# ruff: noqa: ARG001, ARG005 (laws are called with all that there is, whatever they need of it)

from collections.abc import Generator
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import bumpstop as bs

from .one_mass import one_mass, shaking

HERE: dict[str, Any] = {"node": "P", "direction": (1, 0, 0)}


def user(force: Any, **changes: Any) -> bs.UserLaw:
    return bs.UserLaw("mine", force=force, **HERE | changes)


def end(problem: bs.Problem, *method: str, **options: Any) -> Any:
    response = bs.simulate(problem, *method, **options)
    return response.sample("displacement", "P", "dx", times=[problem.duration])[0]


def test_it_moves_as_the_formula_does() -> None:
    force = "-100*x - 2e6*x**3 - 3*v"
    known = bs.ForceRelation("known", force=force, **HERE)
    mine = user(lambda q, v, t: -100 * q - 2e6 * q**3 - 3 * v)
    runs = [
        bs.simulate(one_mass(law, place=5e-3, loads=[shaking(0.3, 4.0)]), rtol=1e-12)
        for law in (known, mine)
    ]
    times = np.linspace(0.0, 1.0, 21)
    one, other = (run.sample("displacement", "P", "dx", times=times) for run in runs)
    assert np.abs(one - other).max() < 1e-12 * 5e-3
    assert runs[1].energy_residual < 1e-10


def test_time_and_memory_reach_it() -> None:
    """Wear that grows with time: z' = 2 t, a force z t, x'' = t^3."""
    mine = user(lambda q, v, t, z: z * t, memory_rate=lambda q, v, t, z: 2 * t, memory=0.5)
    x = end(one_mass(mine, duration=2.0), rtol=1e-12)
    assert x == pytest.approx(2.0**5 / 20 + 0.5 * 2.0**3 / 6, rel=1e-11)


def test_a_hysteresis_of_bouc_and_wen_is_that_of_scipy() -> None:
    """x'' = f(t) - 40 x - 60 z, z' = v - 3 |v| |z| z - v z^2: force and variable to 1e-8."""

    def rate(v: float, z: float) -> float:
        return v - 3.0 * abs(v) * abs(z) * z - v * z**2

    mine = user(lambda q, v, t, z: -40.0 * q - 60.0 * z, memory_rate=lambda q, v, t, z: rate(v, z))
    problem = one_mass(mine, place=0.05, speed=0.3, duration=4.0, loads=[shaking(8.0, 1.1)])
    run = bs.simulate(problem, rtol=1e-12)
    times = np.linspace(0.0, 4.0, 81)

    def slope(t: float, y: Any) -> list[float]:
        x, v, z = y
        push = 8.0 * np.sin(2.0 * np.pi * 1.1 * t)
        return [v, push - 40.0 * x - 60.0 * z, rate(v, z)]

    known = solve_ivp(slope, (0.0, 4.0), [0.05, 0.3, 0.0], "DOP853", times, rtol=1e-13, atol=1e-15)
    x, v, z = known.y
    for quantity, expected in (("displacement", x), ("velocity", v)):
        found = run.sample(quantity, "P", "dx", times=times)
        assert np.abs(found - expected).max() < 1e-8 * np.abs(expected).max()
    force = -40.0 * x - 60.0 * z
    assert np.abs(run.sample("stop_force", "mine", times=times) - force).max() < 1e-8 * 60.0
    memory = run.at(times).internal_variables("mine")["memory"].values
    assert np.abs(memory - z).max() < 1e-8 * np.abs(z).max()
    assert np.ptp(z) > 0.3  # of one at most: it yields


def test_in_two_directions_it_couples_them() -> None:
    """A follower force turns the motion: x'' = -k y', y'' = k x', a circle."""
    basis = bs.ModalBasis.from_modes(
        frequency=[0, 0], damping=[0, 0], shapes={("P", "dx"): [1, 0], ("P", "dy"): [0, 1]}
    )
    mine = user(
        lambda q, v, t: np.array([-3.0 * v[1], 3.0 * v[0]]),
        further_directions=[(0, 1, 0)],
        jacobian=lambda q, v, t: (np.zeros((2, 2)), np.array([[0.0, -3.0], [3.0, 0.0]])),
    )
    start = bs.ModalState(velocity=[1.0, 0.0])
    response = bs.simulate(bs.Problem(basis, laws=[mine], initial=start, duration=1.0), rtol=1e-12)
    x, y = (response.sample("displacement", "P", dof, times=[1.0])[0] for dof in ("dx", "dy"))
    assert (x, y) == pytest.approx((np.sin(3.0) / 3, (1 - np.cos(3.0)) / 3), rel=1e-11)
    assert response.energy_residual < 1e-12


def test_it_stands_beside_stops() -> None:
    wall = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=0.1, stiffness=1e4)
    spring = bs.SpringLaw("spring", stiffness=[50.0], **HERE)
    mine = user(lambda q, v, t: -50.0 * q)
    both = [one_mass(law, wall, speed=1.0, duration=3.0) for law in (spring, mine)]
    assert end(both[1], rtol=1e-12) == pytest.approx(end(both[0], "exact"), abs=1e-8)


@pytest.mark.parametrize(
    ("force", "words"),
    [
        (lambda q, v, t: 1 / (0.5 - min(t, 0.5)), "force of law 'mine' raised ZeroDivisionError"),
        (lambda q, v, t: (1.0, 2.0), r"force of law 'mine' is array\(\[1., 2.\]\) at t = 0"),
        (lambda q, v, t: np.nan, r"force of law 'mine' is array\(\[nan\]\) at t = 0"),
        (lambda q, v: 0.0, "force of law 'mine' raised TypeError"),
        (lambda q, v, t: "much", "force of law 'mine' raised ValueError"),
    ],
)
def test_what_goes_wrong_in_it_is_told_in_one_line(force: Any, words: str) -> None:
    with pytest.raises(bs.ComputationError, match=words) as caught:
        end(one_mass(user(force), speed=1.0))
    assert "at t = " in str(caught.value)
    assert "\n" not in str(caught.value)


def test_an_interrupt_in_it_ends_the_run() -> None:
    def force(q: float, v: float, t: float) -> float:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        end(one_mass(user(force)))


@pytest.mark.parametrize("method", ["exact", "newmark", "symplectic_euler"])
def test_other_methods_refuse_it(method: str) -> None:
    options: dict[str, Any] = {} if method == "exact" else {"dt": 1e-3}
    with pytest.raises(bs.InputError, match="function in Python"):
        end(one_mass(user(lambda q, v, t: 0.0)), method, **options)


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ({"force": 3.0}, "force"),
        ({"jacobian": "no"}, "jacobian"),
        ({"memory": "full"}, "memory"),
        ({"further_directions": [(0, 0, 0)]}, "further_directions"),
        ({"further_directions": [(0, 1, 0)] * 3}, "further_directions"),
    ],
)
def test_bad_input_is_refused(wrong: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        bs.UserLaw("mine", **HERE | {"force": lambda q, v, t: 0.0} | wrong)
    assert caught.value.key == key


def program(asked: list[int]) -> Generator[float, tuple[int, float, float], None]:
    """Answer as a spring and a damper, with a state of its own: the number of the step."""
    step, q, v = yield 0.0
    while True:
        asked.append(step)
        step, q, v = yield -40.0 * q - 2.0 * v


def test_a_program_outside_is_asked_once_a_step_and_never_again() -> None:
    asked: list[int] = []
    running = program(asked)
    next(running)
    outside = bs.OutsideProgram("out", exchange=lambda *told: running.send(told), **HERE)
    inside = bs.SpringLaw("in", stiffness=[40.0], damping=2.0, **HERE)
    problems = [one_mass(law, speed=1.0, duration=0.5) for law in (outside, inside)]
    runs = [bs.simulate(problem, "symplectic_euler", dt=1e-3) for problem in problems]
    told = len(asked)
    times = np.linspace(0.0, 0.5, 26)
    one, other = (run.sample("displacement", "P", "dx", times=times) for run in runs)
    assert one == pytest.approx(other, rel=1e-12, abs=1e-15)
    forces = [
        run.sample("stop_force", law, times=times)
        for run, law in zip(runs, ("out", "in"), strict=True)
    ]
    assert forces[0] == pytest.approx(forces[1], rel=1e-9)
    assert runs[0].energy_residual < 0.1
    assert len(asked) == told
    assert asked == list(range(len(asked)))
    assert 500 <= len(asked) <= 500 + 64


def test_a_program_outside_converges_to_what_scipy_makes_of_it() -> None:
    """x'' = -40 x - 2 x' - 50 p with a pressure p' = 6 (x' - p) that the program carries itself."""

    def error(steps: int) -> float:
        h = 1.0 / steps

        def exchange(step: int, q: float, v: float) -> float:
            pressure[0] += h * 6.0 * (v - pressure[0])
            return -40.0 * q - 2.0 * v - 50.0 * pressure[0]

        pressure = [0.0]
        law = bs.OutsideProgram("out", exchange=exchange, **HERE)
        run = bs.simulate(one_mass(law, speed=1.0), "symplectic_euler", dt=h)
        found = run.sample("displacement", "P", "dx", times=times)
        return float(np.abs(found - known).max() / np.abs(known).max())

    def slope(_: float, y: Any) -> list[float]:
        x, v, p = y
        return [v, -40.0 * x - 2.0 * v - 50.0 * p, 6.0 * (v - p)]

    times = np.linspace(0.0, 1.0, 21)
    start = [0.0, 1.0, 0.0]
    known = solve_ivp(slope, (0.0, 1.0), start, "DOP853", times, rtol=1e-13, atol=1e-15).y[0]
    coarse, fine = error(1000), error(8000)
    assert fine < 5e-3
    assert np.log(coarse / fine) / np.log(8.0) == pytest.approx(1.0, abs=0.05)


def test_the_force_of_a_program_outside_is_read_as_it_was_told() -> None:
    outside = bs.OutsideProgram(
        "out", exchange=lambda step, q, v: -2.0 if step >= 300 else 0.0, **HERE
    )
    run = bs.simulate(one_mass(outside, speed=1.0, duration=0.5), "symplectic_euler", dt=1e-3)
    force = run.sample("stop_force", "out", times=[0.0, 0.1, 0.2985, 0.3015, 0.5])
    assert force.tolist() == [0.0, 0.0, 0.0, -2.0, -2.0]
    way = np.ptp(run.sample("displacement", "P", "dx", times=[0.3, 0.5]))
    lost = run.energy_terms([0.5])["dissipated_stops"][0]
    assert lost == pytest.approx(2.0 * way, rel=0.01)


def test_other_methods_refuse_a_program_outside() -> None:
    problem = one_mass(bs.OutsideProgram("out", exchange=lambda n, q, v: 0.0, **HERE))
    for method, options in (("auto", {}), ("newmark", {"dt": 1e-3}), ("rk54", {})):
        with pytest.raises(bs.InputError, match=r"'out'.*once a step.*symplectic_euler"):
            bs.simulate(problem, method, **options)  # type: ignore[arg-type]


def test_what_goes_wrong_outside_is_told_with_its_step() -> None:
    outside = bs.OutsideProgram("out", exchange=lambda n, q, v: 1 / (n - 20), **HERE)
    with pytest.raises(bs.ComputationError, match=r"program of law 'out' raised Zero.* at step 20"):
        bs.simulate(one_mass(outside), "symplectic_euler", dt=1e-3)
