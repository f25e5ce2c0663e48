"""Functions of time: their values, and what they refuse."""

from typing import Any, cast

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.loads.time import check_span


def test_a_phase_leads_the_cosine() -> None:
    wave = bs.Harmonic.with_phase(3.0, amplitude=2.0, phase=0.4)
    times = np.linspace(0.0, 1.0, 7)
    np.testing.assert_allclose(wave.at(times), 2.0 * np.cos(6.0 * np.pi * times + 0.4), atol=1e-14)


def test_a_polynomial_begins_with_its_constant() -> None:
    assert bs.Polynomial([1.0, 0.0, 2.0]).at(np.array([0.0, 2.0])).tolist() == [1.0, 9.0]


def test_a_table_has_jumps_and_ends() -> None:
    times, values = [1.0, 2.0, 2.0, 3.0], [1.0, 3.0, 5.0, 4.0]
    wanted = np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 9.0])
    held = bs.TimeTable(times, values, beyond="hold").at(wanted)
    assert held.tolist() == [1.0, 1.0, 2.0, 5.0, 4.5, 4.0, 4.0]
    ended = bs.TimeTable(times, values, beyond="zero").at(wanted)
    assert ended.tolist() == [0.0, 1.0, 2.0, 5.0, 4.5, 0.0, 0.0]


@pytest.mark.parametrize(
    ("make", "key", "what"),
    [
        (lambda: bs.Harmonic(0.0), "frequency", "positive"),
        (lambda: bs.Harmonic(1.0, sine=float("nan")), "sine", "finite"),
        (lambda: bs.Polynomial([]), "coefficients", "list of numbers"),
        (lambda: bs.Polynomial([0.0] * 7), "coefficients", "degree 5"),
        (lambda: bs.TimeTable([0.0, 1.0], [1.0]), "values", "one value for each time"),
        (lambda: bs.TimeTable([0.0, 2.0, 1.0], np.zeros(3)), "times", "must not go backwards"),
        (lambda: bs.TimeTable([0.0, 1.0], np.array([0.0, np.nan])), "values", "entry 2 of 2"),
        (lambda: bs.TimeTable(np.array([]), np.array([])), "times", "list of numbers"),
        (lambda: bs.TimeTable([0.0], [1.0], beyond="nought"), "beyond", "did you mean|known"),
        (lambda: bs.NodalForce("p", node="P", time=[]), "time", "must not be empty"),
        (
            lambda: bs.NodalForce("p", node="P", time=cast(Any, "sin")),
            "time",
            "a Harmonic, a Polynomial",
        ),
    ],
)
def test_mistakes_are_one_line(make: Any, key: str, what: str) -> None:
    with pytest.raises(bs.InputError, match=what) as caught:
        make()
    assert caught.value.key == key
    assert "\n" not in str(caught.value)


def test_a_table_out_of_order_tells_the_number_as_it_is_written() -> None:
    with pytest.raises(bs.InputError, match=r"got 1\.0\)"):
        bs.TimeTable(np.array([0.0, 2.0, 1.0]), np.zeros(3))


def test_a_table_covers_the_run_or_says_what_is_beyond() -> None:
    short = bs.TimeTable([0.0, 1.0], [0.0, 1.0])
    check_span([short, bs.Harmonic(1.0)], 1.0)
    with pytest.raises(bs.InputError, match=r"0 s to 1 s, run 0 to 2 s.*beyond"):
        check_span([short], 2.0)
    check_span([bs.TimeTable([0.5, 1.0], [0.0, 1.0], beyond="zero")], 2.0)
