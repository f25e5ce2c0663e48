"""The adaptive methods against the exact one, against SciPy, and where they could go wrong."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs

from .several.coupled import random_coupled
from .several.forced import random_forced
from .several.multilinear import random_multilinear
from .several.random_problems import random_several
from .several.rubbing import random_rubbing
from .several.scan import ScanSolution

CASES = Path(__file__).parents[2] / "cases"
ADAPTIVE = ("rk32", "rk54", "dop853", "exprk43")


def case_problem(name: str, variant: str) -> bs.Problem:
    return bs.load_case(CASES / name / "case.toml").problems[variant]


def error(response: bs.Response, exact: bs.Response) -> float:
    """Largest difference of the modal displacements over the largest of them."""
    times = np.linspace(0.0, exact.problem.duration, 301)
    found, true = (each.history.motion(times, 0) for each in (response, exact))
    return float(np.abs(found - true).max() / np.abs(true).max())


def switches(history: Any, law: int) -> list[str]:
    """The states of one law, one after the other.

    Those that last for an instant only are left out: at the end of sliding it is rounding that
    decides whether the damper holds the slider for a moment.
    """
    columns = history.events()
    rows = zip(columns["time"], columns["law"], columns["after"], strict=True)
    own = [(time, after) for time, which, after in rows if which == law]
    lasting = [
        state for (time, state), (end, _) in pairwise([*own, (np.inf, "")]) if end - time > 1e-9
    ]
    return [state for before, state in pairwise(["", *lasting]) if state != before]


@pytest.mark.parametrize(
    ("name", "variant"),
    [
        ("sdnl32", "soft"),
        ("sdnl32", "stiff"),
        ("sdnd100a", "published"),  # friction
        ("sdnd101a", "exact"),
        ("sdnd102a", "exact"),
        ("sdnl104b", "exact"),
        ("sdnl105b", "converged"),
        ("sdnl111a", "exact"),
    ],
)
def test_cases_are_solved_as_the_exact_method_does(name: str, variant: str) -> None:
    problem = case_problem(name, variant)
    exact = bs.simulate(problem, "exact")
    events = exact.event_table()
    response = bs.simulate(problem, "dop853", rtol=1e-10)
    assert error(response, exact) < 1e-9
    assert response.energy_residual < 1e-9
    found = response.event_table()
    assert found["time"] == pytest.approx(events["time"], abs=1e-8 * problem.duration)
    for law in range(len(problem.laws)):
        assert switches(response.history, law) == switches(exact.history, law)
    for column in ("start", "closing_speed", "peak_force", "impulse", "energy_returned"):
        assert response.impact_table()[column] == pytest.approx(
            exact.impact_table()[column], rel=1e-6
        )


@pytest.mark.parametrize("method", ADAPTIVE)
def test_the_error_follows_the_tolerance(method: str) -> None:
    """Ten times the tolerance, ten times the error, or so; and of the size of the tolerance."""
    problem = case_problem("sdnl32", "soft")
    exact = bs.simulate(problem, "exact")
    tolerances = np.array([1e-3, 1e-4, 1e-5, 1e-6])
    errors = [error(bs.simulate(problem, method, rtol=rtol), exact) for rtol in tolerances]
    slope = np.polyfit(np.log(tolerances), np.log(errors), 1)[0]
    assert 0.7 < slope < 1.4
    assert all(errors < tolerances)


@pytest.mark.parametrize(
    ("method", "order"), [("rk32", 3), ("rk54", 5), ("dop853", 8), ("exprk43", 4)]
)
@pytest.mark.parametrize(("name", "variant"), [("sdnl32", "soft"), ("sdnd102a", "exact")])
def test_the_order_is_that_of_the_pair(method: str, order: int, name: str, variant: str) -> None:
    """Through contacts: the steps go with the tolerance to the power -1/order."""
    problem = case_problem(name, variant)
    exact = bs.simulate(problem, "exact")
    tolerances = (1e-6, 1e-9) if order > 3 else (1e-4, 1e-6)
    runs = [bs.simulate(problem, method, rtol=rtol) for rtol in tolerances]
    errors = [error(run, exact) for run in runs]
    steps = [run.steps for run in runs]
    found = np.log(errors[0] / errors[1]) / np.log(steps[1] / steps[0])
    assert found > 0.8 * order


LARGEST_GROWTH = 1e5
FAMILIES = {
    "several": random_several,
    "forced": random_forced,
    "coupled": random_coupled,
    "multilinear": random_multilinear,
    "rubbing": random_rubbing,
}


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("seed", range(8))
def test_random_problems_of_several_laws(family: str, seed: int) -> None:
    """The exact method is held against judges of its own in other files."""
    problem = FAMILIES[family](seed)
    # Up to where what is rounding in one of them may have grown to what the tolerance lets pass,
    # and not just to a switch.
    problem = problem.but(duration=0.99 * ScanSolution(problem, LARGEST_GROWTH).end)
    exact, found = problem.solve(), problem.solve("dop853", 1e-12)
    times = np.linspace(0.0, problem.duration, 41)
    true = exact.motion(times, 0)
    assert np.abs(found.motion(times, 0) - true).max() < 1e-8 * np.abs(true).max()
    assert found.energy_residual() < 1e-9
    for law in range(len(problem.laws)):
        assert switches(found, law) == switches(exact, law)


def test_a_dip_within_a_step_is_not_missed() -> None:
    """A high mode makes short dips into a stop that both ends of long steps are far from."""
    basis = bs.ModalBasis.from_modes(
        frequency=[1.0, 37.0], damping=[0.0, 0.0], shapes={("P", "dx"): [1.0, 0.02]}
    )
    start = bs.ModalState(displacement=[1.0, 1.0], velocity=[0.0, 0.0])

    def problem(gap: float) -> bs.Problem:
        stop = bs.Stop("stop", node="P", normal=(1, 0, 0), gap=gap, stiffness=50.0)
        return bs.Problem(basis, laws=[stop], initial=start, duration=2.0)

    # The free motion comes down to -1.0187; each gap lets a little more of its dips through.
    for depth in (1e-3, 1e-5):
        lowest = (
            -bs.simulate(problem(5.0), "exact")
            .sample("displacement", "P", "dx", times=np.linspace(0, 1, 200001))
            .min()
        )
        exact = bs.simulate(problem(lowest - depth), "exact").impact_table()
        for method, rtol in (("rk32", 1e-9), ("rk54", 1e-10), ("dop853", 1e-10)):
            found = bs.simulate(problem(lowest - depth), method, rtol=rtol).impact_table()
            assert found["start"] == pytest.approx(exact["start"], abs=1e-4)
            assert found["impulse"] == pytest.approx(exact["impulse"], rel=0.05)


@pytest.mark.parametrize("method", ADAPTIVE)
def test_energy_is_kept_to_the_tolerance(method: str) -> None:
    """Without damping; many impacts later, too."""
    basis = bs.ModalBasis.from_modes(
        frequency=[2.0, 5.3], damping=[0.0, 0.0], shapes={("P", "dx"): [1.0, 0.6]}
    )
    stop = bs.Stop("stop", node="P", normal=(1, 0, 0), gap=0.01, stiffness=1e4)
    start = bs.ModalState(displacement=[0.2, 0.1], velocity=[0.0, 1.0])
    problem = bs.Problem(basis, laws=[stop], initial=start, duration=10.0)
    response = bs.simulate(problem, method, rtol=1e-7)
    assert len(response.impact_table()["start"]) > 15
    assert response.energy_residual < 1e-4
    terms = response.energy_terms(np.linspace(0, 10, 500))
    held = terms["kinetic"] + terms["elastic"] + terms["stored"]
    assert np.ptp(held) < 1e-4 * held.max()


def test_obstacles_that_move_are_followed() -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[4.0, 11.0], damping=[0.01, 0.01], shapes={("P", "dx"): [1.0, 0.5]}
    )
    shaking: list[bs.Harmonic | bs.Polynomial] = [
        bs.Harmonic(6.0, cosine=0.004, sine=0.001),
        bs.Polynomial([0.0, 2e-3]),
    ]
    ramp = bs.TimeTable([0.0, 0.5, 0.8, 2.0], [0.0, 2e-3, 0.0, 1e-3], beyond="hold")
    stops = [
        bs.Stop("near", node="P", normal=(1, 0, 0), gap=1e-3, stiffness=2e4, motion=shaking),
        bs.Stop(
            "far", node="P", normal=(-1, 0, 0), gap=2e-3, stiffness=9e3, damping=3.0, motion=ramp
        ),
    ]
    problem = bs.Problem(basis, laws=stops, duration=2.0)
    exact = bs.simulate(problem, "exact")
    response = bs.simulate(problem, "dop853", rtol=1e-11)
    assert error(response, exact) < 1e-8
    assert response.event_table()["guard"] == exact.event_table()["guard"]
    found, true = (each.energy_terms([2.0]) for each in (response, exact))
    for term, value in true.items():
        assert found[term] == pytest.approx(value, rel=1e-7, abs=1e-10)
    assert response.energy_residual < 1e-8


def test_an_absolute_tolerance_lets_small_motions_pass() -> None:
    problem = case_problem("sdnl32", "soft")
    steps = [bs.simulate(problem, "rk54", rtol=1e-12, atol=atol).steps for atol in (1e-12, 1e-6)]
    assert steps[1] < steps[0] / 3


def test_auto_says_which_law_is_smooth() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[0.0], damping=[0.0], shapes={("P", "dx"): [1.0]})
    stop = bs.Stop("plain", node="P", normal=(1, 0, 0), gap=1.0, stiffness=1.0)
    ball = bs.HertzStop("ball", node="P", normal=(-1, 0, 0), gap=1.0, stiffness=1e6)
    start = bs.ModalState(displacement=[0.0], velocity=[1.0])
    plain = bs.Problem(basis, laws=[stop], initial=start, duration=1.5)
    response = bs.simulate(plain, rtol=1e-6)
    assert (response.method, response.options) == ("exact", {})
    response = bs.simulate(bs.Problem(basis, laws=[stop, ball], initial=start, duration=1.5))
    assert response.method == "dop853"
    assert response.method_reason.startswith("'ball' is not piecewise linear")
    assert response.options == {"rtol": 1e-8}


@pytest.mark.parametrize(
    ("method", "options", "key"),
    [
        ("rk54", {"rtol": 1e-16}, "rtol"),
        ("rk54", {"rtol": 1.0}, "rtol"),
        ("rk54", {"rtol": float("nan")}, "rtol"),
        ("dop853", {"atol": -1.0}, "atol"),
        ("dop853", {"dt": 1e-3}, "dt"),
        ("exact", {"rtol": 1e-3}, "rtol"),
        ("central_difference", {"atol": 1e-3}, "atol"),
    ],
)
def test_options_out_of_place_are_refused(method: str, options: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        bs.simulate(case_problem("sdnl32", "soft"), method, **options)
    assert caught.value.key == key


@pytest.mark.parametrize(("name", "variant"), [("sdnl32", "stiff"), ("sdnd100a", "published")])
def test_the_adaptive_central_difference_is_of_second_order(name: str, variant: str) -> None:
    """Through contacts and friction, whose switches it locates."""
    problem = case_problem(name, variant)
    exact = bs.simulate(problem, "exact")
    runs = [
        bs.simulate(problem, "adaptive_central_difference", points_per_period=points)
        for points in (200.0, 800.0)
    ]
    coarse, fine = (error(run, exact) for run in runs)
    assert coarse / fine == pytest.approx(16.0, rel=0.3)
    assert fine < 1e-5
    assert len(runs[1].event_table()["time"]) == len(exact.event_table()["time"])


def test_its_steps_follow_the_contact_and_not_the_flight() -> None:
    """A stop of 100 times the frequency of the structure makes steps short while it is closed."""
    basis = bs.ModalBasis.from_modes(frequency=[5.0], damping=0.0, shapes={("P", "dx"): [1.0]})
    wall = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=0.01, stiffness=1e4 * (10 * np.pi) ** 2)
    state = bs.ModalState(velocity=[-1.0])
    problem = bs.Problem(basis, laws=[wall], initial=state, duration=1.0)
    run = bs.simulate(problem, "adaptive_central_difference", points_per_period=200.0)
    assert error(run, bs.simulate(problem, "exact")) < 0.02
    # Equal steps as fine as the contact asks for would be 100,000.
    assert run.steps < 5000


GROWING: dict[str, Any] = {
    "sine": bs.Harmonic(1.0, sine=1.0),
    "ramp": bs.TimeTable(times=[0.0, 1.0], values=[0.0, 1.0]),
    "shock": bs.TimeTable(times=[0.0, 0.5, 0.51, 1.0], values=[0.0, 0.0, 1.0, 1.0]),
}


@pytest.mark.parametrize("load", GROWING)
@pytest.mark.parametrize("points", [20.0, 50.0, 1e4])
def test_it_leaves_rest_under_a_load_that_grows_from_zero(load: str, points: float) -> None:
    """The velocity that its first step predicts is none, and so would be the work of the load."""
    basis = bs.ModalBasis.from_modes(
        frequency=[5.0, 12.0], damping=[0.02, 0.01], shapes={("P", "dx"): [1.0, 0.5]}
    )
    push = bs.NodalForce("push", node="P", force=(1, 0, 0), time=GROWING[load])
    problem = bs.Problem(basis, loads=[push], duration=1.0)
    run = bs.simulate(problem, "adaptive_central_difference", points_per_period=points)
    assert error(run, bs.simulate(problem, "exact")) < 40.0 / points**2
    assert run.energy_residual < 40.0 / points**2


def test_its_steps_follow_dampers_too() -> None:
    """A mass on a damper alone has no frequency, but a rate."""
    basis = bs.ModalBasis.from_modes(frequency=[0.0], damping=[0.0], shapes={("P", "dx"): [1.0]})
    damper = bs.DamperLaw("damper", node="P", direction=(1, 0, 0), damping=(5.0,), breaks=())
    start = bs.ModalState(displacement=[0.0], velocity=[1.0])
    problem = bs.Problem(basis, laws=[damper], initial=start, duration=1.0)
    times = np.linspace(0.0, 1.0, 21)
    true = (1.0 - np.exp(-5.0 * times)) / 5.0
    coarse, fine = (
        np.abs(
            bs.simulate(problem, "adaptive_central_difference", points_per_period=points).sample(
                "displacement", "P", "dx", times=times
            )
            - true
        ).max()
        for points in (50.0, 200.0)
    )
    assert coarse / fine == pytest.approx(16.0, rel=0.3)
    assert fine < 1e-3 * true[-1]


ALONG: dict[str, Any] = {"node": "P", "direction": (1, 0, 0)}
DAMPERS: list[Any] = [
    bs.DamperLaw("damper", damping=(5.0,), breaks=(), **ALONG),
    bs.ForceRelation("smooth damper", force="-5 * v", **ALONG),
]


@pytest.mark.parametrize("damper", DAMPERS, ids=lambda law: str(law.name))
@pytest.mark.parametrize("method", ADAPTIVE)
@pytest.mark.parametrize("rtol", [1e-3, 1e-5, 1e-7, 1e-10])
def test_the_first_step_is_short_for_what_a_law_answers(
    method: str, rtol: float, damper: Any
) -> None:
    """A mass on a damper alone, over one time constant.

    The estimate of `rk32` is `z^3 (1 - z) / 48` for a step of `z` time constants: it vanishes for
    all of the run.
    """
    basis = bs.ModalBasis.from_modes(frequency=[0.0], damping=[0.0], shapes={("P", "dx"): [1.0]})
    start = bs.ModalState(displacement=[0.0], velocity=[1.0])
    problem = bs.Problem(basis, laws=[damper], initial=start, duration=0.2)
    run = bs.simulate(problem, method, rtol=rtol)
    times = np.linspace(0.0, 0.2, 21)
    true = (1.0 - np.exp(-5.0 * times)) / 5.0
    found = run.sample("displacement", "P", "dx", times=times)
    assert found == pytest.approx(true, abs=10.0 * rtol * true[-1])


@pytest.mark.parametrize("method", ADAPTIVE)
@pytest.mark.parametrize("rtol", [1e-3, 1e-4, 1e-5, 1e-7])
def test_steps_are_short_behind_a_switch_to_a_law_that_answers_fast(
    method: str, rtol: float
) -> None:
    """Where the valve closes, its time constant falls to a fortieth, in the midst of long steps."""
    problem = case_problem("damper-law", "valve")
    exact = bs.simulate(problem, "exact")
    run = bs.simulate(problem, method, rtol=rtol)
    assert error(run, exact) < 3.0 * rtol
    assert list(run.event_table()["after"]) == list(exact.event_table()["after"])


def test_stiff_modes_at_rest_cost_the_exponential_pair_nothing() -> None:
    """Beside a mode of 5 Hz one of 50 kHz, whose period no explicit pair can step over."""
    basis = bs.ModalBasis.from_modes(
        frequency=[5.0, 5e4], damping=[0.01, 0.01], shapes={("P", "dx"): [1.0, 0.5]}
    )
    wall = bs.HertzStop("wall", node="P", normal=(1, 0, 0), gap=0.005, stiffness=1e6, exponent=2.0)
    state = bs.ModalState(velocity=[-1.0, 0.0])
    problem = bs.Problem(basis, laws=[wall], initial=state, duration=0.5)
    # Steps from end to end, as flights would spare the explicit pair most of them.
    exponential, explicit = (
        bs.simulate(problem, method, rtol=1e-6, exact_flights=False)
        for method in ("exprk43", "rk54")
    )
    assert exponential.steps < explicit.steps / 50
    assert error(exponential, explicit) < 1e-4


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"points_per_period": 5.0}, r"points_per_period.*20 to 1e\+07"),
        ({"points_per_period": float("nan")}, "points_per_period"),
        ({"rtol": 1e-6}, "no option of the adaptive_central_difference method"),
    ],
)
def test_wrong_resolutions_are_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(bs.InputError, match=message):
        bs.simulate(case_problem("sdnl32", "soft"), "adaptive_central_difference", **given)


def test_energy_from_nowhere_is_told_with_its_time_and_mode() -> None:
    """A tolerance that lets anything pass."""
    basis = bs.ModalBasis.from_modes(
        frequency=[1.0, 40.0], damping=0.0, shapes={("P", "dx"): [1.0, 1.0]}
    )
    problem = bs.Problem(basis, initial=bs.ModalState(velocity=[1.0, 1.0]), duration=500.0)
    with pytest.raises(bs.ComputationError, match=r"blows up: at t = .*mode 2.*tolerance"):
        bs.simulate(problem, "rk32", rtol=0.5, atol=1e9)


def test_rigid_stops_are_refused() -> None:
    problem = case_problem("ball-on-floor", "base")
    with pytest.raises(bs.InputError, match=r"does not take rigid stops.*exact and moreau_jean do"):
        bs.simulate(problem, "rk54")


def test_a_motion_without_bounds_is_told_with_its_time() -> None:
    """A spring that pushes away: the numbers run out after some 700 time constants."""
    basis = bs.ModalBasis.from_modes(frequency=[0.0], damping=[0.0], shapes={("P", "dx"): [1.0]})
    push = bs.SpringLaw("push", node="P", direction=(1, 0, 0), stiffness=(-1e6,))
    start = bs.ModalState(displacement=[0.0], velocity=[1.0])
    problem = bs.Problem(basis, laws=[push], initial=start, duration=2.0)
    with pytest.raises(bs.ComputationError, match=r"rk54 method could not finish.*t = "):
        bs.simulate(problem, "rk54", rtol=1e-4)


@pytest.mark.parametrize("method", ADAPTIVE)
def test_a_structure_leaves_rest_under_a_force_that_begins_at_zero(method: str) -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[3.0, 7.5], damping=0.01, shapes={("P", "dx"): [1.0, 0.4]}
    )
    sine = bs.NodalForce("sine", node="P", force=(10, 0, 0), time=[bs.Harmonic(5.0, sine=1.0)])
    problem = bs.Problem(basis, loads=[sine], duration=1.0)
    times = np.linspace(0.0, 1.0, 101)
    one, other = (
        response.sample("displacement", "P", "dx", times=times)
        for response in (bs.simulate(problem, method, rtol=1e-6), bs.simulate(problem))
    )
    np.testing.assert_allclose(one, other, rtol=0, atol=3e-5 * np.abs(other).max())
