"""The plots hold the curves and the published points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import bumpstop as bs

from .conftest import (
    draw_all,
)

if TYPE_CHECKING:
    from playwright.sync_api import Page


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

    def test_every_figure_is_drawn_with_its_axes(self, page: Page) -> None:
        draw_all(page)
        places = page.locator("#variant-1 [data-figure]")
        for number in range(places.count()):
            place = places.nth(number)
            assert place.locator("path.js-line, path.js-fill").count() >= 1
            for title in (".xtitle", ".ytitle"):
                assert place.locator(title).inner_html().endswith(")")

    def test_hovering_tells_values_with_units(self, page: Page) -> None:
        place = page.locator("#variant-1 [data-figure]").first
        draw_all(page)
        place.scroll_into_view_if_needed()
        box = place.bounding_box()
        assert box is not None
        page.mouse.move(box["x"] + box["width"] * 0.5, box["y"] + box["height"] * 0.5)
        hover = place.locator(".hoverlayer")
        hover.locator("text").first.wait_for()
        assert " ms" in hover.inner_html()
        assert " mm" in hover.inner_html()

    def test_no_button_sends_data_away(self, page: Page) -> None:
        draw_all(page)
        titles = page.locator(".modebar-btn").evaluate_all(
            "buttons => buttons.map(button => button.dataset.title)"
        )
        assert set(titles) == {"Download plot as a PNG", "Zoom", "Pan", "Reset axes"}
