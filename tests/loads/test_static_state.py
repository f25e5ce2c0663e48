"""States of equilibrium, against closed forms and the complementarity of SciPy's optimiser."""

from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

import bumpstop as bs

LENGTH = 1.2
STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.25, density=7800.0)
BAR = bs.Rectangle(height=0.03, width=0.02)
BENDING = 210e9 * 0.02 * 0.03**3 / 12


def cantilever(modes: int | str = "all") -> bs.ModalBasis:
    """Bending in the plane xy."""
    beam = bs.Beam(
        "AB", nodes=("A", "B"), elements=4, material=STEEL, section=BAR, theory="euler_bernoulli"
    )
    model = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)},
        beams=[beam],
        supports=[
            bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry")),
            bs.Support(nodes="A", fixed=("dy", "drz")),
        ],
    )
    return bs.ModalBasis.from_structure(model, modes=modes, damping=0.01)


PUSH = bs.NodalForce("push", node="B", force=(0, -500.0, 0))
STOP = bs.Stop("wall", node="B", normal=(0, 1, 0), gap=2e-3, stiffness=2e5)


def test_a_beam_pushed_onto_its_stop_and_let_go() -> None:
    basis = cantilever()
    held = bs.StaticState(loads=[PUSH], laws=[STOP])
    response = bs.simulate(bs.Problem(basis, laws=[STOP], initial=held, duration=0.05))
    stiffness = 3 * BENDING / LENGTH**3
    tip = -(500.0 + 2e5 * 2e-3) / (stiffness + 2e5)
    found, force = (
        response.sample(*target, times=[0.0])[0]
        for target in (("displacement", "B", "dy"), ("stop_force", "wall"))
    )
    assert found == pytest.approx(tip, rel=1e-10)
    assert force == pytest.approx(-2e5 * (tip + 2e-3))
    assert abs(response.sample("velocity", "B", "dy", times=[0.0])[0]) < 1e-15
    assert response.sample("displacement", "B", "dy").max() > 0.0  # thrown off
    assert response.energy_residual < 1e-12


def test_what_is_held_stays_at_rest() -> None:
    basis = cantilever(3)
    weight = bs.Gravity("weight", acceleration=(0, -9.81, 0))
    held = bs.StaticState(loads=[PUSH, weight], laws=[STOP])
    problem = bs.Problem(basis, laws=[STOP], loads=[PUSH, weight], initial=held, duration=0.5)
    response = bs.simulate(problem)
    motion = response.motion()
    assert np.abs(motion - motion[0]).max() < 1e-12 * np.abs(motion[0]).max()
    assert response.event_count == 0


