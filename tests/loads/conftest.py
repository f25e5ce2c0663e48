import pytest

import bumpstop as bs


@pytest.fixture(scope="module")
def hinged_beam() -> bs.ModalBasis:
    """The beam of SDNL32: hinged at A, free at B, bending in the plane xy."""
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (0.783, 0, 0)},
        beams=[
            bs.Beam(
                "AB",
                nodes=("A", "B"),
                elements=10,
                theory="timoshenko",
                material=bs.Material(young_modulus=67e9, poisson_ratio=0.0, density=2400.0),
                section=bs.Rectangle(height=0.014, width=0.014),
            )
        ],
        supports=[
            bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry")),
            bs.Support(nodes=("A",), fixed=("dy",)),
        ],
    )
    return bs.ModalBasis.from_structure(structure, modes=10, damping=0.01)
