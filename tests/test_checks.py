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


def wall(stiffness: float, name: str = "wall", **options: Any) -> bs.Stop:
    said: dict[str, Any] = {"gap": 1e-3, "stiffness": stiffness}
    return bs.Stop(name, node="B", normal=(-1, 0, 0), **said | options)


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


def beam(modes: int) -> bs.ModalBasis:
    """A slender beam along x, held at A, that bends further in z than in y."""
    section = bs.Rectangle(height=0.04, width=0.01)
    model = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)},
        beams=[bs.Beam("AB", nodes=("A", "B"), elements=12, material=STEEL, section=section)],
        supports=[bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))],
    )
    return bs.ModalBasis.from_structure(model, modes=modes)


AXIAL_LAWS: dict[str, Any] = {
    "buckling": lambda k: bs.BucklingStop(
        "law",
        node="B",
        normal=(-1, 0, 0),
        gap=1e-3,
        stiffness=k,
        critical_force=2.0,
        post_force=1.0,
    ),
    "plane": lambda k: bs.PlaneStop(
        "law",
        node="B",
        normal=(-1, 0, 0),
        gap=1e-3,
        stiffness=k,
        friction=0.1,
        tangential_stiffness=k,
    ),
    "spring": lambda k: bs.SpringLaw(
        "law", node="B", direction=(1, 0, 0), stiffness=(0.0, k), breaks=(1e-3,)
    ),
    "seismic": lambda k: bs.SeismicDevice(
        "law", node="B", direction=(1, 0, 0), first_stiffness=k, second_stiffness=0.0, threshold=1.0
    ),
    "hardening": lambda k: bs.HardeningSpring(
        "law", node="B", direction=(1, 0, 0), curve=[(1e-3, 1e-3 * k), (1.0, 2e-3 * k)]
    ),
    "zener": lambda k: bs.ZenerDamper(
        "law",
        node="B",
        direction=(1, 0, 0),
        series_stiffness=2 * k,
        parallel_stiffness=0.5 * k,
        branch_stiffness=1.5 * k,
        damping=1.0,
    ),
    "relation": lambda k: bs.ForceRelation("law", node="B", direction=(1, 0, 0), force=f"-{k} * x"),
}
"""Laws along the rod that resist with a stiffness, by that."""


@pytest.mark.parametrize("kind", AXIAL_LAWS)
def test_every_law_of_a_known_stiffness_is_held_against_the_modes(kind: str) -> None:
    basis = rod(3)
    (missing,) = missing_flexibility(basis, [wall(1.0)])
    make = AXIAL_LAWS[kind]
    (line,) = bs.Problem(basis, laws=[make(0.2 / missing)], duration=1e-4).warnings
    what = "stop" if kind in ("buckling", "plane") else "law"
    assert line.startswith(f"{what} 'law': the modes left out would give way 20 % as")
    assert bs.Problem(basis, laws=[make(0.05 / missing)], duration=1e-4).warnings == ()


@pytest.mark.parametrize("kind", ["circle", "polar"])
@pytest.mark.parametrize("roll", [0.0, np.pi / 2])
def test_obstacles_about_an_axis_go_by_the_softer_direction(kind: str, roll: float) -> None:
    """Two modes are the first in z, which is thinner, and a second one: y is told, or z is."""
    basis = beam(2)
    about: dict[str, Any] = {"node": "B", "axis": (1, 0, 0), "roll": roll}
    shape: dict[str, Any] = {"radius": 0.01}
    law: Any = bs.CircleStop
    if kind == "polar":
        law, shape = bs.PolarStop, {"profile": [(n * np.pi / 2, 0.01) for n in range(4)]}
    planes = [bs.Stop("plane", node="B", normal=n, stiffness=1.0) for n in ((0, 1, 0), (0, 0, 1))]
    largest = missing_flexibility(basis, planes).max()
    stop = law("ring", stiffness=0.5 / largest, **about, **shape)
    assert missing_flexibility(basis, [stop, *planes])[0] == pytest.approx(largest, rel=1e-12)
    (line,) = bs.Problem(basis, laws=[stop], duration=1e-4).warnings
    assert line.startswith("stop 'ring': the modes left out would give way 50 % as")


