"""The tables say what the response and the checks say."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import Check, Reference, check_references
from bumpstop.report import tables
from bumpstop.report.published import deviation_told, published, verdict, worst
from bumpstop.report.summary import method_words, model_rows
from bumpstop.report.words import title_of

from .conftest import CASES, Run


@pytest.fixture(scope="module")
def check(sdnl32: Run) -> Check:
    """The published -4.92 mm at 3 ms, which the exact -4.952965 mm misses by 0.67 %."""
    return sdnl32.checks["soft"][2]


def rows_of(group: dict[str, Any]) -> list[dict[str, Any]]:
    return list(group["rows"])


def test_published_beside_computed(sdnl32: Run) -> None:
    (group,) = published(sdnl32.checks["soft"])
    assert (group["title"], group["heading"], group["unit"]) == (
        "Displacement dy of B",
        "Time (ms)",
        "mm",
    )
    third = rows_of(group)[2]
    assert (third["label"], third["reference"], third["value"]) == ("3", "−4.92", "−4.9530")
    assert (third["deviation"], third["tolerance"]) == ("−0.67 %", "0.8 %")
    assert third["passed"]
    assert [row["label"] for row in rows_of(group)] == [str(t) for t in range(1, 13)]


def test_the_bar_points_to_the_side_of_the_deviation(check: Check) -> None:
    def bar(each: Check) -> tuple[float, float]:
        (group,) = published([each, each])
        row = rows_of(group)[0]
        return float(row["bar_left"]), float(row["bar_width"])

    left, width = bar(check)
    assert width == pytest.approx(50.0 * check.deviation / check.tolerance, abs=0.1)
    assert left + width == pytest.approx(50.0, abs=0.1)
    above = replace(check, value=-4.90e-3, deviation=0.02 / 4.92)
    assert bar(above)[0] == 50.0
    far = replace(check, deviation=1.0, passed=False)
    assert bar(far) == (0.0, 50.0)


def test_single_values_stand_together_with_their_units(ball: Run) -> None:
    (group,) = published(ball.checks["base"])
    labels = [row["label"] for row in rows_of(group)]
    assert labels[0] == "Instant of closing, impact 1 on spring"
    assert "Velocity dz of P at 71.982 ms" in labels
    assert rows_of(group)[0]["reference"] == "71.982 ms"
    assert all("%" in row["deviation"] for row in rows_of(group))


def test_deviations_are_as_fine_as_their_tolerance(check: Check) -> None:
    fine = replace(check, value=1.0000063, reference=1.0, deviation=6.3e-6, tolerance=1e-5)
    assert deviation_told(fine, sign=True) == "+0.0006 %"
    assert deviation_told(replace(fine, tolerance=0.0)) == "0.00 %"
    absolute = replace(fine, absolute=True, tolerance=1e-5, units="m")
    assert deviation_told(absolute) == "6.3 µm"


def test_a_missing_impact_is_missed(ball: Run) -> None:
    fifth = Reference(quantity="impact_start", stop="spring", impact=5, values=[1.0], tolerance=0.1)
    checks = check_references(ball.responses["base"], [fifth])
    assert verdict(checks).state == "failed"
    assert worst([*ball.checks["base"], *checks]) is checks[0]
    (group,) = published(checks)
    (row,) = rows_of(group)
    assert (row["deviation"], row["passed"]) == ("–", False)


def test_verdicts(sdnl32: Run, check: Check) -> None:
    every = [check for checks in sdnl32.checks.values() for check in checks]
    assert verdict(every).text == "Meets all 24 published values"
    missed = replace(check, passed=False)
    assert verdict([*every, missed]).text == "1 of 25 published values missed"
    assert verdict([]).state == "none"


def test_the_worst_is_the_one_nearest_its_own_tolerance(check: Check) -> None:
    lenient = replace(check, deviation=0.02, tolerance=0.1)
    assert worst([lenient, check]) is check
    assert worst([]) is None


def test_head_and_overview(sdnl32: Run) -> None:
    seconds = {"soft": 2e-6, "stiff": 3e-6}
    facts = {f["name"]: f for f in tables.facts(sdnl32.responses, sdnl32.checks, seconds)}
    assert facts["Published values met"]["value"] == "24 of 24"
    assert facts["Solved in"]["value"] == "5 µs"
    overview = tables.overview(sdnl32.responses, sdnl32.checks, seconds)
    soft = dict(zip(overview["columns"][1:], overview["rows"][0]["cells"], strict=False))
    response = sdnl32.responses["soft"]
    assert soft["Impacts"] == "1"
    assert soft["Steps"] == f"{response.steps:,}"
    assert soft["Events"] == str(response.event_count)
    assert soft["Peak force"].startswith("89.")
    assert soft["Worst deviation"] == "0.67 % of 0.8 %"
    assert overview["rows"][1]["verdict"] == "12 of 12 met"


def test_impacts(ball: Run) -> None:
    table = tables.impacts(ball.responses["base"])
    first = dict(zip(table["columns"], table["rows"][0]["cells"], strict=True))
    assert first["Closes (ms)"] == f"{math.sqrt(2.0 / 386.0) * 1e3:.3f}"
    assert first["Closing speed (mm/s)"] == f"{math.sqrt(2.0 * 386.0) * 25.4:.2f}"
    last = dict(zip(table["columns"], table["rows"][-1]["cells"], strict=True))
    assert last["Opens (ms)"] == "–"


def test_many_impacts_are_cut_short_and_said_to_be(bouncing: bs.Response) -> None:
    table = tables.impacts(bouncing)
    count = len(bouncing.impact_table()["start"])
    assert len(table["rows"]) == tables.MOST_IMPACTS
    assert table["more"] == str(count - tables.MOST_IMPACTS)


def test_modes(soft: bs.Response) -> None:
    rigid, second, *_ = tables.modes(soft.problem.basis)
    assert (rigid["frequency"], rigid["damping"]) == ("rigid", "–")
    assert second["frequency"].startswith("85.40")
    assert (second["damping"], second["title"]) == ("1.00 %", "Mode 2: 85.407 Hz")


def test_static_shapes_are_called_by_their_names(soft: bs.Response) -> None:
    structure = soft.problem.basis.structure
    assert structure is not None
    places = [("B", "dy"), ("B", "drz"), ("A", "drz")]
    one = bs.ModalBasis.from_structure(structure, modes=4, static_shapes=places[:1])
    assert tables.modes(one)[4]["title"].startswith("Static shape of B.dy: ")
    assert dict(model_rows(bs.Problem(one, duration=1.0)))["Basis"] == [
        "4 modes, 1 of them rigid, and 1 static shape, up to 1231.9 Hz, undamped"
    ]
    three = bs.ModalBasis.from_structure(structure, modes=4, static_shapes=places)
    assert tables.modes(three)[6]["title"].startswith("Mode 7: ")


def test_an_unstable_mode_has_no_frequency() -> None:
    basis = bs.ModalBasis(
        omega2=np.array([-4.0]),
        damping_ratio=np.zeros(1),
        dofs=(("P", "dx"),),
        shapes=np.ones((1, 1)),
    )
    (row,) = tables.modes(basis)
    assert row == {"frequency": "unstable", "damping": "–", "title": "Mode 1: unstable"}


def test_variants_tell_what_sets_them_apart(sdnl32: Run) -> None:
    notes = tables.variant_notes(sdnl32.case.problems)
    assert notes == {"soft": "stiffness 18 kN/m", "stiff": "stiffness 45 kN/m"}
    rows = {row["term"]: row["lines"] for row in tables.model(sdnl32.case.problems)}
    assert [line["variant"] for line in rows["Stops"]] == ["soft", "stiff"]
    assert [line["variant"] for line in rows["Beams"]] == [""]


def test_the_model_in_words(ball: Run, soft: bs.Response, pendulum: bs.Problem) -> None:
    beam = dict(model_rows(soft.problem))
    assert beam["Beams"] == [
        "AB: 783 mm from A to B, 10 Timoshenko elements, section 14 mm × 14 mm, "
        "E = 67 GPa, ν = 0, ρ = 2400 kg/m³"
    ]
    assert beam["Initial state"] == ["turns about A as a rigid body with (0, 0, −3.8) rad/s"]
    falling = dict(model_rows(ball.case.problems["base"]))
    assert falling["Masses"] == ["ball: 87.563 kg at P"]
    assert falling["Loads"] == ["weight: gravity (0, 0, −9.8044) m/s²"]
    assert falling["Basis"] == ["1 rigid mode"]
    hung = dict(model_rows(pendulum))
    assert "Beams" not in hung
    assert hung["Stops"][0].endswith("gap 1 mm, 100 kN/m, 20 N s/m")


@pytest.mark.parametrize(
    ("case", "words"),
    [
        ("sdnl111a", "moves straight with (−1, 0, 0) m/s: flying"),
        ("bar-on-wall", "moves straight with (−0.1, 0, 0) m/s"),
    ],
)
def test_what_flies_is_named(case: str, words: str) -> None:
    problem = next(iter(bs.load_case(CASES / case / "case.toml").problems.values()))
    assert dict(model_rows(problem))["Initial state"] == [words]


def test_methods_are_named_with_their_reason(soft: bs.Response) -> None:
    assert method_words(soft)[0] == "Exact"
    stepped = bs.simulate(soft.problem, method="symplectic_euler", dt=1e-5)
    assert method_words(stepped)[0] == "Symplectic Euler, dt = 10 µs"
    automatic = bs.simulate(soft.problem, method="auto")
    assert "because all laws are piecewise linear" in method_words(automatic)[1]


@pytest.mark.parametrize(
    ("target", "title"),
    [
        (("velocity", "AB@0.4 m", "drz"), "Velocity drz of AB@0.4 m"),
        (("gap", "guide"), "Gap at stop guide"),
        (("gauge", "top"), "Strain at gauge top"),
        (("energy", "kinetic"), "Kinetic energy"),
        (("modal_displacement", 2), "Modal displacement of mode 2"),
        (("peak_force", "guide", 1), "Largest force, impact 1 on guide"),
    ],
)
def test_titles(target: tuple[str | int, ...], title: str) -> None:
    assert title_of(target) == title


def test_a_force_of_nothing_is_told_so() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    loads = [bs.NodalForce("off", node="P"), bs.NodalForce("on", node="P", force=(2.0, 0, 0))]
    told = dict(model_rows(bs.Problem(basis, loads=loads, duration=1.0)))
    assert told["Loads"] == ["off: nothing at P", "on: (2, 0, 0) N at P"]
