"""Figures as data: the right numbers, in the right units, in plotly's form."""

import math
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import Reference
from bumpstop.report import as_plotly, figures
from bumpstop.report.curves import MOST_POINTS
from bumpstop.report.scales import power_of_ten

from .conftest import Run


def trace(figure: figures.Figure, name: str) -> dict[str, Any]:
    (found,) = [trace for trace in figure["data"] if trace["name"] == name]
    return dict(found)


def axis_titles(figure: figures.Figure) -> tuple[str, str]:
    layout = figure["layout"]
    return layout["xaxis"]["title"]["text"], layout["yaxis"]["title"]["text"]


def every_figure(response: bs.Response) -> dict[str, figures.Figure]:
    stop, gauge = response.problem.laws[0].name, response.problem.gauges[0].name
    return {
        "displacement": figures.node_motion(response, "displacement", "B", "dy"),
        "acceleration": figures.node_motion(response, "acceleration", "B", "drz"),
        "stop_force": figures.stop_force(response, stop),
        "gap": figures.gap(response, stop),
        "gauge_strain": figures.gauge_strain(response, gauge),
        "energy_ledger": figures.energy_ledger(response),
        "phase_portrait": figures.phase_portrait(response, "B", "dy"),
    }


def test_plotly_takes_every_figure(soft: bs.Response) -> None:
    """plotly refuses keys and values that it does not know."""
    for name, figure in every_figure(soft).items():
        taken = as_plotly(figure)
        assert len(taken.data) == len(figure["data"]), name
        assert taken.layout.title.text, name
        assert taken.layout.xaxis.title.text.endswith(")"), name


def test_plotly_would_refuse_a_mistake() -> None:
    with pytest.raises(ValueError, match="colour"):
        as_plotly({"data": [{"type": "scatter", "colour": "red"}], "layout": {}})


def test_displacement_with_its_published_points(sdnl32: Run) -> None:
    response, references = sdnl32.responses["stiff"], sdnl32.case.references["stiff"]
    figure = figures.node_motion(response, "displacement", "B", "dy", references)
    assert axis_titles(figure) == ("Time (ms)", "Displacement dy (mm)")
    computed, published = trace(figure, "Computed"), trace(figure, "Published")
    np.testing.assert_allclose(published["x"], np.arange(1, 13))
    np.testing.assert_allclose(published["y"][[0, 11]], [-2.25, 4.99])
    # The curve goes through the computed value at every published instant.
    at = np.searchsorted(computed["x"], published["x"] - 1e-9)
    expected = response.sample("displacement", "B", "dy", times=np.arange(1, 13) * 1e-3)
    np.testing.assert_allclose(computed["y"][at], expected * 1e3, rtol=1e-12)
    deviation = (expected[4] + 0.124e-3) / 0.124e-3 * 100.0
    told = f"{expected[4] * 1e3:.4f} mm ({deviation:+.2f} %)"
    assert published["customdata"][4] == told.replace("-", "−")
    assert figure["layout"]["xaxis"]["range"] == [0.0, 20.0]


def test_references_to_something_else_are_not_drawn(soft: bs.Response) -> None:
    elsewhere = Reference(
        quantity="displacement", node="A", dof="drz", times=[0.01], values=[1.0], tolerance=0.1
    )
    figure = figures.node_motion(soft, "displacement", "B", "dy", [elsewhere])
    assert [trace["name"] for trace in figure["data"]] == ["Computed"]


def test_a_published_zero_has_no_relative_deviation(soft: bs.Response) -> None:
    zero = Reference(
        quantity="gap", stop="spring", times=[0.0], values=[0.0], absolute_tolerance=1e-9
    )
    figure = figures.gap(soft, "spring", [zero])
    (told,) = trace(figure, "Published")["customdata"]
    assert told.endswith(" mm")


def test_force_is_stiffness_times_what_the_gap_lacks(soft: bs.Response) -> None:
    force = trace(figures.stop_force(soft, "spring"), "Computed")
    gap = trace(figures.gap(soft, "spring"), "Computed")
    np.testing.assert_allclose(force["y"], 18.0 * np.maximum(0.0, -gap["y"]), atol=1e-9)
    assert axis_titles(figures.stop_force(soft, "spring")) == ("Time (ms)", "Force (N)")


def test_strain_is_told_in_microstrain(soft: bs.Response) -> None:
    figure = figures.gauge_strain(soft, "strain")
    assert axis_titles(figure)[1] == "Strain (µε)"
    drawn = trace(figure, "Computed")
    expected = soft.sample("gauge", "strain", times=drawn["x"] * 1e-3)
    np.testing.assert_allclose(drawn["y"], expected * 1e6, rtol=1e-9, atol=1e-6)


