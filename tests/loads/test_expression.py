"""Formulas in time: what they mean, what they refuse, and the straight lines through them."""

import math

import numpy as np
import pytest

import bumpstop as bs

TIMES = np.linspace(0.0, 2.0, 20_011)


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("3", np.full_like(TIMES, 3.0)),
        ("t", TIMES),
        ("-t**2 / 2 + 1e-1", -(TIMES**2) / 2 + 0.1),
        ("exp(-3*t) * sin(2*pi*5*t)", np.exp(-3 * TIMES) * np.sin(10 * np.pi * TIMES)),
        ("max(0, cos(9*t))", np.maximum(0, np.cos(9 * TIMES))),
        ("2*step(t - 0.5) - step(t - 1.25)", 2.0 * (TIMES >= 0.5) - (TIMES >= 1.25)),
        ("atan2(t, 1) + sqrt(abs(t - 1)) + e", np.arctan(TIMES) + np.sqrt(abs(TIMES - 1)) + math.e),
    ],
)
def test_a_formula_is_read(formula: str, expected: np.ndarray) -> None:
    expression = bs.Expression(formula)
    np.testing.assert_allclose(expression.at(TIMES), expected, rtol=1e-15, atol=1e-15)
    (table,) = expression.terms(2.0)
    strayed = np.abs(table.at(TIMES) - expected)
    # A jump is found to a part of 1e-9 of the run, and may be on the other side of an instant.
    near_jump = np.abs(np.diff(expected, prepend=expected[0])) > 0.5
    assert strayed[~near_jump].max() <= 1e-4 * np.abs(expected).max()


def test_a_jump_is_a_jump() -> None:
    (table,) = bs.Expression("step(t - 1/3)").terms(1.0)
    times, values = np.asarray(table.times), np.asarray(table.values)
    at = int(np.flatnonzero(np.diff(times) == 0.0)[0])
    assert times[at] == pytest.approx(1 / 3, abs=1e-9)
    assert values[at : at + 2].tolist() == [0.0, 1.0]
    assert np.count_nonzero(np.diff(times) == 0.0) == 1


@pytest.mark.parametrize(
    ("formula", "what"),
    [
        ("", "must be a name"),
        ("sin(t", "is no formula"),
        ("2 t", "is no formula"),
        ("t + x", "unknown name .*'x'"),
        ("sn(t)", "unknown function .*did you mean 'sin'"),
        ("sin(t, 2)", "sin takes one argument, not 2"),
        ("max(t)", "max takes 2 arguments"),
        ("t ^ 2", "must not have this in it .*t \\^ 2"),
        ("__import__('os').system('true')", "must not have this"),
        ("t.real", "must not have this"),
        ("[t for t in (1,)]", "must not have this"),
        ("(lambda: t)()", "must not have this"),
        ("True", "must not have this"),
        ("'a'", "must not have this"),
        ("1j * t", "must not have this"),
        ("sin(x=t)", "must not have this"),
        ("t if t else 1", "must not have this"),
        ("(" * 500 + "t" + ")" * 500, "is no formula"),
        ("t" + "+t" * 2000, "shorter than 2000"),
    ],
)
def test_what_is_no_formula_is_refused_in_one_line(formula: str, what: str) -> None:
    with pytest.raises(bs.InputError, match=what) as caught:
        bs.Expression(formula)
    assert caught.value.key == "formula"
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("formula", "where"), [("1/t", "t = 0 s"), ("log(t - 1)", "t = 0 s"), ("9**9**9**t", "t = ")]
)
def test_values_are_finite(formula: str, where: str) -> None:
    basis = bs.ModalBasis.from_modes(frequency=[3.0], shapes={("P", "dx"): [1.0]})
    push = bs.NodalForce("push", node="P", force=(1, 0, 0), time=bs.Expression(formula))
    with pytest.raises(
        bs.InputError, match=r"loads\.push\.time\.formula: has no finite value"
    ) as caught:
        bs.Problem(basis, loads=[push], duration=2.0)
    assert str(caught.value.value).startswith(where)


@pytest.mark.parametrize(
    "formula",
    [
        "1/(t - 0.0333333)",
        "1/(t - 0.0333333)**2",
        "3 + 1e-3/(t - 0.7)",
        "tan(47*t)",
        "1/sqrt(abs(t - 1/3))",
        "step(t - 0.2) / (t - 0.2)",
        "1/(t - 1)",
    ],
)
def test_poles_are_refused(formula: str) -> None:
    with pytest.raises(bs.InputError, match=r"time\.formula: (grows without limit|has no finite)"):
        bs.Expression(formula).terms(1.0)


@pytest.mark.parametrize(
    ("formula", "largest"),
    [
        ("1/(1e-8 + (t - 0.3)**2)", 1e8),
        ("abs(t - 1/3) / (t - 1/3)", 1.0),
        ("1e6 * step(t - 1/3) * exp(-t)", 1e6 * np.exp(-1 / 3)),
        ("sqrt(abs(t - 1/3))", np.sqrt(2 / 3)),
        ("atan(1e13 * (t - 1/3))", np.pi / 2),
    ],
)
def test_peaks_and_jumps_are_no_poles(formula: str, largest: float) -> None:
    (table,) = bs.Expression(formula).terms(1.0)
    assert np.abs(table.values).max() == pytest.approx(largest, rel=1e-4)


def test_what_is_too_quick_is_refused() -> None:
    with pytest.raises(bs.InputError, match="needs more than 2,000,000"):
        bs.Expression("sin(1e9 * t)", tolerance=1e-6).terms(2.0)
