"""Motions of the supports."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

import bumpstop as bs


def mast(*, damping: bool = False) -> bs.ModalBasis:
    """Two masses on a chain of springs along x, held at its foot; with dampers beside these."""
    dampers = (6.0, 2.0) if damping else (0.0, 0.0)
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0), "C": (2, 0, 0)},
        masses=[bs.PointMass("b", node="B", mass=2.0), bs.PointMass("c", node="C", mass=1.0)],
        springs=[
            bs.Spring("low", node="B", other="A", stiffness=800.0, damping=dampers[0]),
            bs.Spring("high", node="C", other="B", stiffness=300.0, damping=dampers[1]),
        ],
        supports=[
            bs.Support(nodes=["A"], fixed=["dx", "dy", "dz"]),
            bs.Support(nodes=["B", "C"], fixed=["dy", "dz"]),
        ],
    )
    return bs.ModalBasis.from_structure(structure, modes=2, damping=0.0 if damping else 0.02)


def test_modal_forces_are_participation_factors() -> None:
    basis = mast()
    shapes = np.array([basis.row(node, "dx") for node in ("B", "C")])
    expected = -3.0 * shapes.T @ np.array([2.0, 1.0])
    motion = bs.BaseMotion(acceleration=(3.0, 7.0, 0.0))
    np.testing.assert_allclose(motion.modal_force(basis), expected, rtol=1e-12)


def test_a_shaken_chain_follows_its_frequency_response() -> None:
    """After the free motion has died out, against the direct solution on the dofs."""
    basis = mast()
    wave = bs.Harmonic(2.0, cosine=1.0, sine=-0.5)
    shake = bs.BaseMotion(acceleration=(0.7, 0, 0), time=wave)
    response = bs.simulate(bs.Problem(basis, loads=[shake], duration=200.0))
    stiffness = np.array([[1100.0, -300.0], [-300.0, 300.0]])
    mass = np.diag([2.0, 1.0])
    omega = 4.0 * np.pi
    shapes = np.array([basis.row(node, "dx") for node in ("B", "C")])
    damping = mass @ shapes @ np.diag(basis.damping) @ shapes.T @ mass
    dynamic = stiffness + 1j * omega * damping - omega**2 * mass
    amplitude = np.linalg.solve(dynamic, -mass @ np.ones(2) * 0.7 * (1.0 + 0.5j))
    times = np.linspace(199.0, 200.0, 41)
    for number, node in enumerate(("B", "C")):
        found = response.at(times).displacement(node, "dx").to_numpy()
        expected = (amplitude[number] * np.exp(1j * omega * times)).real
        np.testing.assert_allclose(found, expected, atol=1e-11 * abs(amplitude).max())


def test_masses_are_needed() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[3.0], shapes={("P", "dx"): [1.0]})
    with pytest.raises(bs.InputError, match=r"loads\.base_motion\.acceleration: needs the masses"):
        bs.Problem(basis, loads=[bs.BaseMotion(acceleration=(1, 0, 0))], duration=1.0)


def table() -> bs.TimeTable:
    times = np.linspace(0.0, 2.0, 21)
    return bs.TimeTable(times, np.sin(5 * times) * np.exp(-times), beyond="hold")


WAVES = [bs.Harmonic(2.2, sine=1.0), bs.Harmonic(5.1, cosine=0.4), bs.Polynomial([0.1, 0.0, 0.3])]


@pytest.mark.parametrize("time", [WAVES, [table()], [*WAVES, table()], None])
def test_what_moves_from_rest_has_its_acceleration(time: Any) -> None:
    """Displacement and velocity of the base, by quadrature of its acceleration."""
    motion = bs.BaseMotion(acceleration=(1.0, 0, 0), time=time).travel(2.0)
    times = np.linspace(0.0, 2.0, 20_001)
    acceleration = motion.at(times, 2)
    if time is not None:
        np.testing.assert_allclose(acceleration[:-1], sum(f.at(times[:-1]) for f in time))
    velocity = cumulative_simpson(acceleration, x=times, initial=0.0)
    np.testing.assert_allclose(motion.at(times, 1), velocity, atol=2e-6)
    displacement = cumulative_simpson(motion.at(times, 1), x=times, initial=0.0)
    np.testing.assert_allclose(motion.at(times), displacement, atol=1e-12)


def test_a_displacement_and_its_acceleration_are_one_motion() -> None:
    """Cubics of t and a wave whose phase leaves the base at rest at the start."""
    wave, omega = bs.Harmonic(3.0, cosine=-1.0), 6 * np.pi
    placed = bs.BaseMotion(
        displacement=(1e-3, 0, 0), time=[wave, bs.Polynomial([1.0, 0, 0, 2.0])], frame="absolute"
    )
    pushed = bs.BaseMotion(
        acceleration=(1e-3, 0, 0),
        time=[bs.Harmonic(3.0, cosine=omega**2), bs.Polynomial([0, 12.0])],
        frame="absolute",
    )
    found = [
        bs.simulate(bs.Problem(mast(), loads=[load], duration=2.0)).sample(
            "displacement", "C", "dx"
        )
        for load in (placed, pushed)
    ]
    np.testing.assert_allclose(found[0], found[1], atol=1e-15)


@pytest.mark.parametrize("wall", [None, "relative", "absolute"])
def test_absolute_motion_is_that_under_imposed_displacements(wall: str | None) -> None:
    """The same chain with its foot pulled by k d + c d', and walls in space or on the foot."""
    wave, omega = bs.Harmonic(1.7, sine=1.0, cosine=0.5), 2 * np.pi * 1.7
    stop: dict[str, Any] = {"node": "C", "normal": (-1, 0, 0), "gap": 4e-3, "stiffness": 5e4}
    moved = bs.BaseMotion(displacement=(3e-3, 0, 0), time=wave, frame="absolute")
    laws = [] if wall is None else [bs.Stop("wall", frame=wall, damping=20.0, **stop)]
    start = bs.ModalState(displacement=[1e-3, 0.0], velocity=[0.0, 0.02])
    damped = mast(damping=True)
    seen = bs.simulate(bs.Problem(damped, laws=laws, loads=[moved], initial=start, duration=3.0))
    pull = bs.NodalForce(
        "pull",
        node="B",
        force=(3e-3, 0, 0),
        time=bs.Harmonic(1.7, sine=800.0 - 0.5 * 6.0 * omega, cosine=400.0 + 6.0 * omega),
    )
    if wall == "relative":
        away = bs.Harmonic(1.7, sine=-3e-3, cosine=-1.5e-3)
        laws = [bs.Stop("wall", motion=away, damping=20.0, **stop)]
    elif wall == "absolute":
        laws = [bs.Stop("wall", damping=20.0, **stop)]
    # The state at the start, seen from the ground.
    assert damped.model is not None
    rigid = damped.project_field(damped.model.rigid_field(translation=(1.0, 0, 0)))
    displacement, velocity = start.modal_state(damped)
    absolute = bs.ModalState(
        displacement=displacement + 1.5e-3 * rigid, velocity=velocity + 3e-3 * omega * rigid
    )
    direct = bs.simulate(
        bs.Problem(damped, laws=laws, loads=[pull], initial=absolute, duration=3.0)
    )
    for node in ("B", "C"):
        for quantity in ("displacement", "velocity", "acceleration"):
            one, other = (each.sample(quantity, node, "dx") for each in (seen, direct))
            np.testing.assert_allclose(one, other, atol=2e-13 * np.abs(other).max())
    assert seen.history.event_count == direct.history.event_count
    assert (seen.history.event_count > 4) == (wall is not None)
    if wall is not None:
        one, other = (each.sample("stop_force", "wall") for each in (seen, direct))
        np.testing.assert_allclose(one, other, atol=1e-11 * other.max())
    np.testing.assert_allclose(seen.sample("displacement", "A", "dx"), 3e-3 * wave.at(seen.times))


