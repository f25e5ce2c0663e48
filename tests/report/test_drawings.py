"""Every drawing is one call that gives a plotly figure."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import bumpstop as bs

from .conftest import Run

go = pytest.importorskip("plotly.graph_objects")


@pytest.mark.parametrize(
    ("draw", "across", "up"),
    [
        (lambda run: bs.draw_history(run, "displacement", "B", "dy"), "Time", "Displacement dy"),
        (lambda run: bs.draw_history(run, "acceleration", "B", "drz"), "Time", "Acceleration drz"),
        (lambda run: bs.draw_history(run, "stop_force", "spring"), "Time", "Force"),
        (lambda run: bs.draw_history(run, "gap", "spring"), "Time", "Gap"),
        (lambda run: bs.draw_history(run, "gauge", "strain"), "Time", "Strain"),
        (lambda run: bs.draw_phase_portrait(run, "B", "dy"), "Displacement dy", "Velocity dy"),
        (lambda run: bs.draw_section(run, "B", "dy", 1e-3), "Displacement", "Velocity"),
        (lambda run: bs.draw_loop(run, "spring"), "Depth beyond contact", "Force"),
        (bs.draw_energy, "Time", "Energy"),
    ],
)
def test_curves(
    soft: bs.Response, draw: Callable[[bs.Response], Any], across: str, up: str
) -> None:
    figure = draw(soft)
    assert isinstance(figure, go.Figure)
    assert figure.layout.xaxis.title.text.startswith(f"{across} (")
    assert figure.layout.yaxis.title.text.startswith(f"{up} (")


def test_a_section_is_the_motion_once_a_period(soft: bs.Response) -> None:
    (points,) = bs.draw_section(soft, "B", "dy", 2e-3, phase=0.25).data
    times = (np.arange(10) + 0.25) * 2e-3
    expected = np.sort(soft.sample("displacement", "B", "dy", times=times))
    np.testing.assert_allclose(points.x, expected * 1e3, rtol=1e-9)


@pytest.mark.parametrize(
    ("target", "told"),
    [
        (("speed", "B", "dy"), "unknown quantity"),
        (("displacement", "B"), "is of a node and a dof"),
        (("gap", "spring", "dy"), "is of one name"),
    ],
)
def test_histories_of_nothing_are_refused(
    soft: bs.Response, target: tuple[str, ...], told: str
) -> None:
    with pytest.raises(bs.InputError, match=told):
        bs.draw_history(soft, *target)


def test_an_orbit_shows_the_forces(tube: Run) -> None:
    path, contact, border = bs.draw_orbit(tube.responses["whirling"], "hole").data
    radius = np.hypot(path.x, path.y)
    np.testing.assert_allclose(radius, 800.0, rtol=1e-6)  # µm
    np.testing.assert_allclose(contact.marker.color, 40.0, rtol=1e-6)
    np.testing.assert_allclose(np.hypot(border.x, border.y), 600.0, rtol=1e-9)


def test_arrows_push_inwards(tube: Run) -> None:
    arrows = bs.draw_orbit(tube.responses["whirling"], "hole").layout.annotations
    assert arrows
    for arrow in arrows:
        # Its tail is drawn from the head by (ax, ay) pixels, up being negative.
        tail = np.array([arrow.ax, -arrow.ay])
        assert tail @ [arrow.x, arrow.y] > 0.99 * np.hypot(*tail) * np.hypot(arrow.x, arrow.y)


def test_a_plane_has_no_orbit(soft: bs.Response) -> None:
    with pytest.raises(bs.InputError, match="no obstacle about an axis"):
        bs.draw_orbit(soft, "spring")


def test_sectors_lie_around_their_circle() -> None:
    angle = (np.arange(8) + 0.5) * np.pi / 4
    rate = xr.DataArray(angle, coords={"angle": angle}, attrs={"units": "W", "long_name": "rate"})
    (bars,) = bs.draw_sectors(rate).data
    np.testing.assert_allclose(bars.theta, np.degrees(angle))
    np.testing.assert_allclose(bars.width, 45.0)
    with pytest.raises(bs.InputError, match="over angle"):
        bs.draw_sectors(rate.rename(angle="time"))


class TestScene:
    def test_frames_are_the_motion_at_their_scale(self, soft: bs.Response) -> None:
        figure = bs.draw_scene(soft, 20.0)
        for scale in (20, 1):
            frames = [frame for frame in figure.frames if frame.group == str(scale)]
            assert [frame.name for frame in frames[:2]] == [f"{scale}:0", f"{scale}:1"]
            last = frames[-1].data[1]  # the nodes
            tip = list(last.text).index("B")
            (end,) = soft.sample("displacement", "B", "dy", times=[0.02])
            assert last.y[tip] == pytest.approx(scale * end, rel=1e-5)
            assert last.x[tip] == pytest.approx(0.783, rel=1e-5)

    def test_beams_have_the_shape_of_their_elements(self, soft: bs.Response) -> None:
        frame = next(f for f in bs.draw_scene(soft, 10.0).frames if f.name == "10:60")
        beam = frame.data[0]
        along = np.array(beam.x, dtype=float)
        time = [0.02 * 60 / 120]
        bent = [
            10.0 * soft.sample("displacement", f"AB@{s!r}", "dy", times=time)[0]
            for s in along.clip(0.0, 0.783).tolist()
        ]
        np.testing.assert_allclose(beam.y, bent, atol=1e-6)

    def test_what_pushes_is_told_apart(self, soft: bs.Response) -> None:
        frames = [frame for frame in bs.draw_scene(soft).frames if frame.group != "1"]
        end = float(soft.impact_table()["end"][0]) / 0.02
        for share, frame in zip(np.linspace(0.0, 1.0, len(frames)), frames, strict=True):
            pressed, forces = frame.data[3], frame.data[4]
            closed = 0.0 < share < end
            assert np.isfinite(np.array(pressed.x, dtype=float)).sum() > 10 or not closed
            assert (len(forces.x) > 1) == closed

    def test_scales_go_with_their_buttons(self, soft: bs.Response) -> None:
        figure = bs.draw_scene(soft)
        play, scales = figure.layout.updatemenus
        assert [button.label for button in play.buttons] == ["Play", "Pause"]
        assert [button.label for button in scales.buttons] == ["Motion × 5", "True scale"]
        names = {frame.name for frame in figure.frames}
        for button in scales.buttons:
            layout = button.args[1]
            steps = [step["args"][0][0] for step in layout["sliders"][0]["steps"]]
            assert set(steps) <= names

    def test_round_stops_and_links_are_there(self, tube: Run) -> None:
        frame = bs.draw_scene(tube.responses["whirling"]).frames[3]
        pressed = frame.data[3]
        np.testing.assert_allclose(np.hypot(pressed.y, pressed.z), 0.6e-3, rtol=1e-5)

    def test_a_magnification_is_positive(self, soft: bs.Response) -> None:
        with pytest.raises(bs.InputError, match="magnification"):
            bs.draw_scene(soft, 0.0)

    def test_it_does_not_play_by_itself(self, soft: bs.Response, tmp_path: Path) -> None:
        path = tmp_path / "scene.html"
        bs.draw_scene(soft).write_html(path, include_plotlyjs=False)
        assert "Plotly.animate" not in path.read_text()


def test_modes_in_space(portal: bs.ModalBasis) -> None:
    figure = bs.draw_modes(portal)
    steps = figure.layout.sliders[0].steps
    assert len(steps) == 6
    for number, step in enumerate(steps):
        shown = step.args[0]["visible"]
        beams, nodes = [i for i, seen in enumerate(shown) if seen][2:]
        assert beams == 2 + 2 * number
        assert f"Mode {number + 1}: " in step.args[1]["title.text"]
        rest = np.stack([figure.data[1][axis] for axis in "xyz"], axis=1)
        moved = np.stack([figure.data[nodes][axis] for axis in "xyz"], axis=1) - rest
        # In proportion to the shape.
        names = list(figure.data[nodes].text)
        shape = np.array(
            [[portal.row(name, dof)[number] for dof in ("dx", "dy", "dz")] for name in names]
        )
        factor = np.linalg.norm(moved) / np.linalg.norm(shape)
        np.testing.assert_allclose(moved, factor * shape, atol=1e-5)
