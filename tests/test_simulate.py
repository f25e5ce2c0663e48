import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs


def problem(**changes: Any) -> bs.Problem:
    basis = bs.ModalBasis.from_modes(
        frequency=[3.0, 7.5], damping=0.01, shapes={("P", "dx"): [1.0, 0.4]}
    )
    stop = bs.Stop("guide", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=1e4)
    given: dict[str, Any] = {
        "initial": bs.ModalState(velocity=[0.2, 0.0]),
        "laws": [stop],
        "duration": 0.5,
    }
    return bs.Problem(basis, **(given | changes))


def test_auto_is_exact_and_says_why() -> None:
    response = bs.simulate(problem())
    assert response.method == "exact"
    assert "piecewise linear" in response.method_reason
    assert dict(response.options) == {}


@pytest.mark.parametrize(("highest", "taken"), [(1e3, "dop853"), (1e5, "exprk43")])
def test_auto_steps_over_stiff_modes_where_a_law_is_smooth(highest: float, taken: str) -> None:
    """Both come to the same motion, against the pair that follows every mode."""
    basis = bs.ModalBasis.from_modes(
        frequency=[5.0, 40.0, highest],
        damping=[0.01, 0.01, 0.01],
        shapes={("P", "dx"): [1.0, 0.6, 0.3]},
    )
    spring = bs.ForceRelation("spring", node="P", direction=(1, 0, 0), force="-1e9 * x**3")
    start = bs.ModalState(velocity=[0.5, 0.3, 0.0])
    stiff = bs.Problem(basis, laws=[spring], initial=start, duration=0.02)
    response = bs.simulate(stiff)
    assert response.method == taken
    assert "is not piecewise linear" in response.method_reason
    assert ("times the lowest frequency" in response.method_reason) == (taken == "exprk43")
    other = bs.simulate(stiff, "dop853", rtol=1e-11)
    found, expected = (each.sample("displacement", "P", "dx") for each in (response, other))
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-7 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("more", "what"),
    [
        ({"friction": 0.3}, "auto finds none: exact does not take friction at rigid stops"),
        ({}, "auto finds none: dop853 does not take rigid stops such as 'wall'"),
    ],
)
def test_auto_says_which_parts_no_method_of_its_own_takes(more: dict[str, Any], what: str) -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[5.0, 7.0], shapes={("P", "dx"): [1.0, 0.0], ("P", "dy"): [0.0, 1.0]}
    )
    wall = bs.RigidStop("wall", node="P", normal=(1, 0, 0), restitution=0.5, **more)
    ball: Any = bs.HertzStop("ball", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=1e7)
    laws = [wall] if more else [wall, ball]
    with pytest.raises(bs.InputError) as caught:
        bs.simulate(bs.Problem(basis, laws=laws, duration=1.0))
    assert str(caught.value).startswith(f"method: {what}")
    assert "moreau_jean with a step dt does" in str(caught.value)
    assert "got" not in str(caught.value)


def test_what_is_asked_for_is_taken() -> None:
    response = bs.simulate(problem(), method="central_difference", dt=1e-4)
    assert response.method == "central_difference"
    assert response.method_reason == "asked for"
    assert dict(response.options) == {"dt": 1e-4}
    assert response.steps == 5000
    assert response.solve_seconds > 0.0


def test_reading_on_does_not_change_the_time_that_a_run_took() -> None:
    response = bs.simulate(problem())
    taken = response.solve_seconds
    response.sample("displacement", "P", "dx")
    assert response.solve_seconds == taken


@pytest.mark.parametrize("method", ["symplectic_euler", "central_difference"])
def test_fixed_steps_approach_the_exact_solution(method: str) -> None:
    exact = bs.simulate(problem(), method="exact").sample("displacement", "P", "dx")
    coarse, fine = (
        bs.simulate(problem(), method=method, dt=dt).sample("displacement", "P", "dx")
        for dt in (2e-4, 2e-5)
    )
    assert np.abs(fine - exact).max() < 0.2 * np.abs(coarse - exact).max()


