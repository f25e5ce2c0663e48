"""The page that compares runs, in the browser."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from bumpstop.report import write_comparison

from ..conftest import Run
from .conftest import draw_all

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page

    from .conftest import Opened


@pytest.fixture
def compared(sdnl32: Run, opened: Opened, tmp_path: Path) -> Page:
    path = tmp_path / "compare.html"
    write_comparison(sdnl32.responses, path)
    return opened(path)


def test_every_figure_has_a_curve_for_each_run(compared: Page) -> None:
    draw_all(compared)
    places = compared.locator("[data-figure]")
    assert places.count() == 5
    for number in range(places.count()):
        place = places.nth(number)
        assert place.locator(".scatterlayer path.js-line").count() == 2
        assert place.locator(".legendtext").all_text_contents() == ["soft", "stiff"]
        assert str(place.get_attribute("aria-label")).startswith("Plot of ")


def test_the_legend_hides_a_run(compared: Page) -> None:
    draw_all(compared)
    place = compared.locator("[data-figure]").first
    place.locator(".legendtoggle").last.click()
    compared.wait_for_function(
        "place => place.data[1].visible === 'legendonly'", arg=place.element_handle()
    )
    assert place.locator(".scatterlayer path.js-line").count() == 1


def test_tables_have_headings_and_can_be_reached_by_keyboard(compared: Page) -> None:
    frame = compared.locator("#results .table-frame")
    assert frame.get_attribute("role") == "region"
    assert frame.get_attribute("tabindex") == "0"
    first = frame.get_by_role("table").first
    assert first.get_by_role("columnheader").all_inner_texts() == [
        "Quantity",
        "soft",
        "stiff",
        "less soft",
    ]
    assert first.get_by_role("rowheader").first.inner_text().startswith("Lowest")


@pytest.mark.parametrize("width", [360, 1200])
def test_it_fits_the_screen(sdnl32: Run, opened: Opened, tmp_path: Path, width: int) -> None:
    path = tmp_path / "compare.html"
    write_comparison(sdnl32.responses, path)
    page = opened(path, width=width)
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
