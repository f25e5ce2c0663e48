"""Controls for everybody: each has a name, and each can be reached and used without a mouse."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import bumpstop as bs
from bumpstop.cli.outputs import write_convergence

from ..conftest import CASES
from .conftest import motion_of, tab

if TYPE_CHECKING:
    from playwright.sync_api import Page

    from .conftest import Opened

ROLES = ("button", "slider", "combobox", "radio", "tab", "link", "region", "tablist")
"""Roles of which a screen reader tells the name."""

A_PLOT = 6
"""Buttons beside a plot, at most."""

TABBABLE = "a[href], button, input, select, [tabindex='0']"


def nameless(page: Page) -> list[str]:
    """Return what a screen reader would call by its role alone."""
    lines = [line.strip(" -") for line in page.locator("body").aria_snapshot().splitlines()]
    return [line for line in lines if re.match(rf"({'|'.join(ROLES)})\b(?! \")", line)]


@pytest.fixture(scope="module")
def converged_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("converged")
    write_convergence(bs.converge(bs.load_case(CASES / "sdnl32" / "case.toml")), folder)
    return folder / "report.html"


class TestNames:
    def test_of_a_report(self, page: Page) -> None:
        assert "slider" in page.locator("body").aria_snapshot()
        assert nameless(page) == []
        tab(page, "stiff").click()
        assert nameless(page) == []

    def test_of_a_page_of_modes(self, opened: Opened, portal_page: Path) -> None:
        assert nameless(opened(portal_page)) == []

    def test_of_a_report_with_convergence(self, opened: Opened, converged_page: Path) -> None:
        assert nameless(opened(converged_page)) == []


class TestKeys:
    def test_the_tabulator_reaches_every_control(self, page: Page) -> None:
        wanted = page.evaluate(
            """(selector) => [...document.querySelectorAll(selector)].filter((each) =>
                each.offsetParent && each.tabIndex >= 0 && !each.closest(".js-plotly-plot")
                && !(each.type === "radio" && !each.checked))
                .map((each) => each.outerHTML.slice(0, 90))""",
            TABBABLE,
        )
        first = page.locator("a.skip")
        first.focus()
        page.evaluate("window.reached = new Set([document.activeElement])")
        # plotly's own buttons are passed by on the way.
        passed = A_PLOT * page.locator("[data-figure]:visible").count()
        for _ in range(len(wanted) + passed):
            page.keyboard.press("Tab")
            page.evaluate(
                """() => { const each = document.activeElement;
                if (each !== document.body && !each.closest(".js-plotly-plot"))
                    window.reached.add(each); }"""
            )
        reached = page.evaluate("[...window.reached].map((each) => each.outerHTML.slice(0, 90))")
        assert set(wanted) <= set(reached)
        assert len(wanted) > 8

    def test_what_has_the_focus_is_seen(self, page: Page) -> None:
        for control in (motion_of(page).locator("[data-part=play]"), tab(page, "soft")):
            control.focus()
            page.keyboard.press("Shift+Tab")
            page.keyboard.press("Tab")
            outline = page.evaluate("getComputedStyle(document.activeElement).outlineStyle")
            assert outline != "none"

    def test_speed_and_modes_answer_to_arrow_keys(self, page: Page) -> None:
        speed = motion_of(page).locator("[data-part=speed]")
        before = speed.input_value()
        speed.focus()
        speed.press("ArrowDown")
        assert speed.input_value() != before
        first = page.get_by_role("radio").first
        title = page.locator("[data-part=mode-title]").first
        told = title.inner_text()
        first.focus()
        first.press("ArrowDown")
        assert title.inner_text() != told


class TestConvergence:
    def test_its_figures_are_drawn(self, opened: Opened, converged_page: Path) -> None:
        page = opened(converged_page)
        section = page.locator("section[aria-labelledby=convergence-title]")
        section.scroll_into_view_if_needed()
        for name in ("convergence-1-basis", "convergence-2-mesh"):
            place = page.locator(f"[data-figure={name}]")
            place.scroll_into_view_if_needed()
            place.locator(".main-svg").first.wait_for()
            assert place.locator(".scatterlayer .trace").count() == 2
        assert section.get_by_role("row").count() == 2 * (1 + 12)
        assert section.get_by_text("those of 10 modes, not of the structure itself").count() == 1
