"""The page can be read in narrow windows, on dark screens and on paper."""

from __future__ import annotations

import re
import zlib
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from bumpstop.report.palette import DARK, LIGHT

from .conftest import (
    colour,
    draw_all,
    motion_of,
    pixels_a_metre,
    shown_time,
)

if TYPE_CHECKING:
    from playwright.sync_api import Page

    from .conftest import Opened


POINTS_A_PIXEL = 0.75
"""Of CSS: 96 pixels and 72 points are an inch."""


def scales_in(pdf: bytes) -> list[float]:
    """Return how large each printed page is drawn, in points for a pixel."""
    streams = re.findall(rb"stream\r?\n(.*?)endstream", pdf, re.DOTALL)
    texts = [zlib.decompress(stream) for stream in streams if stream.startswith(b"x\x9c")]
    matrix = re.compile(rb"([\d.]+) 0 0 -?[\d.]+ [-\d.]+ [-\d.]+ cm")
    # A page begins with the matrix of its device; what it holds begins with the second one.
    pages = [matrix.findall(text)[:2] for text in texts if matrix.match(text)]
    return [float(device) * float(layout) for device, layout in pages]


class TestAppearance:
    @pytest.mark.parametrize("name", ["sdnl32_page", "ball_page"])
    def test_a_narrow_window_needs_no_sideways_scrolling(
        self, opened: Opened, name: str, request: pytest.FixtureRequest
    ) -> None:
        page = opened(request.getfixturevalue(name), width=360)
        draw_all(page)
        assert page.evaluate("document.documentElement.scrollWidth") == 360
        verdict = page.locator(".published tbody td:last-child").first
        assert verdict.evaluate("cell => cell.getBoundingClientRect().right") <= 345
        too_small = page.evaluate(
            "[...document.querySelectorAll('p, td, th, dd, dt, h1, h2, h3, h4, text, label')]"
            ".filter(e => e.textContent.trim() && parseFloat(getComputedStyle(e).fontSize) < 10)"
            ".map(e => e.textContent)"
        )
        assert too_small == []

    def test_the_stage_follows_the_window(self, page: Page) -> None:
        wide = pixels_a_metre(motion_of(page))
        page.set_viewport_size({"width": 420, "height": 900})
        page.wait_for_function(
            "document.querySelector('[data-part=stage]').getBoundingClientRect().width < 420"
        )
        assert pixels_a_metre(motion_of(page)) < wide

    def test_dark_screens_get_dark_plots(self, opened: Opened, sdnl32_page: Path) -> None:
        page = opened(sdnl32_page, dark=True)
        draw_all(page)
        self.check_colours(page, DARK)
        page.emulate_media(color_scheme="light")
        self.check_colours(page, LIGHT)

    def test_light_screens_get_light_plots(self, page: Page) -> None:
        draw_all(page)
        self.check_colours(page, LIGHT)

    def test_paper_is_light_and_holds_everything(self, opened: Opened, sdnl32_page: Path) -> None:
        page = opened(sdnl32_page, dark=True)
        page.emulate_media(media="print")
        page.locator("#variant-2 .main-svg").first.wait_for()
        self.check_colours(page, LIGHT)
        for variant in ("#variant-1", "#variant-2"):
            assert page.locator(variant).is_visible()
            assert page.locator(f"{variant} .variant-title").is_visible()
            figures = page.locator(f"{variant} [data-figure]").count()
            assert page.locator(f"{variant} [data-figure] .svg-container").count() == figures
        for control in (".tabs", ".controls", ".time-slider"):
            assert not page.locator(control).first.is_visible()
        # A motion stands still where its stop pushes hardest.
        assert motion_of(page).get_attribute("data-contact") == "closed"
        page.emulate_media(media="screen")
        page.wait_for_function("document.querySelector('.controls').offsetHeight > 0")
        self.check_colours(page, DARK)
        assert shown_time(motion_of(page)) == 0.0

    @pytest.mark.parametrize("width", [1280, 700, 400])
    @pytest.mark.parametrize("name", ["sdnl32_page", "ball_page"])
    def test_it_prints_in_full_size_from_any_window(
        self, opened: Opened, name: str, width: int, request: pytest.FixtureRequest
    ) -> None:
        """A browser makes a page smaller on which something is wider than the paper."""
        page = opened(request.getfixturevalue(name), width=width)
        drawn = scales_in(page.pdf(format="A4"))
        assert drawn
        np.testing.assert_allclose(drawn, POINTS_A_PIXEL, rtol=2e-3)

    def test_small_plots_stand_side_by_side_on_paper(
        self, opened: Opened, sdnl32_page: Path
    ) -> None:
        page = opened(sdnl32_page, width=688)
        page.emulate_media(media="print")
        page.locator("#variant-2 .main-svg").first.wait_for()
        assert page.evaluate("document.documentElement.scrollWidth") == 688
        left, right = (page.locator("#variant-1 .figures figure").nth(i) for i in range(2))
        boxes = left.bounding_box(), right.bounding_box()
        assert boxes[0] is not None
        assert boxes[1] is not None
        assert boxes[0]["y"] == boxes[1]["y"]
        assert boxes[0]["x"] + boxes[0]["width"] <= boxes[1]["x"]

    @pytest.mark.parametrize(
        ("name", "width", "rows"),
        [
            ("sdnl32_page", 1280, [5]),
            ("sdnl32_page", 880, [5]),
            ("sdnl32_page", 400, [2, 2, 1]),
            ("portal_page", 1280, [3]),
        ],
    )
    def test_no_headline_number_stands_alone_beside_a_gap(
        self,
        opened: Opened,
        name: str,
        width: int,
        rows: list[int],
        request: pytest.FixtureRequest,
    ) -> None:
        page = opened(request.getfixturevalue(name), width=width)
        boxes = page.locator(".facts div").evaluate_all(
            "cards => cards.map(card => card.getBoundingClientRect().toJSON())"
        )
        tops = [box["top"] for box in boxes]
        assert [tops.count(top) for top in dict.fromkeys(tops)] == rows
        right = {top: box["right"] for top, box in zip(tops, boxes, strict=True)}
        np.testing.assert_allclose(list(right.values()), max(right.values()))

    def test_impacts_are_read_without_sideways_scrolling(
        self, opened: Opened, sdnl32_page: Path
    ) -> None:
        table = opened(sdnl32_page, width=400).locator("#variant-1 .impacts")
        sizes = "table => [table.scrollWidth, table.parentElement.clientWidth]"
        assert table.evaluate(sizes)[0] <= table.evaluate(sizes)[1]
        peak = table.locator("td").nth(5)
        assert peak.get_attribute("data-label") == "Peak force (N)"
        assert peak.inner_text() == "89.859"

    @staticmethod
    def check_colours(page: Page, theme: dict[str, str]) -> None:
        assert colour(page.locator("body"), "backgroundColor") == theme["paper"]
        assert colour(page.locator("body"), "color") == theme["ink"]
        plot = page.locator("#variant-1 [data-figure]").first
        assert colour(plot.locator(".main-svg").first, "backgroundColor") == theme["paper"]
        assert colour(plot.locator("path.js-line").first, "stroke") == theme["computed"]