@pytest.mark.parametrize(
    ("options", "key", "what"),
    [
        ({"method": "exakt"}, "method", "did you mean 'exact'"),
        ({"method": None}, "method", "unknown method"),
        ({"method": "exact", "dt": 1e-4}, "dt", "of the exact method.*dt is for symplectic_euler"),
        ({"dt": 1e-4}, "dt", "no option of the exact method .got 0.0001.; it takes progress; dt"),
        ({"beyond_stability_limit": True}, "beyond_stability_limit", "no option of the exact"),
        ({"method": "exact", "rtol": 1e-6}, "rtol", "it takes progress; rtol is for auto and rk32"),
        ({"rtoll": 1e-6}, "rtoll", "no option of the exact method .got 1e-06.; known: progress"),
        (
            {"method": "central_difference", "rtol": 1e-6},
            "rtol",
            "no option of the central_difference method.*takes dt, beyond_stability_limit, ",
        ),
        ({"method": "central_difference", "dtt": 1e-4}, "dtt", "did you mean 'dt'"),
        ({"method": "central_difference"}, "dt", "needs a step.*stable up to"),
        ({"method": "symplectic_euler", "dt": 0.0}, "dt", "must be positive"),
        ({"method": "symplectic_euler", "dt": math.nan}, "dt", "must be finite"),
        ({"method": "symplectic_euler", "dt": "10 us"}, "dt", "must be a number"),
        ({"method": "central_difference", "dt": 0.6}, "dt", "must not exceed the duration"),
        ({"method": "central_difference", "dt": 1e-9}, "dt", "e.08 steps, more than the 6.7e.07"),
        ({"method": "central_difference", "dt": 0.1}, "dt", "above the stability limit"),
        ({"method": "newmark"}, "dt", "needs a step in s; every step is stable"),
        (
            {"method": "devogelaere", "dt": 0.1},
            "dt",
            "above the stability limit of 0.0240137 s",
        ),
        ({"method": "newmark", "dt": 1e-3, "beta": -1}, "beta", "must be from 0 to 1"),
        ({"method": "newmark", "dt": 1e-3, "gamma": 0.4}, "gamma", "must be from 0.5 to 1"),
        ({"method": "hht", "dt": 1e-3, "alpha": 0.1}, "alpha", "must be from -0.333333 to 0"),
        ({"method": "hht", "dt": 1e-3, "beta": 0.3}, "beta", "beta is for newmark"),
        (
            {"method": "generalized_alpha", "dt": 1e-3, "spectral_radius": 1.1},
            "spectral_radius",
            "must be from 0 to 1",
        ),
        (
            {"method": "newmark", "dt": 1e-3, "beyond_stability_limit": "no"},
            "beyond_stability_limit",
            "must be True or False",
        ),
        ({"progress": 3}, "progress", "must be a function"),
    ],
)
def test_refuses(options: dict[str, Any], key: str, what: str) -> None:
    with pytest.raises(bs.InputError, match=what) as caught:
        bs.simulate(problem(), **options)
    assert caught.value.key == key


@pytest.mark.parametrize("modes", [1, 8, 9, 40])
def test_steps_that_memory_cannot_hold_are_refused_before_the_core_does(modes: int) -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0] * modes, shapes={("P", "dx"): [1.0] * modes})
    start = bs.ModalState(velocity=[1.0] * modes)
    long = bs.Problem(basis, initial=start, duration=1e4, sample=1.0)
    most = 4 * 2**30 // (64 * math.ceil(modes / 8))
    with pytest.raises(bs.InputError, match=r"dt: makes .* that memory holds .*; take at least"):
        bs.simulate(long, method="central_difference", dt=1e4 / (most + 10))
    most = 4 * 2**30 // (32 * (2 * modes + 4))
    with pytest.raises(bs.InputError, match=r"dt: makes .* that memory holds .*; take at least"):
        bs.simulate(long, method="newmark", dt=1e4 / (most + 10))


def test_energies_beyond_all_numbers_are_refused() -> None:
    with pytest.raises(bs.InputError, match="too fast to compute with") as caught:
        bs.simulate(problem(initial=bs.ModalState(velocity=[1e200, 0.0])))
    assert caught.value.key == "initial"


def test_a_case_is_no_problem() -> None:
    case = bs.load_case(Path(__file__).parents[1] / "cases" / "sdnl32" / "case.toml")
    with pytest.raises(bs.InputError, match=r"must be a Problem.*take one of its problems"):
        bs.simulate(case)  # type: ignore[arg-type]


def test_the_stability_limit_is_that_of_the_closed_stop() -> None:
    """Central difference is stable up to 2 / omega of the stiffest closed system."""
    stiff = np.diag((2 * np.pi * np.array([3.0, 7.5])) ** 2) + 1e4 * np.outer([1, 0.4], [1, 0.4])
    limit = 2.0 / math.sqrt(np.linalg.eigvalsh(stiff).max())
    bs.simulate(problem(), method="central_difference", dt=0.9 * limit)
    with pytest.raises(bs.InputError, match="stability limit"):
        bs.simulate(problem(), method="central_difference", dt=1.05 * limit)


def damped_spectral_radius(omega: float, damping: float, dt: float) -> float:
    """Return that of central difference with the rate by the backward difference, from its text."""
    h, e = (omega * dt) ** 2, damping * dt
    return float(np.abs(np.roots([1.0, -2.0 + h + 1.5 * e, 1.0 - 2.0 * e, 0.5 * e])).max())


