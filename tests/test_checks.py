"""What users are warned of: stops too stiff for a basis, and stops pressed from the start."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.checks import missing_flexibility
from bumpstop.cli import main

LENGTH = 1.2
STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.25, density=7800.0)
BAR = bs.Rectangle(height=0.03, width=0.02)
AXIAL = 210e9 * 0.03 * 0.02


def rod(modes: int, *, held: bool = True, **options: Any) -> bs.ModalBasis:
    """A bar of 60 elements along x, held at A or free."""
    beam = bs.Beam("AB", nodes=("A", "B"), elements=60, material=STEEL, section=BAR, theory="bar")
    supports = [bs.Support(nodes="all", fixed=("dy", "dz", "drx", "dry", "drz"))]
    model = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)},
        beams=[beam],
        supports=[*supports, bs.Support(nodes="A", fixed="dx")] if held else supports,
    )
    return bs.ModalBasis.from_structure(model, modes=modes, **options)


def wall(stiffness: float, **options: Any) -> bs.Stop:
    said: dict[str, Any] = {"gap": 1e-3, "stiffness": stiffness}
    return bs.Stop("wall", node="B", normal=(-1, 0, 0), **said | options)


@pytest.mark.parametrize("modes", [2, 5])
def test_what_a_held_rod_gives_way_beyond_its_modes(modes: int) -> None:
    """L / EA less the series of its modes, 8 / (pi^2 (2 n - 1)^2) of that each."""
    (found,) = missing_flexibility(rod(modes), [wall(1.0)])
    series = sum(8.0 / (np.pi * (2 * n - 1)) ** 2 for n in range(1, modes + 1))
    assert found == pytest.approx(LENGTH / AXIAL * (1.0 - series), rel=0.02)  # 60 elements


def test_what_a_free_rod_gives_way_beyond_its_modes() -> None:
    """Balanced by inertia its end gives way by L / 3 EA, of which mode n has 2 / (n pi)^2."""
    (found,) = missing_flexibility(rod(4, held=False), [wall(1.0)])
    series = sum(2.0 / (n * np.pi) ** 2 for n in range(1, 4))
    assert found == pytest.approx(LENGTH / AXIAL * (1.0 / 3.0 - series), rel=0.02)


@pytest.mark.parametrize("factor", [0.05, 0.2, 5.0])
def test_a_stop_too_stiff_for_the_modes_is_told(factor: float) -> None:
    basis = rod(3)
    (missing,) = missing_flexibility(basis, [wall(1.0)])
    problem = bs.Problem(basis, laws=[wall(factor / missing)], duration=1e-4)
    if factor < 0.1:
        assert problem.warnings == ()
        return
    (line,) = problem.warnings
    assert line.startswith(f"stop 'wall': the modes left out would give way {100 * factor:.3g} %")
    assert "\n" not in line
    assert line in problem.remarks
    with pytest.warns(bs.ModellingWarning, match="static_shapes") as caught:
        bs.simulate(problem)
    assert len(caught) == 1


def test_its_static_shape_mends_it() -> None:
    basis = rod(3, static_shapes=[("B", "dx")])
    (missing,) = missing_flexibility(basis, [wall(1.0)])
    assert missing < 1e-12 * LENGTH / AXIAL
    assert bs.Problem(basis, laws=[wall(1e12)], duration=1e-4).warnings == ()
    # And it is what spoils the force: pressed by a long push, with and without.
    push = bs.NodalForce("push", node="AB.30", force=(1e5, 0, 0))
    stiff = wall(2e9, gap=0.0)
    forces = []
    for given in (rod(3), basis, rod(60)):
        state = bs.StaticState(loads=[push], laws=[stiff]).modal_state(given)[0]
        forces.append(-2e9 * float(stiff.row(given) @ state))
    assert forces[1] == pytest.approx(forces[2], rel=1e-9)
    assert abs(forces[0] / forces[2] - 1.0) > 0.01


@pytest.mark.parametrize(
    ("stop", "initial", "told"),
    [
        ({}, None, None),
        ({"gap": 0.0}, None, None),
        ({"gap": -1e-3}, None, r"stop 'wall': its gap of -0\.001 m is closed from the start"),
        ({}, bs.ModalState(displacement=[2.0]), r"the structure starts .* m inside its obstacle"),
        ({"gap": 0.0}, bs.ModalState(velocity=[2.0]), None),
        ({"gap": -1e-3}, bs.StaticState(laws=[wall(1e4, gap=-1e-3)]), None),
    ],
)
def test_stops_pressed_from_the_start_are_told(
    stop: dict[str, Any], initial: Any, told: str | None
) -> None:
    basis = bs.ModalBasis.from_modes(frequency=[2.0], shapes={("B", "dx"): [1.0]})
    problem = bs.Problem(basis, laws=[wall(1e4, **stop)], initial=initial, duration=0.1)
    if told is None:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            bs.simulate(problem)
        return
    with pytest.warns(bs.ModellingWarning, match=told):
        bs.simulate(problem)


CASE = """
[nodes]
P = [0, 0, 0]
[masses.ball]
node = "P"
mass = 2.0
[[supports]]
nodes = "all"
fixed = ["dx", "dy", "drx", "dry", "drz"]
[basis]
modes = 1
[stops.floor]
node = "P"
normal = [0, 0, 1]
gap = "-2 mm"
stiffness = 1e4
[run]
duration = 0.1
"""


def test_a_run_tells_them_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "case.toml").write_text(CASE)
    assert main(["run", str(tmp_path / "case.toml"), "--no-report"]) == 0
    printed = capsys.readouterr()
    text = " ".join((printed.out + printed.err).split())
    assert text.count("stop 'floor': its gap of -0.002 m is closed from the start") == 1


def test_a_sum_of_dofs_without_mass_is_refused() -> None:
    ball = bs.Structure(nodes={"P": (0, 0, 0)}, masses=[bs.PointMass("ball", node="P", mass=2.0)])
    basis = bs.ModalBasis.from_structure(ball, modes=3)
    stop = bs.Stop("gear", terms={("P", "drx"): 0.1, ("P", "dx"): 1.0}, stiffness=1e4)
    with pytest.raises(bs.InputError, match=r"stops\.gear\.terms: a force here has no mass"):
        bs.Problem(basis, laws=[stop], duration=1.0)


def test_many_problems_of_a_basis_ask_the_structure_once(monkeypatch: pytest.MonkeyPatch) -> None:
    basis = rod(3)
    first = missing_flexibility(basis, [wall(1.0)])
    monkeypatch.delattr("bumpstop.modal.static_shapes.StaticShapes.under")
    assert missing_flexibility(basis, [wall(2.0), wall(1.0)]).tolist() == [*first, *first]
