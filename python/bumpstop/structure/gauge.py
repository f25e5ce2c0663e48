"""Strain gauges."""

from __future__ import annotations

from dataclasses import dataclass, field

from bumpstop.arguments import finite, name, pair

__all__ = ["Gauge"]


@dataclass(frozen=True)
class Gauge:
    """A strain gauge along a fibre of a beam.

    Its reading is the axial strain u' - y drz' + z dry', from the shape functions of the
    element it sits on; where two elements meet, of the one after the node.

    Parameters
    ----------
    name
        Name of the gauge.
    beam
        Name of the beam.
    at
        Distance from the beam's first node, in m.
    fibre
        Where the gauge sits in the section: (y, z) from its centroid in the beam's local
        axes, in m.

    Raises
    ------
    InputError
        If a value cannot be used.
    """

    name: str
    beam: str = field(kw_only=True)
    at: float = field(kw_only=True)
    fibre: tuple[float, float] = field(kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", name("name", self.name))
        object.__setattr__(self, "beam", name("beam", self.beam))
        object.__setattr__(self, "at", finite("at", self.at))
        object.__setattr__(self, "fibre", pair("fibre", self.fibre))
