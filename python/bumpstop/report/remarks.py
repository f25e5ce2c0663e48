"""What is to be said of a basis beside its frequencies."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis

__all__ = ["remarks"]


def remarks(basis: ModalBasis) -> list[str]:
    """Return that no mode is missing, where that is proved, and what else is to be known."""
    proof = [] if basis.sturm is None else [str(basis.sturm)]
    return [*proof, *basis.remarks]
