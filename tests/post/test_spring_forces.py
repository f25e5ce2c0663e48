"""Forces of springs, dampers and bearings against closed forms and balances."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bumpstop as bs
from bumpstop.structure.dofs import DOFS

STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
ALONG = ("dy", "dz", "drx", "dry", "drz")


def beam(elements: int) -> bs.Beam:
    section = bs.Rectangle(height=0.02, width=0.03)
    return bs.Beam("AB", nodes=("A", "B"), elements=elements, material=STEEL, section=section)


def thrown(damping: float) -> tuple[bs.Response, float, float]:
    """A mass on a spring and damper to the ground; its angular frequency and rate of decay."""
    mass, stiffness = 2.0, 800.0
    structure = bs.Structure(
        nodes={"P": (0, 0, 0)},
        masses=[bs.PointMass("m", node="P", mass=mass)],
        springs=[
            bs.Spring(
                "mount",
                node="P",
                stiffness=(stiffness, 0, 0, 0, 0, 0),
                damping=(damping, 0, 0, 0, 0, 0),
            )
        ],
        supports=[bs.Support(nodes="P", fixed=ALONG)],
    )
    basis = bs.ModalBasis.from_structure(structure, modes=1)
    start = bs.NodalState(velocity={("P", "dx"): 1.0})
    problem = bs.Problem(basis, initial=start, duration=1.0)
    decay = damping / (2.0 * mass)
    return bs.simulate(problem), math.sqrt(stiffness / mass - decay**2), decay


@pytest.mark.parametrize("damping", [0.0, 6.0])
def test_a_mass_on_a_spring_and_a_damper(damping: float) -> None:
    run, omega, decay = thrown(damping)
    found = bs.recovery(run).spring_forces("mount")
    t = run.times
    x = np.exp(-decay * t) * np.sin(omega * t) / omega
    v = np.exp(-decay * t) * np.cos(omega * t) - decay * x
    assert_allclose(found["dx"].sel(node="P"), -800.0 * x - damping * v, atol=1e-10)
    assert found["dx"].attrs["units"] == "N"
    assert not found[["dy", "drx"]].to_array().values.any()


@pytest.fixture(scope="module")
def shaken() -> bs.Response:
    """A beam on mounts at its ends, and on a strut between it and a mass aside."""
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0), "M": (1.0, 0.3, 0.2)},
        beams=[beam(6)],
        masses=[bs.PointMass("m", node="M", mass=1.5, inertia=(0.02, 0.03, 0.04))],
        springs=[
            bs.Spring("left", node="A", stiffness=(2e5, 3e5, 4e5, 300.0, 400.0, 500.0)),
            bs.Spring("right", node="B", stiffness=(1e5, 1e5, 2e5, 0, 0, 0)),
            bs.Spring("strut", node="B", other="M", stiffness=(5e4, 6e4, 7e4, 80.0, 90.0, 70.0)),
        ],
    )
    basis = bs.ModalBasis.from_structure(structure, modes=5, damping=0.02)
    push = bs.NodalForce(
        "push", node="B", force=(3.0, -40.0, 20.0), time=bs.Harmonic(frequency=15.0, sine=1.0)
    )
    return bs.simulate(bs.Problem(basis, loads=[push], duration=0.3))


def test_springs_to_the_ground_are_the_elastic_part_of_the_balance(shaken: bs.Response) -> None:
    found = bs.recovery(shaken)
    left, right = (found.spring_forces(name).isel(node=0) for name in ("left", "right"))
    elastic = found.resultants()["elastic"]
    size = float(np.abs(elastic).max())
    for dof in DOFS[:3]:
        total = left[dof] + right[dof]
        assert_allclose(total, elastic.sel(dof=dof), atol=1e-9 * size)
    # Of the right one, a metre along x, with its arm.
    about_y = left["dry"] + right["dry"] - right["dz"]
    assert_allclose(about_y, elastic.sel(dof="dry"), atol=1e-9 * size)
    assert size > 10.0


def test_what_a_strut_does_to_its_nodes_is_in_balance(shaken: bs.Response) -> None:
    found = bs.recovery(shaken).spring_forces("strut")
    near, far = found.sel(node="B"), found.sel(node="M")
    force = np.array([far[dof].values for dof in DOFS[:3]])
    size = np.abs(force).max()
    for number, dof in enumerate(DOFS[:3]):
        assert_allclose(near[dof], -force[number], atol=1e-9 * size)
    moments = [np.array([side[dof].values for dof in DOFS[3:]]) for side in (near, far)]
    arm = np.array([0.0, 0.3, 0.2])
    assert_allclose(sum(moments) + np.cross(arm, force.T).T, 0.0, atol=1e-9 * size)


def test_a_bearing_that_pushes_across() -> None:
    cross = 3e4
    structure = bs.Structure(
        nodes={"P": (0, 0, 0)},
        masses=[bs.PointMass("m", node="P", mass=2.0)],
        bearings=[
            bs.Bearing(
                "film", node="P", axis=(1, 0, 0), stiffness=[[1e5, cross], [-cross, 1e5]],
                damping=[[300.0, 0.0], [0.0, 300.0]],
            )
        ],
        supports=[bs.Support(nodes="P", fixed=("dx", "drx", "dry", "drz"))],
    )  # fmt: skip
    basis = bs.ModalBasis.from_structure(structure, modes=2)
    start = bs.NodalState(velocity={("P", "dy"): 0.3})
    run = bs.simulate(bs.Problem(basis, initial=start, duration=0.2))
    found = bs.recovery(run).spring_forces("film").sel(node="P")
    for dof in ("dy", "dz"):
        inertia = 2.0 * run.acceleration("P", dof).values
        assert_allclose(found[dof].values, inertia, atol=1e-9 * np.abs(inertia).max())


def test_what_there_is_not_is_refused() -> None:
    run, _, _ = thrown(0.0)
    with pytest.raises(bs.InputError, match=r"spring: .*did you mean 'mount'"):
        bs.recovery(run).spring_forces("mont")
    clamped = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[beam(1)],
        supports=[bs.Support(nodes="A", fixed=DOFS)],
    )
    basis = bs.ModalBasis.from_structure(clamped, modes=1)
    alone = bs.simulate(bs.Problem(basis, duration=0.1))
    with pytest.raises(bs.InputError, match="no springs or bearings"):
        bs.recovery(alone).spring_forces("mount")
