"""The modes can be chosen, and are drawn as they are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import bumpstop as bs

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page


def node_in_modes(modes: Locator) -> float:
    return float(modes.locator("[data-part=mode-stage] [data-node=B]").get_attribute("cy") or "nan")


class TestModes:
    def test_the_chosen_mode_is_drawn(self, page: Page, soft: bs.Response) -> None:
        modes = page.locator("#modes-1")
        frequencies = soft.problem.basis.frequencies
        for number in (2, 5, 10):
            modes.get_by_role("radio", name=str(number), exact=True).check()
            title = modes.locator("[data-part=mode-title]").inner_text()
            assert title.startswith(f"Mode {number}: ")
            hertz = float(title.removeprefix(f"Mode {number}: ").removesuffix(" Hz"))
            assert hertz == pytest.approx(frequencies[number - 1], rel=1e-4)
            path = modes.locator(".beam").get_attribute("d") or ""
            points = np.array([point.split() for point in path[1:].split("L")], dtype=float)
            axis = points[0, 1]
            crossings = np.count_nonzero(np.diff(np.sign(points[2:, 1] - axis)))
            assert crossings == number - 1  # a hinged-free beam: one node more each mode

    def test_a_mode_swings_and_rests(self, stopped_page: Page) -> None:
        page = stopped_page
        modes = page.locator("#modes-1")
        button = modes.locator("[data-part=swing]")
        rest = node_in_modes(modes)
        button.click()
        page.clock.run_for(500)
        assert button.inner_text() == "Pause"
        assert abs(node_in_modes(modes) - rest) > 20.0
        button.click()
        assert button.inner_text() == "Animate"
        assert node_in_modes(modes) == rest

    def test_every_mode_has_a_thumbnail(self, page: Page) -> None:
        paths = page.locator(".thumbnail-line").evaluate_all(
            "lines => lines.map(line => line.getAttribute('d'))"
        )
        assert len(set(paths)) == 10
