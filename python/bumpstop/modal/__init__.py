"""How it vibrates: eigenmodes and imported modes, as a basis for everything above."""

from bumpstop.modal.basis import ModalBasis

__all__ = ["ModalBasis"]
