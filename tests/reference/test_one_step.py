"""The classical schemes against closed forms, the exact method, and each other."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs

from .problem import Array

CASES = Path(__file__).parents[2] / "cases"
IMPLICIT = ("newmark", "hht", "generalized_alpha", "trbdf2", "exponential")
SCHEMES = (*IMPLICIT, "devogelaere")


def oscillator(frequency: float = 1.0, **changes: Any) -> bs.Problem:
    """One mode that starts at 1 with velocity 0."""
    basis = bs.ModalBasis.from_modes(
        frequency=[frequency], damping=changes.pop("damping", 0.0), shapes={("P", "dx"): [1.0]}
    )
    given: dict[str, Any] = {"initial": bs.ModalState(displacement=[1.0]), "duration": 10.0}
    return bs.Problem(basis, **given | changes)


def bouncing(**stop: Any) -> bs.Problem:
    """Two modes that hit a stop several times, under a load that changes."""
    basis = bs.ModalBasis.from_modes(
        frequency=[3.0, 7.5], damping=0.01, shapes={("P", "dx"): [1.0, 0.4]}
    )
    given = {"gap": 1e-3, "stiffness": 2e4} | stop
    guide = bs.Stop("guide", node="P", normal=(-1, 0, 0), **given)
    shake = bs.NodalForce("shake", node="P", force=(1, 0, 0), time=bs.Harmonic(2.0, cosine=5.0))
    start = bs.ModalState(velocity=[0.2, 0.0])
    return bs.Problem(basis, laws=[guide], loads=[shake], initial=start, duration=0.6)


def error(response: bs.Response, exact: bs.Response) -> float:
    """Largest difference of the modal displacements over the largest of them."""
    times = np.linspace(0.0, exact.problem.duration, 301)
    found, true = (each.history.motion(times, 0) for each in (response, exact))
    return float(np.abs(found - true).max() / np.abs(true).max())


def displacements(response: bs.Response, times: Any) -> Array:
    """Of the first mode."""
    found: Array = response.history.motion(np.array(times, dtype=np.float64), 0)[:, 0]
    return found


def amplitude(response: bs.Response, step: int) -> float:
    """Half the square root of displacement and velocity over the frequency squared."""
    dt = response.options["dt"]
    q, v = (response.history.motion(np.array([step * dt]), order)[0, 0] for order in (0, 1))
    omega = 2 * np.pi * response.problem.basis.frequencies[0]
    return float(np.hypot(q, v / omega))


def test_average_acceleration_keeps_the_energy() -> None:
    """Newmark, section 9.1 of Hughes: the amplitude of a free mode stays, at any step."""
    response = bs.simulate(oscillator(), "newmark", dt=0.05)
    found = [amplitude(response, step) for step in (0, 77, 200)]
    assert found == pytest.approx([1.0] * 3, rel=1e-12)


@pytest.mark.parametrize("radius", [0.3, 0.8])
def test_generalised_alpha_leaves_what_it_is_told(radius: float) -> None:
    """A mode far too fast for the step follows a recursion whose three roots are the radius."""
    fast = oscillator(1e5, duration=20.0)
    response = bs.simulate(fast, "generalized_alpha", dt=1.0, spectral_radius=radius)
    x = displacements(response, range(1, 12))
    before = np.column_stack([x[2:-1], x[1:-2], x[:-3]])
    sums = np.linalg.lstsq(before, x[3:])[0]
    roots = -radius * np.ones(3)
    # Accelerations of 1e11 round displacements of 1, and roots that coincide feel it.
    assert np.concatenate([[1.0], -sums]) == pytest.approx(np.poly(roots), rel=1e-3)


def test_generalised_alpha_of_radius_zero_removes_the_highest_modes() -> None:
    fast = oscillator(1e5, duration=20.0)
    response = bs.simulate(fast, "generalized_alpha", dt=1.0, spectral_radius=0.0)
    assert np.abs(displacements(response, range(4, 20))).max() < 1e-9


@pytest.mark.parametrize("method", IMPLICIT)
@pytest.mark.parametrize("frequency", [1.0, 30.0, 1e4])
def test_every_step_is_stable(method: str, frequency: float) -> None:
    response = bs.simulate(oscillator(frequency, duration=200.0), method, dt=0.37)
    ends = 0.37 * np.arange(300, 540)
    # What is left is rounding of the exponential of an angle of 2e4.
    assert np.abs(displacements(response, ends)).max() < 1.0 + 1e-8


@pytest.mark.parametrize(
    ("method", "options", "limit"),
    [
        ("devogelaere", {}, 2 * np.sqrt(2)),
        ("newmark", {"beta": 0.0}, 2.0),
        ("newmark", {"beta": 1 / 6}, 2 * np.sqrt(3)),
    ],
)
def test_steps_beyond_the_limit_blow_up_and_are_refused(
    method: str, options: dict[str, Any], limit: float
) -> None:
    problem = oscillator(1 / (2 * np.pi), duration=400.0)
    response = bs.simulate(problem, method, dt=0.99 * limit, **options)
    assert np.abs(displacements(response, [390.0])).max() < 20.0
    with pytest.raises(bs.InputError, match=f"stability limit of {limit:.6g} s of the {method}"):
        bs.simulate(problem, method, dt=1.01 * limit, **options)
    with pytest.raises(bs.ComputationError, match="the motion blows up"):
        bs.simulate(problem, method, dt=1.01 * limit, beyond_stability_limit=True, **options)


def test_damping_lowers_the_limit_of_devogelaere() -> None:
    """Where 3 w^2 h^2 + 4 c h = 24."""
    ratio, omega = 0.8, 1.0
    damping = 2 * ratio * omega
    limit = 12 / (damping + np.sqrt(damping**2 + 18 * omega**2))
    problem = oscillator(omega / (2 * np.pi), damping=ratio, duration=600.0)
    quiet = bs.simulate(problem, "devogelaere", dt=0.98 * limit)
    assert np.abs(displacements(quiet, [590.0])).max() < 1e-3
    with pytest.raises(bs.ComputationError, match="the motion blows up"):
        bs.simulate(problem, "devogelaere", dt=1.02 * limit, beyond_stability_limit=True)


def test_exponentials_are_exact_for_a_linear_structure() -> None:
    """At a step of several periods, under a load that grows linearly."""
    grows = bs.NodalForce("grows", node="P", force=(1, 0, 0), time=bs.Polynomial([1.0, 2.0]))
    problem = oscillator(damping=0.05, loads=[grows])
    times = np.arange(0.0, 10.0, 2.5)
    exactly: dict[str, Any] = {}
    runs = (("exponential", {"dt": 2.5}), ("exact", exactly))
    found, exact = (
        displacements(bs.simulate(problem, method, **options), times) for method, options in runs
    )
    assert found == pytest.approx(exact, abs=1e-13)


@pytest.mark.parametrize("method", SCHEMES)
@pytest.mark.parametrize("damping", [0.0, 60.0])
def test_contacts_converge_to_the_exact_ones(method: str, damping: float) -> None:
    """At second order where the force is continuous, at first where it jumps."""
    problem = bouncing(damping=damping)
    exact = bs.simulate(problem, "exact")
    assert len(exact.impact_table()["start"]) > 2
    steps = [4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5, 1.25e-5]
    runs = [bs.simulate(problem, method, dt=dt) for dt in steps]
    errors = [error(run, exact) for run in runs]
    order = -np.polyfit(np.arange(6.0), np.log2(errors), 1)[0]
    assert order > (1.8 if damping == 0.0 else 0.8)
    assert errors[-1] < 1e-3
    for column in ("start", "end", "closing_speed", "peak_force", "impulse", "energy_returned"):
        found, true = (run.impact_table()[column] for run in (runs[-1], exact))
        assert found == pytest.approx(true, rel=5e-3, nan_ok=True)
    assert runs[-1].energy_residual < 5e-3
    assert runs[-1].steps == 48000


@pytest.mark.parametrize("method", SCHEMES)
@pytest.mark.parametrize(
    ("name", "variant"),
    [("sdnd100a", "published"), ("sdnd102a", "exact"), ("sdnl105b", "converged")],
)
def test_cases_converge(method: str, name: str, variant: str) -> None:
    """Friction, base motion, and stops between structures."""
    problem = bs.load_case(CASES / name / "case.toml").problems[variant]
    exact = bs.simulate(problem, "exact")
    coarse, fine = (
        error(bs.simulate(problem, method, dt=problem.duration / steps), exact)
        for steps in (2500, 20000)
    )
    assert fine < 0.3 * coarse
    assert fine < 1e-2


@pytest.mark.parametrize("method", SCHEMES)
@pytest.mark.parametrize("damping", [1e3, 1e5])
def test_a_damper_that_throws_off_within_a_step_is_no_obstacle(method: str, damping: float) -> None:
    """The force that jumps at closing has no equilibrium at the end of some steps."""
    problem = bouncing(damping=damping)
    response = bs.simulate(problem, method, dt=2e-3, beyond_stability_limit=True)
    assert np.abs(response.sample("displacement", "P", "dx")).max() < 0.1
    force = response.sample("stop_force", "guide")
    assert (force >= 0.0).all()


@pytest.mark.parametrize("method", SCHEMES)
def test_hertz_contact_converges_to_the_adaptive_solution(method: str) -> None:
    basis = bs.ModalBasis.from_modes(frequency=[3.0], damping=0.01, shapes={("P", "dx"): [1.0]})
    ball = bs.HertzStop("ball", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=1e6)
    start = bs.ModalState(velocity=[0.2])
    problem = bs.Problem(basis, laws=[ball], initial=start, duration=0.6)
    true = bs.simulate(problem, "dop853", rtol=1e-11)
    errors = [error(bs.simulate(problem, method, dt=dt), true) for dt in (8e-4, 4e-4, 2e-4, 1e-4)]
    assert np.log2(errors[0] / errors[-1]) / 3 > 1.7
    assert errors[-1] < 1e-2


def rotor(**changes: Any) -> bs.Problem:
    """A disc on springs, whose gyroscopic forces couple its modes, beside a stop that moves."""
    skew = np.array([[0.0, 3.0], [-3.0, 0.0]])
    model = bs.Matrices(
        mass=np.eye(2),
        stiffness=np.diag([400.0, 900.0]),
        gyroscopic=skew,
        dofs=[("P", "dx"), ("P", "dy")],
    )
    basis = bs.ModalBasis.from_structure(model, modes="all")
    motion = bs.Harmonic(1.5, cosine=1e-3)
    guide = bs.Stop("guide", node="P", normal=(-1, 0, 0), gap=5e-3, stiffness=2e4, motion=motion)
    start = bs.ModalState(velocity=[0.2, 0.0])
    return bs.Problem(basis, laws=[guide], initial=start, duration=0.6, **changes)


@pytest.mark.parametrize("method", ["newmark", "hht", "generalized_alpha", "trbdf2"])
def test_coupled_modes_and_moving_stops_converge(method: str) -> None:
    problem = rotor()
    exact = bs.simulate(problem, "exact")
    assert len(exact.impact_table()["start"]) > 1
    errors = [error(bs.simulate(problem, method, dt=dt), exact) for dt in (8e-4, 4e-4, 2e-4, 1e-4)]
    assert np.log2(errors[0] / errors[-1]) / 3 > 1.8


@pytest.mark.parametrize("method", ["devogelaere", "exponential"])
def test_schemes_that_go_mode_by_mode_refuse_coupled_ones(method: str) -> None:
    with pytest.raises(bs.InputError, match=f"does not take modes that damping.*got '{method}'"):
        bs.simulate(rotor(), method, dt=1e-3)