def test_stops_between_two_nodes_are_held_against_what_both_give_way() -> None:
    """Two rods, one behind the other, give way twice as much as one does."""
    how: dict[str, Any] = {"elements": 60, "material": STEEL, "section": BAR, "theory": "bar"}
    two = bs.Structure(
        nodes={n: (x, 0, 0) for n, x in zip("ABCD", (0.0, LENGTH, 1.3, LENGTH + 1.3), strict=True)},
        beams=[bs.Beam("AB", nodes=("A", "B"), **how), bs.Beam("CD", nodes=("C", "D"), **how)],
        supports=[
            bs.Support(nodes="all", fixed=("dy", "dz", "drx", "dry", "drz")),
            bs.Support(nodes=["A", "D"], fixed="dx"),
        ],
    )
    basis = bs.ModalBasis.from_structure(two, modes=6)
    between = wall(1.0, other="C")
    (missing,) = missing_flexibility(basis, [between])
    (alone,) = missing_flexibility(rod(3), [wall(1.0)])
    assert missing == pytest.approx(2.0 * alone, rel=1e-9)
    (line,) = bs.Problem(basis, laws=[wall(0.2 / missing, other="C")], duration=1e-4).warnings
    assert line.startswith("stop 'wall': the modes left out would give way 20 % as")


def test_the_slope_of_a_power_is_that_where_the_stop_holds_the_energy() -> None:
    basis = rod(3)
    (missing,) = missing_flexibility(basis, [wall(1.0)])
    start = bs.ModalState(velocity=[3.0, 0.0, 0.0])  # 4.5 J
    # With k d^2.5 / 2.5 = 4.5 J the slope is 1.5 k d^0.5: that shall be 0.2 of what is missing.
    depth = (1.5 * 2.5 * 4.5 / (0.2 / missing)) ** 0.5
    stiffness = 2.5 * 4.5 / depth**2.5

    def lines(k: float, initial: Any) -> tuple[str, ...]:
        ball = bs.HertzStop("ball", node="B", normal=(-1, 0, 0), gap=1e-3, stiffness=k)
        return bs.Problem(basis, laws=[ball], initial=initial, duration=1e-4).warnings

    (line,) = lines(stiffness, start)
    assert line.startswith("stop 'ball': the modes left out would give way 20 % as")
    assert lines(0.1 * stiffness, start) == ()
    assert lines(stiffness, None) == ()  # how deep it is pressed nobody knows


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


PRESSED: dict[str, Any] = {
    "hertz": bs.HertzStop("stop", node="B", normal=(-1, 0, 0), gap=-1e-3, stiffness=1e6),
    "buckling": bs.BucklingStop(
        "stop",
        node="B",
        normal=(-1, 0, 0),
        gap=-1e-3,
        stiffness=1e3,
        critical_force=9,
        post_force=8,
    ),
    "moving": wall(1e4, name="stop", motion=bs.Harmonic(frequency=1.0, cosine=2e-3)),
    "circle": bs.CircleStop(
        "stop", node="B", axis=(0, 0, 1), radius=0.01, centre=(0.011, 0, 0), stiffness=1e4
    ),
    "polar": bs.PolarStop(
        "stop",
        node="B",
        axis=(0, 0, 1),
        profile=[((2 * n + 1) * np.pi / 4, 0.01 * np.sqrt(2)) for n in range(4)],
        centre=(0.011, 0, 0),
        stiffness=1e4,
    ),
    "plane": bs.PlaneStop(
        "stop",
        node="B",
        normal=(-1, 0, 0),
        gap=-1e-3,
        stiffness=1e4,
        friction=0.1,
        tangential_stiffness=1e4,
    ),
    "beside": bs.CircleStop(
        "stop",
        node="B",
        other="C",
        axis=(0, 0, 1),
        side="outside",
        radius=6e-3,
        body_radius=6e-3,
        centre=(0.011, 0, 0),
        stiffness=1e4,
    ),
}
"""Stops that are pressed 1 mm in at t = 0."""


