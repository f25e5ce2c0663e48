"""Forces and stresses of full models: held to all modes, solved exactly, and to equilibrium."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import bumpstop as bs
from bumpstop import full
from bumpstop.arguments import FloatArray
from bumpstop.modal import full as full_model
from bumpstop.problem import Load

STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
TUBE = bs.Tube(outer_radius=0.01, thickness=0.001)
ALL = ("dx", "dy", "dz", "drx", "dry", "drz")
DURATION = 0.02
STOP = bs.Stop("stop", node="B", normal=(0, -1, 0), gap=1e-4, stiffness=4e4, damping=3.0)
WAVE = bs.Harmonic(25.0, sine=1.0)
LOADS: list[Load] = [
    bs.NodalForce("push", node="B", force=(0, 40, 15), time=WAVE),
    bs.Gravity("weight", acceleration=(1.0, -3.0, -9.81)),
    bs.LineForce("wind", beam="AM", force=(0, 7.0, 12.0), time=WAVE),
    bs.BaseMotion(acceleration=(0, 6.0, 6.0), time=WAVE, frame="absolute"),
    bs.SupportMotion("lifted", nodes="A", displacement=(0, 5e-5, 1e-4), time=WAVE),
    bs.MovingForce("rolling", beam="MB", force=(0, 9.0, -20.0), speed=20.0),
]


def cantilever() -> bs.Structure:
    """Return a tube of 1 m along x, clamped at A, with a damper to the ground at its middle."""
    halves = [
        bs.Beam(f"{a}{b}", nodes=(a, b), elements=3, material=STEEL, section=TUBE)
        for a, b in ("AM", "MB")
    ]
    dashpot = bs.Spring("dashpot", node="M", stiffness=6 * (0,), damping=(0, 8.0, 0, 0, 0, 0))
    return bs.Structure(
        nodes={"A": (0, 0, 0), "M": (0.5, 0, 0), "B": (1, 0, 0)},
        beams=halves,
        springs=[dashpot],
        supports=[bs.Support(nodes="A", fixed=ALL)],
    )


def read(basis: bs.ModalBasis, loads: list[Load], method: str, dt: float | None) -> bs.Recovery:
    """Return the recovery of a run, at instants that are ends of its steps."""
    problem = bs.Problem(basis, laws=[STOP], loads=loads, duration=DURATION)
    run = bs.simulate(problem, method) if dt is None else bs.simulate(problem, method, dt=dt)
    return bs.recovery(run.at(np.arange(201) * 1e-4))


def readings(found: bs.Recovery) -> dict[str, FloatArray]:
    """Return moments, a shear force, a stress, reactions and a deflection, over time."""
    moments = found.section_forces("AM", [0.0, 0.21])
    return {
        "My": moments.My.values,
        "Mz": moments.Mz.values,
        "stress": found.stress("AM", 0.1, (0.006, 0.008)).values,
        "reaction": found.reactions("A")["dry"].values,
        "deflection": found.displacement("MB@0.4", "dz").values,
    }


@pytest.mark.parametrize("load", LOADS, ids=lambda load: type(load).__name__)
def test_readings_are_those_of_all_modes(load: Load) -> None:
    """What is left of the step is in modes that are faster than it."""
    structure = cantilever()
    basis = bs.ModalBasis.from_structure(structure, modes=bs.AllModes(), damping=0.05)
    exact = readings(read(basis, [load], "exact", None))
    model = bs.FullModel.from_structure(structure, damping=0.05)
    found = readings(read(model, [load], "newmark", 5e-6))
    for name, values in exact.items():
        assert np.abs(found[name] - values).max() < 2e-3 * np.abs(values).max(), name


def test_moments_bend_between_the_nodes() -> None:
    """Under a load along the beam moments are parabolas, q h^2 / 8 above their chords."""
    model = bs.FullModel.from_structure(cantilever(), mass="lumped")
    found = read(model, LOADS[2:3], "newmark", 1e-5)
    places = np.array([1.2, 1.5, 1.8]) * 0.5 / 3.0
    first, middle, last = found.section_forces("AM", places.tolist()).My.values.T
    wind = 12.0 * WAVE.at(found.response.times)
    bow = wind * (places[2] - places[0]) ** 2 / 8.0
    assert np.allclose(np.abs(middle - 0.5 * (first + last)), np.abs(bow), rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("mass", ["consistent", "lumped"])
@pytest.mark.parametrize("sparse", [False, True])
def test_every_free_dof_is_in_equilibrium_at_every_step(
    mass: str, sparse: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if sparse:
        monkeypatch.setattr(full_model, "MOST_DENSE", 0)
    damping = bs.RayleighDamping(alpha=2.0, beta=1e-6)
    model = bs.FullModel.from_structure(cantilever(), damping=damping, mass=mass)
    found = read(model, LOADS, "newmark", 1e-5)
    free = found.forces.model.free
    lacking = found.lacking(found.response.times)
    assert np.abs(lacking[free]).max() < 1e-11 * np.abs(lacking).max()
    sums = found.resultants()
    assert np.abs(sums.residual).max() < 1e-11 * np.abs(sums.reaction).max()


def test_between_steps_equilibrium_lacks_what_the_method_does() -> None:
    model = bs.FullModel.from_structure(cantilever())
    problem = bs.Problem(model, laws=[STOP], loads=LOADS[:1], duration=DURATION)
    run = bs.simulate(problem, "newmark", dt=1e-5).at((np.arange(2000) + 0.5) * 1e-5)
    sums = bs.recovery(run).resultants()
    assert 1e-11 < np.abs(sums.residual).max() / np.abs(sums.reaction).max() < 1e-2


def test_lumped_masses_hang_on_their_nodes() -> None:
    """Between nodes nothing pulls: moments of a weight are straight there, and it is whole."""
    model = bs.FullModel.from_structure(cantilever(), mass="lumped")
    found = read(model, LOADS[1:2], "central_difference", 5e-7)
    weight = -9.81 * STEEL.density * TUBE.area
    assert found.resultants()["load"].sel(dof="dz").values == pytest.approx(weight, rel=1e-12)
    places = np.array([1.2, 1.5, 1.8]) * 0.5 / 3.0
    first, middle, last = found.section_forces("AM", places.tolist()).My.values.T
    assert np.allclose(middle, 0.5 * (first + last), rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_supports_that_all_move_alike_are_a_base(mass: str) -> None:
    """Its masses are the run's own, so that either load tells the same of it, to rounding."""
    model = bs.FullModel.from_structure(cantilever(), mass=mass)
    structure = replace(cantilever(), springs=[])  # the dashpot's ground would move, too
    model = bs.FullModel.from_structure(structure, mass=mass)
    method, dt = ("newmark", 1e-5) if mass == "consistent" else ("central_difference", 5e-7)
    size = (0.0, 5e-5, 1e-4)
    loads: list[Load] = [
        bs.BaseMotion(displacement=size, time=WAVE, frame="absolute"),
        bs.SupportMotion("lifted", nodes="A", displacement=size, time=WAVE),
    ]
    runs = [
        bs.simulate(bs.Problem(model, loads=[load], duration=DURATION), method, dt=dt)
        for load in loads
    ]
    base, supports = (bs.recovery(run.at(np.arange(201) * 1e-4)) for run in runs)
    for dof in ("dy", "dz"):
        expected = base.displacement("B", dof).values
        found = supports.displacement("B", dof).values
        assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()
    sums = supports.resultants()
    assert np.abs(sums.residual).max() < 1e-9 * np.abs(sums.reaction).max()


def test_runs_that_kept_a_few_dofs_say_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(full, "KEPT", 0)
    model = bs.FullModel.from_structure(cantilever())
    run = bs.simulate(bs.Problem(model, laws=[STOP], duration=1e-3), "newmark", dt=1e-5)
    with pytest.raises(bs.InputError, match="motion of all dofs"):
        bs.recovery(run)
    with pytest.raises(bs.InputError, match="motion of all dofs"):
        bs.periodicity(run, 1e-4)
