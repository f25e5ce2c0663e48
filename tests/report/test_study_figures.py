"""Pictures of studies: every point stands where its run is, whoever counts them."""

import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import bumpstop as bs
from bumpstop.report import write_study
from bumpstop.report.studies.bars import shares_figure
from bumpstop.report.studies.grids import basin_figure, curve_figure, heat_figure
from bumpstop.report.studies.points import (
    MOST_MARKS,
    histogram_figure,
    over_time_figure,
    scatter_figure,
)
from bumpstop.report.studies.raster import rastered
from tests.study.bouncing import CASE, STUDY, written

GAP, STIFFNESS = "stops.spring.gap", "stops.spring.stiffness"


@pytest.fixture(scope="module")
def grid(tmp_path_factory: pytest.TempPathFactory) -> tuple[bs.Study, xr.Dataset]:
    study = bs.load_study(written(tmp_path_factory.mktemp("grid")))
    return study, study.run(workers=1)


def test_cells_of_a_heat_map_are_their_runs(grid: tuple[bs.Study, xr.Dataset]) -> None:
    study, found = grid
    (trace,) = heat_figure(found, "start", x=GAP, y=STIFFNESS)["data"]
    for (row, column), run in np.ndenumerate(trace["customdata"]):
        values = study.runs.row(int(run))
        assert trace["x"][column] == values[GAP]
        assert trace["y"][row] == values[STIFFNESS]
        # 3 m/s over the gap, told in ms
        assert trace["z"][row, column] == pytest.approx(1e3 * float(values[GAP]) / 3.0)


def test_axes_are_logarithmic_where_values_are(grid: tuple[bs.Study, xr.Dataset]) -> None:
    figure = bs.heat_map(grid[1], "force")
    assert figure.layout.xaxis.title.text == f"{STIFFNESS} (N/m)"
    assert figure.layout.xaxis.type == "log"
    assert figure.layout.yaxis.type is None
    assert figure.layout.title.text == "Largest force of spring"


def test_over_further_parameters_the_largest_is_shown() -> None:
    values = np.arange(24.0).reshape(2, 3, 4)
    values[0, 0, 3] = np.nan
    dims = ("a", "b", "c")
    found = xr.Dataset(
        {"force": (dims, values), "failed": (dims, np.zeros(values.shape, dtype=bool))},
        coords={name: np.arange(size) for name, size in zip(dims, values.shape, strict=True)},
    )
    (trace,) = heat_figure(found, "force", x="b", y="a")["data"]
    assert trace["z"].tolist() == [[2, 7, 11], [15, 19, 23]]
    assert trace["customdata"].tolist() == [[2, 7, 11], [15, 19, 23]]
    for words, told in [({"x": "z"}, "no such parameter"), ({"x": "a", "y": "a"}, "other axis")]:
        with pytest.raises(bs.InputError, match=told):
            heat_figure(found, "force", **words)
    with pytest.raises(bs.InputError, match="did you mean 'force'"):
        bs.heat_map(found, "forse")


def test_one_parameter_makes_a_curve(grid: tuple[bs.Study, xr.Dataset]) -> None:
    found = grid[1].sel({GAP: 0.5}, drop=True)
    (trace,) = curve_figure(found, "force")["data"]
    assert trace["customdata"].tolist() == [1, 3, 5, 7, 9]
    with pytest.raises(bs.InputError, match="grid of two parameters"):
        heat_figure(found, "force")


def test_basins_are_drawn_by_attractor() -> None:
    numbers = np.array([[1, 2, 0], [1, 1, 2]])
    found = xr.Dataset(
        {
            "attractor": (("x", "v"), numbers),
            "failed": (("x", "v"), numbers < 0),
            "attractor_periods": ("attractors", np.array([1, 3])),
        },
        coords={"x": [0.0, 1.0], "v": [0.0, 1.0, 2.0]},
    )
    (trace,) = basin_figure(found)["data"]
    assert trace["z"].tolist() == numbers.tolist()
    assert trace["colorbar"]["ticktext"] == ["none found", "1 (period 1)", "2 (period 3)"]
    colours = [colour for _, colour in trace["colorscale"]]
    assert colours[0::2] == colours[1::2]
    assert len(set(colours)) == 3
    assert bs.basin_map(found, x="x", y="v").data[0].z.shape == (3, 2)
    with pytest.raises(bs.InputError, match="looked for no attractors"):
        basin_figure(found.drop_vars("attractor"))


