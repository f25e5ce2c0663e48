"""The scene that one call draws, with its buttons and its slider, in a real browser."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import bumpstop as bs

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

TIP = """place => { const nodes = place.data[2], at = nodes.text.indexOf("B");
    return Array.from(nodes.y._inputArray ?? nodes.y)[at]; }"""
"""Height of the tip as it is drawn."""


@pytest.fixture(scope="module")
def scene(browser: Browser, soft: bs.Response, tmp_path_factory: pytest.TempPathFactory) -> Page:
    path: Path = tmp_path_factory.mktemp("scene") / "scene.html"
    bs.draw_scene(soft, 10.0).write_html(path)
    page = browser.new_page(viewport={"width": 900, "height": 640})
    page.goto(path.as_uri())
    page.locator(".slider-group").wait_for()
    return page


def tip(page: Page) -> float:
    return float(page.locator(".js-plotly-plot").evaluate(TIP))


def go_to(page: Page, step: int) -> None:
    page.locator(".js-plotly-plot").evaluate(
        """(place, at) => { const { method, args } = place.layout.sliders[0].steps[at];
        return Plotly[method](place, ...args); }""",
        step,
    )


def test_buttons_and_slider_show_the_motion_at_both_scales(scene: Page, soft: bs.Response) -> None:
    (halfway, end) = soft.sample("displacement", "B", "dy", times=[0.01, 0.02])
    assert abs(tip(scene)) < 1e-12
    go_to(scene, 60)
    assert tip(scene) == pytest.approx(10.0 * halfway, rel=1e-5)
    scene.locator(".updatemenu-button", has_text="True scale").click()
    go_to(scene, 60)
    assert tip(scene) == pytest.approx(halfway, rel=1e-5)
    go_to(scene, 120)
    assert tip(scene) == pytest.approx(end, rel=1e-5)
    scene.locator(".updatemenu-button", has_text="Motion × 10").click()
    go_to(scene, 120)
    assert tip(scene) == pytest.approx(10.0 * end, rel=1e-5)


def test_it_plays_when_told_to(scene: Page) -> None:
    go_to(scene, 0)
    scene.wait_for_timeout(300)
    assert abs(tip(scene)) < 1e-12
    scene.locator(".updatemenu-button", has_text="Play").click()
    scene.wait_for_function(f"Math.abs(({TIP})(document.querySelector('.js-plotly-plot'))) > 1e-3")
    scene.locator(".updatemenu-button", has_text="Pause").click()
