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


@pytest.mark.parametrize("method", ["newmark", "exponential"])
@pytest.mark.parametrize("turn", [0.0, 0.3, 3.1, 3.2, 40.0])
@pytest.mark.parametrize("stiffness", [1e-2, 11.0, 13.0, 1e3, 1e9])
def test_springs_of_any_stiffness_leave_the_energy_as_it_is(
    method: str, turn: float, stiffness: float
) -> None:
    """Of a free mode and one that turns by some angle in each step of 1 s, tied by a spring."""
    shape = np.array([0.8, 0.6])
    omega = np.array([0.0, turn])
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0, turn / (2 * np.pi)], damping=0.0, shapes={("P", "dx"): list(shape)}
    )
    spring = bs.SpringLaw("k", node="P", direction=(1, 0, 0), stiffness=(stiffness,), breaks=())
    start = bs.ModalState(displacement=[1.0, -0.4], velocity=[0.0, 0.2])
    problem = bs.Problem(basis, laws=[spring], initial=start, duration=400.0)
    response = bs.simulate(problem, method, dt=1.0)
    q, v = (response.history.motion(np.arange(0.0, 400.0), order) for order in (0, 1))
    energy = (v**2).sum(1) + ((omega * q) ** 2).sum(1) + stiffness * (q @ shape) ** 2
    assert energy == pytest.approx(energy[0], rel=1e-6)


def test_dampers_of_laws_bound_the_step_of_exponentials() -> None:
    """A mode that turns by more than half a circle a step turns back between what a damper sees."""
    damper = bs.DamperLaw("c", node="P", direction=(1, 0, 0), damping=(1.0,), breaks=())
    problem = oscillator(0.5, laws=[damper], duration=300.0)
    stable = bs.simulate(problem, "exponential", dt=0.9)
    assert np.abs(displacements(stable, [290.0])).max() < 1.0
    with pytest.raises(bs.InputError, match="above the stability limit of 1 s of the exponential"):
        bs.simulate(problem, "exponential", dt=1.3)
    with pytest.raises(bs.ComputationError, match="the motion blows up"):
        bs.simulate(problem, "exponential", dt=1.3, beyond_stability_limit=True)


@pytest.mark.parametrize("method", [*SCHEMES, "moreau_jean"])
def test_motions_small_beside_the_breaks_of_a_law_are_those_of_its_segment(method: str) -> None:
    def run(stiffness: tuple[float, ...], breaks: tuple[float, ...]) -> Array:
        spring = bs.SpringLaw(
            "k", node="P", direction=(1, 0, 0), stiffness=stiffness, breaks=breaks
        )
        start = bs.ModalState(displacement=[1e-9])
        problem = oscillator(laws=[spring], initial=start, duration=0.5)
        return displacements(bs.simulate(problem, method, dt=1e-3), np.linspace(0.0, 0.5, 101))

    found, expected = run((4e3, 1e3, 4e3), (-2e-3, 2e-3)), run((1e3,), ())
    assert found == pytest.approx(expected, abs=1e-21)


@pytest.mark.parametrize("method", [*SCHEMES, "moreau_jean"])
@pytest.mark.parametrize(
    ("name", "variant"),
    [("damper-law", "valve"), ("spring-law", "play"), ("moving-stop", "coming")],
)
def test_laws_of_segments_and_moving_ones_converge(method: str, name: str, variant: str) -> None:
    problem = bs.load_case(CASES / name / "case.toml").problems[variant]
    exact = bs.simulate(problem, "exact")
    coarse, fine = (
        error(bs.simulate(problem, method, dt=problem.duration / steps), exact)
        for steps in (500, 4000)
    )
    assert fine < 0.1 * coarse
    assert fine < 1e-4


@pytest.mark.parametrize("method", [*SCHEMES, "moreau_jean"])
def test_a_motion_dies_out_on_a_damped_stop(method: str) -> None:
    """To numbers so small that they lose their digits."""
    stop = bs.Stop("stop", node="P", normal=(-1, 0, 0), gap=0.0, stiffness=1e4, damping=20.0)
    start = bs.ModalState(velocity=[1.0])
    problem = oscillator(50.0, damping=0.3, laws=[stop], initial=start)
    response = bs.simulate(problem, method, dt=1e-3)
    assert np.abs(displacements(response, [9.99])).max() < 1e-290


