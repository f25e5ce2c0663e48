"""What is handed to functions of a run, and is none, is refused in one line that says so."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs


@pytest.fixture(scope="module")
def swing() -> bs.Response:
    """A body on a spring, before a wall that it reaches."""
    basis = bs.ModalBasis.from_modes(frequency=[2.0], damping=0.05, shapes={("P", "dx"): [1.0]})
    wall = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=2e4)
    start = bs.ModalState(velocity=[0.5])
    problem = bs.Problem(basis, laws=[wall], initial=start, duration=1.0, sample=1e-3)
    return bs.simulate(problem)


OF_RUNS: dict[str, Callable[[Any], object]] = {
    "contact_statistics": lambda run: bs.contact_statistics(run, "wall"),
    "contact_impacts": lambda run: bs.contact_impacts(run, "wall"),
    "wear_work": lambda run: bs.wear_work(run, "wall"),
    "wear": lambda run: bs.wear(run, "wall", bs.ArchardWear(1e-15), [1.0]),
    "work_by_sector": lambda run: bs.work_by_sector(run, "wall"),
    "stroboscopic_section": lambda run: bs.stroboscopic_section(run, "P", "dx", 0.5),
    "impact_section": lambda run: bs.impact_section(run, "wall"),
    "periodicity": lambda run: bs.periodicity(run, 0.5),
    "lyapunov_exponents": lambda run: bs.lyapunov_exponents(run),
    "recovery": lambda run: bs.recovery(run),
    "Stream": lambda run: bs.Stream(run, "displacement", "P", "dx", step=0.1),
    "draw_scene": lambda run: bs.draw_scene(run),
    "draw_history": lambda run: bs.draw_history(run, "gap", "wall"),
    "draw_phase_portrait": lambda run: bs.draw_phase_portrait(run, "P", "dx"),
    "draw_section": lambda run: bs.draw_section(run, "P", "dx", 0.5),
    "draw_orbit": lambda run: bs.draw_orbit(run, "wall"),
    "draw_loop": lambda run: bs.draw_loop(run, "wall"),
    "draw_friction_loop": lambda run: bs.draw_friction_loop(run, "wall"),
    "draw_energy": lambda run: bs.draw_energy(run),
}


@pytest.mark.parametrize("name", OF_RUNS)
def test_what_is_no_run(name: str, swing: bs.Response) -> None:
    for value in (None, "run.nc", swing.problem, np.zeros(3)):
        with pytest.raises(bs.InputError, match=r"^response: must be a response.*bs\.simulate"):
            OF_RUNS[name](value)


@pytest.mark.parametrize("path", [None, "", 3, b"run.csv", ["run.csv"]])
def test_what_is_no_name_of_a_file(path: Any, swing: bs.Response) -> None:
    for use in (swing.export, swing.to_netcdf, bs.read_netcdf, bs.read_results, bs.read_curves):
        with pytest.raises(bs.InputError, match=r"^path: must be the name of a file"):
            use(path)


def test_other_odd_values(swing: bs.Response, tmp_path: Path) -> None:
    odd: Any = object()
    with pytest.raises(bs.InputError, match=r"^most: "):
        list(swing.blocks(odd))
    with pytest.raises(bs.InputError, match=r"^title: "):
        swing.to_netcdf(tmp_path / "run.nc", title=odd)
    with pytest.raises(bs.InputError, match=r"^scar: "):
        bs.wear(swing, "wall", bs.ArchardWear(1e-15), [1.0], scar=odd)
    with pytest.raises(bs.InputError, match=r"^signal: "):
        bs.signal_statistics(odd)
    with pytest.raises(bs.InputError, match=r"^basis: "):
        bs.draw_modes(odd)
    with pytest.raises(bs.InputError, match=r"^array: "):
        bs.draw_sectors(odd)
    with pytest.raises(bs.InputError, match=r"^kind: "):
        bs.plot(swing.gap("wall"), odd)
    with pytest.raises(bs.InputError, match=r"^log: "):
        bs.plot(swing.gap("wall"), log=odd)
    assert not any(tmp_path.iterdir())


def test_statistics_of_an_array_are_those_of_a_stream(swing: bs.Response) -> None:
    stream = bs.signal_statistics(bs.Stream(swing, "displacement", "P", "dx", step=1e-3))
    whole = bs.signal_statistics(swing.displacement("P", "dx"))
    values = swing.displacement("P", "dx").values
    assert (whole.count, whole.units) == (len(values), "m")
    assert whole.mean == pytest.approx(values.mean(), rel=1e-12)
    assert whole.standard_deviation == pytest.approx(values.std(), rel=1e-12)
    assert whole.maximum == stream.maximum == values.max()
    assert whole.time_of_maximum == swing.times[values.argmax()]
