"""Modes from universal files (.uff, .unv): data sets 55, in the units of data set 164.

Where there are none, modes are identified from measured functions, data sets 58.

Real modes (analysis type 2) are taken as they are. Complex ones (types 3 and 7) are taken where all
their points move in phase, as far as ``IN_PHASE`` allows; the frequency is then the size of the
eigenvalue and the modal mass follows from modal A = 2 i omega_d m.
Source: as for universal.py; for modal A, D. J. Ewins, Modal Testing, 2nd ed., section 2.7.
"""

from __future__ import annotations

import cmath
import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bumpstop.errors import InputError
from bumpstop.io.modes.given import refuse_identification
from bumpstop.io.modes.mode_set import ModeSet
from bumpstop.io.reading import in_file
from bumpstop.io.universal import DataSet, Units, data_sets, file_units
from bumpstop.structure.dofs import DOFS, Dof

__all__ = ["read_universal_modes"]

IN_PHASE = 0.2
"""Largest part of a complex mode that may move out of phase, by its norm, to be taken as real."""

_NORMAL, _COMPLEX = 2, (3, 7)
_COMPLEX_NUMBERS = 5


class _Mode(NamedTuple):
    frequency: float
    damping: float
    modal_mass: float
    """Zero where the file does not tell it."""
    components: dict[Dof, float]


def read_universal_modes(
    path: Path, band: tuple[float, float] | None = None, count: int | None = None
) -> ModeSet:
    """Read the modes of a universal file. Nodes are called by their numbers.

    Raises
    ------
    InputError
        If the file cannot be read, is truncated, holds no mode, or a mode is complex; if a
        band or count is given but it holds modes; or if modes cannot be identified.
    """
    with in_file(path):
        found = data_sets(path)
        modes = [_mode(data) for data in found if data.number == 55]
        taken = [mode for mode in modes if mode is not None]
        if not taken:
            return _identified(found, band, count)
        refuse_identification(band, count)
        return _mode_set(taken, file_units(found))


def _identified(
    found: list[DataSet], band: tuple[float, float] | None, count: int | None
) -> ModeSet:
    if all(data.number != 58 for data in found):
        numbers = ", ".join(str(number) for number in sorted({data.number for data in found}))
        hint = f"modes are data sets 55, measured functions 58, and it has {numbers}"
        raise InputError("holds no mode", hint=hint)
    from bumpstop.io.modes.functions import measured_functions
    from bumpstop.io.modes.identify import identify_modes

    return identify_modes(measured_functions(found, file_units(found)), band=band, count=count)


def _mode_set(modes: list[_Mode], units: Units) -> ModeSet:
    # Sensors that are not there stand as zeros: such a dof is unknown, not at rest.
    measured = {dof for mode in modes for dof, value in mode.components.items() if value != 0.0}
    dofs = sorted(measured, key=lambda dof: (int(dof[0]), DOFS.index(dof[1])))
    if not dofs:
        raise InputError("holds modes that are zero everywhere")
    shapes = np.array([[mode.components.get(dof, 0.0) for mode in modes] for dof in dofs])
    turns = np.array([dof.startswith("dr") for _, dof in dofs])
    shapes[turns] *= units.length  # rad per unit of length becomes rad per metre
    mass = np.array([mode.modal_mass for mode in modes]) / units.mass
    return ModeSet(
        frequency=np.array([mode.frequency for mode in modes]),
        damping=np.array([mode.damping for mode in modes]),
        modal_mass=mass if mass.all() else None,
        dofs=tuple(dofs),
        shapes=shapes,
    )


def _mode(data: DataSet) -> _Mode | None:
    """Return the mode of a data set; None where it is something else at nodes."""
    analysis, _, _, numbers, values = data.integers(5, 6)[1:6]
    if analysis not in (_NORMAL, *_COMPLEX):
        return None
    number = data.integers(6, 4)[3]
    part = data.reals(7, 4 if analysis == _NORMAL else 6)
    shape = _components(data, values, numbers == _COMPLEX_NUMBERS)
    if analysis == _NORMAL:
        frequency, mass, viscous, hysteretic = part[:4]
        real, _ = _in_phase(number, shape)
        return _Mode(frequency, viscous or 0.5 * hysteretic, mass, real)
    return _complex_mode(number, complex(part[0], part[1]), complex(part[2], part[3]), shape)


def _complex_mode(
    number: int, eigenvalue: complex, modal_a: complex, shape: dict[Dof, complex]
) -> _Mode:
    real, turn = _in_phase(number, shape)
    size = abs(eigenvalue)
    if size == 0.0:
        raise InputError(f"mode {number} has the eigenvalue zero")
    mass = modal_a * turn**2 / (2j * eigenvalue.imag) if eigenvalue.imag else 0j
    return _Mode(size / (2.0 * math.pi), -eigenvalue.real / size, max(mass.real, 0.0), real)


def _in_phase(number: int, shape: dict[Dof, complex]) -> tuple[dict[Dof, float], complex]:
    """Return the shape turned to be as real as it can be, and the factor that turned it."""
    values: NDArray[np.complex128] = np.array(list(shape.values()), dtype=complex)
    turn = 1.0 + 0.0j
    if np.any(values.imag):
        turn = cmath.exp(-0.5j * cmath.phase(complex(np.sum(values**2))))
        values = values * turn
        out = float(np.linalg.norm(values.imag) / np.linalg.norm(values))
        if out > IN_PHASE:
            what = f"mode {number} is complex: {out:.0%} of it moves out of phase"
            raise InputError(what, hint="give real modes")
    return dict(zip(shape, values.real.tolist(), strict=True)), turn


def _components(data: DataSet, values: int, is_complex: bool) -> dict[Dof, complex]:
    """Return the components at all nodes."""
    if values not in (3, 6):
        what = f"has {values} values a node, neither 3 displacements nor 6 with rotations"
        raise InputError(what, key=f"line {data.line + 5}")
    needed = values * (2 if is_complex else 1)
    components: dict[Dof, complex] = {}
    index = 8
    while index < len(data.lines):
        node = str(data.integers(index, 1)[0])
        index += 1
        numbers: list[float] = []
        while len(numbers) < needed:
            numbers += data.reals(index, 1)
            index += 1
        if is_complex:
            pairs = zip(numbers[:needed:2], numbers[1:needed:2], strict=True)
            at_node = [complex(*pair) for pair in pairs]
        else:
            at_node = [complex(number) for number in numbers[:needed]]
        if (node, "dx") in components:
            raise InputError(f"gives node {node} twice", key=f"line {data.line + index}")
        components.update(zip(((node, dof) for dof in DOFS), at_node, strict=False))
    if not components:
        raise InputError("a mode has no node", key=f"line {data.line}")
    return components
