"""MovingForce: a force that travels along a beam."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite, name, not_negative, vector
from bumpstop.errors import InputError
from bumpstop.loads.along_beam import beam_length, beam_nodes, model_of
from bumpstop.loads.load import ForceComponent
from bumpstop.loads.product import Product
from bumpstop.loads.time import TimeFunction, TimeTable, time_functions
from bumpstop.projection import TRANSLATIONS

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.model import LinearModel

__all__ = ["MovingForce"]

_PARTS = 64
"""Straight lines in each element along which the shapes are followed."""


@dataclass(frozen=True, eq=False)
class MovingForce:
    """A force that travels along a beam at constant speed, and acts while it is on it.

    Each mode feels ``force . phi(x(t))`` with its shape phi along the beam, which is followed along
    64 straight lines in each element: within ``(k l / 64)^2 / 8`` of its largest value where
    the shape is a wave of wave number k and l is the length of an element.

    Parameters
    ----------
    name
        What the load is called.
    beam
        Name of the beam.
    force
        Components along the global axes, in N.
    speed
        In m/s from the first node to the last; negative for the other way.
    enters
        When it enters the beam, in s: at the first node, or at the last where the speed is
        negative.
    time
        What the force is multiplied by: a function of time, or a list of functions whose sum is
        meant; constant where left out.

    Raises
    ------
    InputError
        If a component is missing or not finite, or the speed is zero.

    References
    ----------
    L. Fryba, Vibration of Solids and Structures under Moving Loads, 3rd edition, 1999, chapter 1.

    Examples
    --------
    >>> MovingForce("axle", beam="AB", force=(0, 0, -8e4), speed=30.0).speed
    30.0
    """

    name: str
    _: KW_ONLY
    beam: str
    force: Vector
    speed: float
    enters: float = 0.0
    time: TimeFunction | Sequence[TimeFunction] | None = None

    def __post_init__(self) -> None:
        name("name", self.name)
        name("beam", self.beam)
        object.__setattr__(self, "force", vector("force", self.force))
        object.__setattr__(self, "speed", finite("speed", self.speed))
        if self.speed == 0.0:
            hint = "a force that stays is a NodalForce"
            raise InputError("must not be zero", key="speed", value=self.speed, hint=hint)
        object.__setattr__(self, "enters", not_negative("enters", self.enters))
        time_functions(self.time)

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        force = ", ".join(f"{part:g}" for part in self.force)
        return f"({force}) N along {self.beam} at {self.speed:g} m/s"

    def passage(self, model: LinearModel, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return where along the beam it is at some times, in m, and what it is multiplied by.

        It is multiplied by zero while it is not on the beam, and its place is then that of an end.

        Raises
        ------
        InputError
            If the model has no such beam.
        """
        length = beam_length(model, self.beam)
        gone = self.speed * (times - self.enters) + (length if self.speed < 0.0 else 0.0)
        places = np.clip(gone, 0.0, length)
        factors = np.where(gone == places, 1.0, 0.0)
        functions = time_functions(self.time)
        if functions:
            factors *= sum(function.at(times) for function in functions)
        return places, factors

    def components(self, basis: ModalBasis) -> tuple[ForceComponent, ...]:
        """Return the force on each mode, with the function of time that it is.

        Raises
        ------
        InputError
            If the basis was not made from beams, or has no such beam.
        """
        model = model_of(basis, self.beam)
        known = self._known
        if id(basis) not in known:
            known[id(basis)] = (basis, self._made(basis, model))
        return known[id(basis)][1]

    def _made(self, basis: ModalBasis, model: LinearModel) -> tuple[ForceComponent, ...]:
        at, rows = self._passed(basis, model)
        times = self.enters + at / abs(self.speed)
        if self.speed < 0.0:
            rows = rows[::-1]
            times = self.enters + (at[-1] - at[::-1]) / abs(self.speed)
        factors = time_functions(self.time)
        made = []
        for mode, values in enumerate(rows.T):
            unit = np.zeros(len(basis.omega2))
            unit[mode] = 1.0
            table: TimeFunction = TimeTable(times, np.ascontiguousarray(values), beyond="zero")
            made.append(ForceComponent(unit, (Product([table, factors]) if factors else table,)))
        return tuple(made)

    def _passed(self, basis: ModalBasis, model: LinearModel) -> tuple[FloatArray, FloatArray]:
        """Return places along the beam in m, (K,), and the force on each mode there, (K, N)."""
        elements = len(beam_nodes(model, self.beam)) - 1
        at = np.linspace(0.0, beam_length(model, self.beam), _PARTS * elements + 1)
        rows = np.zeros((len(at), len(basis.omega2)))
        for size, dof in zip(self.force, TRANSLATIONS, strict=True):
            if size != 0.0:
                for row, place in zip(rows, at.tolist(), strict=True):
                    form = model.displacement_form(f"{self.beam}@{place!r}", dof)
                    row += size * form.of(basis.shapes)
        return at, rows

    @cached_property
    def _known(self) -> dict[int, tuple[ModalBasis, tuple[ForceComponent, ...]]]:
        """Components found so far, with their bases, which keeps the ids from reuse."""
        return {}
