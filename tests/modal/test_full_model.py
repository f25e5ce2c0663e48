"""A structure on its own dofs, against all its modes, solved exactly, and closed forms."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

import bumpstop as bs
from bumpstop import full
from bumpstop.structure.lumped import lumped_mass

IMPLICIT = ("newmark", "hht", "generalized_alpha")
DURATION = 0.015
TIMES = np.linspace(0.0, DURATION, 151)
ALLOY = bs.Material(young_modulus=67e9, poisson_ratio=0.0, density=2400.0)


def beam(elements: int = 6) -> bs.Structure:
    """Return a hinged beam that bends in one plane."""
    bar = bs.Beam(
        "AB",
        nodes=("A", "B"),
        elements=elements,
        material=ALLOY,
        section=bs.Rectangle(height=0.014, width=0.014),
    )
    return bs.Structure(
        nodes={"A": (0, 0, 0), "B": (0.783, 0, 0)},
        beams=[bar],
        supports=[
            bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry")),
            bs.Support(nodes=("A",), fixed=("dy",)),
        ],
    )


def swung(basis: bs.ModalBasis, *laws: Any, **more: Any) -> bs.Problem:
    """Return the beam that swings onto its stop."""
    stop = bs.Stop("stop", node="B", normal=(0, 1, 0), gap=0.0, stiffness=45e3)
    start: dict[str, Any] = {"initial": bs.RigidRotation(about="A", rate=(0, 0, -3.8))}
    return bs.Problem(basis, laws=laws or [stop], duration=DURATION, **(start | more))


def differences(found: bs.Response, exact: bs.Response) -> tuple[float, float]:
    """Return the largest differences of the tip and of the stop's force, over the largest."""
    pairs = [("displacement", "B", "dy"), ("stop_force", "stop")]
    errors = []
    for quantity, *target in pairs:
        true = exact.sample(quantity, *target, times=TIMES)
        other = found.sample(quantity, *target, times=TIMES)
        errors.append(np.abs(other - true).max() / np.abs(true).max())
    return errors[0], errors[1]


def lumped_modes(structure: bs.Structure, ratio: float) -> bs.ModalBasis:
    """Return all modes of the lumped masses, by SciPy's dense eigensolver."""
    mass = structure.reduced(lumped_mass(structure)).to_dense()
    omega2, shapes = eigh(structure.reduced(structure.stiffness).to_dense(), mass)
    omega2[0] = 0.0
    free = [structure.dofs[dof] for dof in structure.free]
    return bs.ModalBasis.from_modes(
        frequency=(np.sqrt(omega2) / (2 * np.pi)).tolist(),
        damping=ratio,
        shapes={dof: row.tolist() for dof, row in zip(free, shapes, strict=True)},
    )


@pytest.mark.parametrize("method", IMPLICIT)
def test_implicit_steps_tend_to_all_modes_at_second_order(method: str) -> None:
    structure = beam()
    exact = bs.simulate(swung(bs.ModalBasis.from_structure(structure, modes="all", damping=0.01)))
    problem = swung(bs.FullModel.from_structure(structure, damping=0.01))
    coarse, fine = (differences(bs.simulate(problem, method, dt=dt), exact) for dt in (8e-6, 4e-6))
    assert max(coarse) < 1e-4
    for before, after in zip(coarse, fine, strict=True):
        assert before / after > 3.5


def test_explicit_steps_tend_to_all_modes_of_the_lumped_masses_at_second_order() -> None:
    structure = beam()
    model = bs.FullModel.from_structure(structure, damping=0.01, mass="lumped")
    problem = swung(model)
    modes = lumped_modes(structure, 0.01)
    mass = model.matrices.mass.to_dense()
    start = modes.shapes.T @ mass @ structure.rigid_field(rotation=(0, 0, -3.8))[structure.free]
    state = bs.ModalState(velocity=start)
    exact = bs.simulate(swung(modes, *problem.laws, initial=state))
    coarse, fine = (
        differences(bs.simulate(problem, "central_difference", dt=dt), exact) for dt in (4e-6, 2e-6)
    )
    assert max(coarse) < 1e-4
    for before, after in zip(coarse, fine, strict=True):
        assert before / after > 3.5


def test_explicit_and_implicit_steps_agree_as_the_mesh_is_refined() -> None:
    def apart(elements: int) -> float:
        structure = beam(elements)
        models = [
            bs.FullModel.from_structure(structure, mass=mass) for mass in ("consistent", "lumped")
        ]
        implicit = bs.simulate(swung(models[0]), "newmark", dt=4e-6)
        explicit = bs.simulate(swung(models[1]), "central_difference", dt=1e-6)
        return differences(explicit, implicit)[0]

    assert apart(16) < 0.35 * apart(8) < 0.35**2 * apart(4) * 1.5


