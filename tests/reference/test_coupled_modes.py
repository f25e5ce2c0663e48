"""Modes that dampers, gyroscopic and circulatory forces couple, against the physical equations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.linalg import expm
from scipy.optimize import brentq

import bumpstop as bs

Array = NDArray[np.float64]

STIFFNESS = np.array([[5e4, -2e4, 0.0], [-2e4, 4e4, -2e4], [0.0, -2e4, 2e4]])
MASS = np.diag([2.0, 1.0, 3.0])
DOFS = [(node, "dx") for node in "PQR"]
DAMPER = np.array([[4.0, -4.0, 0.0], [-4.0, 4.0, 0.0], [0.0, 0.0, 30.0]])
SKEW = np.array([[0.0, 60.0, 0.0], [-60.0, 0.0, 25.0], [0.0, -25.0, 0.0]])
VELOCITY = np.array([0.4, -0.3, 0.8])
DURATION = 0.5
STOP_STIFFNESS = 2e5
GAP = 2e-3


def basis(
    *, damping: Array | None = None, skew: Array | None = None, circulatory: Array | None = None
) -> bs.ModalBasis:
    model = bs.Matrices(
        stiffness=STIFFNESS,
        mass=MASS,
        damping=damping,
        gyroscopic=skew,
        circulatory=circulatory,
        dofs=DOFS,
    )
    return bs.ModalBasis.from_structure(model, modes="all")


def problem(
    of: bs.ModalBasis, *, laws: list[bs.Stop] | None = None, force: float = 0.0
) -> bs.Problem:
    modal_velocity = of.project_field(VELOCITY)
    loads = [bs.NodalForce("pull", node="R", force=(force, 0.0, 0.0))] if force else []
    return bs.Problem(
        of,
        laws=laws or [],
        loads=loads,
        initial=bs.ModalState(velocity=modal_velocity.tolist()),
        duration=DURATION,
    )


@dataclass(frozen=True)
class Motion:
    """The physical equations as ``z' = A z + b``, z = (u, u')."""

    matrix: Array
    load: Array

    def after(self, start: Array, time: float) -> Array:
        rest = np.linalg.solve(self.matrix, -self.load)
        after: Array = rest + expm(self.matrix * time) @ (start - rest)
        return after


def motion(
    velocity_matrix: Array,
    stop: float = 0.0,
    force: float = 0.0,
    circulatory: Array | None = None,
) -> Motion:
    stiffness = STIFFNESS.copy() if circulatory is None else STIFFNESS + circulatory
    load = np.array([0.0, 0.0, force])
    stiffness[2, 2] += stop
    load[2] -= stop * GAP  # the stop pushes by -k (u + gap) along +x
    zero, one = np.zeros((3, 3)), np.eye(3)
    inverse = np.linalg.inv(MASS)
    matrix = np.block([[zero, one], [-inverse @ stiffness, -inverse @ velocity_matrix]])
    return Motion(matrix, np.concatenate([np.zeros(3), inverse @ load]))


def with_stop(flight: Motion, contact: Motion) -> Callable[[float], Array]:
    """Return the motion against the stop, its events found by scanning and bisection."""
    state = np.concatenate([np.zeros(3), VELOCITY])
    pieces, begun = [(0.0, state, flight)], 0.0
    step = 2e-4
    while begun < DURATION:
        _, state, present = pieces[-1]

        def distance(time: float, state: Array = state, present: Motion = present) -> float:
            return float(present.after(state, time)[2] + GAP)

        times = np.arange(step, DURATION - begun + step, step)
        signs = np.array([distance(time) > 0 for time in times])
        changed = np.flatnonzero(signs != (present is flight))
        if not len(changed):
            break
        end = times[changed[0]]
        found = brentq(distance, end - step if changed[0] else 0.5 * step, end, xtol=1e-16)
        begun += found
        pieces.append(
            (begun, present.after(state, found), contact if present is flight else flight)
        )

    def at(time: float) -> Array:
        start, state, present = next(piece for piece in reversed(pieces) if piece[0] <= time)
        after: Array = present.after(state, time - start)
        return after

    return at


@pytest.mark.parametrize("velocity_matrix", [DAMPER, SKEW, DAMPER + SKEW], ids=["C", "G", "C+G"])
def test_free_vibration_is_that_of_the_matrices(velocity_matrix: Array) -> None:
    symmetric = 0.5 * (velocity_matrix + velocity_matrix.T)
    of = basis(damping=symmetric, skew=velocity_matrix - symmetric)
    assert of.couples
    response = bs.simulate(problem(of, force=100.0))
    exact = motion(velocity_matrix, force=100.0)
    start = np.concatenate([np.zeros(3), VELOCITY])
    times = np.linspace(0.0, DURATION, 41)
    wanted = np.array([exact.after(start, time) for time in times])
    sampled = response.at(times)
    for column, (node, dof) in enumerate(DOFS):
        found = sampled.displacement(node, dof)
        np.testing.assert_allclose(found, wanted[:, column], atol=1e-12 * np.abs(wanted).max())
        speed = sampled.velocity(node, dof)
        np.testing.assert_allclose(speed, wanted[:, 3 + column], rtol=0, atol=1e-11)
        push = sampled.acceleration(node, dof)
        rate = wanted @ exact.matrix.T + exact.load
        np.testing.assert_allclose(push, rate[:, 3 + column], rtol=0, atol=1e-9)
    assert response.energy_residual < 1e-12


def test_contact_of_coupled_modes() -> None:
    of = basis(damping=DAMPER, skew=SKEW)
    stop = bs.Stop("wall", node="R", normal=(1, 0, 0), gap=GAP, stiffness=STOP_STIFFNESS)
    response = bs.simulate(problem(of, laws=[stop]))
    exact = with_stop(motion(DAMPER + SKEW), motion(DAMPER + SKEW, stop=STOP_STIFFNESS))
    times = np.linspace(0.0, DURATION, 101)
    wanted = np.array([exact(time)[2] for time in times])
    found = response.at(times).displacement("R", "dx")
    assert len(response.impact_table()["start"]) >= 3
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-9 * np.abs(wanted).max())
    assert response.energy_residual < 1e-11


def test_skew_forces_alone_dissipate_nothing() -> None:
    response = bs.simulate(problem(basis(skew=SKEW)))
    energy = response.energy
    assert float(np.abs(energy["dissipated_damping"]).max()) < 1e-13 * float(
        energy["kinetic"].max()
    )


def test_free_rotor_turns_on_its_own_circle() -> None:
    """A free mass under a gyroscopic force alone: u'' = w x u' is a circle."""
    free = bs.Matrices(
        stiffness=np.zeros((2, 2)),
        mass=np.eye(2),
        gyroscopic=np.array([[0.0, 3.0], [-3.0, 0.0]]),
        dofs=[("P", "dx"), ("P", "dy")],
    )
    of = bs.ModalBasis.from_structure(free, modes="all", rigid_modes=2)
    state = bs.ModalState(velocity=of.project_field(np.array([1.0, 0.0])).tolist())
    response = bs.simulate(bs.Problem(of, initial=state, duration=2.0))
    times = np.linspace(0.0, 2.0, 21)
    np.testing.assert_allclose(
        response.at(times).displacement("P", "dx"), np.sin(3 * times) / 3, atol=1e-12
    )
    pulled = bs.Problem(
        of, loads=[bs.NodalForce("f", node="P", force=(1, 0, 0))], initial=state, duration=2.0
    )
    # z' = i w z + f with z = u' as a complex number, w the sense of rotation.
    turn = 3j
    speed = (1.0 + 1.0 / turn) * np.exp(turn * times) - 1.0 / turn
    place = (1.0 + 1.0 / turn) * (np.exp(turn * times) - 1.0) / turn - times / turn
    response = bs.simulate(pulled)
    for dof, part in (("dx", np.real), ("dy", np.imag)):
        sampled = response.at(times)
        np.testing.assert_allclose(sampled.displacement("P", dof), part(place), atol=1e-12)
        np.testing.assert_allclose(sampled.velocity("P", dof), part(speed), atol=1e-12)
    assert response.energy_residual < 1e-11


