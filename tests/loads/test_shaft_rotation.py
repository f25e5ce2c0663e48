"""Shafts that turn: whirl in closed form, run-ups by SciPy, conventions, bad input."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import bumpstop as bs

OMEGA, RATIO, MOMENT = 2.0 * np.pi * 8.0, 0.03, 1e-3
POLAR, ACROSS, STIFFNESS = 0.9, 0.6, 2400.0
OFFSET, SPRING, MASS = 40.0, 5e4, 12.0


def jeffcott(**changes: Any) -> bs.ModalBasis:
    """Return a disc of 1 kg in the middle of a shaft along x."""
    shapes = {("D", "dy"): [1.0, 0.0], ("D", "dz"): [0.0, 1.0]}
    damping = [RATIO, RATIO]
    return bs.ModalBasis.from_modes(frequency=[8.0, 8.0], damping=damping, shapes=shapes, **changes)


def disc(spin: float = 1.0) -> bs.ModalBasis:
    """Return a disc on a shaft along x that displacements and rotations couple at, complete."""
    dofs = [("D", dof) for dof in ("dy", "dz", "dry", "drz")]
    stiffness = np.array(
        [
            [SPRING, 0.0, 0.0, -OFFSET],
            [0.0, SPRING, OFFSET, 0.0],
            [0.0, OFFSET, STIFFNESS, 0.0],
            [-OFFSET, 0.0, 0.0, STIFFNESS],
        ]
    )
    gyroscopic = np.zeros((4, 4))
    gyroscopic[2, 3], gyroscopic[3, 2] = spin * POLAR, -spin * POLAR
    model = bs.Matrices(
        dofs=dofs,
        mass=np.diag([MASS, MASS, ACROSS, ACROSS]),
        stiffness=stiffness,
        gyroscopic=gyroscopic,
    )
    return bs.ModalBasis.from_structure(model, modes="all", damping=0.02)


def by_scipy(
    problem: bs.Problem, accelerating: Any, force: Callable[[float], Any] = lambda _: np.zeros(4)
) -> Any:
    """Integrate the disc on its own dofs, without modes; returns (time, dof)."""
    rotation, basis = problem.rotation, problem.basis
    assert rotation is not None
    assert basis.model is not None
    mass, stiffness = (
        basis.model.reduced(m).to_dense() for m in (basis.model.mass, basis.model.stiffness)
    )
    shapes = basis.shapes
    damping = mass @ shapes @ np.diag(basis.damping) @ shapes.T @ mass
    gyroscopic = basis.model.gyroscopic.to_dense() / rotation.spin
    inverse = np.linalg.inv(mass)

    def rates(t: float, y: Any) -> Any:
        speed, change = float(rotation.speed_at([t])[0]), float(rotation.acceleration_at([t])[0])
        q, v = y[:4], y[4:]
        pull = force(t) - (damping + speed * gyroscopic) @ v
        return [*v, *(inverse @ (pull - (stiffness + change * accelerating) @ q))]

    start = np.zeros(8)
    assert problem.initial is not None
    place, speed = problem.initial.modal_state(basis)
    start[:4], start[4:] = shapes @ place, shapes @ speed
    times = problem.times
    knots = [0.0, problem.duration]
    if isinstance(rotation.speed, bs.TimeTable):
        knots = sorted({*knots, *np.clip(rotation.speed.times, 0.0, problem.duration).tolist()})
    found = [start[np.newaxis, :4]]
    for begin, end in pairwise(knots):
        inside = times[(times > begin) & (times <= end)]
        # The last number before a knot: what holds there.
        stop = np.nextafter(end, begin)
        asked = np.append(np.minimum(inside, np.nextafter(stop, begin)), stop)
        run = solve_ivp(rates, (begin, stop), start, "DOP853", asked, rtol=1e-12, atol=1e-16)
        found.append(run.y[:4, : len(inside)].T)
        start = run.y[:, -1]
    return np.concatenate(found)


def test_a_steady_unbalance_whirls_in_a_circle() -> None:
    """r = m e W^2 / (w^2 - W^2 + 2 i xi w W) in the plane y + i z, at every speed."""
    basis = jeffcott()
    for speed in (20.0, OMEGA, -90.0):
        rotation = bs.ShaftRotation(speed, initial_angle=0.4)
        load = bs.Unbalance("u", node="D", rotation=rotation, moment=MOMENT, phase=0.3)
        radius = MOMENT * speed**2 / (OMEGA**2 - speed**2 + 2j * RATIO * OMEGA * speed)
        first = radius * np.exp(0.7j)
        turning = 1j * speed * first
        start = bs.ModalState(
            displacement=[first.real, first.imag], velocity=[turning.real, turning.imag]
        )
        problem = bs.Problem(basis, loads=[load], initial=start, rotation=rotation, duration=2.0)
        response = bs.simulate(problem)
        assert response.method == "exact"
        y, z = response.motion(0).T
        expected = radius * np.exp(1j * (0.7 + speed * problem.times))
        assert y + 1j * z == pytest.approx(expected, abs=1e-12 * abs(radius) + 1e-16)


def test_a_disc_whirls_at_the_frequencies_of_its_campbell_diagram() -> None:
    """Id w^2 - Ip W w - k = 0 for a disc that only turns; the plane y + i z in closed form."""
    dofs = [("D", "dry"), ("D", "drz")]
    model = bs.Matrices(
        dofs=dofs,
        mass=np.diag([ACROSS, ACROSS]),
        stiffness=np.diag([STIFFNESS, STIFFNESS]),
        gyroscopic=np.array([[0.0, POLAR], [-POLAR, 0.0]]),
    )
    basis = bs.ModalBasis.from_structure(model, modes="all")
    speeds = [0.0, 30.0, 100.0, 400.0]
    found = bs.campbell(basis, speeds).frequencies * 2.0 * np.pi
    for speed, frequencies in zip(speeds, found, strict=True):
        backward, forward = np.sort(np.roots([ACROSS, -POLAR * speed, -STIFFNESS]))
        assert frequencies == pytest.approx(sorted([-backward, forward]), rel=1e-12)
        start = bs.NodalState(displacement={("D", "dry"): 1e-3})
        rotation = bs.ShaftRotation(speed)
        problem = bs.Problem(basis, initial=start, rotation=rotation, duration=1.0)
        response = bs.simulate(problem)
        assert response.method == "exact"
        t = problem.times
        whirl = backward * np.exp(1j * forward * t) - forward * np.exp(1j * backward * t)
        expected = 1e-3 * whirl / (backward - forward)
        turned = response.sample("displacement", "D", "dry") + 1j * response.sample(
            "displacement", "D", "drz"
        )
        assert turned == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("terms", ["lagrange", "fixed_axis", "none"])
@pytest.mark.parametrize("spin", [1.0, 25.0])
def test_a_run_up_is_that_of_scipy(terms: str, spin: float) -> None:
    basis = disc(spin)
    run_up = bs.ShaftRotation(
        bs.Polynomial([5.0, 40.0, 3.0]), spin=spin, acceleration_terms=terms, initial_angle=0.2
    )
    load = bs.Unbalance("u", node="D", rotation=run_up, mass=0.2, eccentricity=5e-3, phase=-0.5)
    start = bs.ModalState(displacement=[1e-3, 0.0, 2e-3, 0.0])
    problem = bs.Problem(
        basis, loads=[load], initial=start, rotation=run_up, duration=2.5, sample=0.05
    )
    accelerating = np.zeros((4, 4))
    if terms != "none":
        accelerating[2, 3] = POLAR
    if terms == "fixed_axis":
        accelerating[3, 2] = -POLAR

    def force(t: float) -> Any:
        angle = -0.3 + 5.0 * t + 20.0 * t**2 + t**3
        speed, change = 5.0 + 40.0 * t + 3.0 * t**2, 40.0 + 6.0 * t
        cos, sin = np.cos(angle), np.sin(angle)
        y, z = speed**2 * cos + change * sin, speed**2 * sin - change * cos
        return 1e-3 * np.array([y, z, 0.0, 0.0])

    expected = by_scipy(problem, accelerating, force)
    for method in ("dop853", "rk54", "exprk43"):
        rtol = 1e-11 if method != "exprk43" else 1e-10
        response = bs.simulate(problem, method, rtol=rtol)
        found = response.motion(0) @ basis.shapes.T
        assert found == pytest.approx(expected, abs=1e-8 * np.abs(expected).max())
        assert response.energy_residual < 1e-8
    assert bs.simulate(problem).method == "dop853"


def test_a_table_of_speeds_has_no_error_at_its_knots() -> None:
    basis = disc()
    speeds = bs.TimeTable([0.0, 0.413, 1.0], [0.0, 300.0, 120.0], beyond="hold")
    rotation = bs.ShaftRotation(speeds)
    start = bs.ModalState(displacement=[1e-3, 0.0, 2e-3, 0.0])
    problem = bs.Problem(basis, initial=start, rotation=rotation, duration=1.5, sample=0.05)
    accelerating = np.zeros((4, 4))
    accelerating[2, 3] = POLAR
    expected = by_scipy(problem, accelerating)
    response = bs.simulate(problem, rtol=1e-11)
    found = response.motion(0) @ basis.shapes.T
    assert found == pytest.approx(expected, abs=1e-8 * np.abs(expected).max())
    angle = 0.5 * 0.413 * 300.0 + 0.587 * 210.0 + 0.5 * 120.0
    assert rotation.angle_at([1.5])[0] == pytest.approx(angle, rel=1e-14)


def test_accelerations_and_stops_follow_the_run_up() -> None:
    """The acceleration is that of the equations; a stop is hit and the ledger stays closed."""
    run_up = bs.ShaftRotation(bs.Polynomial([0.0, 30.0]))
    load = bs.Unbalance("u", node="D", rotation=run_up, moment=MOMENT)
    stop = bs.Stop("rub", node="D", normal=(0, -1, 0), gap=2e-3, stiffness=1e6, damping=10.0)
    problem = bs.Problem(jeffcott(), laws=[stop], loads=[load], duration=3.0)
    response = bs.simulate(problem, rtol=1e-10)
    assert len(response.impact_table()["start"]) > 5
    assert response.energy_residual < 1e-8
    times = np.array([0.3, 0.7])
    q, v, a = (response.motion(order, times)[:, 1] for order in range(3))
    speed, angle = 30.0 * times, 15.0 * times**2
    force = MOMENT * (speed**2 * np.sin(angle) - 30.0 * np.cos(angle))
    assert a == pytest.approx(force - OMEGA**2 * q - 2 * RATIO * OMEGA * v, rel=1e-9)
    coarse = bs.simulate(problem, "adaptive_central_difference", points_per_period=400)
    least = response.motion(0, np.array([1.0]))
    assert coarse.motion(0, np.array([1.0])) == pytest.approx(least, abs=2e-5)


def test_a_speed_that_does_not_change_is_the_spin_of_the_basis() -> None:
    start = bs.ModalState(displacement=[1e-3, 0.0, 2e-3, 0.0])
    table = bs.TimeTable([0.0, 1.0], [70.0, 70.0])
    both = [
        bs.simulate(bs.Problem(disc(70.0), initial=start, duration=1.0)),
        bs.simulate(
            bs.Problem(disc(), initial=start, rotation=bs.ShaftRotation(table), duration=1.0)
        ),
    ]
    assert [response.method for response in both] == ["exact", "exact"]
    assert both[0].motion(0) == pytest.approx(both[1].motion(0), abs=1e-15)


@pytest.mark.parametrize("method", ["exact", "newmark", "symplectic_euler", "moreau_jean"])
def test_methods_whose_matrices_do_not_change_refuse_a_run_up(method: str) -> None:
    run_up = bs.ShaftRotation(bs.Polynomial([0.0, 30.0]))
    load = bs.Unbalance("u", node="D", rotation=run_up, moment=MOMENT)
    problem = bs.Problem(jeffcott(), loads=[load], duration=1.0)
    with pytest.raises(bs.InputError, match=r"speeds that change.*dop853"):
        bs.simulate(problem, method, dt=None if method == "exact" else 1e-4)
    response = bs.simulate(problem)
    assert "changes in speed" in response.method_reason
    with pytest.raises(bs.InputError, match="speed that changes"):
        bs.continued(response, duration=1.0)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"speed": "fast"}, "speed"),
        ({"speed": float("nan")}, "speed"),
        ({"speed": bs.TimeTable([0.0, 1.0, 1.0], [0.0, 1.0, 2.0])}, "jump"),
        ({"speed": 1.0, "spin": 0.0}, "spin"),
        ({"speed": 1.0, "acceleration_terms": "all"}, "acceleration_terms"),
        ({"speed": 1.0, "initial_angle": float("inf")}, "initial_angle"),
    ],
)
def test_bad_rotations_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(bs.InputError, match=message):
        bs.ShaftRotation(**changes)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"rotation": 3.0}, "rotation"),
        ({"moment": -1.0}, "moment"),
        ({"moment": 1.0, "mass": 1.0}, "moment"),
        ({"moment": None, "mass": 1.0}, "eccentricity"),
        ({"moment": None, "mass": -1.0, "eccentricity": 1e-3}, "mass"),
        ({"axis": (0, 0, 0)}, "axis"),
        ({"phase": float("nan")}, "phase"),
    ],
)
def test_bad_unbalances_are_refused(changes: dict[str, Any], message: str) -> None:
    usual: dict[str, Any] = {"node": "D", "rotation": bs.ShaftRotation(1.0), "moment": 1e-3}
    with pytest.raises(bs.InputError, match=message):
        bs.Unbalance("u", **usual | changes)


def test_problems_that_a_rotation_does_not_go_with_are_refused() -> None:
    basis = jeffcott()
    short = bs.ShaftRotation(bs.TimeTable([0.0, 0.5], [0.0, 1.0]))
    with pytest.raises(bs.InputError, match="cover the run"):
        bs.Problem(basis, rotation=short, duration=1.0)
    load = bs.Unbalance("u", node="D", rotation=short, moment=1e-3)
    with pytest.raises(bs.InputError, match="cover the run"):
        bs.Problem(basis, loads=[load], duration=1.0)
    with pytest.raises(bs.InputError, match="ShaftRotation"):
        bs.Problem(basis, rotation=30.0, duration=1.0)  # type: ignore[arg-type]
    elsewhere = bs.Unbalance("u", node="E", rotation=bs.ShaftRotation(1.0), moment=1e-3)
    with pytest.raises(bs.InputError, match="E"):
        bs.Problem(basis, loads=[elsewhere], duration=1.0)
