"""The slider of friction on its obstacle, in the report."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import bumpstop as bs
from bumpstop.report import write_report

from ..conftest import made_case
from .conftest import motion_of, seek

if TYPE_CHECKING:
    from .conftest import Opened

LIFTS = bs.Harmonic(2.0, cosine=-1.0)


@pytest.fixture(scope="module")
def rubbing() -> bs.Response:
    """A block on a floor that is pulled along it, and lifted off in the middle of the run."""
    shapes = {("P", "dx"): [1.0, 0.0], ("P", "dy"): [0.0, 1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[2.0, 0.0], damping=[0.05, 0.0], shapes=shapes)
    floor = bs.Stop(
        "floor", node="P", normal=(0, 1, 0), gap=0.0, stiffness=2e4, damping=100.0, friction=0.3,
        sliding=(1, 0, 0), tangential_stiffness=5e3,
    )  # fmt: skip
    pull = bs.NodalForce("pull", node="P", force=(40, 0, 0))
    press = bs.NodalForce("press", node="P", force=(0, 50, 0), time=LIFTS)
    return bs.simulate(bs.Problem(basis, laws=[floor], loads=[pull, press], duration=0.4))


def test_the_slider_is_on_the_floor_while_that_is_touched(
    rubbing: bs.Response, opened: Opened, tmp_path: Path
) -> None:
    path = tmp_path / "report.html"
    write_report(made_case({"base": rubbing.problem}), {"base": rubbing}, {}, path)
    page = opened(path)
    motion = motion_of(page)
    mark = motion.locator("path.slider")
    frames = int(motion.locator("[data-part=slider]").get_attribute("max") or "0")

    def shown(time: float) -> str:
        seek(motion, round(frames * time / 0.4))
        return mark.get_attribute("d") or ""

    (opens,) = (float(end) for end in rubbing.impacts["end"][:1])
    early, late = (float(re.findall(r"-?[\d.]+", shown(t))[0]) for t in (0.02, 0.9 * opens))
    assert late > early  # it is dragged along
    assert shown(min(opens + 0.02, 0.4)) == ""
