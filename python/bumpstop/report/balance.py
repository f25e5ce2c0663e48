"""How well the energies of a run balance, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.post.energy import LEAST_TOLD
from bumpstop.report.scales import power_of_ten

if TYPE_CHECKING:
    from bumpstop.response import Response

__all__ = ["ledger_instants", "residual_told"]


def residual_told(residual: float, less_than: str = "<") -> str:
    """Return an energy residual in powers of ten.

    Examples
    --------
    >>> residual_told(0.0), residual_told(3.14e-9)
    ('< 1 × 10⁻¹⁵', '3.1 × 10⁻⁹')
    """
    if residual < LEAST_TOLD:
        return f"{less_than} {power_of_ten(LEAST_TOLD, 1)}"
    return power_of_ten(residual)


def ledger_instants(response: Response) -> str:
    """Return when the ledger was looked at for the residual of a response."""
    return "at steps" if response.certified_steps is None else "at switches and the end"
