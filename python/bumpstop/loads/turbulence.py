"""Turbulence: random forces along a beam, correlated over a length."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, Vector, count, name, not_negative, positive, vector
from bumpstop.errors import InputError
from bumpstop.loads.along_beam import beam_length, model_of
from bumpstop.loads.density import SpectralDensity
from bumpstop.loads.line_force import LineForce
from bumpstop.loads.load import ForceComponent
from bumpstop.loads.random_signal import RandomSignal

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.cut import Cut
    from bumpstop.structure.model import LinearModel

__all__ = ["Turbulence", "cell_correlation"]

_A_LENGTH = 4
"""Cells in a correlation length."""
_FEWEST, _MOST = 32, 128
"""Cells of a span, where their number is left out."""


@dataclass(frozen=True, eq=False)
class Turbulence:
    """Random forces per length of a flow along a tube, alike at places near each other.

    The forces at x and x' have the spectral density S(f) each, and the coherence ``exp(-|x - x'|
    / correlation_length)``. The span is cut into cells; each carries the mean over itself, whose
    densities between cells i and j are those of the integrals of the coherence over both,

        ``S (2 (l/h) - 2 (l/h)^2 (1 - exp(-h/l)))`` for i = j,
        ``S (2 (l/h) sinh(h / 2l))^2 exp(-|i - j| h / l)`` else,

    with cells of length h and the correlation length l. A triangular factor of these makes
    correlated forces out of independent signals of one seed. What cells cannot tell are patterns
    within a quarter of the correlation length.

    Parameters
    ----------
    name
        What the load is called.
    beam
        Name of the beam.
    direction
        Along which the force acts, in global axes; its length multiplies the force.
    density
        One-sided spectral density of the force per length, in (N/m)^2/Hz.
    correlation_length
        In m.
    seed, period
        As for a `RandomSignal`.
    start, end
        Between which distances from the first node it acts, in m; the whole beam where left out.
    cells
        Number of cells; four a correlation length where left out, at least 32 and at most 128.

    Raises
    ------
    InputError
        If a number is out of its range.

    References
    ----------
    M. K. Au-Yang, Flow-Induced Vibration of Power and Process Plant Components, ASME Press,
    2001, chapters 8 and 9 (joint acceptances, coherence).
    """

    name: str
    _: KW_ONLY
    beam: str
    direction: Vector
    density: SpectralDensity
    correlation_length: float
    seed: int
    period: float
    start: float = 0.0
    end: float | None = None
    cells: int | None = None

    def __post_init__(self) -> None:
        name("name", self.name)
        name("beam", self.beam)
        object.__setattr__(self, "direction", vector("direction", self.direction))
        if not any(self.direction):
            raise InputError("must have a length", key="direction", value=self.direction)
        length = positive("correlation_length", self.correlation_length)
        object.__setattr__(self, "correlation_length", length)
        object.__setattr__(self, "start", not_negative("start", self.start))
        if self.end is not None:
            object.__setattr__(self, "end", positive("end", self.end))
        if self.cells is not None:
            object.__setattr__(self, "cells", count("cells", self.cells))
        self._first_signal  # noqa: B018  # says what is wrong now

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        return (
            f"turbulence along {self.beam}, rms {self.density.rms:.4g} N/m, "
            f"correlated over {self.correlation_length:g} m, seed {self.seed}"
        )

    def nodal_forces(self, model: LinearModel) -> FloatArray:
        """Return the force on each dof for each independent signal, one a column, (dofs, cells).

        Raises
        ------
        InputError
            If the model has no such beam, or the load is not on it.
        """
        if id(model) not in self._known:
            self._known[id(model)] = (model, self._placed(model))
        return self._known[id(model)][1]

    def _placed(self, model: LinearModel) -> FloatArray:
        unit = [load.nodal_force(model) for load in self._cells(model)]
        forces: FloatArray = np.stack(unit, axis=1) @ self._mixing(model)
        return forces

    def _cells(self, model: LinearModel) -> list[LineForce]:
        """Return a unit force along each cell."""
        edges = self._edges(model).tolist()
        return [
            LineForce(self.name, beam=self.beam, force=self.direction, start=left, end=right)
            for left, right in pairwise(edges)
        ]

    def _mixing(self, model: LinearModel) -> FloatArray:
        """Return the forces of the cells by the independent signals, (cells, cells)."""
        edges = self._edges(model)
        joint = cell_correlation(
            len(edges) - 1, float(edges[1] - edges[0]), self.correlation_length
        )
        return np.asarray(np.linalg.cholesky(joint), dtype=np.float64)

    def inside(self, cut: Cut) -> FloatArray:
        """Return what it does inside an element for each independent signal, (r, cells)."""
        unit = [load.inside(cut) for load in self._cells(cut.model)]
        forces = np.hstack(unit) @ self._mixing(cut.model)
        return np.asarray(forces, dtype=np.float64)

    def components(self, basis: ModalBasis) -> tuple[ForceComponent, ...]:
        """Return the force on each mode of each independent signal.

        Raises
        ------
        InputError
            If the basis was not made from beams, or the load is not on the beam.
        """
        forces = basis.shapes.T @ self.nodal_forces(model_of(basis, self.beam))
        return tuple(
            ForceComponent(np.ascontiguousarray(force), (self._signal(stream),))
            for stream, force in enumerate(forces.T)
        )

    def _edges(self, model: LinearModel) -> FloatArray:
        """Return where the cells begin and end, in m from the first node, (cells + 1,)."""
        whole = beam_length(model, self.beam)
        end = whole if self.end is None else self.end
        if not self.start < end <= whole * (1.0 + 1e-9):
            what = f"must be beyond the start, on the beam, which is {whole:g} m long"
            raise InputError(what, key="end", value=end)
        wanted = math.ceil(_A_LENGTH * (end - self.start) / self.correlation_length)
        cells = self.cells or min(max(wanted, _FEWEST), _MOST)
        return np.linspace(self.start, end, cells + 1)

    @cached_property
    def _first_signal(self) -> RandomSignal:
        return RandomSignal(self.density, seed=self.seed, period=self.period)

    def _signal(self, stream: int) -> RandomSignal:
        known = self._signals
        if stream not in known:
            known[stream] = RandomSignal(
                self.density, seed=self.seed, period=self.period, stream=stream
            )
        return known[stream]

    @cached_property
    def _known(self) -> dict[int, tuple[LinearModel, FloatArray]]:
        """Forces found so far, with their models, which keeps the ids from reuse."""
        return {}

    @cached_property
    def _signals(self) -> dict[int, RandomSignal]:
        """Signals made so far: a problem asks for them when it is made, and when it is run."""
        return {0: self._first_signal}


def cell_correlation(cells: int, length: float, correlation_length: float) -> FloatArray:
    """Return the correlation of the means over cells of a process, (cells, cells).

    Parameters
    ----------
    cells
        Their number, side by side.
    length
        Length of each, in m.
    correlation_length
        Over which the process falls to 1/e of its coherence, in m.

    Examples
    --------
    >>> cell_correlation(2, 1e-6, 1.0).round(5)
    array([[1., 1.],
           [1., 1.]])
    """
    part = length / correlation_length
    apart = np.abs(np.subtract.outer(np.arange(cells), np.arange(cells)))
    joint = (2.0 * np.sinh(0.5 * part) / part) ** 2 * np.exp(-part * apart)
    # 2 (x - 1 + exp(-x)) / x^2, whose series spares the cancellation of short cells.
    short = 1.0 - part / 3.0 + part**2 / 12.0 - part**3 / 60.0
    own = short if part < 1e-3 else 2.0 * (part + np.expm1(-part)) / part**2
    np.fill_diagonal(joint, own)
    correlation: FloatArray = joint
    return correlation
