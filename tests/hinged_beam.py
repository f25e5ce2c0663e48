"""The beam of SDNL32, which many tests look at: hinged at A, free at B, bending in the plane xy."""

import bumpstop as bs

ALLOY = bs.Material(young_modulus=67e9, poisson_ratio=0.0, density=2400.0)
BAR = bs.Rectangle(height=0.014, width=0.014)
IN_PLANE = bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))
HINGE = bs.Support(nodes=("A",), fixed=("dy",))
SWING = bs.RigidRotation(about="A", rate=(0, 0, -3.8))


def hinged_beam(elements: int = 10, at: tuple[float, float] = (0.0, 0.0)) -> bs.Structure:
    """Return the beam, with its hinge at a place in the plane."""
    x, y = at
    return bs.Structure(
        nodes={"A": (x, y, 0), "B": (x + 0.783, y, 0)},
        beams=[bs.Beam("AB", nodes=("A", "B"), elements=elements, material=ALLOY, section=BAR)],
        supports=[IN_PLANE, HINGE],
    )


def hinged_modes(elements: int = 10, modes: int = 10, damping: float = 0.01) -> bs.ModalBasis:
    """Return its lowest modes, a rigid one among them, damped in each."""
    return bs.ModalBasis.from_structure(hinged_beam(elements), modes=modes, damping=damping)


def end_stop(stiffness: float) -> bs.Stop:
    """Return the stop that the tip just touches."""
    return bs.Stop("spring", node="B", normal=(0, 1, 0), stiffness=stiffness)
