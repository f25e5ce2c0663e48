"""LineForce: a force spread along a beam."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import KW_ONLY, dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, Vector, name, not_negative, one_of, positive, vector
from bumpstop.errors import InputError
from bumpstop.loads.along_beam import beam_length, beam_nodes, model_of
from bumpstop.loads.load import SingleLoad
from bumpstop.loads.time import TimeFunction, time_functions
from bumpstop.projection import TRANSLATIONS
from bumpstop.structure.model import BeamModel

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.cut import Cut
    from bumpstop.structure.model import LinearModel

__all__ = ["LineForce", "points_along"]

AXES = ("global", "local")
_GAUSS = 4
"""Places in each element; exact up to polynomials of degree seven."""
_ROUNDING = 1e-9


@dataclass(frozen=True)
class LineForce(SingleLoad):
    """A force per length along a beam or a part of it: uniform, or changing linearly.

    The nodes take the work-equivalent forces and moments ``integral of N' f dx`` with the shape
    functions N of the elements (J. S. Przemieniecki, Theory of Matrix Structural Analysis,
    McGraw-Hill, 1968, chapter 10). At the nodes the static deflection is then that of the beam
    under the load as it is.

    Parameters
    ----------
    name
        What the load is called.
    beam
        Name of the beam.
    force
        Components in N/m.
    end_force
        Components in N/m at the end of the loaded length, where they differ from those at its
        start; between, they change linearly.
    start, end
        Between which distances from the first node it acts, in m; the whole beam where left out.
    axes
        ``"global"``, or ``"local"`` for components along the axes of the beam.
    time
        What it is multiplied by: a function of time, or a list of functions whose sum is meant;
        constant where left out.

    Raises
    ------
    InputError
        If a component is missing or not finite, or the length is none.

    Examples
    --------
    >>> LineForce("snow", beam="AB", force=(0, 0, -500.0)).axes
    'global'
    """

    name: str
    _: KW_ONLY
    beam: str
    force: Vector
    end_force: Vector | None = None
    start: float = 0.0
    end: float | None = None
    axes: str = "global"
    time: TimeFunction | Sequence[TimeFunction] | None = None

    def __post_init__(self) -> None:
        name("name", self.name)
        name("beam", self.beam)
        object.__setattr__(self, "force", vector("force", self.force))
        if self.end_force is not None:
            object.__setattr__(self, "end_force", vector("end_force", self.end_force))
        object.__setattr__(self, "start", not_negative("start", self.start))
        if self.end is not None:
            object.__setattr__(self, "end", positive("end", self.end))
            if self.end <= self.start:
                what = "must be beyond the start of the load"
                raise InputError(what, key="end", value=self.end)
        one_of("axes", self.axes, AXES)
        time_functions(self.time)

    @property
    def functions(self) -> tuple[TimeFunction, ...]:
        """The functions of time whose sum it is multiplied by; none where it is constant."""
        return time_functions(self.time)

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        parts = [f"({', '.join(f'{part:g}' for part in self.force)})"]
        if self.end_force is not None:
            parts.append(f"({', '.join(f'{part:g}' for part in self.end_force)})")
        return f"{' to '.join(parts)} N/m along {self.beam}"

    def modal_force(self, basis: ModalBasis) -> FloatArray:
        """Return the force on each mode (N,) where the function of time is one.

        Raises
        ------
        InputError
            If the basis was not made from beams, or the load is not on the beam.
        """
        return self.nodal_force(model_of(basis, self.beam)) @ basis.shapes

    def nodal_force(self, model: LinearModel) -> FloatArray:
        """Return the force on each dof of a model, (dofs,), in N and N m.

        Raises
        ------
        InputError
            If the model has no such beam, or the load is not on it.
        """
        places, weights, parts = points_along(model, self.beam, self.start, self.end)
        first, last = self._ends(model)
        total = np.zeros(len(model.dofs))
        for axis, dof in enumerate(TRANSLATIONS):
            if first[axis] == 0.0 == last[axis]:
                continue
            sizes = weights * (first[axis] + (last[axis] - first[axis]) * parts)
            for place, size in zip(places, sizes.tolist(), strict=True):
                form = model.displacement_form(place, dof)
                np.add.at(total, form.dofs, size * form.weights)
        return total

    def inside(self, cut: Cut) -> FloatArray:
        """Return what it does inside an element, (r, 1)."""
        if self.beam != cut.beam:
            return super().inside(cut)
        last = beam_length(cut.model, self.beam) if self.end is None else self.end
        first, second = self._ends(cut.model)

        def density(place: float) -> FloatArray:
            part = (place - self.start) / (last - self.start)
            return np.concatenate([first + part * (second - first), np.zeros(3)])[:, np.newaxis]

        return cut.of_density(density, self.start, last)

    def _ends(self, model: LinearModel) -> tuple[FloatArray, FloatArray]:
        """Return its components at both ends, along the global axes."""
        first = np.array(self.force)
        last = first if self.end_force is None else np.array(self.end_force)
        if self.axes == "local":
            assert isinstance(model, BeamModel)  # `points_along` has made sure
            axes = model.beam_axes(self.beam)
            first, last = first @ axes, last @ axes
        return first, last


def points_along(
    model: LinearModel, beam: str, start: float = 0.0, end: float | None = None
) -> tuple[list[str], FloatArray, FloatArray]:
    """Return points along a length of a beam at which an integral is a sum.

    Parameters
    ----------
    model
        The model that the beam belongs to.
    beam
        Its name.
    start, end
        The length, in m from the first node; the whole beam where left out.

    Returns
    -------
    tuple
        The points by their names, their weights in m, and their parts of the length, 0 to 1.

    Raises
    ------
    InputError
        If there is no such beam, or the length is not on it.
    """
    corners = np.array([model.position(node) for node in beam_nodes(model, beam)])
    along = np.linalg.norm(corners - corners[0], axis=1)
    last = along[-1] if end is None else end
    for key, value in (("start", start), ("end", last)):
        if value > along[-1] * (1.0 + _ROUNDING):
            what = f"must be on the beam, which is {along[-1]:g} m long"
            raise InputError(what, key=key, value=value)
    found = list(_gauss(along, start, min(float(last), float(along[-1]))))
    ats, weights = (np.concatenate(column) for column in zip(*found, strict=True))
    parts = (ats - start) / (last - start)
    return [f"{beam}@{at!r}" for at in ats.tolist()], weights, parts


def _gauss(along: FloatArray, start: float, end: float) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield places and weights in each element between two distances."""
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
    for left, right in pairwise(along.tolist()):
        begin, stop = max(left, start), min(right, end)
        if stop > begin:
            half = 0.5 * (stop - begin)
            yield begin + half * (1.0 + nodes), half * weights
