"""Figures of labelled arrays."""

import numpy as np
import pytest
import xarray as xr

import bumpstop as bs
from bumpstop.report.arrays import MOST_CELLS, array_figure


def array(values: object, dims: tuple[str, ...] = ("time",), units: str = "m") -> xr.DataArray:
    data = np.asarray(values, dtype=float)
    coords = {
        name: (name, np.arange(size) * 0.5, {"units": "s"})
        for name, size in zip(dims, data.shape, strict=True)
    }
    return xr.DataArray(data, coords=coords, dims=dims, name="reading", attrs={"units": units})


def test_a_line_is_scaled_as_its_axes_say() -> None:
    figure = array_figure(array([0.0, 1e-3, 4e-3]))
    assert figure["layout"]["yaxis"]["title"]["text"] == "Reading (mm)"
    assert figure["data"][0]["y"].tolist() == [0.0, 1.0, 4.0]
    assert figure["layout"]["title"]["text"] == "Reading"


def test_compound_units_have_no_prefix() -> None:
    figure = array_figure(array([0.0, 1e-3], units="m^2/Hz"))
    assert figure["layout"]["yaxis"]["title"]["text"] == "Reading (m²/Hz)"
    assert figure["data"][0]["y"].tolist() == [0.0, 1e-3]


def test_logarithmic_axes() -> None:
    layout = array_figure(array([1.0, 2.0]), log="y")["layout"]
    assert layout["yaxis"]["type"] == "log"
    assert "type" not in layout["xaxis"]


def test_bars_are_as_wide_as_their_classes() -> None:
    classes = array([3.0, 1.0], units="1").assign_coords(
        {"from": ("time", [-0.25, 0.25]), "to": ("time", [0.25, 0.75])}
    )
    figure = array_figure(classes, "bars")
    assert np.allclose(figure["data"][0]["width"], np.full(2, 500.0))
    assert figure["layout"]["xaxis"]["title"]["text"] == "Time (ms)"


def test_points_are_not_thinned() -> None:
    assert len(array_figure(array(np.arange(9000.0)), "points")["data"][0]["x"]) == 9000


def test_a_map_is_thinned_and_may_be_logarithmic() -> None:
    values = np.outer(np.arange(1.0, 801.0), np.arange(1.0, 1001.0))
    figure = array_figure(array(values, ("frequency", "time")), log="z")
    cells = figure["data"][0]["z"]
    assert cells.size <= MOST_CELLS
    assert cells[0, 0] == 0.0
    assert figure["layout"]["title"]["subtitle"]["text"] == "log₁₀ of reading (m)"


def test_plotly_takes_them() -> None:
    for kind in ("line", "bars", "points"):
        assert len(bs.plot(array([1.0, 2.0]), kind).data) == 1
    assert bs.plot(array([[1.0, 2.0]], ("a", "b"))).data[0].type == "heatmap"


@pytest.mark.parametrize(("dims", "kind"), [(("a",), "map"), (("a", "b"), "line"), (("a",), "pie")])
def test_refuses(dims: tuple[str, ...], kind: str) -> None:
    with pytest.raises(bs.InputError, match=r"cannot be drawn so|unknown kind"):
        array_figure(array(np.ones([2] * len(dims)), dims), kind)