@pytest.mark.parametrize("seed", range(8))
def test_the_least_of_the_potential_energy(seed: int) -> None:
    """Random structures with springs of several slopes and stops, by an optimiser."""
    rng = np.random.default_rng(seed)
    modes = 4
    shapes: Any = {("P", f"d{axis}"): rng.normal(size=modes).tolist() for axis in "xyz"}
    shapes |= {("Q", "dx"): rng.normal(size=modes).tolist()}
    frequency = [0.0 if seed % 2 else 0.3, 1.0, 2.0, 5.0]
    basis = bs.ModalBasis.from_modes(frequency=frequency, shapes=shapes)
    laws: list[Any] = [
        bs.Stop("x", node="P", normal=(1, 0, 0), gap=0.1, stiffness=300.0),
        bs.Stop("-x", node="P", normal=(-1, 0, 0), gap=0.05, stiffness=900.0),
        bs.Stop("y", node="P", normal=(0, 1, 0), gap=-0.02, stiffness=100.0),
        bs.SpringLaw(
            "q", node="Q", direction=(1, 0, 0), stiffness=(80.0, 5.0, 40.0), breaks=(-0.1, 0.2)
        ),
    ]
    force = rng.normal(size=3) * 20.0
    ramp = bs.Polynomial([2.0, 1.0])
    push = bs.NodalForce("push", node="P", force=tuple(force.tolist()), time=ramp)
    place = bs.StaticState(loads=[push], laws=laws).modal_state(basis)[0]
    rows = {law.name: law.row(basis) for law in laws}
    pushed = 2.0 * sum(f * basis.row("P", f"d{axis}") for f, axis in zip(force, "xyz", strict=True))
    knots = np.linspace(-50.0, 50.0, 2_000_001)
    stored = np.concatenate([[0], np.cumsum(laws[3].force(0.5 * (knots[1:] + knots[:-1])))]) * 5e-5
    stored -= np.interp(0.0, knots, stored)

    def energy(q: np.ndarray) -> float:
        stops = sum(
            0.5 * law.stiffness * min(0.0, law.gap + rows[law.name] @ q) ** 2 for law in laws[:3]
        )
        spring = np.interp(rows["q"] @ q, knots, stored)
        return float(0.5 * q @ (basis.omega2 * q) - pushed @ q + stops + spring)

    options = {"xatol": 1e-9, "fatol": 1e-13, "maxiter": 20000, "maxfev": 20000}
    least = minimize(energy, place + 0.01, method="Nelder-Mead", options=options)
    assert energy(place) <= least.fun + 1e-7 * abs(least.fun)
    left = pushed - basis.omega2 * place
    for law in laws:
        left = left + law.static_force(float(rows[law.name] @ place))[0] * rows[law.name]
    assert np.abs(left).max() < 1e-9 * np.abs(pushed).max()


def free(**options: Any) -> bs.ModalBasis:
    return bs.ModalBasis.from_modes(
        frequency=[0.0, 2.0], shapes={("P", "dx"): [1.0, 0.5], ("Q", "dx"): [1.0, -0.7]}, **options
    )


def test_a_free_structure_leans_on_a_stop() -> None:
    """A body pushed against a wall from 3 m away: all of the force goes through the wall."""
    push = bs.NodalForce("push", node="P", force=(-7.0, 0, 0))
    wall = bs.Stop("wall", node="Q", normal=(1, 0, 0), gap=3.0, stiffness=1e5)
    place = bs.StaticState(loads=[push], laws=[wall]).modal_state(free())[0]
    row = wall.row(free())
    assert -1e5 * (3.0 + row @ place) == pytest.approx(7.0, rel=1e-9)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_what_nothing_holds_is_refused(direction: float) -> None:
    push = bs.NodalForce("push", node="P", force=(direction, 0, 0))
    wall = bs.Stop("wall", node="Q", normal=(1, 0, 0), gap=3.0, stiffness=1e5)
    laws = [wall] if direction > 0 else []
    state = bs.StaticState(loads=[push], laws=laws)
    with pytest.raises(bs.InputError, match=r"initial\.static: finds no equilibrium"):
        bs.Problem(free(), laws=laws, initial=state, duration=1.0)


def test_laws_without_a_force_at_rest_are_refused() -> None:
    rigid = bs.RigidStop("floor", node="P", normal=(0, 1, 0), restitution=0.5)
    with pytest.raises(bs.InputError, match=r"laws: has no force at rest.*'floor'"):
        bs.StaticState(laws=[rigid])


