"""Cracked rotors: SciPy's solution of the same equations, closed forms, energies, bad input."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

import bumpstop as bs

SHAPES = {("G", "dry"): [1.0, 0.2, 0.0], ("G", "drz"): [0.0, 0.1, 0.9], ("H", "drz"): [0.3, 0, 0]}
TURN = 2.0 * np.pi


def basis() -> bs.ModalBasis:
    shapes = SHAPES | {("H", "dry"): [0.0, 0.0, 0.25]}
    return bs.ModalBasis.from_modes(frequency=[0.0, 2.0, 3.0], damping=0.02, shapes=shapes)


def table(function: Any, count: int = 36) -> list[tuple[float, float]]:
    angles = 0.3 + TURN * np.arange(count) / count
    return [(float(angle), float(function(angle))) for angle in angles]


def crack(**changes: Any) -> bs.CrackedRotor:
    usual: dict[str, Any] = {
        "node": "G",
        "other": "H",
        "rotation": bs.ShaftRotation(bs.Polynomial([3.0, 2.0]), initial_angle=0.7),
        "stiffness": table(lambda phi: 40.0 * np.exp(np.sin(phi))),
    }
    return bs.CrackedRotor("crack", **usual | changes)


def problem(law: bs.CrackedRotor, duration: float = 3.0) -> bs.Problem:
    start = bs.ModalState(displacement=[0.02, -0.01, 0.03], velocity=[0.1, 0.3, -0.2])
    load = bs.NodalForce("weight", node="G", moment=(0, 0.5, 0))
    return bs.Problem(basis(), laws=[law], loads=[load], initial=start, duration=duration)


def periodic(points: Any) -> CubicSpline:
    angles, values = np.array(points).T
    around = np.append(angles, angles[0] + TURN), np.append(values, values[0])
    return CubicSpline(*around, bc_type="periodic")


@pytest.mark.parametrize("own_derivative", [False, True])
def test_motion_moment_and_direction_are_those_of_scipy(own_derivative: bool) -> None:
    law = crack(derivative=table(lambda phi: 30.0 * np.cos(phi)) if own_derivative else None)
    stiffness = periodic(law.stiffness)
    slope = periodic(law.derivative) if own_derivative else stiffness.derivative()
    rows = np.array([[1.0, 0.2, -0.25], [-0.3, 0.1, 0.9]])
    omega = TURN * np.array([0.0, 2.0, 3.0])

    def bent(t: float, q: Any) -> tuple[Any, float]:
        g = 0.7 + 3.0 * t + t**2
        turned = np.array([[np.cos(g), np.sin(g)], [-np.sin(g), np.cos(g)]])
        l2, l3 = turned @ rows @ q
        phi = np.arctan2(l2, l3) % TURN
        k, s = float(stiffness(phi)), float(slope(phi))
        return turned.T @ [k * l2 + s * l3 / 2, k * l3 - s * l2 / 2], phi

    def rates(t: float, y: Any) -> Any:
        q, v = y[:3], y[3:]
        moment = 0.5 * np.array([1.0, 0.2, 0.0]) - rows.T @ bent(t, q)[0]
        return [*v, *(moment - omega**2 * q - 0.04 * omega * v)]

    case = problem(law)
    times = np.linspace(0.0, case.duration, 61)
    start = [0.02, -0.01, 0.03, 0.1, 0.3, -0.2]
    run = solve_ivp(rates, (0.0, 3.0), start, "DOP853", times, rtol=1e-12, atol=1e-15)
    expected = [bent(t, q) for t, q in zip(times, run.y[:3].T, strict=True)]
    for method in ("dop853", "rk54"):
        response = bs.simulate(case, method, rtol=1e-11)
        motion = response.motion(0, times)
        assert motion == pytest.approx(run.y[:3].T, abs=1e-8 * np.abs(run.y[:3]).max())
        moments = np.array([moment for moment, _ in expected])
        found = -response.history.law_forces(0, times)
        assert found == pytest.approx(moments, abs=1e-8 * np.abs(moments).max())
        direction = response.sample("internal_variable", "crack", "bending_direction", times=times)
        assert direction == pytest.approx([phi for _, phi in expected], abs=1e-6)
        assert response.energy_residual < 1e-7
    assert bs.simulate(case).method == "dop853"


def test_a_stiffness_all_round_is_a_spring() -> None:
    """Two springs in both directions, whatever the shaft does: a complete period in closed form."""
    shapes = {("G", "dry"): [1.0, 0.0], ("G", "drz"): [0.0, 1.0]}
    mass = bs.ModalBasis.from_modes(frequency=[0.0, 0.0], damping=0.0, shapes=shapes)
    law = crack(other=None, stiffness="25")
    start = bs.ModalState(displacement=[0.1, 0.0], velocity=[0.0, 0.3])
    response = bs.simulate(bs.Problem(mass, laws=[law], initial=start, duration=4.0), rtol=1e-12)
    times = np.linspace(0.0, 4.0, 41)
    expected = np.stack([0.1 * np.cos(5 * times), 0.06 * np.sin(5 * times)], axis=1)
    assert response.motion(0, times) == pytest.approx(expected, abs=1e-10)


def test_the_axis_of_the_shaft_turns_the_law_with_it() -> None:
    """The same shaft along x and along z, y across becoming y and z across becoming -x."""
    along_x = crack(other=None)
    along_z = crack(other=None, axis=(0, 0, 1))
    motions = []
    for law, dofs in ((along_x, ("dry", "drz")), (along_z, ("dry", "drx"))):
        sign = 1.0 if dofs[1] == "drz" else -1.0
        shapes = {("G", dofs[0]): [1.0, 0.0], ("G", dofs[1]): [0.0, sign]}
        mass = bs.ModalBasis.from_modes(frequency=[1.0, 1.0], damping=0.0, shapes=shapes)
        start = bs.ModalState(displacement=[0.1, 0.02])
        case = bs.Problem(mass, laws=[law], initial=start, duration=2.0)
        motions.append(bs.simulate(case, rtol=1e-11).motion(0))
    assert motions[0] == pytest.approx(motions[1], abs=1e-10)


def test_a_formula_is_followed_to_rounding() -> None:
    law = crack(stiffness="40 * exp(sin(phi))", derivative="40 * cos(phi) * exp(sin(phi))")
    angles = np.linspace(-10.0, 10.0, 777)
    exact = 40.0 * np.exp(np.sin(angles))
    assert law.stiffness_at(angles) == pytest.approx(exact, rel=1e-10)
    assert law.derivative_at(angles) == pytest.approx(exact * np.cos(angles), abs=1e-8)
    own = crack(stiffness="40 * exp(sin(phi))")
    assert own.derivative_at(angles) == pytest.approx(exact * np.cos(angles), abs=1e-5)


def test_straight_lines_join_the_points() -> None:
    points, slopes = table(lambda p: 9 + np.sin(p), 12), table(np.cos, 12)
    law = crack(stiffness=points, derivative=slopes, interpolation="linear")
    middle = 0.5 * (points[3][0] + points[4][0])
    assert law.stiffness_at([middle])[0] == pytest.approx(0.5 * (points[3][1] + points[4][1]))
    last = points[-1][0] + 0.5 * (points[0][0] + TURN - points[-1][0])
    assert law.derivative_at([last])[0] == pytest.approx(0.5 * (slopes[-1][1] + slopes[0][1]))


@pytest.mark.parametrize("method", ["symplectic_euler", "central_difference"])
def test_explicit_steps_keep_the_time_of_the_crack(method: str) -> None:
    given = problem(crack())
    times = np.linspace(0.0, given.duration, 101)
    expected = bs.simulate(given, rtol=1e-10).history.motion(times, 0)
    errors = []
    for steps in (4_000, 40_000):
        found = bs.simulate(given, method, dt=given.duration / steps).history.motion(times, 0)
        errors.append(np.abs(found - expected).max() / np.abs(expected).max())
    assert errors[0] < 0.05
    assert errors[1] < 0.11 * errors[0]


@pytest.mark.parametrize("method", ["exact", "newmark"])
def test_methods_without_rate_equations_refuse_it(method: str) -> None:
    with pytest.raises(bs.InputError, match="direction of its bending"):
        bs.simulate(problem(crack()), method, dt=None if method == "exact" else 1e-4)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"rotation": 3.0}, "rotation: must be a ShaftRotation"),
        ({"other": "G"}, "other: must be another node"),
        ({"axis": (0, 0, 0)}, "axis"),
        ({"stiffness": [(0.0, 1.0), (1.0, 1.0), (2.0, 1.0)]}, "at least 4 points"),
        ({"stiffness": [(0.0, 1.0), (2.0, 1.0), (1.0, 1.0), (3.0, 1.0)]}, r"stiffness\[2\]"),
        ({"stiffness": [(0.0, 1.0), (2.0, 1.0), (4.0, 1.0), (7.0, 1.0)]}, "one turn"),
        ({"stiffness": [(0.0, 1.0), (2.0, 1.0), (4.0, 1.0), (TURN, 2.0)]}, "full turn"),
        ({"stiffness": [(0.0, 1.0), (2.0, -1.0), (4.0, 1.0), (5.0, 1.0)]}, "positive"),
        ({"stiffness": "40 * phi"}, "positive|full turn"),
        ({"stiffness": "40 + sin(psi)"}, "psi"),
        ({"stiffness": "40 + "}, "is no formula"),
        ({"stiffness": "1 / sin(phi)"}, "finite"),
        ({"derivative": "phi"}, "full turn"),
        ({"interpolation": "cubic"}, "interpolation"),
        ({"interpolation": "linear"}, "derivative: is missing"),
    ],
)
def test_bad_input_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(bs.InputError, match=message):
        crack(**changes)


def test_a_basis_without_rotations_is_refused() -> None:
    mass = bs.ModalBasis.from_modes(frequency=[0.0], damping=[0.0], shapes={("G", "dy"): [1.0]})
    with pytest.raises(bs.InputError, match=r"laws\.crack"):
        bs.Problem(mass, laws=[crack(other=None)], duration=1.0)
