"""The energy ledger over many impacts, and its terms against quadrature of their own powers."""

import numpy as np
import pytest

from . import sdnl32
from .precise import PreciseSolution
from .problem import Array, StopProblem

IMPACTS = 10_000


def bouncing_ball(duration: float) -> StopProblem:
    """Return a ball of 2 kg falling from half a metre onto a spring, again and again."""
    row = np.array([np.sqrt(0.5)])
    return StopProblem(
        omega2=np.zeros(1),
        damping=np.zeros(1),
        row=row,
        gap=0.5,
        stiffness=5e4,
        force=-2 * 9.81 * row,
        duration=duration,
    )


def pressed_beam(duration: float) -> StopProblem:
    """Return the undamped beam of SDNL32, its tip pressed onto the stop by 40 N.

    Its motion is chaotic: rounding moves the number of impacts by a tenth either way.
    """
    beam = sdnl32.clean(45e3, ratio=0.0)
    return beam.but(force=-40.0 * beam.row, duration=duration)


@pytest.mark.parametrize(
    "problem", [bouncing_ball(7000.0), pressed_beam(75.0)], ids=["ball", "beam"]
)
def test_ten_thousand_impacts_keep_the_energy(problem: StopProblem) -> None:
    history = problem.solve()
    assert history.impacts(0)["start"].size >= IMPACTS
    assert history.energy_residual() < 1e-12


@pytest.mark.parametrize("stiffness", sdnl32.EXACT)
def test_damped_sdnl32_keeps_the_energy(stiffness: float) -> None:
    assert sdnl32.clean(stiffness).solve().energy_residual() < 1e-11


def quadrature(solution: PreciseSolution, time: float) -> dict[str, float]:
    """Return the works done up to a time, by Gauss's rule over each step of the oracle."""
    problem = solution.problem
    nodes, weights = np.polynomial.legendre.leggauss(16)
    work = {"modal_dissipation": 0.0, "load_work": 0.0, "stop": 0.0}
    for step in solution.steps:
        start, length = float(step.start), float(step.length * step.end)
        span = min(length, time - start)
        if span <= 0:
            break
        times = start + span * (nodes + 1) / 2
        velocity = solution.motion(times)[1]
        force = solution.contact(times)[1]
        scale = weights * span / 2
        work["modal_dissipation"] += float(scale @ (velocity**2 @ problem.damping))
        work["load_work"] += float(scale @ (velocity @ problem.force))
        work["stop"] -= float(scale @ (force * (velocity @ problem.row)))
    return work


@pytest.mark.parametrize("stop_damping", [0.0, 20.0])
def test_every_term_of_the_ledger_is_the_integral_of_its_power(stop_damping: float) -> None:
    beam = sdnl32.clean(45e3)
    problem = beam.but(stop_damping=stop_damping, force=-40.0 * beam.row, duration=0.03)
    solution, history = PreciseSolution(problem), problem.solve()
    assert len(solution.events) > 1
    for time in (0.004, 0.0213, 0.03):
        times: Array = np.array([time])
        found = {name: float(np.ravel(term)[0]) for name, term in history.energy(times).items()}
        displacement, velocity = (float_row[0] for float_row in solution.motion(times))
        distance, force = (float(value[0]) for value in solution.contact(times))
        expected = quadrature(solution, time)
        total = float(problem.velocity @ problem.velocity) / 2
        close = pytest.approx
        assert found["kinetic"] == close(velocity @ velocity / 2, abs=1e-13 * total)
        elastic = problem.omega2 @ displacement**2 / 2
        assert found["elastic"] == close(elastic, abs=1e-13 * total)
        stored = problem.stiffness * distance**2 / 2 if force > 0 else 0.0
        assert found["law_stored"] == close(stored, abs=1e-13 * total)
        for name in ("modal_dissipation", "load_work"):
            assert found[name] == close(expected[name], abs=1e-12 * total)
        stop = found["law_stored"] + found["law_dissipated"]
        assert stop == close(expected["stop"], abs=1e-12 * total)
