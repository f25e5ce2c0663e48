"""The page that compares runs: its numbers and its curves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.report import tables, write_comparison
from bumpstop.report.comparison import comparison_content

from .conftest import Run

STIFFNESS = {"soft": 1e4, "stiff": 4e4}
SPEED, DURATION = 0.5, 0.5


def thrown(stiffness: float) -> bs.Response:
    """A body of 1 kg that is thrown at a spring 0.1 m away, once."""
    basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("P", "dx"): [1.0]})
    wall = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=0.1, stiffness=stiffness)
    start = bs.ModalState(velocity=[-SPEED])
    return bs.simulate(bs.Problem(basis, laws=[wall], initial=start, duration=DURATION))


@pytest.fixture(scope="module")
def runs() -> dict[str, bs.Response]:
    return {name: thrown(stiffness) for name, stiffness in STIFFNESS.items()}


def rows(runs: dict[str, bs.Response], title: str) -> dict[str, list[str]]:
    """Return the cells of a table by their labels: the values, and the last difference."""
    content, _ = comparison_content(runs)
    (group,) = (group for group in content["groups"] if group["title"] == title)
    return {
        row["label"]: [
            row["first"],
            *(text for cell in row["others"] for text in (cell["value"], cell["difference"])),
        ]
        for row in group["rows"]
    }


def test_contacts_stand_side_by_side(runs: dict[str, bs.Response]) -> None:
    # A half sine: k times the depth v / omega, for half a period.
    told = rows(runs, "Contact at wall")
    assert told["Largest force (N)"] == ["50", "100", "+50 (+100.00 %)"]
    assert told["Mean contact (ms)"] == ["31.416", "15.708", "−15.708 (−50.00 %)"]
    assert told["Impacts"] == ["1", "1", "the same"]
    assert told["Impulse of all (N s)"] == ["1", "1", "the same"]
    assert told["Part of the time in contact (%)"][0] == f"{100 * np.pi / 100 / DURATION:.5g}"


def test_extremes_and_energies(runs: dict[str, bs.Response]) -> None:
    told = rows(runs, "Displacement dx of P")
    assert told["Lowest (mm)"][:2] == ["−105", "−102.5"]
    energies = rows(runs, "Energy at the end of the run")
    assert energies["Kinetic (mJ)"] == ["125", "125", "the same"]


def test_curves_lie_over_each_other(runs: dict[str, bs.Response]) -> None:
    content, data = comparison_content(runs)
    titles = {figure["title"]: figure["id"] for figure in content["figures"]}
    assert list(titles) == [
        "Displacement dx of P",
        "Force of stop wall",
        "Gap at stop wall",
        "Energy of the motion",
        "Energy lost",
    ]
    force = data["figures"][titles["Force of stop wall"]]
    assert [trace["name"] for trace in force["data"]] == list(STIFFNESS)
    assert len({trace["line"]["color"] for trace in force["data"]}) == 2
    for trace, stiffness in zip(force["data"], STIFFNESS.values(), strict=True):
        assert max(trace["y"]) == pytest.approx(SPEED * np.sqrt(stiffness), rel=1e-12)


def test_what_comes_from_a_file_is_the_same(runs: dict[str, bs.Response], tmp_path: Path) -> None:
    runs["soft"].to_netcdf(tmp_path / "soft.nc")
    told = rows(
        {"live": runs["soft"], "read": bs.read_netcdf(tmp_path / "soft.nc")}, "Contact at wall"
    )
    assert {cells[2] for cells in told.values()} == {"the same"}


def test_only_what_all_runs_have_is_compared(runs: dict[str, bs.Response]) -> None:
    free = replace(runs["soft"].problem, laws=[], duration=0.3)
    content, _ = comparison_content({"stop": runs["soft"], "free": bs.simulate(free)})
    assert [group["title"] for group in content["groups"]] == [
        "Displacement dx of P",
        "Energy at the end of the run",
    ]


def test_no_column_is_empty(runs: dict[str, bs.Response], sdnl32: Run) -> None:
    """Nothing is published of runs alone, and so nothing is told of it."""
    content, _ = comparison_content(runs)
    overview = content["overview"]
    assert overview["columns"][-1] == "Core time"
    columns = zip(*(row["cells"] for row in overview["rows"]), strict=True)
    assert not [cells for cells in columns if set(cells) <= {"", "–", "none"}]
    assert all(len(row["cells"]) + 1 == len(overview["columns"]) for row in overview["rows"])
    checked = sdnl32.checks
    told = tables.overview(sdnl32.responses, checked, dict.fromkeys(sdnl32.responses, 1.0))
    assert told["columns"][-1] == "Published values"
    assert all(len(row["cells"]) + 2 == len(told["columns"]) for row in told["rows"])


def test_one_run_is_no_comparison(runs: dict[str, bs.Response], tmp_path: Path) -> None:
    with pytest.raises(bs.InputError, match="two runs or more"):
        write_comparison({"alone": runs["soft"]}, tmp_path / "page.html")
    assert not any(tmp_path.iterdir())


def test_the_page_is_small(sdnl32: Run, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    write_comparison(sdnl32.responses, page)
    assert page.stat().st_size < 8e6