def test_every_point_is_in_its_pixel() -> None:
    draws = np.random.default_rng(3)
    x, y = draws.uniform(-2, 5, 20_000), draws.normal(size=20_000)
    y[7] = np.nan
    raster = rastered(x, y, rows=50)
    known = np.isfinite(y)
    width, height = (np.diff(edge).mean() for edge in (raster.x, raster.y))
    edges = [
        np.append(middles - step / 2, middles[-1] + step / 2)
        for middles, step in ((raster.y, height), (raster.x, width))
    ]
    expected, *_ = np.histogram2d(y[known], x[known], bins=edges)
    # On the edge between two pixels rounding decides.
    assert np.abs(raster.counts - expected).sum() <= 4
    assert raster.counts.sum() == 19_999
    rows, columns = np.nonzero(raster.counts)
    some = raster.some[rows, columns]
    assert np.abs(x[some] - raster.x[columns]).max() <= width / 2 * (1 + 1e-9)
    assert np.abs(y[some] - raster.y[rows]).max() <= height / 2 * (1 + 1e-9)


def test_ten_million_points_are_a_picture() -> None:
    parameters, each = 1000, 10_000
    draws = np.random.default_rng(1)
    x = np.repeat(np.linspace(0.0, 1.0, parameters), each)
    y = draws.random(parameters * each)
    points = pd.DataFrame({"frequency": x, "value": y})
    points.attrs["units"] = {"frequency": "Hz"}
    tracemalloc.start()
    figure = bs.bifurcation_diagram(points)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    shade = np.asarray(figure.data[0].z)
    assert shade.shape == (600, parameters)  # a column a value
    assert np.nansum(10.0**shade) == pytest.approx(parameters * each)
    assert figure.layout.xaxis.title.text == "frequency (Hz)"
    assert peak < 10 * x.nbytes


def test_few_points_are_drawn_one_by_one() -> None:
    points = pd.DataFrame({"gap": [0.0, 0.0, 1.0], "value": [1.0, 2.0, 3.0]})
    figure = bs.bifurcation_diagram(points)
    assert figure.data[0].mode == "markers"
    with pytest.raises(bs.InputError, match="no such column"):
        bs.bifurcation_diagram(points, "speed")
    with pytest.raises(bs.InputError, match="points: must be a table or a Dataset"):
        bs.bifurcation_diagram([1.0])


def test_a_study_at_many_times_is_a_diagram(grid: tuple[bs.Study, xr.Dataset]) -> None:
    found = grid[1].sel({GAP: 0.25}, drop=True)
    (trace,) = over_time_figure(found, "place")["data"]
    assert trace["customdata"].tolist() == [0, 0, 2, 2, 4, 4, 6, 6, 8, 8]
    np.testing.assert_array_equal(trace["y"].reshape(5, 2)[:, 1], found.place.values[:, 1])
    with pytest.raises(bs.InputError, match="over one parameter"):
        bs.bifurcation_diagram(grid[1], "place")


@pytest.mark.parametrize("each", [4, MOST_MARKS])
def test_ways_up_and_down_have_colours_of_their_own(each: int) -> None:
    loads, kinds = np.array([0.5, 1.0, 2.0]), ("way", "run", "speed_impact")
    speed = np.random.default_rng(4).random((2, 3, each))
    speed[0, 0, :2] = np.nan  # fewer impacts than were asked for
    found = xr.Dataset(
        {"speed": (kinds, speed, {"units": "m/s"}), "failed": (kinds[:2], speed[..., -1] < 0)},
        coords={"way": ["up", "down"], "loads": ("run", loads)},
    )
    figure = bs.bifurcation_diagram(found, "speed")
    up, down = figure.data
    assert (up.name, down.name) == ("up", "down")
    assert figure.layout.showlegend
    assert f"{6 * each - 2:,} points" in figure.layout.title.subtitle.text
    assert figure.layout.yaxis.title.text == "Speed (mm/s)"
    if each == 4:
        assert up.marker.color != down.marker.color
        assert down.x.tolist() == np.repeat(loads, each).tolist()
        assert down.y == pytest.approx(1e3 * speed[1].ravel())
    else:
        assert up.colorscale != down.colorscale
        assert np.nansum(10.0**up.z) == pytest.approx(3 * each - 2)
        assert np.nansum(10.0**down.z) == pytest.approx(3 * each)


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    sampled = STUDY.replace('"50 N/m", to = 800, count = 5, spacing = "log"', "50, to = 800")
    sampled += '[sampling]\nmethod = "latin_hypercube"\ncount = 40\n'
    return bs.load_study(written(tmp_path_factory.mktemp("drawn"), sampled)).run(workers=1)


