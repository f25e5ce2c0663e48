"""A Poincaré section as a figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.post.results.motion import Section
from bumpstop.report.arrays import array_figure

if TYPE_CHECKING:
    from bumpstop.report.figures import Figure
    from bumpstop.response import Response

__all__ = ["section_figure"]


def section_figure(
    response: Response,
    node: str,
    dof: str,
    period: float,
    *,
    phase: float = 0.0,
    start: float = 0.0,
) -> Figure:
    """Draw velocities over displacements once in each period; see `stroboscopic_section`."""
    section = Section("section", node=node, dof=dof, period=period, phase=phase, start=start)
    return array_figure(section.plane(response))
