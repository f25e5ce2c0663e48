"""Measured functions of universal files: data sets 58 in text form, in the units of data set 164.

Frequency response functions (function type 4) of displacements, velocities or accelerations over
forces are taken; spectra, coherences and time series beside them are passed over.
Source: as for universal.py.
"""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.io.universal import DataSet, Units
from bumpstop.modal.frequency_response import ComplexArray, FrequencyResponse
from bumpstop.structure.dofs import DOFS, Dof

__all__ = ["measured_functions"]

_FREQUENCY_RESPONSE = 4
_FREQUENCY, _FORCE = 18, 13
_KINDS = {8: "displacement", 11: "velocity", 12: "acceleration"}
_FORMS = {2: (1, 13), 4: (1, 20), 5: (2, 13), 6: (2, 20)}
"""By ordinate data type: how many numbers a value has, and how wide they are."""
_ABSCISSA_WIDTH = 13
_DOF_RECORD, _FORM_RECORD, _ABSCISSA_RECORD, _FIRST_VALUES = 5, 6, 7, 11
_RESPONSE, _REFERENCE = slice(41, 55), slice(66, 80)
"""Columns of a node, ten wide, and its direction, four wide."""


def measured_functions(found: list[DataSet], units: Units) -> list[FrequencyResponse]:
    """Return the frequency response functions among data sets.

    Raises
    ------
    InputError
        If there is none, or one is truncated, has no reference, or is not of a motion over a force.
    """
    taken = [data for data in found if data.number == 58 and _type(data) == _FREQUENCY_RESPONSE]
    if not taken:
        hint = "modes are identified from data sets 58 of function type 4"
        raise InputError("holds no frequency response function", hint=hint)
    return [_function(data, units) for data in taken]


def _type(data: DataSet) -> int:
    return _whole(data, _DOF_RECORD, slice(0, 5), "function type")


def _function(data: DataSet, units: Units) -> FrequencyResponse:
    response, sign = _dof(data, _RESPONSE, "response")
    reference, reference_sign = _dof(data, _REFERENCE, "reference")
    kind = _kind(data)
    frequency, values = _values(data)
    size = _length(response, units) / (units.force * _length(reference, units, turning=True))
    return FrequencyResponse(
        frequency=frequency,
        values=values * (sign * reference_sign / size),
        response=response,
        reference=reference,
        kind=kind,
    )


def _length(dof: Dof, units: Units, *, turning: bool = False) -> float:
    """Return the unit of length if the dof has one: a displacement, or (turning) a moment."""
    return units.length if dof[1].startswith("dr") == turning else 1.0


def _dof(data: DataSet, columns: slice, role: str) -> tuple[Dof, float]:
    """Return node and dof of a record, and the sign of the direction."""
    middle = columns.start + 10
    node = _whole(data, _DOF_RECORD, slice(columns.start, middle), f"{role} node")
    direction = _whole(data, _DOF_RECORD, slice(middle, columns.stop), f"{role} direction")
    if not (node and 1 <= abs(direction) <= len(DOFS)):
        place = f"line {data.line + _DOF_RECORD}"
        raise InputError(f"data set 58 has no {role} node and direction", key=place)
    return (str(node), DOFS[abs(direction) - 1]), 1.0 if direction > 0 else -1.0


def _whole(data: DataSet, record: int, columns: slice, what: str) -> int:
    text = data.text(record)[columns].strip()
    try:
        return int(text or 0)
    except ValueError as error:
        place = f"line {data.line + record}"
        raise InputError(f"{what} must be a whole number", key=place, value=text) from error


def _kind(data: DataSet) -> str:
    abscissa, ordinate, denominator = (
        _whole(data, _ABSCISSA_RECORD + record, slice(0, 10), "data type") for record in range(3)
    )
    if abscissa != _FREQUENCY or denominator != _FORCE or ordinate not in _KINDS:
        what = "data set 58 is not a displacement, velocity or acceleration (data types 8, 11, 12)"
        what += " over a force (13) by frequency (18)"
        given = f"{ordinate} over {denominator} by {abscissa}"
        raise InputError(what, key=f"line {data.line + _ABSCISSA_RECORD}", value=given)
    return _KINDS[ordinate]


def _values(data: DataSet) -> tuple[FloatArray, ComplexArray]:
    """Return frequencies and values."""
    form, number, even = data.integers(_FORM_RECORD, 3, end=30)
    if form not in _FORMS or number < 1:
        what = "data set 58 has no ordinate data type 2, 4, 5 or 6, or no value"
        raise InputError(what, key=f"line {data.line + _FORM_RECORD}", value=form)
    parts, width = _FORMS[form]
    if even:
        rows = _rows(data, [width] * parts, number)
        start, step = data.reals(_FORM_RECORD, 2, start=30)[:2]
        frequency: FloatArray = start + step * np.arange(number, dtype=np.float64)
    else:
        rows = _rows(data, [_ABSCISSA_WIDTH, *[width] * parts], number)
        frequency, rows = rows[:, 0], rows[:, 1:]
    values = rows[:, 0].astype(np.complex128)
    if parts == 2:
        values.imag = rows[:, 1]
    return frequency, values


def _rows(data: DataSet, widths: list[int], number: int) -> FloatArray:
    """Return the values, a row each, which are written one after the other in all lines."""
    numbers: list[float] = []
    for index in range(_FIRST_VALUES, len(data.lines)):
        numbers += data.fields(index, _line_widths(widths))
    needed = number * len(widths)
    if len(numbers) < needed:
        what = f"data set 58 is truncated: {len(numbers)} numbers instead of {needed}"
        raise InputError(what, key=f"line {data.line + len(data.lines)}")
    rows = np.array(numbers[:needed]).reshape(number, len(widths))
    if not np.isfinite(rows).all():
        place = f"line {data.line + _FIRST_VALUES}"
        raise InputError("data set 58 must hold finite numbers", key=place)
    return rows


def _line_widths(widths: list[int]) -> list[int]:
    """Return the widths of a full line of 80 characters."""
    return widths * (80 // sum(widths))