def test_the_stability_limit_is_that_of_the_matrices() -> None:
    structure = beam()
    damping = bs.RayleighDamping(beta=2e-6)
    model = bs.FullModel.from_structure(structure, damping=damping, mass="lumped")
    matrices = [matrix.to_dense() for matrix in model.matrices]
    highest = eigh(matrices[2], matrices[0], eigvals_only=True)[-1]
    chi = 2e-6 * highest
    limit = 2.0 / (chi + np.sqrt(chi**2 + highest))
    free = swung(model, bs.Stop("stop", node="B", normal=(0, 1, 0), gap=1.0, stiffness=1.0))
    bs.simulate(free, "central_difference", dt=0.99 * limit)
    with pytest.raises(bs.InputError, match="above the stability limit of"):
        bs.simulate(free, "central_difference", dt=1.001 * limit)
    with pytest.raises(bs.ComputationError, match=r"the motion blows up: at t = .*smaller step"):
        bs.simulate(free, "central_difference", dt=1.1 * limit, beyond_stability_limit=True)


def test_a_damper_of_a_stop_throws_nothing_back() -> None:
    """Up to c h = 2 m what it stops goes on the way it went; longer steps are refused."""
    support = bs.Support(nodes="P", fixed=("dy", "dz", "drx", "dry", "drz"))
    mass = bs.PointMass("m", node="P", mass=1.0)
    structure = bs.Structure(nodes={"P": (0, 0, 0)}, masses=[mass], supports=[support])
    stop = bs.Stop("stop", node="P", normal=(-1, 0, 0), gap=0.0, stiffness=1.0, damping=1e5)
    start = bs.NodalState(velocity={("P", "dx"): 1.0})
    model = bs.FullModel.from_structure(structure, mass="lumped")
    problem = bs.Problem(model, laws=[stop], initial=start, duration=0.01)
    with pytest.raises(bs.InputError, match="above the stability limit of 2e-05 s"):
        bs.simulate(problem, "central_difference", dt=2e-4)
    run = bs.simulate(problem, "central_difference", dt=1.9e-5)
    way = run.sample("displacement", "P", "dx")
    assert way.min() >= 0.0
    assert way.max() < 2e-5


def test_an_oscillator_under_a_steady_force_goes_as_its_closed_form_says() -> None:
    mass = bs.PointMass("m", node="P", mass=2.0)
    spring = bs.Spring("k", node="P", stiffness=(50, 0, 0, 0, 0, 0))
    support = bs.Support(nodes="P", fixed=("dy", "dz", "drx", "dry", "drz"))
    structure = bs.Structure(
        nodes={"P": (0, 0, 0)}, masses=[mass], springs=[spring], supports=[support]
    )
    push = bs.NodalForce("push", node="P", force=(10.0, 0.0, 0.0))
    for lumping, method in (("consistent", "newmark"), ("lumped", "central_difference")):
        model = bs.FullModel.from_structure(structure, mass=lumping)
        problem = bs.Problem(model, loads=[push], duration=2.0)
        run = bs.simulate(problem, method, dt=1e-3)
        times = run.times
        assert (
            np.abs(run.sample("displacement", "P", "dx") - 0.2 * (1 - np.cos(5 * times))).max()
            < 1e-5
        )
        assert np.abs(run.sample("acceleration", "P", "dx") - 5.0 * np.cos(5 * times)).max() < 1e-3
        energy = run.energy_terms()
        assert np.abs(energy["kinetic"] - np.sin(5 * times) ** 2).max() < 1e-4
        assert np.abs(energy["load_work"] - 2.0 * (1 - np.cos(5 * times))).max() < 1e-4
        assert run.energy_residual < 1e-5


def test_energies_are_those_of_a_modal_run() -> None:
    structure, damping = beam(), bs.RayleighDamping(alpha=3.0, beta=2e-6)
    harmonic = bs.Harmonic(frequency=90.0)
    shake = bs.NodalForce("shake", node="B", force=(0, -40, 0), time=harmonic)
    modal = bs.ModalBasis.from_structure(structure, modes="all", damping=damping)
    stop = bs.Stop("stop", node="B", normal=(0, 1, 0), gap=1e-3, stiffness=45e3, damping=20.0)
    exact = bs.simulate(swung(modal, stop, loads=[shake]))
    full_model = bs.FullModel.from_structure(structure, damping=damping)
    run = bs.simulate(swung(full_model, stop, loads=[shake]), "newmark", dt=2e-6)
    # The damped stop's force jumps at its closing, which a step sees at its end.
    assert run.energy_residual < 1e-3
    true, found = exact.energy_terms(TIMES), run.energy_terms(TIMES)
    scale = true["kinetic"][0]
    for term in ("kinetic", "elastic", "dissipated_damping", "dissipated_stops", "load_work"):
        assert np.abs(found[term] - true[term]).max() < 5e-4 * scale, term
    one, other = (float(each.impact_table()["impulse"][0]) for each in (exact, run))
    assert abs(one - other) < 1e-4 * one


