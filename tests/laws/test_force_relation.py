"""Forces by formulas: closed forms, SciPy, kinks located, energies, bad input."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipk

import bumpstop as bs
from bumpstop.laws.formula import program


def relation(force: str, **changes: Any) -> bs.ForceRelation:
    usual: dict[str, Any] = {"node": "P", "direction": (1, 0, 0)}
    return bs.ForceRelation("relation", force=force, **usual | changes)


def released(law: bs.ForceRelation, place: float, speed: float, duration: float) -> bs.Problem:
    mass = bs.ModalBasis.from_modes(frequency=[0.0], damping=[0.0], shapes={("P", "dx"): [1.0]})
    start = bs.ModalState(displacement=[place], velocity=[speed])
    return bs.Problem(mass, laws=[law], initial=start, duration=duration)


def test_duffings_spring_moves_by_jacobis_cosine() -> None:
    a, b, amplitude = 100.0, 2e6, 5e-3
    problem = released(relation("-100*x - 2e6*x**3"), amplitude, 0.0, 3.0)
    response = bs.simulate(problem, rtol=1e-13)
    times = np.linspace(0.0, 3.0, 61)
    pace = np.sqrt(a + b * amplitude**2)
    modulus = b * amplitude**2 / (2 * (a + b * amplitude**2))
    expected = amplitude * ellipj(pace * times, modulus)[1]
    found = response.sample("displacement", "P", "dx", times=times)
    assert found == pytest.approx(expected, abs=1e-10 * amplitude)
    assert 4 * ellipk(modulus) / pace == pytest.approx(0.536666, abs=1e-6)
    terms = response.energy_terms(times)
    assert terms["stored"] == pytest.approx(
        a * found**2 / 2 + b * found**4 / 4, rel=1e-12, abs=1e-16
    )
    assert np.abs(terms["dissipated_stops"]).max() < 1e-16
    assert response.energy_residual < 1e-11


@pytest.mark.parametrize(
    ("formula", "force"),
    [
        ("2*(1 - x**2)*v - x", lambda x, v: 2 * (1 - x**2) * v - x),
        (
            "-sin(3*x) - 0.3*sign(v)*abs(v)**1.5",
            lambda x, v: -np.sin(3 * x) - 0.3 * v * abs(v) ** 0.5,
        ),
        ("-max(0, x - 0.4)*30 - x - 0.2*v", lambda x, v: -max(0.0, x - 0.4) * 30 - x - 0.2 * v),
        (
            "-5*x*max(0, abs(x) - 0.3) - atan2(x, 2 + v)",
            lambda x, v: -5 * x * max(0.0, abs(x) - 0.3) - np.arctan2(x, 2 + v),
        ),
    ],
)
def test_it_agrees_with_scipy(formula: str, force: Any) -> None:
    duration = 2.0
    problem = released(relation(formula), 0.9, -0.4, duration)
    run = solve_ivp(
        lambda _, y: [y[1], force(y[0], y[1])],
        (0.0, duration),
        [0.9, -0.4],
        "RK45",
        rtol=1e-12,
        atol=1e-14,
        max_step=2e-3,  # so short that kinks within steps do no harm
    )
    for method in ("dop853", "rk54"):
        response = bs.simulate(problem, method, rtol=1e-12)
        found = response.sample("displacement", "P", "dx", times=[duration])[0]
        assert found == pytest.approx(run.y[0, -1], abs=1e-8)
        assert response.energy_residual < 1e-9


def test_kinks_are_located() -> None:
    """A mass meets a spring behind a gap: half a period of the spring within the flights."""
    law = relation("-400 * max(0, x - 0.2)")
    response = bs.simulate(released(law, 0.0, 1.0, 1.0), rtol=1e-12)
    times = response.event_table()["time"]
    assert times == pytest.approx([0.2, 0.2 + np.pi / 20], abs=1e-13)
    deepest = response.sample("displacement", "P", "dx", times=[0.2 + np.pi / 40])[0]
    assert deepest == pytest.approx(0.25, abs=1e-12)
    assert response.energy_residual < 1e-12


def test_schemes_of_fixed_steps_take_it() -> None:
    problem = released(relation("-100*x - 2e6*x**3"), 5e-3, 0.0, 0.5)
    exact = bs.simulate(problem, rtol=1e-12).sample("displacement", "P", "dx", times=[0.5])[0]
    for method in ("symplectic_euler", "central_difference", "newmark", "devogelaere"):
        response = bs.simulate(problem, method, dt=1e-5)
        found = response.sample("displacement", "P", "dx", times=[0.5])[0]
        assert found == pytest.approx(exact, abs=2e-3 * 5e-3), method


def test_the_exact_method_refuses_it() -> None:
    with pytest.raises(bs.InputError, match=r"'relation'.*formula.*dop853"):
        bs.simulate(released(relation("-x**3"), 1.0, 0.0, 1.0), "exact")


def test_force_at_is_what_acts() -> None:
    law = relation("-3*x + min(x, v)*e - pi*cosh(x)/exp(v) + log(2 + x) - sqrt(3) * tanh(v)")
    x, v = np.array([-0.5, 0.0, 0.7]), 0.3
    expected = -3 * x + np.minimum(x, v) * np.e - np.pi * np.cosh(x) / np.exp(v)
    expected += np.log(2 + x) - np.sqrt(3) * np.tanh(v)
    assert law.force_at(x, v) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("formula", "words"),
    [
        ("-2*x + t", "unknown name"),
        ("sinn(x)", "unknown function"),
        ("atan2(x)", "atan2 takes 2 arguments, not 1"),
        ("x if v else 0", "must not have this in it"),
        ("2 *", "is no formula"),
        ("", "must be a name"),
        ("1 / x", "no finite value"),
        ("__import__('os')", "unknown function"),
    ],
)
def test_what_is_no_formula_is_refused(formula: str, words: str) -> None:
    with pytest.raises(bs.InputError, match=words) as caught:
        relation(formula)
    assert caught.value.key == "force"


def test_the_words_come_in_the_order_of_a_stack() -> None:
    assert program("+x - min(v, 2)") == ["x", "v", 2.0, "min", "-"]


def test_a_run_goes_on_from_it() -> None:
    problem = released(relation("-100*x - 2e6*x**3 - v*abs(v)"), 5e-3, 0.0, 0.4)
    first = bs.simulate(problem, rtol=1e-12)
    rest = bs.simulate(bs.continued(first, duration=0.2, at=0.2), rtol=1e-12)
    whole = first.sample("displacement", "P", "dx", times=[0.4])[0]
    assert rest.sample("displacement", "P", "dx", times=[0.2])[0] == pytest.approx(whole, abs=1e-11)


def test_the_report_tells_the_formula() -> None:
    from bumpstop.report.summary import model_rows

    told = dict(model_rows(released(relation("-2*x"), 1.0, 0.0, 1.0)))["Laws"][0]
    assert told == "relation: a force at P along (1, 0, 0), -2*x"
