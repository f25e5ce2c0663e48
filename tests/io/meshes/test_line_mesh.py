from __future__ import annotations

import numpy as np
import pytest

from bumpstop import Beam, InputError, Material, ModalBasis, Rectangle, Structure, Support
from bumpstop.io.meshes.line_mesh import LineMesh, line_mesh
from bumpstop.structure.dofs import DOFS

STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = Rectangle(height=0.06, width=0.025)


@pytest.fixture
def cantilever() -> LineMesh:
    """One of a metre and four lines, in millimetres."""
    return line_mesh(
        nodes={str(i): (250.0 * i, 0.0, 0.0) for i in range(5)} | {"unused": (9.0, 9.0, 9.0)},
        lines={f"L{i}": (str(i), str(i + 1)) for i in range(4)},
        line_groups={"tubes": [f"L{i}" for i in range(4)]},
        node_groups={"base": ["0"], "middle": ["1", "2", "3"]},
    )


def test_a_structure_of_its_beams(cantilever: LineMesh) -> None:
    mesh = cantilever.scaled(1e-3)
    structure = Structure(
        nodes=mesh.nodes,
        beams=mesh.beams("tubes", material=STEEL, section=BAR),
        supports=[Support(nodes="base", fixed=DOFS)],
    )
    plain = Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[Beam("AB", nodes=("A", "B"), elements=4, material=STEEL, section=BAR)],
        supports=[Support(nodes="A", fixed=DOFS)],
    )
    np.testing.assert_allclose(
        ModalBasis.from_structure(structure, modes=8).frequencies,
        ModalBasis.from_structure(plain, modes=8).frequencies,
        rtol=1e-9,
    )


def test_lines_may_be_cut_further(cantilever: LineMesh) -> None:
    beams = cantilever.beams("tubes", material=STEEL, section=BAR, elements=3)
    assert [beam.name for beam in beams] == ["L0", "L1", "L2", "L3"]
    assert {beam.elements for beam in beams} == {3}


def test_nodes_by_name_and_by_group(cantilever: LineMesh) -> None:
    assert cantilever.nodes_of(["middle", "4", "2", "base"]) == ["1", "2", "3", "4", "base"]
    with pytest.raises(InputError, match=r"unknown node or group .got 'midle'.; did you mean 'mid"):
        cantilever.nodes_of(["midle"])
    with pytest.raises(InputError, match=r"unknown group of lines .got 'tube'.; did you mean 'tub"):
        cantilever.beams("tube", material=STEEL, section=BAR)


def test_what_nobody_uses_is_left_out(cantilever: LineMesh) -> None:
    assert "unused" not in cantilever.nodes
