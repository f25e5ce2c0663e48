"""One variant is shown at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from ..conftest import Run
from .conftest import (
    motion_of,
    node,
    pixels_a_metre,
    seek,
    tab,
)

if TYPE_CHECKING:
    from playwright.sync_api import Page


class TestTabs:
    def test_one_variant_at_a_time(self, page: Page) -> None:
        soft, stiff = page.locator("#variant-1"), page.locator("#variant-2")
        assert soft.is_visible()
        assert not stiff.is_visible()
        tab(page, "stiff").click()
        assert stiff.is_visible()
        assert not soft.is_visible()
        assert stiff.locator(".published").is_visible()
        stiff.locator(".main-svg").first.wait_for()

    def test_arrow_keys(self, page: Page) -> None:
        first, second = page.get_by_role("tab").all()
        first.focus()
        first.press("ArrowRight")
        assert second.get_attribute("aria-selected") == "true"
        assert page.locator("#variant-2").is_visible()
        second.press("ArrowRight")
        assert first.get_attribute("aria-selected") == "true"

    def test_the_other_variant_plays_its_own_motion(self, page: Page, sdnl32: Run) -> None:
        tab(page, "stiff").click()
        motion = motion_of(page, 2)
        y, scale = node(motion, "B")[1], pixels_a_metre(motion)
        seek(motion, 800)
        (expected,) = sdnl32.responses["stiff"].sample("displacement", "B", "dy", times=[0.016])
        assert node(motion, "B")[1] == pytest.approx(y - scale * expected, abs=0.01)

    def test_leaving_a_variant_stops_it(self, page: Page) -> None:
        motion_of(page).locator("[data-part=play]").click()
        tab(page, "stiff").click()
        tab(page, "soft").click()
        assert motion_of(page).locator("[data-part=play]").inner_text() == "Play"
