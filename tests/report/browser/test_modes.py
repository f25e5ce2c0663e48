"""The modes can be chosen, and are drawn as they are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import bumpstop as bs

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Locator, Page

    from .conftest import Opened


def node_in_modes(modes: Locator) -> float:
    return float(modes.locator("[data-part=mode-stage] [data-node=B]").get_attribute("cy") or "nan")


class TestModes:
    def test_the_chosen_mode_is_drawn(self, page: Page, soft: bs.Response) -> None:
        modes = page.locator("#modes-1")
        frequencies = soft.problem.basis.frequencies
        for number in (2, 5, 10):
            modes.get_by_role("radio", name=str(number), exact=True).check()
            title = modes.locator("[data-part=mode-title]").inner_text()
            assert title.startswith(f"Mode {number}: ")
            hertz = float(title.removeprefix(f"Mode {number}: ").removesuffix(" Hz"))
            assert hertz == pytest.approx(frequencies[number - 1], rel=1e-4)
            path = modes.locator(".beam").get_attribute("d") or ""
            points = np.array([point.split() for point in path[1:].split("L")], dtype=float)
            axis = points[0, 1]
            crossings = np.count_nonzero(np.diff(np.sign(points[2:, 1] - axis)))
            assert crossings == number - 1  # a hinged-free beam: one node more each mode

    def test_a_mode_swings_and_rests(self, stopped_page: Page) -> None:
        page = stopped_page
        modes = page.locator("#modes-1")
        button = modes.locator("[data-part=swing]")
        rest = node_in_modes(modes)
        button.click()
        page.clock.run_for(500)
        assert button.inner_text() == "Pause"
        assert abs(node_in_modes(modes) - rest) > 20.0
        button.click()
        assert button.inner_text() == "Animate"
        assert node_in_modes(modes) == rest

    def test_every_mode_has_a_thumbnail(self, page: Page) -> None:
        paths = page.locator(".thumbnail-line").evaluate_all(
            "lines => lines.map(line => line.getAttribute('d'))"
        )
        assert len(set(paths)) == 10


class TestTurning:
    def test_a_frame_in_space_is_seen_from_where_it_is_turned_to(
        self, opened: Opened, portal_page: Path
    ) -> None:
        page = opened(portal_page)
        stage = page.locator("[data-part=mode-stage]")
        front, back = place(stage, "foot1"), place(stage, "foot3")
        assert front[1] > back[1]  # what is nearer stands lower on paper
        box = stage.bounding_box()
        assert box is not None
        page.mouse.move(box["x"] + 100, box["y"] + 100)
        page.mouse.down()
        page.mouse.move(box["x"] + 100 + 50 * np.pi, box["y"] + 100, steps=8)
        page.mouse.up()
        turned = place(stage, "foot1")
        # By a right angle: what was in front stands to the right now.
        assert turned[0] > front[0] + 50.0
        assert turned[1] < front[1]

    def test_from_above_and_from_below_no_further(self, opened: Opened, portal_page: Path) -> None:
        page = opened(portal_page)
        stage = page.locator("[data-part=mode-stage]")
        modes = page.locator("#modes-1")
        modes.get_by_role("radio", name="6", exact=True).check()
        stage.focus()
        for _ in range(30):
            page.keyboard.press("ArrowDown")
        # From straight above the feet of a post, at rest, are where its top is at rest.
        lines = stage.locator(".axis-line")
        post = (lines.nth(0).get_attribute("d") or "")[1:].split("L")
        start, end = (np.array(point.split(), dtype=float) for point in (post[0], post[-1]))
        np.testing.assert_allclose(start, end, atol=0.1)

    def test_its_modes_are_chosen_and_move(self, opened: Opened, portal_page: Path) -> None:
        page = opened(portal_page)
        modes = page.locator("#modes-1")
        stage = page.locator("[data-part=mode-stage]")
        rest = place(stage, "top2")
        modes.get_by_role("radio", name="2", exact=True).check()
        assert place(stage, "top2") != rest
        assert modes.locator("[data-part=mode-title]").inner_text().startswith("Mode 2: ")
        before = place(stage, "top2")
        modes.locator("[data-part=swing]").click()
        page.wait_for_timeout(300)
        assert place(stage, "top2") != before
        assert "none missed" in modes.inner_text()

    def test_all_of_it_stays_on_the_stage(self, opened: Opened, portal_page: Path) -> None:
        page = opened(portal_page)
        stage = page.locator("[data-part=mode-stage]")
        stage.focus()
        box = stage.bounding_box()
        assert box is not None
        for key in ["ArrowLeft"] * 12 + ["ArrowUp"] * 12 + ["ArrowRight"] * 12:
            page.keyboard.press(key)
            for number in range(4):
                x, y = place(stage, f"top{number}")
                assert 0.0 < x < box["width"]
                assert 0.0 < y < box["height"]

    def test_the_page_needs_no_plotting_library(self, portal_page: Path) -> None:
        assert portal_page.stat().st_size < 300_000


def place(stage: Locator, node: str) -> tuple[float, float]:
    dot = stage.locator(f"[data-node={node}]")
    return float(dot.get_attribute("cx") or "nan"), float(dot.get_attribute("cy") or "nan")