def test_nodes_with_displacements_and_velocities() -> None:
    basis = cantilever()
    assert basis.model is not None
    state = bs.NodalState(
        displacement={("B", "dy"): 1e-3, ("AB.2", "drz"): -2e-4}, velocity={("AB.1", "dy"): 0.3}
    )
    response = bs.simulate(bs.Problem(basis, initial=state, duration=1e-3))
    for node, dof, place, speed in (
        ("B", "dy", 1e-3, 0.0),
        ("AB.2", "drz", -2e-4, 0.0),
        ("AB.1", "dy", 0.0, 0.3),
        ("B", "drz", 0.0, 0.0),
    ):
        for quantity, value in (("displacement", place), ("velocity", speed)):
            found = response.sample(quantity, node, dof, times=[0.0])[0]
            assert found == pytest.approx(value, abs=1e-12)
    assert state.remarks(basis) == ()
    again = bs.NodalState(velocity=state._field("velocity", basis))
    assert again.modal_state(basis)[1].tobytes() == state.modal_state(basis)[1].tobytes()
    lines = state.remarks(cantilever(2))
    assert len(lines) == 2
    assert "of the initial displacement is lost" in lines[0]


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({"displacement": {("X", "dy"): 1.0}}, "unknown node"),
        ({"velocity": {("A", "dy"): 1.0}}, "is held at zero.*A dy"),
        ({"velocity": {("AB@0.1", "dy"): 1.0}}, "at a node of the mesh"),
        ({"velocity": [1.0, 2.0]}, "for each of the 30 dofs"),
        ({"velocity": {("B", "dy"): float("nan")}}, "must be finite"),
    ],
)
def test_mistakes_of_nodal_states_are_one_line(options: dict[str, Any], what: str) -> None:
    with pytest.raises(bs.InputError, match=what):
        bs.NodalState(**options).modal_state(cantilever())


@pytest.mark.parametrize("held", [True, False])
@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_full_models_rest_where_all_modes_do(mass: str, held: bool) -> None:
    """Pressed against two stops; hinged and carried by a spring where it is not held."""
    fixed = ("dx", "dz", "drx", "dry", *(("dy", "drz") if held else ()))
    beam = bs.Beam("AB", nodes=("A", "B"), elements=6, material=STEEL, section=BAR)
    model = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)},
        beams=[beam],
        supports=[
            bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry")),
            bs.Support(nodes="A", fixed=fixed),
        ],
    )
    middle = bs.Stop("middle", node="AB.3", normal=(0, 1, 0), gap=3e-4, stiffness=3e5)
    foot = bs.SpringLaw("foot", node="A", direction=(0, 1, 0), stiffness=(2e5, 2e5), breaks=(0.0,))
    laws: list[Any] = [STOP, middle, *([] if held else [foot])]
    weight = bs.Gravity("weight", acceleration=(0, -9.81, 0))
    loads = [PUSH, *([weight] if mass == "consistent" else [])]
    full = bs.FullModel.from_structure(model, mass=mass)
    state = bs.StaticState(loads=loads, laws=laws)
    basis = bs.ModalBasis.from_structure(model, modes="all")
    expected = basis.shapes @ state.modal_state(basis)[0]
    found = full.shapes @ state.modal_state(full)[0]
    assert np.abs(found - expected).max() < 1e-12 * np.abs(expected).max()
    # With all its loads, lumped weight too, it stays where it is.
    state = bs.StaticState(loads=[PUSH, weight], laws=laws)
    problem = bs.Problem(full, laws=laws, loads=[PUSH, weight], initial=state, duration=2e-3)
    method, dt = ("newmark", 1e-5) if mass == "consistent" else ("central_difference", 5e-7)
    motion = bs.simulate(problem, method, dt=dt).motion()
    assert np.abs(motion - motion[0]).max() < 1e-11 * np.abs(motion).max()


def test_a_full_model_that_nothing_holds_or_pushes() -> None:
    point = bs.Structure(
        nodes={"P": (0, 0, 0)},
        masses=[bs.PointMass("m", node="P", mass=4.0)],
        supports=[bs.Support(nodes="P", fixed=("dy", "dz", "drx", "dry", "drz"))],
    )
    full = bs.FullModel.from_structure(point)
    assert not bs.StaticState().modal_state(full)[0].any()
    push = bs.NodalForce("push", node="P", force=(1.0, 0, 0))
    with pytest.raises(bs.InputError, match="finds no equilibrium"):
        bs.StaticState(loads=[push]).modal_state(full)
    wall = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=500.0)
    place = bs.StaticState(loads=[push], laws=[wall]).modal_state(full)[0]
    assert place == pytest.approx([1e-3 + 1.0 / 500.0], rel=1e-12)