@pytest.mark.parametrize("friction", [None, 0.3])
def test_what_laws_do_is_what_they_do_to_modes(friction: float | None) -> None:
    structure = beam(3)
    rubbing: dict[str, Any] = {
        "friction": friction,
        "sliding": {("B", "drz"): 0.1},
        "tangential_stiffness": 1e4,
    }
    stop = bs.Stop(
        "stop",
        node="B",
        normal=(0, 1, 0),
        stiffness=45e3,
        **(rubbing if friction is not None else {}),
    )
    spring = bs.SpringLaw("k", node="B", direction=(0, 1, 0), stiffness=(0.0, 2e4), breaks=(0.0,))
    modal = bs.ModalBasis.from_structure(structure, modes="all")
    exact = bs.simulate(swung(modal, stop, spring))
    problem = swung(bs.FullModel.from_structure(structure), stop, spring)
    assert max(differences(bs.simulate(problem, "newmark", dt=1e-6), exact)) < 1e-3


def test_only_what_is_named_is_kept_where_memory_is_short(monkeypatch: pytest.MonkeyPatch) -> None:
    model = bs.FullModel.from_structure(beam())
    gauge = bs.Gauge("g", beam="AB", at=0.4, fibre=(0.007, 0.0))
    problem = swung(model, gauges=[gauge], outputs=[("AB.3", "dy")])
    whole = bs.simulate(problem, "newmark", dt=1e-5)
    monkeypatch.setattr(full, "KEPT", 0)
    part = bs.simulate(problem, "newmark", dt=1e-5)
    assert part.kept is not None
    assert len(part.kept) < len(model.omega2)
    for target in (("displacement", "B", "dy"), ("gauge", "g"), ("stop_force", "stop")):
        assert np.array_equal(part.sample(*target), whole.sample(*target))
    assert part.energy_residual == whole.energy_residual
    with pytest.raises(bs.InputError, match="was not kept"):
        part.sample("displacement", "AB.1", "dy")
    with pytest.raises(bs.InputError, match="are not kept"):
        part.sample("modal_displacement")


def refused(method: str, **options: Any) -> Callable[[bs.ModalBasis], bs.Response]:
    """Return what runs a model by a method that it cannot be run by."""
    return lambda model: bs.simulate(swung(model), method, **options)


@pytest.mark.parametrize(
    ("run", "told"),
    [
        (refused("exact"), "does not take a full model"),
        (refused("dop853"), "does not take a full model"),
        (refused("trbdf2", dt=1e-5), "does not take a full model"),
        (refused("newmark"), "needs a step in s"),
        (refused("central_difference", dt=1e-6), "needs a diagonal mass matrix"),
        (refused("newmark", dt=1e-3, beta=0.0), "above the stability limit"),
    ],
)
def test_what_cannot_be_is_refused(run: Callable[[bs.ModalBasis], bs.Response], told: str) -> None:
    model = bs.FullModel.from_structure(beam(3))
    with pytest.raises(bs.InputError, match=told):
        run(model)


def test_auto_says_why_it_steps() -> None:
    run = bs.simulate(swung(bs.FullModel.from_structure(beam(3))), dt=1e-5)
    assert (run.method, run.method_reason) == ("newmark", "a full model is stepped through time")


def test_ratios_of_many_dofs_are_refused() -> None:
    with pytest.raises(bs.InputError, match="give RayleighDamping"):
        bs.FullModel.from_structure(beam(800), damping=0.01)


def test_a_case_file_may_ask_for_a_full_model(tmp_path: Path) -> None:
    case = Path("cases/sdnl32/case.toml").read_text(encoding="utf-8")
    case = case.replace('method = "exact"', 'method = "newmark"')
    case += '\n[variants.whole]\n"basis.model" = "full"\n'
    case = case.replace("[variants.whole]", '[variants.whole]\n"basis.mass" = "consistent"')
    path = tmp_path / "case.toml"
    path.write_text(case, encoding="utf-8")
    problem = bs.load_case(path).problems["whole"]
    assert isinstance(problem.basis, bs.FullModel)
    run = bs.simulate(problem, "newmark", dt=1e-5)
    run.to_netcdf(tmp_path / "response.nc")
    import xarray as xr

    with xr.open_dataset(tmp_path / "response.nc") as written:
        tip = written["displacement"].sel(node=b"B" if written["node"].dtype.kind == "S" else "B")
        assert np.isfinite(written["stop_force"]).all()
        assert np.allclose(tip.isel(dof=0), run.sample("displacement", "B", "dy"))


def test_what_needs_modes_says_so() -> None:
    structure = beam(3)
    model = bs.FullModel.from_structure(structure)
    with pytest.raises(bs.InputError, match="needs modes"):
        bs.draw_modes(model)