def test_relative_results_stay_what_they_were() -> None:
    waves = bs.Harmonic(2.0, sine=3.0)
    found = [
        bs.simulate(
            bs.Problem(
                mast(),
                loads=[bs.BaseMotion(acceleration=(1.0, 0, 0), time=waves, frame=frame)],
                duration=2.0,
            )
        )
        for frame in ("relative", "absolute")
    ]
    assert found[0].motion().tobytes() == found[1].motion().tobytes()
    relative, absolute = (each.sample("displacement", "C", "dx") for each in found)
    carried = absolute - relative
    t, omega = found[0].times, 4 * np.pi
    np.testing.assert_allclose(carried, 3 * (t / omega - np.sin(omega * t) / omega**2), atol=1e-15)
    assert not found[0].sample("displacement", "A", "dx").any()


@pytest.mark.parametrize(
    ("options", "key", "what"),
    [
        ({}, "acceleration", "or a displacement, and not both"),
        ({"acceleration": (1, 0, 0), "displacement": (1, 0, 0)}, "acceleration", "not both"),
        ({"displacement": (1, 0, 0)}, "time", "must say how the displacement changes"),
        ({"acceleration": (1, 0, 0), "frame": "ground"}, "frame", "known: relative, absolute"),
        (
            {"displacement": (1, 0, 0), "time": table(), "frame": "absolute"},
            "loads.base_motion.time",
            "give the acceleration",
        ),
        (
            {
                "acceleration": (1, 0, 0),
                "time": bs.Polynomial([0] * 4 + [1]),
                "frame": "absolute",
            },
            "loads.base_motion.polynomial",
            "degree 3 at most",
        ),
    ],
)
def test_mistakes_of_motions_are_one_line(options: dict[str, Any], key: str, what: str) -> None:
    with pytest.raises(bs.InputError, match=what) as caught:
        bs.Problem(mast(), loads=[bs.BaseMotion(**options)], duration=1.0)
    assert caught.value.key == key
