"""Results about forces in the structure."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import one_of
from bumpstop.errors import InputError
from bumpstop.post.results.reading import Drawn, Fact, Reading
from bumpstop.quantities import Quantity
from bumpstop.structure.model import SectionModel

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = ["BeamForces", "FibreStress", "Reactions"]


@dataclass(frozen=True)
class BeamForces:
    """Forces in a section of a beam over time; see `Recovery.section_forces`."""

    name: str
    _: KW_ONLY
    beam: str
    at: float

    def check(self, problem: Problem) -> None:
        """Raise where there is no such beam or section."""
        _sections(problem).section_forms(self.beam, self.at)

    def read(self, response: Response) -> Reading:
        """Read the forces that are not zero throughout."""
        from bumpstop.post.recovery import recovery

        found = recovery(response).section_forces(self.beam, self.at)
        return Reading(list(_peaks(found)), [Drawn(found[name]) for name in _present(found)])


@dataclass(frozen=True)
class FibreStress:
    """Axial stress of a fibre of a beam over time; see `Recovery.stress`."""

    name: str
    _: KW_ONLY
    beam: str
    at: float
    fibre: tuple[float, float]

    def check(self, problem: Problem) -> None:
        """Raise where there is no such beam, section or fibre."""
        from bumpstop.structure.gauge import Gauge

        gauge = Gauge(self.name, beam=self.beam, at=self.at, fibre=self.fibre)
        _sections(problem).stress_form(gauge)

    def read(self, response: Response) -> Reading:
        """Read the stress."""
        from bumpstop.post.recovery import recovery

        found = recovery(response).stress(self.beam, self.at, self.fibre).to_dataset()
        return Reading(list(_peaks(found)), [Drawn(found["stress"])])


@dataclass(frozen=True)
class Reactions:
    """What supports do to a node over time; see `Recovery.reactions`."""

    name: str
    _: KW_ONLY
    node: str

    def check(self, problem: Problem) -> None:
        """Raise where there is no such node; a point along a beam is none."""
        model = problem.basis.model
        if model is None:
            what = "reactions need a basis computed from a structure or matrices"
            raise InputError(what, key="node", value=self.node)
        one_of("node", self.node, list(dict.fromkeys(node for node, _ in model.dofs)))

    def read(self, response: Response) -> Reading:
        """Read the reactions that are not zero throughout."""
        from bumpstop.post.recovery import recovery

        found = recovery(response).reactions(self.node)
        return Reading(list(_peaks(found)), [Drawn(found[name]) for name in _present(found)])


def _present(found: xr.Dataset) -> list[str]:
    """Return the names of what is not zero throughout, but for rounding."""
    sizes = {str(name): float(np.abs(array).max()) for name, array in found.items()}
    limit = 1e-9 * max(sizes.values(), default=0.0)
    return [name for name, size in sizes.items() if size > limit]


def _peaks(found: xr.Dataset) -> Iterator[Fact]:
    """Yield the largest magnitude of each that is not zero throughout."""
    for name in _present(found):
        array = found[name]
        what = Quantity(str(array.attrs["units"]), f"largest {array.attrs['long_name']}")
        yield Fact(what, float(np.abs(array).max()))


def _sections(problem: Problem) -> SectionModel:
    model = problem.basis.model
    if not isinstance(model, SectionModel):
        what = "forces in beams need a basis computed from a structure"
        raise InputError(what, key="beam", value=type(model).__name__)
    return model
