"""A real browser, and reports opened in it."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Browser, ConsoleMessage, Locator, Page

    Opened: TypeAlias = Callable[..., Page]

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
LAST_FRAME = 1000

OPTIONS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--no-first-run",
    "--disable-component-update",
    "--disable-sync",
)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    program = next(filter(None, map(shutil.which, BROWSERS)), None)
    if program is None:
        message = f"no browser on PATH ({', '.join(BROWSERS)}): the report was not looked at"
        if "CI" in os.environ:
            pytest.fail(message)
        pytest.skip(message)
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=list(OPTIONS))
        yield browser
        browser.close()


@dataclass
class Visit:
    """A page and everything it complained of or asked for."""

    page: Page
    complaints: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def heard(self, message: ConsoleMessage) -> None:
        self.complaints.append(f"{message.type}: {message.text}")

    def check(self) -> None:
        assert self.complaints == []
        assert self.requests == [self.page.url]


def visit(
    browser: Browser, path: Path, *, width: int = 1200, dark: bool = False, stopped: bool = False
) -> Visit:
    """Open a report; with ``stopped`` its clock stands still unless it is told to run."""
    page = browser.new_page(
        viewport={"width": width, "height": 900}, color_scheme="dark" if dark else "light"
    )
    visit = Visit(page)
    page.on("console", visit.heard)
    page.on("pageerror", lambda error: visit.complaints.append(str(error)))
    page.on("request", lambda request: visit.requests.append(request.url))
    if stopped:
        page.clock.install(time=0)
    page.goto(path.as_uri())
    if stopped:
        page.clock.pause_at(3_600_000)
    return visit


@pytest.fixture(scope="session")
def on_screen(browser: Browser, sdnl32_page: Path) -> Iterator[Visit]:
    opened = visit(browser, sdnl32_page)
    yield opened
    opened.page.close()


@pytest.fixture(scope="session")
def on_stopped_screen(browser: Browser, sdnl32_page: Path) -> Iterator[Visit]:
    opened = visit(browser, sdnl32_page, stopped=True)
    yield opened
    opened.page.close()


@pytest.fixture
def page(on_screen: Visit) -> Iterator[Page]:
    """The report of SDNL32 as it is when it has just been opened."""
    yield put_back(on_screen.page)
    on_screen.check()


@pytest.fixture
def stopped_page(on_stopped_screen: Visit) -> Iterator[Page]:
    """The same, with a clock that runs only when told to."""
    yield put_back(on_stopped_screen.page)
    on_stopped_screen.check()


def put_back(page: Page) -> Page:
    page.set_viewport_size({"width": 1200, "height": 900})
    tab(page, "soft").click()
    motion = motion_of(page)
    motion.locator("[data-part=magnify]").evaluate(
        "slider => { slider.value = slider.defaultValue; slider.dispatchEvent(new Event('input')) }"
    )
    seek(motion, 0)
    return page


@pytest.fixture
def opened(browser: Browser) -> Iterator[Opened]:
    """Opens reports, and at the end checks that none complained or used the network."""
    visits: list[Visit] = []

    def open_report(path: Path, *, width: int = 1200, dark: bool = False) -> Page:
        visits.append(visit(browser, path, width=width, dark=dark))
        return visits[-1].page

    yield open_report
    for each in visits:
        each.check()
        each.page.close()


def tab(page: Page, variant: str) -> Locator:
    return page.get_by_role("tab", name=re.compile(f"^{variant} "))


def motion_of(page: Page, number: int = 1) -> Locator:
    return page.locator(f"#variant-{number}-motion")


def seek(motion: Locator, frame: int) -> None:
    motion.locator("[data-part=slider]").fill(str(frame))


def node(motion: Locator, name: str) -> tuple[float, float]:
    dot = motion.locator(f"[data-part=stage] [data-node={name}]")
    return float(dot.get_attribute("cx") or "nan"), float(dot.get_attribute("cy") or "nan")


def pixels_a_metre(motion: Locator) -> float:
    return float(motion.locator("[data-part=stage]").get_attribute("data-scale") or "nan")


def shown_time(motion: Locator) -> float:
    return float(motion.get_attribute("data-time") or "nan")


def colour(locator: Locator, css: str) -> str:
    found = str(locator.evaluate(f"element => getComputedStyle(element)['{css}']"))
    numbers = [int(part) for part in found[found.index("(") + 1 : -1].split(",")[:3]]
    return "#" + "".join(f"{number:02x}" for number in numbers)


def draw_all(page: Page) -> None:
    """Scroll past every plot in view, so that each is drawn."""
    places = page.locator("[data-figure]:visible")
    for number in range(places.count()):
        places.nth(number).scroll_into_view_if_needed()
        places.nth(number).locator(".main-svg").first.wait_for()