def test_drawn_samples(drawn: xr.Dataset) -> None:
    (trace,) = scatter_figure(drawn, "force", STIFFNESS)["data"]
    assert trace["customdata"].tolist() == list(range(40))
    np.testing.assert_allclose(trace["y"], 3.0 * np.sqrt(2.0 * trace["x"]))
    histogram = histogram_figure(drawn, "force")
    assert histogram["data"][0]["y"].sum() == 40
    assert "50%: " in histogram["layout"]["title"]["subtitle"]["text"]


def test_many_drawn_samples_are_a_picture() -> None:
    number = MOST_MARKS + 1
    stiffness = np.linspace(1.0, 2.0, number)
    found = xr.Dataset(
        {"force": ("run", stiffness**2), "failed": ("run", np.zeros(number, dtype=bool))},
        coords={"k": ("run", stiffness)},
    )
    (trace,) = scatter_figure(found, "force", "k")["data"]
    rows, columns = np.nonzero(trace["customdata"] >= 0)
    runs = trace["customdata"][rows, columns]
    assert np.abs(stiffness[runs] - trace["x"][columns]).max() < 0.5 / 320 * 1.001


def test_sobol_and_tornado_charts() -> None:
    indices = xr.Dataset(
        {
            "force_first": ("parameter", [0.1, 0.6]),
            "force_total": ("parameter", [0.3, 0.8]),
        },
        coords={"parameter": ["gap", "stiffness"]},
    )
    figure = bs.sobol_chart(indices, "force")
    assert figure.data[0].y == ("gap", "stiffness")  # the largest on top
    assert list(figure.data[1].x) == [0.3, 0.8]
    with pytest.raises(bs.InputError, match="no such result"):
        bs.sobol_chart(indices, "tip")


def test_tornado_charts_are_of_parameters_that_go_alone() -> None:
    grid = xr.Dataset({"force": (("a", "b"), np.ones((2, 2)))})
    with pytest.raises(bs.InputError, match="must be of a study of one parameter at a time"):
        bs.tornado_chart(grid, "force")


@pytest.mark.parametrize(
    "draw", [bs.heat_map, bs.sobol_chart, bs.tornado_chart, bs.search_chart, bs.basin_map]
)
def test_pictures_are_of_what_a_study_found(draw: Any) -> None:
    with pytest.raises(bs.InputError, match="must be a Dataset"):
        draw(5, "force")


def test_the_chart_of_a_search() -> None:
    values = [np.nan, 3.0, 1.0, 3.0, 4.0, np.nan, 2.0]
    found = xr.Dataset({"force": ("run", values), "failed": ("run", np.isnan(values))})
    marks, steps = bs.search_chart(found, "force").data
    np.testing.assert_array_equal(marks.y, values)
    assert list(zip(steps.x, steps.y, strict=True)) == [(1, 3.0), (4, 4.0), (6, 4.0)]
    assert list(steps.customdata) == [1, 4, 4]
    nothing = found.assign(force=("run", np.full(7, np.nan)))
    assert "No run has it" in str(bs.search_chart(nothing, "force").layout.title)
    with pytest.raises(bs.InputError, match="no such output"):
        bs.search_chart(found, "tip")
    grid = xr.Dataset({"force": (("a", "b"), np.ones((2, 2)))})
    with pytest.raises(bs.InputError, match="must be one number for each run"):
        bs.search_chart(grid, "force")


def test_shares_of_the_variance_on_a_grid() -> None:
    # 2 a + b + a b over symmetric levels: the variances of the three terms add up.
    a, b = np.linspace(-1.0, 1.0, 5), np.linspace(-1.0, 1.0, 9)
    values = 2.0 * a[:, np.newaxis] + b + a[:, np.newaxis] * b
    dims = ("a", "b")
    found = xr.Dataset(
        {"force": (dims, values), "failed": (dims, values > 9.0)}, coords={"a": a, "b": b}
    )
    parts = 4.0 * a.var(), b.var(), a.var() * b.var()
    (bar,) = shares_figure(found, "force")["data"]
    assert bar["y"] == ["b", "a"]
    np.testing.assert_allclose(bar["x"], [parts[1] / sum(parts), parts[0] / sum(parts)], rtol=1e-12)


