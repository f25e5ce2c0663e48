"""The page of a study, in the browser: a click on a point leads to its run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from bumpstop.cli import main
from tests.study.bouncing import STUDY, written

from .conftest import draw_all

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Locator, Page, Position

    from .conftest import Opened

DRAWN = (
    STUDY.replace('from = "50 N/m", to = 800, count = 5, spacing = "log"', "from = 50, to = 800")
    + '[sampling]\nmethod = "latin_hypercube"\ncount = 12\n'
)
EVEN = STUDY.replace(', spacing = "log"', "")
ALONE = EVEN + '[sampling]\nmethod = "one_at_a_time"\n'
SALTELLI = EVEN + '[sampling]\nmethod = "saltelli"\ncount = 4\n'
FOLLOWED = EVEN.replace('[0.25, "50 cm"]', "[0.1, 0.2, 0.3, 0.4, 0.5]") + (
    '[sampling]\nmethod = "continuation"\n'
)


def swept(folder: Path, study: str, capsys: pytest.CaptureFixture[str]) -> Path:
    path = written(folder, study)
    assert main(["sweep", str(path), "--workers", "1"]) == 0
    capsys.readouterr()
    return path.with_suffix(".html")


def middle_of_cell(place: Locator, column: int, row: int) -> Position:
    """Return where on a plot a cell of its heat map lies."""
    found: Position = place.evaluate(
        """(place, [column, row]) => {
          const { xaxis, yaxis } = place._fullLayout;
          const [trace] = place._fullData;
          return { x: xaxis._offset + xaxis.d2p(trace.x[column]),
                   y: yaxis._offset + yaxis.d2p(trace.y[row]) };
        }""",
        [column, row],
    )
    return found


def test_a_click_on_a_cell_tells_its_run(
    opened: Opened, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page: Page = opened(swept(tmp_path, STUDY, capsys))
    draw_all(page)
    varied = page.get_by_role("region", name="What varies").locator("tbody td")
    assert varied.all_text_contents() == ["50 to 800 N/m, 5 values", "0.25 to 0.5 m, 2 values"]
    place = page.locator("[data-figure]").first
    place.scroll_into_view_if_needed()
    place.click(position=middle_of_cell(place, 3, 1))  # 400 N/m, 50 cm
    told = page.locator("#run [data-part=told]")
    page.wait_for_function(
        "told => told.textContent.includes('stiffness = 400')", arg=told.element_handle()
    )
    words = (told.text_content() or "").split(", ")
    assert words[:2] == ["stops.spring.stiffness = 400 N/m", "stops.spring.gap = 0.5 m"]
    assert words[2] == "force = 84.8528 N"  # 3 m/s sqrt(k m)
    command = page.locator("#run [data-part=command]").text_content() or ""
    assert command == f"bumpstop sweep {tmp_path / 'study.toml'} --open 7"
    # What is offered is what the shell understands.
    assert main(command.split()[1:]) == 0
    assert (tmp_path / "study-run-7" / "report.html").exists()
    assert "stiffness = 400" in (tmp_path / "study-run-7" / "case.toml").read_text()


def test_extremes_and_numbers_lead_to_runs(
    opened: Opened, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page: Page = opened(swept(tmp_path, DRAWN, capsys))
    draw_all(page)
    assert page.locator("[data-figure]").count() == 6  # two outputs: one histogram, two scatters
    rows = page.locator("#results tbody tr")
    largest = rows.first.locator(".run-link").last
    largest.click()
    run = largest.get_attribute("data-run")
    assert page.locator("#run [data-part=number]").input_value() == run
    command = page.locator("#run [data-part=command]")
    assert (command.text_content() or "").endswith(f"--open {run}")
    page.locator("#run [data-part=number]").fill("3")
    assert (command.text_content() or "").endswith("--open 3")


def test_failed_runs_are_listed(
    opened: Opened, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = STUDY.replace('"50 N/m"', "-50").replace('"log"', '"linear"')
    page: Page = opened(swept(tmp_path, wrong, capsys))
    assert page.locator("[data-verdict=failed]").text_content() == "✗ 2 of 10 runs failed"
    failures = page.locator("li", has_text="must be positive")
    assert failures.count() == 2
    failures.last.locator("button").click()
    command = page.locator("#run [data-part=command]").text_content() or ""
    assert command.endswith("--open 1")


def test_a_click_on_a_bar_tells_its_run(
    opened: Opened, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page: Page = opened(swept(tmp_path, ALONE, capsys))
    draw_all(page)
    force = page.locator("[data-figure]").first
    force.scroll_into_view_if_needed()
    bar = force.locator(".barlayer .trace").last.locator("path").last  # stiff
    box = bar.bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    told = page.locator("#run [data-part=told]")
    page.wait_for_function(
        "told => told.textContent.includes('stiffness = 762.5')", arg=told.element_handle()
    )
    command = page.locator("#run [data-part=command]").text_content() or ""
    assert command.endswith("--open 2")


@pytest.mark.parametrize("study", [STUDY, ALONE, SALTELLI, FOLLOWED])
def test_it_is_read_on_narrow_screens_without_sideways_scrolling(
    study: str, opened: Opened, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page: Page = opened(swept(tmp_path, study, capsys), width=360)
    draw_all(page)
    wide = """() => [document.documentElement, ...document.querySelectorAll('.table-frame')]
        .filter((each) => each.scrollWidth > each.clientWidth + 1).length"""
    assert page.evaluate(wide) == 0
