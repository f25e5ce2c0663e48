"""The case SDNL105B: substructures that touch each other, against published runs."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnl105b" / "case.toml")


@pytest.mark.parametrize(
    ("variant", "checks"), [("converged", 12), ("published", 12), ("complete", 6)]
)
def test_references(variant: str, checks: int, case: bs.Case) -> None:
    method = case.methods[variant].name
    dt = 2e-4 if method == "symplectic_euler" else None
    response = bs.simulate(case.problems[variant], method, dt=dt)
    done = check_references(response, case.references[variant])
    assert len(done) == 15 + checks
    assert all(check.passed for check in done)


def test_the_scheme_of_the_second_run(case: bs.Case) -> None:
    """De Vogelaere's, at the step that the published run did not exceed."""
    response = bs.simulate(case.problems["converged"], "devogelaere", dt=2e-5)
    done = check_references(response, case.references["converged"])
    assert len(done) == 27
    assert all(check.passed for check in done)


def test_one_structure_without_components(case: bs.Case) -> None:
    """The published references of run 1 are of such a model: agreement to rounding."""
    basis = bs.ModalBasis.from_structure(_frame(), modes=15)
    laws = [
        bs.Stop(low + high, node=high, other=low, normal=(0, 1, 0), gap=1e-3, stiffness=1e8)
        for low, high in (("one", "two"), ("two", "three"))
    ]
    step = bs.NodalForce("step", node="one", force=(0, 1e6, 0))
    problem = bs.Problem(basis, laws=laws, loads=[step], duration=1.0)
    response = bs.simulate(problem, "symplectic_euler", dt=2e-4)
    published = [each for each in case.references["complete"] if each.node]
    assert len(published) == 6
    for each in published:
        node = str(each.node)[:-2]
        value = response.sample(each.quantity, node, "dy", times=[1.0])
        assert value == pytest.approx(each.values, rel=2e-12)


def _frame() -> bs.Structure:
    beam = bs.Material(young_modulus=1e10, poisson_ratio=0.3, density=1e8)
    post = bs.Material(young_modulus=1e15, poisson_ratio=0.3, density=1e-6)

    def made(first: str, last: str, elements: int, material: bs.Material) -> bs.Beam:
        return bs.Beam(
            first + last,
            nodes=(first, last),
            elements=elements,
            theory="euler_bernoulli",
            material=material,
            section=bs.Tube(outer_radius=0.1, thickness=0.01),
        )

    sides = {"L": 0.0, "R": 1.0}
    nodes = {f"{side}{n}": (x, 0.1 * (n - 1), 0.0) for side, x in sides.items() for n in range(7)}
    beams = [made(f"{side}{n}", f"{side}{n + 1}", 1, post) for side in sides for n in range(6)]
    for storey, name in enumerate(("one", "two", "three")):
        nodes[name] = (0.5, 0.2 * storey, 0.0)
        beams.append(made(f"L{2 * storey + 1}", name, 5, beam))
        beams.append(made(name, f"R{2 * storey + 1}", 5, beam))
    in_plane = bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))
    clamped = bs.Support(nodes=("L0", "L6", "R0", "R6"), fixed=("dy", "drz"))
    return bs.Structure(nodes=nodes, beams=beams, supports=[in_plane, clamped])


def test_the_stops_push_both_beams_alike(case: bs.Case) -> None:
    """Newton's laws for each beam: what it gains of momentum comes from its neighbours."""
    response = bs.simulate(case.problems["converged"], "exact")
    assert response.energy_residual < 1e-12
    impacts = response.impact_table()
    assert set(impacts["stop"]) == {"lower", "upper"}
    times = np.linspace(0.0, 1.0, 4001)
    for stop, (low, high) in {"lower": ("one", "two"), "upper": ("two", "three")}.items():
        below, above = (
            response.sample("displacement", f"{part}.M", "dy", times=times) for part in (low, high)
        )
        gap = 1e-3 + above - below
        np.testing.assert_allclose(response.sample("gap", stop, times=times), gap, atol=1e-15)
        force = response.sample("stop_force", stop, times=times)
        np.testing.assert_allclose(force, np.maximum(0.0, -1e8 * gap), atol=1e-6)


def test_frequencies_are_those_of_clamped_beams_nearly(case: bs.Case) -> None:
    """The ten elements of the beam clamped at both ends, by another eigensolver."""
    from scipy.linalg import eigh

    frequencies = np.sqrt(eigh(*_clamped_beam(), eigvals_only=True)[:5]) / (2.0 * np.pi)
    triples = case.bases["complete"].frequencies.reshape(5, 3)
    assert np.all(triples < frequencies[:, np.newaxis])
    np.testing.assert_allclose(triples, frequencies[:, np.newaxis].repeat(3, axis=1), rtol=1.2e-5)


def _clamped_beam() -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness and mass matrix of ten Hermite elements, the ends held."""
    area, inertia = np.pi * (0.1**2 - 0.09**2), np.pi / 4 * (0.1**4 - 0.09**4)
    h = 0.1
    bending = np.array(
        [
            [12, 6 * h, -12, 6 * h],
            [6 * h, 4 * h * h, -6 * h, 2 * h * h],
            [-12, -6 * h, 12, -6 * h],
            [6 * h, 2 * h * h, -6 * h, 4 * h * h],
        ]
    )
    inertial = np.array(
        [
            [156, 22 * h, 54, -13 * h],
            [22 * h, 4 * h * h, 13 * h, -3 * h * h],
            [54, 13 * h, 156, -22 * h],
            [-13 * h, -3 * h * h, -22 * h, 4 * h * h],
        ]
    )
    stiffness, mass = np.zeros((22, 22)), np.zeros((22, 22))
    for element in range(10):
        place = slice(2 * element, 2 * element + 4)
        stiffness[place, place] += 1e10 * inertia / h**3 * bending
        mass[place, place] += 1e8 * area * h / 420 * inertial
    return stiffness[2:-2, 2:-2], mass[2:-2, 2:-2]