def test_contact_is_shaded_while_the_stop_is_closed(soft: bs.Response) -> None:
    (band,) = figures.stop_force(soft, "spring")["layout"]["shapes"]
    assert band["x0"] == 0.0
    assert band["x1"] == pytest.approx(1e3 * float(soft.impact_table()["end"][0]))


def test_the_stack_of_energies_reaches_what_was_put_in(soft: bs.Response) -> None:
    figure = figures.energy_ledger(soft)
    *stack, given = figure["data"]
    assert {trace["stackgroup"] for trace in stack} == {"energy"}
    np.testing.assert_allclose(sum(trace["y"] for trace in stack), given["y"], rtol=1e-5)
    # The kinetic energy of the rigid rotation is all there is at first: J w2 / 2.
    section, length, density = 0.014**2, 0.783, 2400.0
    inertia = density * (section * length**3 / 3.0 + 0.014**4 / 12.0 * length)
    assert given["y"][0] == pytest.approx(0.5 * inertia * 3.8**2 * 1e3)
    assert given["name"] == "Initial energy"


def test_terms_that_vanish_are_left_out(soft: bs.Response) -> None:
    names = [trace["name"] for trace in figures.energy_ledger(soft)["data"]]
    assert "Lost in stops" not in names
    assert "Lost to damping" in names


def test_the_portrait_marks_impacts_and_the_place_of_contact(ball: Run) -> None:
    response = ball.responses["base"]
    figure = figures.phase_portrait(response, "P", "dz")
    begins, ends = trace(figure, "Contact begins"), trace(figure, "Contact ends")
    assert len(begins["x"]) == len(ends["x"]) + 1  # the run ends in the third contact
    np.testing.assert_allclose([*begins["x"], *ends["x"]], -25.4, rtol=1e-6)
    np.testing.assert_allclose(begins["y"], -math.sqrt(2 * 386.0) * 25.4, rtol=1e-6)
    (boundary,) = figure["layout"]["shapes"]
    assert boundary["x0"] == boundary["x1"] == pytest.approx(-25.4)
    assert axis_titles(figure) == ("Displacement dz (mm)", "Velocity dz (mm/s)")


def test_long_responses_are_thinned_without_losing_the_peak(bouncing: bs.Response) -> None:
    assert len(bouncing.times) > 10 * MOST_POINTS
    for figure in (
        figures.stop_force(bouncing, "floor"),
        figures.phase_portrait(bouncing, "P", "dy"),
        figures.energy_ledger(bouncing),
    ):
        assert all(len(trace["x"]) <= MOST_POINTS for trace in figure["data"])
    force = trace(figures.stop_force(bouncing, "floor"), "Computed")
    peak = max(bouncing.impact_table()["peak_force"])
    assert float(force["y"].max()) == pytest.approx(peak, rel=1e-6)


def test_many_contacts_are_not_shaded(bouncing: bs.Response) -> None:
    assert len(bouncing.impact_table()["start"]) > 60
    assert figures.gap(bouncing, "floor")["layout"]["shapes"] == []


def test_names_cannot_carry_markup() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[2.0], shapes={("<a href='x'>P</a>", "dx"): [1.0]})
    problem = bs.Problem(basis, initial=bs.ModalState(velocity=[1.0]), duration=1.0)
    response = bs.simulate(problem, method="exact")
    figure = figures.node_motion(response, "displacement", "<a href='x'>P</a>", "dx")
    assert "<" not in figure["layout"]["title"]["text"]


def test_the_heading_tells_the_extremes(soft: bs.Response) -> None:
    heading = figures.stop_force(soft, "spring")["layout"]["title"]["subtitle"]["text"]
    peak = float(soft.impact_table()["peak_force"][0])
    assert heading.startswith(f"Highest {peak:.2f} N at ")


def test_the_energies_tell_where_they_were_balanced(soft: bs.Response) -> None:
    def told(response: bs.Response) -> str:
        return str(figures.energy_ledger(response)["layout"]["title"]["subtitle"]["text"])

    assert soft.energy_residual < 1e-15
    assert told(soft) == (
        "Closes to less than 1 × 10⁻¹⁵ of the largest energy, at switches and the end"
    )
    stepped = bs.simulate(soft.problem, method="central_difference", dt=1e-5)
    residual = power_of_ten(stepped.energy_residual)
    assert told(stepped) == f"Closes to {residual} of the largest energy, at steps"