CIRCULATORY = np.array([[0.0, 900.0, 0.0], [-900.0, 0.0, 300.0], [0.0, -300.0, 0.0]])


def test_circulatory_forces_and_their_work() -> None:
    of = basis(damping=DAMPER, circulatory=CIRCULATORY)
    stop = bs.Stop("wall", node="R", normal=(1, 0, 0), gap=GAP, stiffness=STOP_STIFFNESS)
    response = bs.simulate(problem(of, laws=[stop]))
    flight = motion(DAMPER, circulatory=CIRCULATORY)
    contact = motion(DAMPER, stop=STOP_STIFFNESS, circulatory=CIRCULATORY)
    exact = with_stop(flight, contact)
    times = np.linspace(0.0, DURATION, 2001)
    wanted = np.array([exact(time) for time in times])
    found = response.at(times).displacement("R", "dx")
    np.testing.assert_allclose(found, wanted[:, 2], rtol=0, atol=1e-9 * np.abs(wanted[:, 2]).max())
    power = -np.einsum("ti,ij,tj->t", wanted[:, 3:], CIRCULATORY, wanted[:, :3])
    work = CubicSpline(times, power).integrate(0.0, DURATION)
    energy = response.energy
    assert float(energy["circulatory_work"][-1]) == pytest.approx(float(work), rel=1e-4)
    assert abs(float(work)) > 1e-4 * float(energy["total_initial"][0])
    assert response.energy_residual < 1e-12


