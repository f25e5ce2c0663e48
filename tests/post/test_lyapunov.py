"""Lyapunov exponents against multipliers in closed form and against pairs of trajectories."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.arguments import FloatArray
from bumpstop.post.lyapunov import _Tangents
from bumpstop.report.curves import state_spans


def impact_oscillator(
    frequency: float = 4.0, duration: float = 200.0, restitution: float = 0.8
) -> bs.Response:
    """The oscillator of Shaw and Holmes (Journal of Sound and Vibration 90 (1983) 129-155)."""
    basis = bs.ModalBasis.from_modes(frequency=[1.0], damping=0.02, shapes={("P", "dx"): [1.0]})
    wall = bs.RigidStop("wall", node="P", normal=(1, 0, 0), gap=0.0, restitution=restitution)
    load = bs.NodalForce(
        "load", node="P", force=(100.0, 0, 0), time=bs.Harmonic(frequency, cosine=1.0)
    )
    return bs.simulate(bs.Problem(basis, laws=[wall], loads=[load], duration=duration))


def test_a_periodic_impact_motion_has_its_multipliers() -> None:
    """One impact in n periods: the product of the multipliers is r^2 exp(-2 xi w n T).

    (Shaw and Holmes, equation for the determinant of the map.) Where they are complex, both
    exponents are half of the logarithm over n T.
    """
    run = impact_oscillator()
    found = bs.lyapunov_exponents(run, exponents=2, start=100.0)
    expected = math.log(0.8) / 0.5 - 0.02 * 2.0 * math.pi
    assert found.values.sum() == pytest.approx(2.0 * expected, rel=1e-9)
    np.testing.assert_allclose(found.values, expected, rtol=0.05)


def soft(damping: float = 3.0) -> bs.Problem:
    """Two modes, two soft stops with dampers, one of them shaken, and a spring of two slopes."""
    shapes = {("P", "dx"): [1.0, 0.6], ("Q", "dx"): [0.5, -1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[1.0, 3.3], damping=0.02, shapes=shapes)
    shaken = bs.Harmonic(0.7, sine=0.02)
    laws: list[Any] = [
        bs.Stop("p", node="P", normal=(1, 0, 0), gap=0.05, stiffness=900.0, damping=damping),
        bs.Stop("q", node="Q", normal=(-1, 0, 0), gap=0.1, stiffness=400.0, motion=shaken),
        bs.SpringLaw("s", node="Q", direction=(1, 0, 0), stiffness=(5.0, 60.0), breaks=(0.1,)),
    ]
    load = bs.NodalForce("load", node="P", force=(12.0, 0, 0), time=bs.Harmonic(1.4, cosine=1.0))
    return bs.Problem(basis, laws=laws, loads=[load], duration=60.0)


def later(problem: bs.Problem, time: float, duration: float, state: FloatArray) -> bs.Problem:
    """Return the problem from an instant on, from some state."""
    modes = len(state) // 2

    def shifted(function: Any) -> bs.Harmonic:
        angle = 2.0 * math.pi * function.frequency * time
        cosine, sine = function.cosine, function.sine
        return bs.Harmonic(
            function.frequency,
            cosine=cosine * math.cos(angle) + sine * math.sin(angle),
            sine=sine * math.cos(angle) - cosine * math.sin(angle),
        )

    laws: list[Any] = []
    for law in problem.laws:
        if isinstance(law, bs.Stop):
            motion = tuple(shifted(each) for each in law.functions)
            laws.append(
                bs.Stop(
                    law.name,
                    node=law.node,
                    normal=law.normal,
                    gap=law.gap,
                    stiffness=law.stiffness,
                    damping=law.damping,
                    motion=motion,
                )
            )
        else:
            laws.append(law)
    (load,) = problem.loads
    assert isinstance(load, bs.NodalForce)
    moved = bs.NodalForce("load", node="P", force=load.force, time=shifted(load.functions[0]))
    start = bs.ModalState(displacement=state[:modes], velocity=state[modes:])
    return bs.Problem(problem.basis, laws=laws, loads=[moved], initial=start, duration=duration)


def by_pairs(run: bs.Response, start: float, step: float, small: float = 1e-7) -> float:
    """Return the largest exponent by a second trajectory, started anew beside the first."""
    times = np.arange(start, run.problem.duration + 0.5 * step, step)
    states = np.hstack([run.motion(0, times), run.motion(1, times)])
    apart = np.full(states.shape[1], small)
    growth = 0.0
    for time, state, then in zip(times[:-1], states[:-1], states[1:], strict=True):
        beside = bs.simulate(later(run.problem, float(time), step, state + apart), "exact")
        end = np.concatenate([beside.motion(0, [step])[0], beside.motion(1, [step])[0]])
        difference = end - then
        growth += math.log(np.linalg.norm(difference) / np.linalg.norm(apart))
        apart = difference * (small / np.linalg.norm(difference))
    return growth / float(times[-1] - times[0])


@pytest.mark.parametrize("problem", [soft(), soft(damping=0.0)], ids=["damped", "elastic"])
def test_against_pairs_of_trajectories(problem: bs.Problem) -> None:
    run = bs.simulate(problem, "exact")
    assert run.event_count > 100
    found = bs.lyapunov_exponents(run, start=10.0)
    # Both begin with other vectors, which takes a bit of the 50 s.
    assert found.largest == pytest.approx(by_pairs(run, 10.0, 0.5), abs=0.05)


@pytest.mark.parametrize("frequency", [2.86, 3.1])
def test_rigid_impacts_against_pairs(frequency: float) -> None:
    run = impact_oscillator(frequency, 60.0, 0.9)
    found = bs.lyapunov_exponents(run, start=20.0)
    assert found.largest == pytest.approx(by_pairs(run, 20.0, 0.37), abs=0.06)


def test_volumes_shrink_as_dampers_and_impacts_say() -> None:
    """The sum of all exponents: minus the mean trace of damping, less that of impacts."""
    run = bs.simulate(soft(), "exact")
    found = bs.lyapunov_exponents(run, exponents=4)
    row = run.problem.basis.row("P", "dx")
    closed = [end - start for start, end in state_spans(run, "p", "closed")]
    assert len(closed) > 20
    trace = float(run.problem.basis.damping.sum()) + 3.0 * float(row @ row) * sum(closed) / 60.0
    assert found.values.sum() == pytest.approx(-trace, rel=1e-9)


def tangent_map(run: bs.Response) -> FloatArray:
    """Return how differences of the start become those of the end, by the equations."""
    motion = _Tangents(run)
    total = np.eye(2 * len(run.problem.basis.omega2))
    for step in motion.steps(0.0):
        total = step.jump @ (motion.propagator(step) @ total)
    return total


def by_differences(problem: Callable[[FloatArray], bs.Problem], state: FloatArray) -> FloatArray:
    """Return the same by runs from neighbouring states."""

    def end(start: FloatArray) -> FloatArray:
        run = bs.simulate(problem(start), "exact")
        last = [run.problem.duration]
        return np.concatenate([run.motion(0, last)[0], run.motion(1, last)[0]])

    sides = [(end(state + 1e-6 * e), end(state - 1e-6 * e)) for e in np.eye(len(state))]
    return np.stack([(above - below) / 2e-6 for above, below in sides], axis=1)


def test_a_stop_that_pushes_again_before_its_gap_opens() -> None:
    """The force rises from zero there: differences do not jump, as they do at a closing."""
    basis = bs.ModalBasis.from_modes(
        frequency=[1.0, 9.3], damping=0.02, shapes={("P", "dx"): [1.0, 1.0]}
    )
    wall = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=0.01, stiffness=149.0, damping=12.9)
    shaker = bs.Harmonic(7.29, cosine=1.0)
    load = bs.NodalForce("load", node="P", force=(600.0, 0, 0), time=shaker)
    push = bs.NodalForce("push", node="P", force=(-50.0, 0, 0))

    def problem(state: FloatArray) -> bs.Problem:
        start = bs.ModalState(displacement=state[:2], velocity=state[2:])
        return bs.Problem(basis, laws=[wall], loads=[load, push], initial=start, duration=1.0)

    state = np.array([0.1, 0.0, 0.0, 0.0])
    run = bs.simulate(problem(state), "exact")
    events = run.events
    assert ((events["before"] == "released") & (events["after"] == "closed")).any()
    assert ((events["before"] == "open") & (events["after"] == "closed")).any()
    expected = by_differences(problem, state)
    found = tangent_map(run)
    np.testing.assert_allclose(found, expected, atol=1e-5 * float(np.abs(expected).max()))


def test_dampers_of_several_slopes() -> None:
    """Their force has kinks and no jumps: beside a stop, against neighbouring runs."""
    basis = bs.ModalBasis.from_modes(
        frequency=[1.0, 9.3], damping=0.02, shapes={("P", "dx"): [1.0, 1.0]}
    )
    laws: list[Any] = [
        bs.DamperLaw(
            "valve", node="P", direction=(1, 0, 0), damping=(1.0, 12.0, 3.0), breaks=(-1.0, 2.0)
        ),
        bs.Stop("wall", node="P", normal=(1, 0, 0), gap=0.05, stiffness=400.0, damping=2.0),
    ]
    load = bs.NodalForce("load", node="P", force=(300.0, 0, 0), time=bs.Harmonic(2.3, cosine=1.0))

    def problem(state: FloatArray) -> bs.Problem:
        start = bs.ModalState(displacement=state[:2], velocity=state[2:])
        return bs.Problem(basis, laws=laws, loads=[load], initial=start, duration=1.0)

    state = np.array([0.1, 0.0, 0.0, 0.0])
    run = bs.simulate(problem(state), "exact")
    assert {"valve", "wall"} == set(run.events["law"])
    expected = by_differences(problem, state)
    found = tangent_map(run)
    np.testing.assert_allclose(found, expected, atol=1e-5 * float(np.abs(expected).max()))


def test_what_remembers_is_refused_by_name() -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[1.0], shapes={("P", "dx"): [1.0], ("P", "dy"): [0.5]}
    )
    pad = bs.Stop(
        "pad", node="P", normal=(1, 0, 0), gap=0.1, stiffness=1e3,
        friction=0.3, sliding={("P", "dy"): 1.0}, tangential_stiffness=1e3,
    )  # fmt: skip
    run = bs.simulate(bs.Problem(basis, laws=[pad], duration=1.0), "exact")
    with pytest.raises(bs.InputError, match=r"law: rubs.*'pad'.*stops without friction") as caught:
        bs.lyapunov_exponents(run)
    assert "\n" not in str(caught.value)


def test_it_converges_and_can_be_drawn() -> None:
    found = bs.lyapunov_exponents(impact_oscillator(duration=40.0), exponents=2)
    assert found.convergence.dims == ("time", "exponent")
    assert found.convergence[-1].values.tolist() == found.values.tolist()
    assert bs.plot(found.convergence.sel(exponent=1)).data[0].type == "scatter"


def test_refuses() -> None:
    run = impact_oscillator(duration=5.0)
    with pytest.raises(bs.InputError, match="at most 2"):
        bs.lyapunov_exponents(run, exponents=3)
    with pytest.raises(bs.InputError, match="before the end"):
        bs.lyapunov_exponents(run, start=5.0)
    basis = run.problem.basis
    falling = bs.NodalForce("weight", node="P", force=(-400.0, 0, 0))
    rest = bs.simulate(bs.Problem(basis, laws=run.problem.laws, loads=[falling], duration=5.0))
    with pytest.raises(bs.InputError, match="comes to rest"):
        bs.lyapunov_exponents(rest)
    stepped = bs.simulate(bs.Problem(basis, duration=1.0), "central_difference", dt=1e-2)
    with pytest.raises(bs.InputError, match="exact method"):
        bs.lyapunov_exponents(stepped)
