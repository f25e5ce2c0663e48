"""FrequencyResponse: a measured function, the answer at one place to a force at another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray, one_of
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS, Dof

__all__ = ["DERIVATIVES", "ComplexArray", "FrequencyResponse"]

ComplexArray: TypeAlias = NDArray[np.complex128]

DERIVATIVES = {"displacement": 0, "velocity": 1, "acceleration": 2}
"""How often the displacement is derived in time for each kind of answer."""


@dataclass(frozen=True, eq=False)
class FrequencyResponse:
    """What answers at one place, by frequency, to a unit force or moment at another.

    Parameters
    ----------
    frequency
        In Hz, ascending, (n,).
    values
        Complex, (n,): m/N, rad/N, m/(N m) or rad/(N m) for displacements; the same by s or s^2
        for velocities and accelerations. Time goes as exp(+i omega t).
    response, reference
        Node and dof of the answer and of the force.
    kind
        What answers: ``"displacement"``, ``"velocity"`` or ``"acceleration"``.

    Raises
    ------
    InputError
        If sizes do not fit together, a number is not finite, frequencies do not ascend from zero
        or above, or a dof or the kind is unknown.
    """

    frequency: FloatArray
    values: ComplexArray
    response: Dof
    reference: Dof
    kind: str = "displacement"

    def __post_init__(self) -> None:
        frequency = np.asarray(self.frequency, dtype=np.float64)
        values = np.asarray(self.values, dtype=np.complex128)
        object.__setattr__(self, "frequency", frequency)
        object.__setattr__(self, "values", values)
        one_of("kind", self.kind, tuple(DERIVATIVES))
        for _, dof in (self.response, self.reference):
            one_of("dof", dof, DOFS)
        if frequency.ndim != 1 or values.shape != frequency.shape:
            raise InputError("must have one value a frequency", key="values", value=values.shape)
        if not (np.isfinite(frequency).all() and np.isfinite(values).all()):
            raise InputError("must hold finite numbers", key="values")
        if frequency.size == 0 or frequency[0] < 0.0 or np.any(np.diff(frequency) <= 0.0):
            raise InputError("must ascend from zero or above", key="frequency")
