from __future__ import annotations

from collections.abc import Callable

import pytest

from bumpstop import Beam, Material, Rectangle, Structure

Bay = Callable[..., Structure]


@pytest.fixture(scope="session")
def bay() -> Bay:
    """Build a straight beam from A at the origin to B, free in space."""
    steel = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    bar = Rectangle(height=0.06, width=0.025)

    def build(end: tuple[float, float, float] = (1.0, 0.0, 0.0), elements: int = 4) -> Structure:
        beam = Beam("AB", nodes=("A", "B"), elements=elements, material=steel, section=bar)
        return Structure(nodes={"A": (0.0, 0.0, 0.0), "B": end}, beams=[beam])

    return build