def between_walls(model: bs.ModalBasis | bs.FullModel) -> bs.Problem:
    """A unit mass of 1 m/s that goes to and fro between two stiff walls."""
    walls = [
        bs.Stop(name, node="P", normal=(side, 0, 0), gap=0.01, stiffness=1e6)
        for name, side in (("left", 1), ("right", -1))
    ]
    start = bs.NodalState(velocity={("P", "dx"): 1.0})
    return bs.Problem(model, laws=walls, initial=start, duration=20.0)


def unit_mass() -> bs.Structure:
    support = bs.Support(nodes="P", fixed=("dy", "dz", "drx", "dry", "drz"))
    mass = bs.PointMass("m", node="P", mass=1.0)
    return bs.Structure(nodes={"P": (0, 0, 0)}, masses=[mass], supports=[support])


@pytest.mark.parametrize("method", ["newmark", "generalized_alpha", "exponential", "moreau_jean"])
def test_energy_that_contacts_add_is_found_out(method: str) -> None:
    """Steps of three radians of the contact, at which no linear structure would grow."""
    problem = between_walls(bs.ModalBasis.from_structure(unit_mass(), modes=1))
    message = r"blows up: at t = .*e2 times .* mode 1; take a smaller step, a tenth of the shortest"
    with pytest.raises(bs.ComputationError, match=message):
        bs.simulate(problem, method, dt=3e-3)
    # A tenth of the time that a contact lasts, as the message says.
    calm = bs.simulate(problem, method, dt=3e-5)
    assert np.abs(calm.sample("velocity", "P", "dx")).max() < 2.0


def test_a_full_model_that_blows_up_says_where() -> None:
    problem = between_walls(bs.FullModel.from_structure(unit_mass()))
    with pytest.raises(bs.ComputationError, match=r"most of it in dof 1 of.*; dof 1 is P dx$"):
        bs.simulate(problem, "newmark", dt=3e-3)


@pytest.mark.parametrize("method", [*SCHEMES, "moreau_jean"])
@pytest.mark.parametrize(
    "time",
    [bs.Harmonic(1.0, sine=1.0), bs.Polynomial([0.0, 1.0]), bs.Polynomial([0.0, 0.0, 0.0, 1.0])],
)
def test_loads_that_move_what_was_at_rest_are_no_blow_up(method: str, time: Any) -> None:
    push = bs.NodalForce("push", node="P", force=(1e3, 0, 0), time=time)
    still = bs.ModalState(displacement=[0.0])
    for dt in (1e-3, 0.1, 0.25):
        problem = oscillator(loads=[push], initial=still)
        assert bs.simulate(problem, method, dt=dt).steps > 0


def test_blow_ups_are_seen_as_they_begin() -> None:
    problem = oscillator(1 / (2 * np.pi), duration=400.0)
    with pytest.raises(bs.ComputationError, match=r"t = 1\.2e1 s"):
        bs.simulate(problem, "devogelaere", dt=6.0, beyond_stability_limit=True)


def test_the_swinging_energy_of_symplectic_euler_is_no_blow_up() -> None:
    """Near the limit it is up to (1 + h w / 2) / (1 - h w / 2) of itself: 199 here."""
    start = bs.ModalState(displacement=[1.0], velocity=[-1.0])
    problem = oscillator(1 / (2 * np.pi), initial=start, duration=4000.0)
    response = bs.simulate(problem, "symplectic_euler", dt=1.98)
    energy = response.energy_terms()
    assert 100 < (energy["kinetic"] + energy["elastic"]).max() < 200
    with pytest.raises(bs.ComputationError, match="the motion blows up"):
        bs.simulate(problem, "symplectic_euler", dt=2.01, beyond_stability_limit=True)


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
