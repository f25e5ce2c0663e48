"""Forces of laws against what they resist."""

from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.report import as_plotly, figures
from bumpstop.report.loops import force_loop, friction_loop

from .conftest import CASES, Run


def path(figure: figures.Figure) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    (trace,) = figure["data"]
    return np.asarray(trace["x"]), np.asarray(trace["y"])


@pytest.fixture(scope="module")
def device() -> bs.Response:
    """The seismic device of SDND120A, between supports that move."""
    case = bs.load_case(CASES / "sdnd120a" / "case.toml")
    return bs.simulate(case.problems["converged"])


@pytest.fixture(scope="module")
def sliding() -> bs.Response:
    """A block on a spring that slides to rest on a floor."""
    basis = bs.ModalBasis.from_modes(
        frequency=[1.0, 0.0], shapes={("P", "dx"): [1.0, 0.0], ("P", "dy"): [0.0, 1.0]}
    )
    floor = bs.Stop(
        "floor", node="P", normal=(0, 1, 0), gap=-1e-3, stiffness=1e4, friction=0.1,
        tangential_stiffness=1e5,
    )  # fmt: skip
    weight = bs.NodalForce("weight", node="P", force=(0, -10.0, 0))
    thrown = bs.ModalState(velocity=[1.0, 0.0])
    problem = bs.Problem(basis, laws=[floor], loads=[weight], initial=thrown, duration=2.0)
    return bs.simulate(problem, method="exact")


def test_a_spring_comes_back_the_way_it_went(soft: bs.Response) -> None:
    figure = force_loop(soft, "spring")
    depth, force = path(figure)
    np.testing.assert_allclose(force, 18.0 * np.maximum(depth, 0.0), atol=1e-9)  # N over mm
    assert figure["layout"]["shapes"][0]["x0"] == 0.0
    assert figure["layout"]["title"]["subtitle"]["text"] == "Nothing lost in it"
    assert as_plotly(figure).layout.xaxis.title.text == "Depth beyond contact (mm)"


def test_a_short_contact_is_still_a_curve(ball: Run) -> None:
    depth, _ = path(force_loop(ball.responses["base"], "spring"))
    assert np.count_nonzero(depth > 0.0) > 60


def test_the_area_of_a_loop_is_the_energy_lost(device: bs.Response) -> None:
    figure = force_loop(device, "device")
    deformation, force = path(figure)  # mm and kN
    area = float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(deformation)))
    end = device.energy_terms([device.problem.duration])
    held = float(end["stored"][0])
    # Trapezoids between samples of 2 ms, on a curve with corners.
    assert area == pytest.approx(float(end["dissipated_stops"][0]) + held, rel=5e-3)
    assert figure["layout"]["title"]["text"] == "Device: what it resists"
    assert figure["layout"]["title"]["subtitle"]["text"].endswith(" lost in it by the end")


def test_friction_resists_with_the_coefficient_times_the_push(sliding: bs.Response) -> None:
    node, slider = friction_loop(sliding, "floor")["data"]
    way, friction = np.asarray(node["x"]), np.asarray(node["y"])
    assert np.abs(friction).max() == pytest.approx(1.0, rel=1e-9)  # 0.1 of 10 N
    # While it slides on, it resists: the work done on it is positive.
    assert np.sum(0.5 * (friction[1:] + friction[:-1]) * np.diff(way)) > 0.0
    assert (node["name"], slider["name"]) == ("Node", "Slider")


def test_what_rubs_in_no_single_direction_is_refused(soft: bs.Response) -> None:
    with pytest.raises(bs.InputError, match="does not rub in one direction"):
        friction_loop(soft, "spring")


def test_a_device_pulls_as_well_as_it_pushes(device: bs.Response) -> None:
    figure = figures.stop_force(device, "device")
    (trace,) = figure["data"]
    assert min(trace["y"]) < 0.0 < max(trace["y"])
    assert "rangemode" not in figure["layout"]["yaxis"]
    assert figure["layout"]["title"]["text"] == "Force of device device"
    assert figures.gap(device, "device")["layout"]["title"]["text"].startswith("Deformation of")


def test_friction_in_two_directions_is_drawn_in_both() -> None:
    case = bs.load_case(CASES / "tube-in-hole" / "case.toml")
    response = bs.simulate(case.problems["sliding"], method="dop853", rtol=1e-9)
    around, along = figures.friction_force(response, "hole")["data"]
    assert np.abs(around["y"]).max() < 1e-9
    # Sliding forwards, 0.3 of 10 N hold it back.
    assert min(along["y"]) == pytest.approx(-3.0, rel=1e-6)


def test_the_slider_is_behind_the_node_by_what_its_spring_gives(sliding: bs.Response) -> None:
    _, slider = friction_loop(sliding, "floor")["data"]
    anchor = sliding.sample("internal_variable", "floor", "anchor", times=[0.1, 2.0])
    force = sliding.sample("friction_force", "floor", times=[0.1, 2.0])
    place = sliding.sample("displacement", "P", "dx", times=[0.1, 2.0])
    np.testing.assert_allclose(place - anchor, -force / 1e5, rtol=1e-9)
    drawn = np.asarray(slider["x"])
    assert drawn[-1] == pytest.approx(1e3 * anchor[1], rel=1e-6)  # in mm
    # The loop of the slider is a rectangle's: it moves only while the force is the largest.
    pull = np.abs(np.asarray(slider["y"]))
    moves = np.abs(np.diff(drawn)) > 1e-6
    assert np.maximum(pull[1:], pull[:-1])[moves].min() > 0.99


def test_a_slider_out_of_contact_leaves_a_gap() -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[1.0, 0.0], shapes={("P", "dx"): [1.0, 0.0], ("P", "dy"): [0.0, 1.0]}
    )
    floor = bs.Stop(
        "floor", node="P", normal=(0, 1, 0), gap=1e-3, stiffness=1e4, friction=0.1,
        tangential_stiffness=1e5,
    )  # fmt: skip
    start = bs.ModalState(velocity=[0.3, -0.5])
    run = bs.simulate(bs.Problem(basis, laws=[floor], initial=start, duration=0.5))
    _, slider = friction_loop(run, "floor")["data"]
    assert np.isnan(np.asarray(slider["x"], dtype=float)).any()
    assert as_plotly(friction_loop(run, "floor")).layout.showlegend
