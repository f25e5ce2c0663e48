"""Modes beside parts that are very stiff and have next to no mass."""

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