@pytest.mark.parametrize("kind", PRESSED)
def test_every_kind_of_stop_tells_that_it_is_pressed_from_the_start(kind: str) -> None:
    shapes = {(node, dof): [0.0] * 4 for node in "BC" for dof in ("dx", "dy", "dz")}
    for mode, place in enumerate([("B", "dx"), ("B", "dy"), ("B", "dz"), ("C", "dx")]):
        shapes[place][mode] = 1.0
    basis = bs.ModalBasis.from_modes(frequency=[2.0] * 4, shapes=shapes)
    (line,) = bs.Problem(basis, laws=[PRESSED[kind]], duration=0.1).warnings
    assert line.startswith("stop 'stop': its gap of -0.001 m is closed from the start")


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


ON_NODE: dict[str, Any] = {
    "stop": lambda node, axis: bs.Stop("law", node=node, normal=axis, stiffness=1.0),
    "rigid": lambda node, axis: bs.RigidStop("law", node=node, normal=axis, restitution=0.5),
    "hertz": lambda node, axis: bs.HertzStop("law", node=node, normal=axis, stiffness=1.0),
    "buckling": lambda node, axis: bs.BucklingStop(
        "law", node=node, normal=axis, stiffness=1.0, critical_force=1.0, post_force=1.0
    ),
    "spring": lambda node, axis: bs.SpringLaw("law", node=node, direction=axis, stiffness=(1.0,)),
    "damper": lambda node, axis: bs.DamperLaw("law", node=node, direction=axis, damping=(1.0,)),
    "relation": lambda node, axis: bs.ForceRelation("law", node=node, direction=axis, force="-x"),
    "seismic": lambda node, axis: bs.SeismicDevice(
        "law", node=node, direction=axis, first_stiffness=1.0, second_stiffness=0.5, threshold=1.0
    ),
    "hardening": lambda node, axis: bs.HardeningSpring(
        "law", node=node, direction=axis, curve=[(1.0, 1.0), (2.0, 1.5)]
    ),
    "zener": lambda node, axis: bs.ZenerDamper(
        "law", node=node, direction=axis, series_stiffness=1.0, branch_stiffness=1.0, damping=1.0
    ),
    "user": lambda node, axis: bs.UserLaw("law", node=node, direction=axis, force=max),
    "program": lambda node, axis: bs.OutsideProgram("law", node=node, direction=axis, exchange=max),
    "circle": lambda node, axis: bs.CircleStop(
        "law", node=node, axis=axis, radius=1.0, stiffness=1.0
    ),
    "polar": lambda node, axis: bs.PolarStop(
        "law", node=node, axis=axis, profile=[(n * np.pi / 2, 1.0) for n in range(4)], stiffness=1.0
    ),
    "plane": lambda node, axis: bs.PlaneStop(
        "law", node=node, normal=axis, stiffness=1.0, friction=0.1, tangential_stiffness=1.0
    ),
}
"""Every kind of law at a node, along or about an axis."""


@pytest.mark.parametrize("kind", ON_NODE)
def test_every_law_on_a_node_without_mass_is_refused(kind: str) -> None:
    """P has no mass, and follows B on its springs; Q is no node."""
    model = bs.Structure(
        nodes={"B": (0, 0, 0), "P": (1.0, 0, 0)},
        masses=[bs.PointMass("ball", node="B", mass=2.0)],
        springs=[bs.Spring("wire", node="P", other="B", stiffness=(1e4,) * 3 + (0.0,) * 3)],
    )
    basis = bs.ModalBasis.from_structure(model, modes=3)
    with pytest.raises(bs.InputError, match=r"(stops|laws)\.law\.node: .* no mass") as caught:
        bs.Problem(basis, laws=[ON_NODE[kind]("P", (1, 0, 0))], duration=1.0)
    assert "\n" not in str(caught.value)
    with pytest.raises(bs.InputError, match=r"(stops|laws)\.law\.node: "):
        bs.Problem(basis, laws=[ON_NODE[kind]("Q", (1, 0, 0))], duration=1.0)


def test_many_problems_of_a_basis_ask_the_structure_once(monkeypatch: pytest.MonkeyPatch) -> None:
    basis = rod(3)
    first = missing_flexibility(basis, [wall(1.0)])
    monkeypatch.delattr("bumpstop.modal.static_shapes.StaticShapes.under")
    assert missing_flexibility(basis, [wall(2.0), wall(1.0)]).tolist() == [*first, *first]
