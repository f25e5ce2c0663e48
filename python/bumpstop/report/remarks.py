"""What is to be said of a basis beside its frequencies."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis

__all__ = ["remarks", "rigid_modes_told"]


def remarks(basis: ModalBasis) -> list[str]:
    """Return that no mode is missing, where that is proved, and what the basis was made of."""
    proof = [] if basis.sturm is None else [str(basis.sturm)]
    return [*proof, *basis.remarks]


def rigid_modes_told(basis: ModalBasis) -> list[str]:
    """Return a line that names the motions which strain nothing, where there are any.

    Examples
    --------
    >>> from bumpstop import ModalBasis, PointMass, Structure, Support
    >>> ball = PointMass("ball", node="P", mass=2.0)
    >>> guide = Support(nodes="all", fixed=("dx", "dy", "drx", "dry", "drz"))
    >>> structure = Structure(nodes={"P": (0, 0, 0)}, masses=[ball], supports=[guide])
    >>> rigid_modes_told(ModalBasis.from_structure(structure, modes=1))
    ['1 rigid mode: translation along z']
    """
    motions = basis.rigid_modes
    if not motions:
        return []
    number = "1 rigid mode" if len(motions) == 1 else f"{len(motions)} rigid modes"
    return [f"{number}: {'; '.join(motions)}"]
