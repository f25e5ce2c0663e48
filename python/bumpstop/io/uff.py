"""Universal files: signals as data sets 58, for programs of measurement and modal analysis.

Format: "Universal File Datasets Summary", Structural Dynamics Research Laboratory, University of
Cincinnati, data sets 58 (function at nodal dof) and 164 (units). The reader of such files is
`bumpstop.io.universal`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from os import PathLike
from typing import TYPE_CHECKING, NamedTuple, TextIO

import numpy as np

from bumpstop.files import written_whole
from bumpstop.io.signals import Signal, sampled_blocks, signals
from bumpstop.structure.dofs import DOFS

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.response import Response

__all__ = ["write_uff"]

FENCE = "    -1\n"
SI = (
    "   164\n"
    f"{1:10d}{'SI: Meter (newton)':<20}{2:10d}\n"
    f"{1.0:25.17E}{1.0:25.17E}{1.0:25.17E}\n{273.15:25.17E}\n"
)
TIME_RESPONSE = 1
DOUBLE = 4
EVEN = 1e-9
"""Steps that differ by less than this, relative to the first, are equal."""


class _Kind(NamedTuple):
    """How data set 58 calls what is on an axis: its type, and exponents of length and force."""

    type: int
    length: int
    force: int


_TIME = _Kind(17, 0, 0)
_NOTHING = _Kind(0, 0, 0)
_KINDS = {
    "displacement": _Kind(8, 1, 0),
    "velocity": _Kind(11, 1, 0),
    "acceleration": _Kind(12, 1, 0),
    "gap": _Kind(8, 1, 0),
    "stop_force": _Kind(9, 0, 1),
    "friction_force": _Kind(9, 0, 1),
    "gauge": _Kind(3, 0, 0),
}


def write_uff(response: Response, path: str | PathLike[str]) -> None:
    """Write the signals of a response, tabulated at its times, to a universal file.

    Each is a data set 58 in text form: a time response of double precision, twelve digits, in SI
    units (data set 164). Nodes have numbers, from 1 in the order of the basis; the first lines of
    a data set say their names. Instants that are evenly spaced are told by start and step, any
    others one by one, either with the six digits of the format.

    Parameters
    ----------
    response
        What to write.
    path
        The file; one of that name is replaced once the new one is complete.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    nodes = list(dict.fromkeys(node for node, _ in response.problem.basis.dofs))
    with written_whole(path) as part, part.open("w", encoding="ascii", errors="replace") as file:
        file.write(f"{FENCE}{SI}{FENCE}")
        # What laws remember is no kind of quantity of the format.
        told = [each for each in signals(response) if each.quantity in _KINDS]
        for number, signal in enumerate(told, start=1):
            file.write(f"{FENCE}    58\n")
            file.writelines(_head(response, signal, number, nodes))
            _write_values(file, response, signal)
            file.write(FENCE)


def _head(response: Response, signal: Signal, number: int, nodes: Sequence[str]) -> Iterator[str]:
    """Yield the eleven lines before the values."""
    texts = (signal.long_name, signal.name, "bumpstop", " ".join(signal.target), "NONE")
    for text in texts:
        yield f"{text[:80]:<80}\n"
    node, direction = _place(signal, nodes)
    entity = f" {signal.target[0][:10]:<10}"
    yield f"{TIME_RESPONSE:5d}{number:10d}{0:5d}{0:10d}{entity}{node:10d}{direction:4d}"
    yield f" {'NONE':<10}{0:10d}{0:4d}\n"
    times = response.times
    step = _step(times)
    yield f"{DOUBLE:10d}{len(times):10d}{int(step > 0.0):10d}"
    yield f"{times[0]:13.5E}{step:13.5E}{0.0:13.5E}\n"
    kind = _KINDS[signal.quantity]
    for axis, label, units in (
        (_TIME, "Time", "s"),
        (kind, signal.quantity, signal.units),
        (_NOTHING, "NONE", "NONE"),
        (_NOTHING, "NONE", "NONE"),
    ):
        yield f"{axis.type:10d}{axis.length:5d}{axis.force:5d}{0:5d} {label:<20} {units:<20}\n"


def _place(signal: Signal, nodes: Sequence[str]) -> tuple[int, int]:
    """Return the number of a node and of a direction; 0 where a signal is not of a node."""
    if len(signal.target) < 2:
        return 0, 0
    node, dof = signal.target
    # A point along a beam is no node.
    return nodes.index(node) + 1 if node in nodes else 0, DOFS.index(dof) + 1


def _step(times: FloatArray) -> float:
    """Return the step of evenly spaced instants, 0 for any others."""
    if len(times) < 2:
        return 0.0
    step = (times[-1] - times[0]) / (len(times) - 1)
    even = np.abs(times - (times[0] + step * np.arange(len(times)))).max() <= EVEN * step
    return float(step) if even else 0.0


def _write_values(file: TextIO, response: Response, signal: Signal) -> None:
    even = _step(response.times) > 0.0
    form, columns = ("%20.12E" * 4, 4) if even else ("%13.5E%20.12E" * 2, 2)
    for times, (values,) in sampled_blocks(response, [signal]):
        numbers = values[:, np.newaxis] if even else np.stack([times, values], axis=1)
        whole = len(numbers) // columns * columns  # BLOCK is a multiple: only the last is short
        if whole:
            np.savetxt(file, numbers[:whole].reshape(whole // columns, -1), fmt=form)
        if whole < len(numbers):
            rest = numbers[whole:].reshape(1, -1)
            np.savetxt(file, rest, fmt=form[: len(form) * (len(numbers) - whole) // columns])