def test_a_growing_motion_is_paid_for_by_circulatory_forces() -> None:
    response = bs.simulate(problem(basis(circulatory=20.0 * CIRCULATORY)))
    energy = response.energy
    assert float(energy["total"][-1]) > 2.0 * float(energy["total"][0])
    given = energy["total_initial"] + energy["circulatory_work"]
    np.testing.assert_allclose(energy["total"], given, rtol=1e-11)
    assert response.energy_residual < 1e-12


@pytest.mark.parametrize("stops", [0, 1])
def test_symplectic_euler_tends_to_the_exact_motion_of_coupled_modes(stops: int) -> None:
    """To first order, with what dampers take and circulatory forces give."""
    of = basis(damping=DAMPER, skew=SKEW, circulatory=CIRCULATORY)
    stop = bs.Stop("stop", node="R", normal=(1, 0, 0), gap=GAP, stiffness=STOP_STIFFNESS)
    given = problem(of, laws=[stop] * stops)
    exact = bs.simulate(given, "exact")
    times = np.linspace(0.0, DURATION, 101)
    expected = exact.history.motion(times, 0)
    terms = ("dissipated_damping", "circulatory_work")
    known = {term: exact.energy_terms([DURATION])[term][0] for term in terms}
    errors = []
    for dt in (1e-4, 1e-5):
        found = bs.simulate(given, "symplectic_euler", dt=dt)
        apart = np.abs(found.history.motion(times, 0) - expected).max() / np.abs(expected).max()
        energy = found.energy_terms([DURATION])
        lacks = [abs(energy[term][0] / known[term] - 1.0) for term in terms]
        errors.append([apart, *lacks, found.energy_residual])
    assert max(errors[0]) < 0.1
    assert (np.array(errors[1]) < 0.15 * np.array(errors[0])).all()


def test_the_central_difference_is_refused() -> None:
    for of in (basis(damping=DAMPER), basis(circulatory=SKEW)):
        with pytest.raises(bs.InputError, match="method: does not take modes that damping"):
            bs.simulate(problem(of), method="central_difference", dt=1e-5)


def test_pairs_that_only_dampers_couple_are_told_apart() -> None:
    stiffness = np.diag([1e4, 3e4, 2e4, 6e4])
    damping = np.zeros((4, 4))
    damping[:2, :2] = [[8.0, -6.0], [-6.0, 9.0]]
    damping[2:, 2:] = [[20.0, 5.0], [5.0, 4.0]]
    model = bs.Matrices(
        stiffness=stiffness,
        mass=np.eye(4),
        damping=damping,
        dofs=[(node, "dx") for node in "PQRS"],
    )
    of = bs.ModalBasis.from_structure(model, modes="all")
    start = np.array([0.3, -0.2, 0.5, 0.4])
    velocity = of.project_field(start).tolist()
    response = bs.simulate(
        bs.Problem(of, initial=bs.ModalState(velocity=velocity), duration=DURATION)
    )
    whole = np.block([[np.zeros((4, 4)), np.eye(4)], [-stiffness, -damping]])
    time = 0.37 * DURATION
    expected = (expm(whole * time) @ np.concatenate([np.zeros(4), start]))[:4]
    found = [float(response.at([time]).displacement(node, "dx")[0]) for node in "PQRS"]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14)
