"""Motions in space: turned by hand and by keys, with holes, links and forces."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

import bumpstop as bs

from ..conftest import Run, made_case, run
from .conftest import colour, motion_of, node, pixels_a_metre, seek, shown_time

if TYPE_CHECKING:
    from playwright.sync_api import Locator

    from bumpstop.problem import Law

    from .conftest import Opened


@pytest.fixture(scope="module")
def mast() -> Run:
    """A mast in space that hits a post of a hole, with a spring and a rigid stop besides."""
    steel = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    section = bs.Tube(outer_radius=0.03, thickness=0.004)
    structure = bs.Structure(
        nodes={"foot": (0, 0, 0), "top": (0, 0, 2), "side": (0.5, 0, 2)},
        beams=[
            bs.Beam("mast", nodes=("foot", "top"), elements=6, material=steel, section=section),
            bs.Beam("arm", nodes=("top", "side"), elements=2, material=steel, section=section),
        ],
        supports=[bs.Support(nodes=["foot"], fixed=("dx", "dy", "dz", "drx", "dry", "drz"))],
        springs=[bs.Spring("guy", node="side", stiffness=(2e3, 0, 0, 0, 0, 0))],
    )
    basis = bs.ModalBasis.from_structure(structure, modes=6)
    corners = [((2 * n + 1) * np.pi / 4, 6e-3) for n in range(4)]
    laws: list[Law] = [
        bs.PolarStop("square", node="top", axis=(0, 0, 1), profile=corners, stiffness=1e6),
        bs.ForceRelation("tie", node="side", direction=(0, 1, 0), force="-100 * x"),
    ]
    shaken = bs.NodalForce("wind", node="top", force=(200.0, 300.0, 0.0))
    problem = bs.Problem(basis, laws=laws, loads=[shaken], duration=0.4)
    case = made_case({"base": problem}, title="A mast in space")
    return run(case, method="dop853")


@pytest.fixture(scope="module")
def mast_page(mast: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return mast.write(tmp_path_factory.mktemp("mast") / "report.html")


def dot(motion: Locator) -> tuple[float, float]:
    found = motion.locator(".orbit .cursor-dot")
    return tuple(float(found.get_attribute(key) or "nan") for key in ("cx", "cy"))  # type: ignore[return-value]


class TestOrbit:
    def test_the_node_whirls_in_its_hole(self, opened: Opened, tube_page: Path, tube: Run) -> None:
        motion = motion_of(opened(tube_page))
        orbit = motion.locator(".orbit")
        assert "Within hole" in orbit.inner_text()
        scale = float(orbit.locator("svg").get_attribute("data-scale") or "nan")
        response = tube.responses["whirling"]
        found, expected = [], []
        for frame in (100, 420, 777):
            seek(motion, frame)
            found.append(dot(motion))
            time = shown_time(motion)
            expected.append(
                [response.sample("displacement", "P", d, times=[time])[0] for d in ("dy", "dz")]
            )
        moved = np.diff(np.array(found), axis=0) * [1.0, -1.0] / scale
        np.testing.assert_allclose(moved, np.diff(expected, axis=0), atol=2e-8)

    def test_the_push_points_inwards(self, opened: Opened, tube_page: Path) -> None:
        motion = motion_of(opened(tube_page))
        middle = float(motion.locator(".orbit svg").get_attribute("width") or "nan") / 2
        for frame in (10, 500):
            seek(motion, frame)
            path = motion.locator(".orbit .force").get_attribute("d") or ""
            ends = [
                [float(part) for part in point.split()]
                for point in path[1:].split("M")[0].split("L")
            ]
            away = [np.hypot(x - middle, y - middle) for x, y in ends]
            assert away[1] < away[0] < middle
            assert "40.0" in motion.locator(".orbit figcaption span").inner_text()

    def test_the_hole_is_drawn_in_the_scene(self, opened: Opened, tube_page: Path) -> None:
        motion = motion_of(opened(tube_page))
        hole = motion.locator("[data-part=stage] [data-stop=hole]")
        assert hole.get_attribute("data-contact") == "closed"
        assert len((hole.locator(".border").get_attribute("d") or "").split("L")) > 50


class TestSpace:
    def test_it_is_turned_by_keys_and_by_hand(self, opened: Opened, mast_page: Path) -> None:
        page = opened(mast_page)
        motion = motion_of(page)
        stage = motion.locator("[data-part=stage]")
        before = node(motion, "side")
        stage.focus()
        stage.press("ArrowRight")
        by_key = node(motion, "side")
        assert by_key != before
        box = stage.bounding_box()
        assert box is not None
        page.mouse.move(box["x"] + 200, box["y"] + 100)
        page.mouse.down()
        page.mouse.move(box["x"] + 260, box["y"] + 120, steps=4)
        page.mouse.up()
        assert node(motion, "side") != by_key
        # The mast stands upright whatever its azimuth.
        foot, top = node(motion, "foot"), node(motion, "top")
        assert top[1] < foot[1]

    def test_a_turned_motion_plays_and_is_magnified(
        self, opened: Opened, mast_page: Path, mast: Run
    ) -> None:
        motion = motion_of(opened(mast_page))
        stage = motion.locator("[data-part=stage]")
        stage.focus()
        for key in ("ArrowLeft", "ArrowLeft", "ArrowDown"):
            stage.press(key)
        slider = motion.locator("[data-part=magnify]")
        for choice in ("0", slider.get_attribute("max") or ""):
            slider.fill(choice)
            seek(motion, 0)
            rest, scale = np.array(node(motion, "top")), pixels_a_metre(motion)
            seek(motion, 700)
            moved = np.linalg.norm(np.array(node(motion, "top")) - rest) / scale
            time = [shown_time(motion)]
            response = mast.responses["base"]
            travel = [
                response.sample("displacement", "top", dof, times=time)[0]
                for dof in ("dx", "dy", "dz")
            ]
            # On paper it goes no further than in space, and most of it is seen.
            assert 0.2 * np.linalg.norm(travel) < moved + 0.02 / scale
            assert moved <= 1.01 * np.linalg.norm(travel) + 0.02 / scale

    def test_what_holds_it_is_drawn(self, opened: Opened, mast_page: Path) -> None:
        motion = motion_of(opened(mast_page))
        stage = motion.locator("[data-part=stage]")
        assert stage.locator("[data-stop=guy] .spring").get_attribute("d")
        assert stage.locator("[data-stop=tie] .spring").get_attribute("d")
        contact = motion.locator("[data-stop=square]")
        frames = range(0, 1001, 20)
        touching = []
        for frame in frames:
            seek(motion, frame)
            closed = contact.get_attribute("data-contact") == "closed"
            touching.append(closed)
            assert colour(contact.locator(".border"), "stroke") in {"#d55e00", "#59636e"}
        assert any(touching)
        assert not all(touching)
