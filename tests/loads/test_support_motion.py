"""Supports that move differently, against direct solutions of the whole structure."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import bumpstop as bs

STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = bs.Rectangle(height=0.02, width=0.03)
PLANE = ("dx", "dz", "drx", "dry")
FREQUENCY = 23.0
OMEGA = 2 * np.pi * FREQUENCY


def beam(elements: int = 4) -> bs.Structure:
    """Clamped at A, pinned at B, bending in the plane xy."""
    return bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1.5, 0, 0)},
        beams=[bs.Beam("AB", nodes=("A", "B"), elements=elements, material=STEEL, section=BAR)],
        supports=[
            bs.Support(nodes="all", fixed=PLANE),
            bs.Support(nodes="A", fixed=("dy", "drz")),
            bs.Support(nodes="B", fixed="dy"),
        ],
    )


def test_a_beam_whose_ends_move_differently() -> None:
    """All modes, against the exponential of the state matrix of all free dofs and the motion."""
    model = beam()
    basis = bs.ModalBasis.from_structure(model, modes="all", damping=0.03)
    left = bs.SupportMotion(
        "left", nodes="A", displacement=(0, 2e-3, 0), time=bs.Harmonic(FREQUENCY, sine=1.0)
    )
    right = bs.SupportMotion(
        "right", nodes="B", displacement=(0, -1e-3, 0), time=bs.Harmonic(FREQUENCY, cosine=1.0)
    )
    gauge = bs.Gauge("root", beam="AB", at=0.1, fibre=(0.01, 0.0))
    problem = bs.Problem(basis, loads=[left, right], duration=0.4, gauges=[gauge])
    response = bs.simulate(problem)

    free = model.free
    held: Any = [model.dofs.index(place) for place in (("A", "dy"), ("B", "dy"))]
    stiffness: Any = model.stiffness.to_dense()
    mass: Any = model.mass.to_dense()
    inner: Any = np.ix_(free, free)
    followed = -np.linalg.solve(stiffness[inner], stiffness[np.ix_(free, held)])
    shapes = basis.shapes[free]
    damping = mass[inner] @ shapes @ np.diag(basis.damping) @ shapes.T @ mass[inner]
    size, number = 2 * len(free), len(free)
    # State: whole displacements, velocities, sine and cosine.
    motion = np.array([[2e-3, 0.0], [0.0, -1e-3]])  # of both supports by sine and cosine
    turning = OMEGA * np.array([[0.0, 1.0], [-1.0, 0.0]])  # d/dt of (sine, cosine)
    rate = motion @ turning
    force = (
        -stiffness[np.ix_(free, held)] @ motion
        + damping @ followed @ rate
        + OMEGA**2 * mass[np.ix_(free, held)] @ motion
    )
    state = np.zeros((size + 2, size + 2))
    state[:number, number:size] = np.eye(number)
    state[number:size, :number] = -np.linalg.solve(mass[inner], stiffness[inner])
    state[number:size, number:size] = -np.linalg.solve(mass[inner], damping)
    state[number:size, size:] = np.linalg.solve(mass[inner], force)
    state[size:, size:] = turning
    now = np.zeros(size + 2)
    now[-1] = 1.0
    now[:number] = followed @ motion @ now[size:]
    now[number:size] = followed @ rate @ now[size:]

    times = np.linspace(0.0, 0.4, 9)
    step = expm(state * times[1])
    whole = np.zeros((len(times), len(model.dofs)))
    speeds = np.zeros((len(times), len(model.dofs)))
    for row, fast in zip(whole, speeds, strict=True):
        row[free], row[held] = now[:number], motion @ now[size:]
        fast[free], fast[held] = now[number:size], rate @ now[size:]
        now = step @ now
    for node, dof in (("AB.1", "dy"), ("AB.3", "dy"), ("B", "drz"), ("A", "dy"), ("AB@0.6", "dy")):
        form = model.displacement_form(node, dof)
        for quantity, fields in (("displacement", whole), ("velocity", speeds)):
            expected = np.array([form.of(field) for field in fields])
            found = response.sample(quantity, node, dof, times=times)
            np.testing.assert_allclose(found, expected, atol=1e-10 * np.abs(expected).max())
    strains = np.array([model.strain_form(gauge).of(field) for field in whole])
    found = response.sample("gauge", "root", times=times)
    np.testing.assert_allclose(found, strains, atol=1e-9 * np.abs(strains).max())


def test_equal_motions_of_all_supports_are_a_base_motion() -> None:
    basis = bs.ModalBasis.from_structure(beam(), modes=4, damping=0.01)
    times = np.linspace(0.0, 0.3, 31)
    table = bs.TimeTable(times, np.sin(90 * times), beyond="zero")
    each = bs.SupportMotion("ends", nodes=["A", "B"], acceleration=(0, 5.0, 0), time=table)
    base = bs.BaseMotion(acceleration=(0, 5.0, 0), time=table, frame="absolute")
    stop = bs.Stop("wall", node="AB.2", normal=(0, -1, 0), gap=5e-4, stiffness=1e6)
    still = bs.Stop(
        "wall", node="AB.2", normal=(0, -1, 0), gap=5e-4, stiffness=1e6, frame="absolute"
    )
    found = [
        bs.simulate(bs.Problem(basis, laws=[law], loads=[load], duration=0.4))
        for law, load in ((stop, each), (still, base))
    ]
    for node in ("AB.1", "AB.2"):
        one, other = (response.sample("displacement", node, "dy") for response in found)
        np.testing.assert_allclose(one, other, atol=1e-9 * np.abs(other).max())
    assert found[0].history.event_count == found[1].history.event_count > 0


def test_motions_of_one_support_add_up() -> None:
    basis = bs.ModalBasis.from_structure(beam(), modes=4, damping=0.01)
    wave, other = bs.Harmonic(FREQUENCY, sine=1.0), bs.Harmonic(9.0, cosine=1.0)
    parts = [
        bs.SupportMotion("one", nodes="A", displacement=(0, 2e-3, 0), time=wave),
        bs.SupportMotion("two", nodes=["A", "B"], displacement=(0, -1e-3, 0), time=other),
    ]
    runs = [bs.Problem(basis, loads=loads, duration=0.2) for loads in (parts, *zip(parts))]
    both, *each = (bs.simulate(run) for run in runs)
    for node in ("A", "AB.1"):
        found = both.sample("displacement", node, "dy")
        expected = sum(run.sample("displacement", node, "dy") for run in each)
        np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(found).max())


def chain() -> bs.Structure:
    """A mass between two supports and one beyond, with dampers, along x."""
    return bs.Structure(
        nodes={name: (float(place), 0, 0) for place, name in enumerate("ABCD")},
        masses=[bs.PointMass("b", node="B", mass=2.0), bs.PointMass("c", node="C", mass=1.0)],
        springs=[
            bs.Spring("ab", node="A", other="B", stiffness=800.0, damping=3.0),
            bs.Spring("bc", node="B", other="C", stiffness=300.0, damping=1.0),
            bs.Spring("cd", node="C", other="D", stiffness=500.0, damping=2.0),
        ],
        supports=[
            bs.Support(nodes=["A", "D"], fixed=["dx", "dy", "dz"]),
            bs.Support(nodes=["B", "C"], fixed=["dy", "dz"]),
        ],
    )


def test_dampers_and_a_stop_feel_the_whole_motion() -> None:
    """One end shaken by a table, the other still, and a wall; against a Runge-Kutta scheme."""
    knots = np.linspace(0.0, 1.0, 11)
    table = bs.TimeTable(knots, np.cos(4 * knots), beyond="zero")
    shaken = bs.SupportMotion("left", nodes="A", acceleration=(2.0, 0, 0), time=table)
    wall = bs.Stop("wall", node="C", normal=(-1, 0, 0), gap=0.02, stiffness=4e3, damping=4.0)
    basis = bs.ModalBasis.from_structure(chain(), modes="all")
    response = bs.simulate(bs.Problem(basis, laws=[wall], loads=[shaken], duration=1.5))

    def rate(t: float, y: np.ndarray) -> list[float]:
        b, c, d, vb, vc, vd = y
        left = 800 * (d - b) + 3 * (vd - vb)
        middle = 300 * (c - b) + vc - vb
        right = -500 * c - 2 * vc
        push = max(0.0, 4e3 * (c - 0.02) + 4 * vc) if c > 0.02 else 0.0
        moved = 2 * float(table.at(np.array([t]))[0])
        return [vb, vc, vd, (left + middle) / 2, right - middle - push, moved]

    times = np.linspace(0.0, 1.5, 31)
    found = solve_ivp(
        rate, (0, 1.5), np.zeros(6), "DOP853", t_eval=times, rtol=1e-11, atol=1e-14, max_step=2e-3
    )
    for node, expected in (("B", found.y[0]), ("C", found.y[1]), ("A", found.y[2])):
        computed = response.sample("displacement", node, "dx", times=times)
        # Dampers and wall see cubics of the motion along straight lines: 1e-7 of it.
        np.testing.assert_allclose(computed, expected, atol=3e-7 * np.abs(found.y).max())
    assert response.history.event_count >= 2
    gap = response.sample("gap", "wall", times=times)
    np.testing.assert_allclose(gap, 0.02 - found.y[1], atol=1e-6)


@pytest.mark.parametrize("kind", ["displacement", "acceleration"])
def test_springs_of_several_slopes_feel_the_whole_motion(kind: str) -> None:
    """Between the masses and to the ground, against a Runge-Kutta scheme."""
    knots = np.linspace(0.0, 1.0, 11)
    table = bs.TimeTable(knots, np.cos(4 * knots), beyond="zero")
    shaken = (
        bs.SupportMotion("left", nodes="A", acceleration=(2.0, 0, 0), time=table)
        if kind == "acceleration"
        else bs.SupportMotion(
            "left", nodes="A", displacement=(0.05, 0, 0), time=bs.Harmonic(3.0, sine=1.0)
        )
    )
    between = bs.SpringLaw(
        "between",
        node="B",
        other="C",
        direction=(1, 0, 0),
        stiffness=(900.0, 100.0, 2000.0),
        breaks=(-0.004, 0.01),
        damping=3.0,
        preload=1.0,
    )
    ground = bs.SpringLaw(
        "ground", node="B", direction=(1, 0, 0), stiffness=(0.0, 1000.0), breaks=(0.03,)
    )
    basis = bs.ModalBasis.from_structure(chain(), modes="all")
    problem = bs.Problem(basis, laws=[between, ground], loads=[shaken], duration=1.5)
    response = bs.simulate(problem)
    travel, size = shaken.travel(1.5), shaken.size[0]

    def moved(t: float, derivative: int) -> float:
        return size * float(travel.at(np.array([t]), derivative)[0])

    def rate(t: float, y: np.ndarray) -> list[float]:
        b, c, vb, vc = y
        left = 800 * (moved(t, 0) - b) + 3 * (moved(t, 1) - vb)
        middle = 300 * (c - b) + vc - vb - float(between.force([b - c])[0]) - 3 * (vb - vc)
        right = -500 * c - 2 * vc
        return [vb, vc, (left + middle - float(ground.force([b])[0])) / 2, right - middle]

    follow = np.linalg.solve(np.array([[1100.0, -300.0], [-300.0, 800.0]]), np.array([800.0, 0]))
    start = np.concatenate([follow * moved(0.0, 0), follow * moved(0.0, 1)])
    times = np.linspace(0.0, 1.5, 31)
    found = solve_ivp(
        rate, (0, 1.5), start, "DOP853", t_eval=times, rtol=1e-10, atol=1e-13, max_step=2e-3
    )
    for node, expected in zip("BC", found.y, strict=False):
        computed = response.sample("displacement", node, "dx", times=times)
        np.testing.assert_allclose(computed, expected, atol=3e-7 * np.abs(found.y).max())
    assert response.event_count > 3
    assert response.energy_residual < 1e-12


@pytest.mark.parametrize(
    ("options", "laws", "message"),
    [
        ({"nodes": "X"}, [], r"loads\.left\.nodes: unknown node.*'X'"),
        ({"nodes": "B"}, [], r"loads\.left\.nodes: no support holds its dx"),
        ({"nodes": []}, [], "nodes: must "),
        (
            {"displacement": (1, 0, 0), "acceleration": None},
            [],
            "time: must say how the displacement changes",
        ),
        (
            {},
            [bs.RigidStop("floor", node="B", normal=(1, 0, 0), restitution=0.5)],
            r"stops\.floor: cannot follow the supports that 'left' moves",
        ),
    ],
)
def test_mistakes_are_one_line(options: dict[str, Any], laws: list[Any], message: str) -> None:
    basis = bs.ModalBasis.from_structure(chain(), modes="all")
    said: dict[str, Any] = {"nodes": "A", "acceleration": (1, 0, 0)} | options
    with pytest.raises(bs.InputError, match=message) as caught:
        bs.Problem(basis, laws=laws, loads=[bs.SupportMotion("left", **said)], duration=1.0)
    assert "\n" not in str(caught.value)


def test_frames_go_together() -> None:
    basis = bs.ModalBasis.from_structure(chain(), modes="all")
    loads: list[Any] = [
        bs.SupportMotion("left", nodes="A", acceleration=(1, 0, 0)),
        bs.BaseMotion(acceleration=(1, 0, 0)),
    ]
    with pytest.raises(bs.InputError, match=r"loads\.base_motion\.frame: must be the same"):
        bs.Problem(basis, loads=loads, duration=1.0)


def test_modes_from_elsewhere_have_no_supports() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    load = bs.SupportMotion("left", nodes="A", acceleration=(1, 0, 0))
    with pytest.raises(bs.InputError, match=r"loads\.left\.nodes: the basis has no supports"):
        bs.Problem(basis, loads=[load], duration=1.0)
