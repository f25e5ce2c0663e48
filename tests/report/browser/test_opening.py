"""How fast a report opens, and that no control of it is left without a test here."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

SECONDS = 2.0
TRIALS = 5
"""The machine may be busy; the quickest counts."""

CONTROLS = """() =>
    [...document.querySelectorAll('button, input, select, textarea, a[href], summary')]
    .filter((each) => !each.closest('.js-plotly-plot'))
    .map((each) => each.dataset.part ?? each.getAttribute('role') ?? each.className ?? each.name)
    .map((name) => name || 'mode')"""
DRIVEN = {
    "skip": "below",
    "tab": "test_tabs.py",
    "slider": "test_motion.py",
    "play": "test_motion.py",
    "speed": "test_motion.py",
    "magnify": "test_motion.py",
    "mode": "test_modes.py",
    "swing": "test_modes.py",
}
"""Which file drives what; plotly's own tools are in test_plots.py."""


def opening(browser: Browser, path: Path) -> float:
    """Return the time in s until the structure stands there, its controls ready."""
    page = browser.new_page(viewport={"width": 1200, "height": 900})
    start = perf_counter()
    page.goto(path.as_uri())
    page.locator("[data-part=stage] .beam").first.wait_for(state="attached")
    taken = perf_counter() - start
    page.close()
    return taken


def test_it_opens_within_two_seconds(browser: Browser, sdnl32_page: Path) -> None:
    assert min(opening(browser, sdnl32_page) for _ in range(TRIALS)) < SECONDS


def test_every_control_is_driven_by_a_test(page: Page) -> None:
    assert set(page.evaluate(CONTROLS)) == set(DRIVEN)


def test_the_skip_link_leads_to_the_results(browser: Browser, sdnl32_page: Path) -> None:
    page = browser.new_page(viewport={"width": 1200, "height": 900})
    page.goto(sdnl32_page.as_uri())
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.className") == "skip"
    page.keyboard.press("Enter")
    results = page.locator("#results").bounding_box()
    assert results is not None
    assert abs(results["y"]) < 2.0
    page.close()
