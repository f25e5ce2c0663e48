"""Modes beside parts that are very stiff and have next to no mass."""

from dataclasses import replace

import mpmath
import numpy as np
import pytest

import bumpstop as bs

TUBE = bs.Tube(outer_radius=0.1, thickness=0.01)
BEAM = bs.Material(young_modulus=1e10, poisson_ratio=0.3, density=1e8)
STIFF = 1e15
POST = 0.1
IN_PLANE = bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))


def beam(first: str, last: str) -> bs.Beam:
    return bs.Beam(
        first + last,
        nodes=(first, last),
        elements=5,
        theory="euler_bernoulli",
        material=BEAM,
        section=TUBE,
    )


def on_posts(density: float) -> bs.Structure:
    """A beam between posts, two elements below and two above each of its ends."""
    post = bs.Material(young_modulus=STIFF, poisson_ratio=0.3, density=density)
    nodes = {"M": (0.5, 0.0, 0.0)}
    posts = []
    for side, x in (("L", 0.0), ("R", 1.0)):
        nodes |= {f"{side}{n}": (x, POST * n, 0.0) for n in (-2, -1, 0, 1, 2)}
        posts += [
            bs.Beam(
                f"{side}p{n}",
                nodes=(f"{side}{n}", f"{side}{n + 1}"),
                elements=1,
                theory="euler_bernoulli",
                material=post,
                section=TUBE,
            )
            for n in (-2, -1, 0, 1)
        ]
    held = bs.Support(nodes=("L-2", "L2", "R-2", "R2"), fixed=("dy", "drz"))
    return bs.Structure(
        nodes=nodes,
        beams=[beam("L0", "M"), beam("M", "R0"), *posts],
        supports=[IN_PLANE, held],
    )


def on_springs() -> bs.Structure:
    """The same beam on the springs that the posts are for its ends."""
    # Two posts of two elements of length h, held at the far end: EA / 2h along each of them, and
    # (4 - 2 * 2 / 8) EI / h turning, since the node between the elements turns alone.
    along = 2.0 * STIFF * TUBE.area / (2.0 * POST)
    turning = 2.0 * 3.5 * STIFF * TUBE.inertia_z / POST
    springs = [
        bs.Spring(f"{side}s", node=side, stiffness=(0.0, along, 0.0, 0.0, 0.0, turning))
        for side in ("L0", "R0")
    ]
    return bs.Structure(
        nodes={"L0": (0, 0, 0), "M": (0.5, 0, 0), "R0": (1, 0, 0)},
        beams=[beam("L0", "M"), beam("M", "R0")],
        springs=springs,
        supports=[IN_PLANE],
    )


@pytest.mark.parametrize("density", [1e-9, 1e-6, 1e-3, 1.0])
def test_light_stiff_posts_are_springs(density: float) -> None:
    """Modes of the posts lie a million times higher and more; those of the beam do not care."""
    found = bs.ModalBasis.from_structure(on_posts(density), modes=6)
    expected = bs.ModalBasis.from_structure(on_springs(), modes=6)
    assert found.sturm is not None
    # Rounding of the sums of stiffnesses of such different size alone makes 1e-12.
    np.testing.assert_allclose(found.frequencies, expected.frequencies, rtol=1e-10)
    middle, expected_middle = found.row("M", "dy"), expected.row("M", "dy")
    np.testing.assert_allclose(middle, expected_middle, rtol=1e-8, atol=1e-12)


def on_two_posts(modulus: float, elements: int) -> bs.Structure:
    """The beam on one post under each of its ends, nearly without mass."""
    post = bs.Material(young_modulus=modulus, poisson_ratio=0.3, density=1e-6)
    nodes = {"L": (0.0, 0.0, 0.0), "R": (1.0, 0.0, 0.0), "A": (0, -POST, 0), "B": (1, -POST, 0)}
    posts = [
        bs.Beam(
            side,
            nodes=(low, side),
            elements=1,
            theory="euler_bernoulli",
            material=post,
            section=TUBE,
        )
        for low, side in (("A", "L"), ("B", "R"))
    ]
    return bs.Structure(
        nodes=nodes,
        beams=[replace(beam("L", "R"), elements=elements), *posts],
        supports=[IN_PLANE, bs.Support(nodes=("A", "B"), fixed=("dy", "drz"))],
    )


def exact_frequencies(model: bs.Structure) -> np.ndarray:
    """All of them, with sixty digits."""
    with mpmath.workdps(60):
        stiffness, mass = (
            mpmath.matrix(model.reduced(matrix).to_dense().tolist())
            for matrix in (model.stiffness, model.mass)
        )
        inverse = mpmath.cholesky(mass) ** -1
        omega2 = mpmath.eigsy(inverse * stiffness * inverse.T, eigvals_only=True)
        return np.array([float(mpmath.sqrt(each) / (2 * mpmath.pi)) for each in omega2])


@pytest.mark.parametrize("modulus", [1e12, 1e15, 1e19, 1e22])
def test_all_modes_beside_stiff_posts(modulus: float) -> None:
    model = on_two_posts(modulus, elements=4)
    found = bs.ModalBasis.from_structure(model, modes="all")
    np.testing.assert_allclose(found.frequencies, exact_frequencies(model), rtol=1e-11)
    assert found.sturm is not None
    assert found.sturm.count == len(model.free)


def test_all_modes_of_many_dofs_beside_stiff_posts() -> None:
    """What is found must not depend on how much is asked for, and must be modes."""
    model = on_two_posts(1e22, elements=100)
    found = bs.ModalBasis.from_structure(model, modes="all")
    lowest = bs.ModalBasis.from_structure(model, modes=16)
    np.testing.assert_allclose(found.frequencies[:16], lowest.frequencies, rtol=1e-9)
    shapes = found.shapes
    unit = shapes.T @ (model.mass @ shapes)
    np.testing.assert_allclose(unit, np.eye(len(unit)), atol=1e-6)
    assert found.sturm is not None
