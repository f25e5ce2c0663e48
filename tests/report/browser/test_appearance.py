"""The page can be read in narrow windows, on dark screens and on paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

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

    def test_it_prints(self, page: Page) -> None:
        assert page.pdf(format="A4").startswith(b"%PDF")

    @staticmethod
    def check_colours(page: Page, theme: dict[str, str]) -> None:
        assert colour(page.locator("body"), "backgroundColor") == theme["paper"]
        assert colour(page.locator("body"), "color") == theme["ink"]
        plot = page.locator("#variant-1 [data-figure]").first
        assert colour(plot.locator(".main-svg").first, "backgroundColor") == theme["paper"]
        assert colour(plot.locator("path.js-line").first, "stroke") == theme["computed"]