def test_shares_of_the_variance_of_drawn_samples() -> None:
    draws = np.random.default_rng(5).uniform(-1.0, 1.0, (3, 20_000))
    names = {name: ("run", column) for name, column in zip("abc", draws, strict=True)}
    values = 2.0 * draws[0] + draws[1]  # and c does nothing
    found = xr.Dataset({"force": ("run", values), "failed": ("run", values > 9.0)}, coords=names)
    (bar,) = shares_figure(found, "force")["data"]
    assert bar["y"] == ["c", "b", "a"]
    # Within each of 12 classes, 1/144 of the variance of the parameter itself is left.
    np.testing.assert_allclose(bar["x"], [0.0, 0.2, 0.8], atol=0.01)


WORDS: dict[str, object] = {"run.method": ["exact", "central_difference"]}
STUDIES: list[tuple[dict[str, object], str]] = [
    (WORDS, "grid"),
    (WORDS | {GAP: [0.25, 0.5]}, "grid"),
    (WORDS | {GAP: [0.25, 0.5]}, "list"),
    ({GAP: [0.5]}, "grid"),
    ({GAP: [0.5], STIFFNESS: [100.0]}, "grid"),
    ({STIFFNESS: [-1.0, -2.0]}, "grid"),  # all fail
    ({GAP: [50.0, 60.0]}, "grid"),  # none hits
    (WORDS | {GAP: [0.25, 0.5]}, "one_at_a_time"),
    ({GAP: [50.0, 60.0]}, "one_at_a_time"),
    (WORDS | {GAP: [0.25, 0.5]}, "saltelli"),
    ({STIFFNESS: [-1.0, 2.0]}, "saltelli"),  # half of them fail
    ({GAP: [0.2, 0.4], STIFFNESS: [50.0, 100.0], "stops.spring.damping": [0.0, 1.0]}, "grid"),
]


@pytest.mark.parametrize(("parameters", "sampling"), STUDIES)
def test_every_study_has_a_page(
    parameters: dict[str, object], sampling: str, grid: tuple[bs.Study, xr.Dataset], tmp_path: Path
) -> None:
    case = bs.load_case(written(tmp_path, case=CASE + "dt = 1e-3\n").parent / "case.toml")
    outputs = grid[0].outputs
    drawn = bs.Sampling(sampling, 8 if sampling == "saltelli" else None)
    study = bs.Study(case, parameters, outputs, sampling=drawn)
    write_study(study, study.run(workers=1), tmp_path / "page.html", opened_by="bumpstop --open")
    page = (tmp_path / "page.html").read_text()
    assert all(name in page for name in (*parameters, *outputs))


def test_each_parameter_alone(grid: tuple[bs.Study, xr.Dataset]) -> None:
    study = grid[0]
    force = {"force": bs.Output(quantity="largest_force", stop="spring")}
    given = {GAP: bs.Range(0.2, 0.4), STIFFNESS: bs.Range(100.0, 300.0)}
    swings = bs.one_at_a_time(study.case, given, force, share=0.25)
    stiffness = np.array([[200.0, 200.0, 200.0], [150.0, 200.0, 250.0]])
    np.testing.assert_allclose(swings.force.values, 3.0 * np.sqrt(2.0 * stiffness), rtol=1e-12)
    figure = bs.tornado_chart(swings, "force")
    assert figure.data[0].y == (GAP, STIFFNESS)
    assert [list(bar.customdata) for bar in figure.data] == [[0, 3], [2, 5]]  # their runs
    low, high = (bar.base[1] + bar.x[1] for bar in figure.data)
    assert (low, high) == pytest.approx((3.0 * np.sqrt(300.0), 3.0 * np.sqrt(500.0)))
    with pytest.raises(bs.InputError, match=r"must be below 0\.5"):
        bs.one_at_a_time(study.case, given, force, share=0.5)


def test_a_run_is_opened_as_a_case_of_its_own(
    grid: tuple[bs.Study, xr.Dataset], tmp_path: Path
) -> None:
    study, found = grid
    case = bs.load_case(bs.write_case(study, 5, tmp_path / "run.toml"))
    response = bs.simulate(case.problems["base"])
    assert response.impact_table()["peak_force"][0] == found.force.values.ravel()[5]
    with pytest.raises(bs.InputError, match="has runs 0 to 9"):
        bs.write_case(study, 10, tmp_path / "none.toml")
