"""The moving picture shows what the response says, and every control of it works."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.report.palette import LIGHT

from ..conftest import Run
from .conftest import (
    LAST_FRAME,
    colour,
    motion_of,
    node,
    pixels_a_metre,
    seek,
    shown_time,
)

if TYPE_CHECKING:
    from playwright.sync_api import Page

    from .conftest import Opened


class TestMotion:
    def test_the_tip_is_where_the_response_says(self, page: Page, soft: bs.Response) -> None:
        motion = motion_of(page)
        seek(motion, 0)
        x, y = node(motion, "B")
        scale = pixels_a_metre(motion)
        for frame in (1, 150, 333, 615, 616, 800, LAST_FRAME):
            seek(motion, frame)
            time = 0.02 * frame / LAST_FRAME
            assert shown_time(motion) == pytest.approx(time, rel=1e-6)
            (displacement,) = soft.sample("displacement", "B", "dy", times=[time])
            assert node(motion, "B")[0] == x
            assert node(motion, "B")[1] == pytest.approx(y - scale * displacement, abs=0.01)

    def test_the_beam_is_drawn_with_its_shape_functions(
        self, page: Page, soft: bs.Response
    ) -> None:
        motion = motion_of(page)
        (x0, y0), scale = node(motion, "A"), pixels_a_metre(motion)
        seek(motion, 500)
        path = motion.locator(".beam").get_attribute("d") or ""
        points = np.array([point.split() for point in path[1:].split("L")], dtype=float)
        along = np.linspace(0.0, 0.783, len(points))
        bent = [
            soft.sample("displacement", f"AB@{s!r}", "dy", times=[0.01])[0] for s in along.tolist()
        ]
        np.testing.assert_allclose(points[:, 1], y0 - scale * np.array(bent), atol=0.02)
        assert np.all(np.diff(points[:, 0]) > 0)
        assert points[0, 0] == pytest.approx(x0, abs=0.01)

    def test_contact_is_shown_as_the_table_of_impacts_has_it(
        self, page: Page, soft: bs.Response
    ) -> None:
        motion = motion_of(page)
        ((start, end),) = zip(soft.impacts["start"], soft.impacts["end"], strict=True)
        assert start == 0.0  # the stop is touched as the run begins, without a force yet
        for frame in (0, 1, 300, 614, 616, 900):
            seek(motion, frame)
            closed = start <= 0.02 * frame / LAST_FRAME < end
            expected = "closed" if closed else "open"
            assert motion.get_attribute("data-contact") == expected
            stop = motion.locator("[data-stop=spring]")
            assert stop.get_attribute("data-contact") == expected
            role = "contact" if closed else "muted"
            assert colour(stop.locator(".spring"), "stroke") == LIGHT[role]
            pushed = closed and frame > 0
            assert bool(motion.locator(".force").get_attribute("d")) == pushed
            chip = "in contact" if closed else "free"
            assert motion.locator("[data-value=contact]").inner_text() == chip

    def test_the_time_line_shades_the_same_contacts(self, page: Page, soft: bs.Response) -> None:
        strip = motion_of(page).locator("[data-part=strip]")
        (band,) = strip.locator(".contact-band").all()
        left, width = (float(band.get_attribute(key) or "nan") for key in ("x", "width"))
        whole = float(strip.get_attribute("width") or "nan") - 2 * left
        assert width / whole == pytest.approx(soft.impacts["end"][0] / 0.02, rel=1e-3)

    def test_the_stop_touches_the_beam_while_closed_and_rests_while_open(self, page: Page) -> None:
        motion = motion_of(page)

        def clearance() -> float:
            plate = motion.locator("[data-stop=spring] .plate").get_attribute("d") or ""
            return float(plate[1:].split("L")[0].split()[1]) - node(motion, "B")[1]

        seek(motion, 0)
        touching = clearance()
        seek(motion, 300)
        assert clearance() == pytest.approx(touching, abs=0.05)
        seek(motion, 900)
        assert clearance() > touching + 20.0

    def test_the_readout_tells_the_numbers(self, page: Page, soft: bs.Response) -> None:
        motion = motion_of(page)
        seek(motion, 400)
        (displacement,) = soft.sample("displacement", "B", "dy", times=[0.008])
        (force,) = soft.sample("stop_force", "spring", times=[0.008])

        def told(name: str) -> str:
            return motion.locator(f"[data-value={name}]").inner_text().replace("−", "-")

        assert told("time") == "8.00 ms"
        assert told("value") == f"{displacement * 1e3:.2f} mm"
        assert told("force") == f"{force:.2f} N"
        slider = motion.locator("[data-part=slider]")
        assert (slider.get_attribute("aria-valuetext") or "").startswith("8.00 ms, ")

    def test_play_pause_and_play_again(self, stopped_page: Page) -> None:
        page = stopped_page
        motion = motion_of(page)
        button = motion.locator("[data-part=play]")
        before = node(motion, "B")
        button.click()
        assert button.inner_text() == "Pause"
        page.clock.run_for(2000)
        button.click()
        assert button.inner_text() == "Play"
        # At 400 times slower, two seconds are a quarter of the 20 ms.
        assert shown_time(motion) == pytest.approx(0.005, rel=0.02)
        moved = node(motion, "B")
        assert moved[1] - before[1] > 5.0
        page.clock.run_for(2000)
        assert node(motion, "B") == moved
        button.click()
        page.clock.run_for(7000)
        assert shown_time(motion) == pytest.approx(0.02)
        assert button.inner_text() == "Play"
        button.click()
        page.clock.run_for(1000)
        assert shown_time(motion) == pytest.approx(0.0025, rel=0.03)

    def test_speed(self, stopped_page: Page) -> None:
        page = stopped_page
        motion = motion_of(page)
        speed = motion.locator("[data-part=speed]")
        for label in speed.locator("option").all_inner_texts():
            slowdown = float(label.split(" × slower")[0].replace(",", ""))
            speed.select_option(label)
            seek(motion, 0)
            motion.locator("[data-part=play]").click()
            page.clock.run_for(1000)
            motion.locator("[data-part=play]").click()
            assert shown_time(motion) == pytest.approx(1.0 / slowdown, rel=0.03)

    def test_magnification(self, page: Page, soft: bs.Response) -> None:
        motion = motion_of(page)
        (displacement,) = soft.sample("displacement", "B", "dy", times=[0.02])
        slider = motion.locator("[data-part=magnify]")
        drawn: dict[int, float] = {}
        for choice in range(int(slider.get_attribute("max") or 0) + 1):
            slider.fill(str(choice))
            factor = int(motion.locator("[data-part=magnified]").inner_text().lstrip("× "))
            seek(motion, LAST_FRAME)
            (ax, ay), (bx, by) = node(motion, "A"), node(motion, "B")
            assert bx - ax > 0.783 * 500  # the beam keeps most of the width
            drawn[factor] = (ay - by) / (bx - ax)
            assert drawn[factor] == pytest.approx(factor * displacement / 0.783, rel=1e-3)
        assert len(drawn) >= 3

    def test_keys_alone_suffice(self, stopped_page: Page) -> None:
        page = stopped_page
        motion = motion_of(page)
        slider = motion.locator("[data-part=slider]")
        slider.focus()
        slider.press("ArrowRight")
        slider.press("ArrowRight")
        assert shown_time(motion) == pytest.approx(0.02 * 2 / LAST_FRAME)
        slider.press("End")
        assert shown_time(motion) == pytest.approx(0.02)
        slider.press("Home")
        slider.press("Tab")
        page.keyboard.press("Space")
        page.clock.run_for(500)
        assert shown_time(motion) > 0.0

    def test_the_time_line_can_be_dragged(self, page: Page) -> None:
        motion = motion_of(page)
        strip = motion.locator("[data-part=strip]")
        strip.scroll_into_view_if_needed()
        box = strip.bounding_box()
        assert box is not None
        page.mouse.move(box["x"] + box["width"] * 0.25, box["y"] + 20)
        page.mouse.down()
        page.mouse.move(box["x"] + box["width"] * 0.5, box["y"] + 20)
        page.mouse.up()
        assert shown_time(motion) == pytest.approx(0.01, rel=0.01)


class TestBall:
    def test_it_falls_touches_and_rises(self, opened: Opened, ball_page: Path, ball: Run) -> None:
        motion = motion_of(opened(ball_page))
        response = ball.responses["base"]
        start, scale = node(motion, "P")[1], pixels_a_metre(motion)
        touch = math.sqrt(2.0 / 386.0)
        for time in (0.5 * touch, 1.4 * touch, 2.7 * touch):
            frame = round(time / 0.5 * LAST_FRAME)
            seek(motion, frame)
            instant = 0.5 * frame / LAST_FRAME
            (height,) = response.sample("displacement", "P", "dz", times=[instant])
            assert node(motion, "P")[1] == pytest.approx(start - scale * height, abs=0.01)
            (gap,) = response.sample("gap", "spring", times=[instant])
            expected = "closed" if gap < 0 else "open"
            assert motion.get_attribute("data-contact") == expected

    def test_there_is_nothing_to_magnify(self, opened: Opened, ball_page: Path) -> None:
        motion = motion_of(opened(ball_page))
        assert motion.locator("[data-part=magnify]").count() == 0
        assert "Drawn to scale" in motion.inner_text()