@pytest.mark.parametrize("damping", [0.0, 1.0, 120.0, 400.0, 2000.0])
def test_a_damper_in_the_stop_lowers_the_limit_of_central_difference(damping: float) -> None:
    """One kilogram held on its stop by 100 N: found stable and unstable beside the limit."""
    mass = bs.ModalBasis.from_modes(frequency=[0.0], damping=[0.0], shapes={("P", "dx"): [1.0]})
    stop = bs.Stop("wall", node="P", normal=(1, 0, 0), stiffness=1e4, damping=damping)
    press = bs.NodalForce("press", node="P", force=(-100.0, 0, 0))
    start = bs.ModalState(displacement=[-0.011], velocity=[0.0])
    pressed = bs.Problem(mass, laws=[stop], loads=[press], initial=start, duration=2.0)
    limit = 2.0 / (damping + math.hypot(damping, 100.0))
    assert damped_spectral_radius(100.0, damping, 0.999 * limit) <= 1.0 + 1e-12
    assert damped_spectral_radius(100.0, damping, 1.001 * limit) > 1.0
    held = bs.simulate(pressed, method="central_difference", dt=0.95 * limit)
    assert np.abs(held.sample("displacement", "P", "dx")).max() < 0.03
    with pytest.raises(bs.InputError, match="stability limit"):
        bs.simulate(pressed, method="central_difference", dt=1.01 * limit)


def test_an_unstable_step_is_taken_when_asked_for_by_name() -> None:
    response = bs.simulate(
        problem(duration=0.1), method="central_difference", dt=0.03, beyond_stability_limit=True
    )
    assert response.steps == 4


def test_what_cannot_be_finished_is_said() -> None:
    """Far above the limit the motion leaves the range of numbers."""
    with pytest.raises(bs.ComputationError, match="central_difference method could not finish"):
        bs.simulate(
            problem(duration=400.0),
            method="central_difference",
            dt=0.4,
            beyond_stability_limit=True,
        )


@pytest.mark.parametrize("stiffness", [-1e7, -1e9])
def test_growth_beyond_all_numbers_is_said(stiffness: float) -> None:
    """The certified walk ends there; it used to halve its cells for ever."""
    spring = bs.SpringLaw("pull", node="P", direction=(1, 0, 0), stiffness=(stiffness,))
    growing = problem(laws=[*problem().laws, spring], duration=2.0)
    with pytest.raises(bs.ComputationError, match="grew beyond all bounds at t = "):
        bs.simulate(growing, "exact")


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are Linux's")
def test_steps_that_fill_the_memory_are_said() -> None:
    """A process with little memory left is told so, not ended."""
    source = """
import resource
import bumpstop as bs
basis = bs.ModalBasis.from_modes(frequency=[3.0], shapes={("P", "dx"): [1.0]})
damper = bs.ZenerDamper("d", node="P", direction=(1, 0, 0), series_stiffness=1e9,
    branch_stiffness=1e9, damping=1e-3, exponent=1.0)
start = bs.ModalState(velocity=[1.0])
def run(duration):
    bs.simulate(bs.Problem(basis, laws=[damper], initial=start, duration=duration), "dop853")
run(1e-11)
used = 4096 * int(open("/proc/self/statm").read().split()[0])
resource.setrlimit(resource.RLIMIT_AS, (used + 2**26, -1))
try:
    run(1.0)
except bs.ComputationError as error:
    print(error)
"""
    done = subprocess.run(
        [sys.executable, "-c", source], capture_output=True, text=True, check=False, timeout=300
    )
    assert "fill the memory" in done.stdout, done.stderr


def test_progress_is_told_between_0_and_1() -> None:
    seen: list[float] = []
    long = problem(duration=20.0)
    bs.simulate(long, method="central_difference", dt=1e-5, progress=seen.append)
    assert all(0.0 <= fraction <= 1.0 for fraction in seen)
    assert seen == sorted(seen)


@pytest.mark.parametrize("size", [1e155, 1e200, 1e300])
@pytest.mark.parametrize("method", ["auto", "newmark", "exponential", "dop853"])
def test_numbers_beyond_all_range_never_become_results(size: float, method: str) -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[5.0, 9.0], damping=[0.01, 0.01], shapes={("P", "dx"): [1.0, 0.5]}
    )
    wall = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=1e5)
    push = bs.NodalForce("push", node="P", force=(1.0, 0, 0), time=bs.Harmonic(1.0, sine=size))
    problem = bs.Problem(basis, laws=[wall], loads=[push], duration=1.0)
    dt = 1e-4 if method in ("newmark", "exponential") else None
    with pytest.raises(bs.InputError, match=r"loads\.push: pushes too hard to compute with"):
        bs.simulate(problem, method, dt=dt)


def test_energies_that_are_no_numbers_are_not_told() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    response = bs.simulate(bs.Problem(basis, duration=1.0))

    class Lost:
        def energy_residual(self) -> float:
            return math.nan

        def energy(self, times: Any) -> Any:
            terms = dict.fromkeys(
                ("kinetic", "elastic", "modal_dissipation"), np.full(len(times), np.nan)
            )
            works = ("load_work", "circulatory_work", "obstacle_work")
            shares = dict.fromkeys(("law_stored", "law_dissipated"), np.zeros((0, len(times))))
            return terms | dict.fromkeys(works, np.zeros(len(times))) | shares

    lost = replace(response, history=Lost())  # type: ignore[arg-type]
    for reading in (lambda: lost.energy_residual, lambda: lost.energy):
        with pytest.raises(bs.ComputationError, match="energies leave the range of numbers"):
            reading()
