"""The plots hold the curves and the published points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import bumpstop as bs

from .conftest import (
    draw_all,
)

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page

    from .conftest import Opened


class TestPlots:
    def test_they_hold_the_curve_and_the_published_points(
        self, page: Page, soft: bs.Response
    ) -> None:
        draw_all(page)
        drawn = page.locator("#variant-1 [data-figure]").first.evaluate(
            "place => place.data.map(({ name, x, y }) =>"
            " ({ name, x: Array.from(x._inputArray ?? x), y: Array.from(y._inputArray ?? y) }))"
        )
        computed, published = drawn
        assert (computed["name"], published["name"]) == ("Computed", "Published")
        np.testing.assert_allclose(published["x"], np.arange(1, 13))
        times = np.clip(np.array(computed["x"]) * 1e-3, 0.0, 0.02)
        expected = soft.sample("displacement", "B", "dy", times=times) * 1e3
        np.testing.assert_allclose(computed["y"], expected, atol=1e-5 * np.abs(expected).max())

    def test_a_page_opens_without_waiting_for_them(self, opened: Opened, sdnl32_page: Path) -> None:
        page = opened(sdnl32_page)
        assert not page.evaluate("'Plotly' in window")
        draw_all(page)
        assert page.evaluate("'Plotly' in window")

    def test_every_figure_is_drawn_with_its_axes(self, page: Page) -> None:
        draw_all(page)
        places = page.locator("#variant-1 [data-figure]")
        for number in range(places.count()):
            place = places.nth(number)
            assert place.locator("path.js-line, path.js-fill").count() >= 1
            for title in (".xtitle", ".ytitle"):
                assert place.locator(title).inner_html().endswith(")")

    @pytest.mark.parametrize(
        ("number", "target", "unit"),
        [
            (0, ("displacement", "B", "dy"), "mm"),
            (1, ("stop_force", "spring"), "N"),
            (2, ("gap", "spring"), "mm"),
            (4, ("gauge", "strain"), "µε"),
        ],
    )
    @pytest.mark.parametrize("time", [0.5, 6.37, 15.0])
    def test_pointing_at_a_curve_tells_value_unit_and_instant(
        self,
        page: Page,
        soft: bs.Response,
        number: int,
        target: tuple[str, ...],
        unit: str,
        time: float,
    ) -> None:
        factor = {"mm": 1e3, "N": 1.0, "µε": 1e6}[unit]
        told, instant = self.pointed_at(
            page, number, time, factor * soft.sample(*target, times=[time * 1e-3])[0]
        )
        when = float(instant.removeprefix("at ").removesuffix(" ms"))
        assert when == pytest.approx(time, abs=0.05)  # a pixel
        expected = factor * soft.sample(*target, times=[when * 1e-3])[0]
        assert float(told.removesuffix(f" {unit}")) == pytest.approx(expected, rel=1e-3, abs=1e-6)

    @pytest.mark.parametrize(("time", "published"), [(1.0, -2.66), (6.0, -2.87)])
    def test_pointing_at_a_published_value_compares_it(
        self, page: Page, soft: bs.Response, time: float, published: float
    ) -> None:
        (value,) = soft.sample("displacement", "B", "dy", times=[time * 1e-3]) * 1e3
        told = self.pointed_at(page, 0, time, published)
        deviation = 100.0 * (value - published) / abs(published)
        computed = f"computed {value:.3f} mm ({deviation:+.2f} %)".replace("-", "−")
        assert told == [f"published {published} mm", computed, f"at {time:.0f} ms"]

    @staticmethod
    def pointed_at(page: Page, number: int, x: float, y: float) -> list[str]:
        """Point at a place of a figure, in the units of its axes, and return what it tells."""
        place = page.locator("#variant-1 [data-figure]").nth(number)
        page.mouse.move(0, 0)
        place.scroll_into_view_if_needed()
        place.locator(".main-svg").first.wait_for()
        at = place.evaluate(
            "(place, [x, y]) => {"
            " const { xaxis, yaxis } = place._fullLayout, box = place.getBoundingClientRect();"
            " return [box.x + xaxis._offset + xaxis.c2p(x), box.y + yaxis._offset + yaxis.c2p(y)];"
            "}",
            [x, y],
        )
        page.mouse.move(*at)
        lines = place.locator(".hoverlayer .nums tspan")
        lines.first.wait_for()
        return lines.all_text_contents()

    def test_no_button_sends_data_away(self, page: Page) -> None:
        draw_all(page)
        titles = page.locator(".modebar-btn").evaluate_all(
            "buttons => buttons.map(button => button.dataset.title)"
        )
        assert set(titles) == {"Download plot as a PNG", "Zoom", "Pan", "Reset axes"}
