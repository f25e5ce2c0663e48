from __future__ import annotations

from collections.abc import Callable

import pytest

from bumpstop import Beam, Material, Rectangle, Structure, Support
from bumpstop.structure.dofs import DOFS

Cantilever = Callable[..., Structure]


@pytest.fixture
def steel() -> Material:
    return Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)


@pytest.fixture
def bar() -> Rectangle:
    return Rectangle(height=0.06, width=0.025)


@pytest.fixture
def cantilever(steel: Material, bar: Rectangle) -> Cantilever:
    def build(tip: tuple[float, float, float] = (1.0, 0.0, 0.0), elements: int = 3) -> Structure:
        return Structure(
            nodes={"A": (0.0, 0.0, 0.0), "B": tip},
            beams=[Beam("AB", nodes=("A", "B"), elements=elements, material=steel, section=bar)],
            supports=[Support(nodes=("A",), fixed=DOFS)],
        )

    return build
