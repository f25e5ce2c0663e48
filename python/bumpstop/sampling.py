"""Sampling: quantities of a response as plain arrays over time.

Whatever is made of the motion of all modes is made block by block of instants, so that a signal
of any length takes the memory of itself and of one block.
"""

from __future__ import annotations

from collections.abc import Iterator
from numbers import Integral
from typing import TYPE_CHECKING, Any, SupportsIndex

import numpy as np

from bumpstop.arguments import FloatArray, one_of
from bumpstop.errors import InputError
from bumpstop.projection import along
from bumpstop.quantities import QUANTITIES, STATE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bumpstop.response import Response

__all__ = ["MOTIONS", "kept_rows", "sampled"]

MOTIONS = ("displacement", "velocity", "acceleration")
"""Position in this list is the derivative that the core is asked for."""
MOST_NUMBERS = 4_000_000
"""Modes times instants of a block."""


def sampled(
    response: Response, quantity: str, target: tuple[str | SupportsIndex, ...], times: FloatArray
) -> NDArray[Any]:
    """Return a quantity at instants within the run; see `Response.sample`.

    Raises
    ------
    InputError
        If quantity or target are unknown.
    """
    one_of("quantity", quantity, (*QUANTITIES, "state", "internal_variable"))
    _check_target(quantity, target)
    if quantity in MOTIONS:
        return _nodal(response, quantity, *map(str, target), times=times)
    if quantity.startswith("modal_"):
        if response.kept is not None:
            hint = "a smaller model or larger steps leave room for all"
            raise InputError("are not kept for each dof", key="quantity", value=quantity, hint=hint)
        motion = response.motion(MOTIONS.index(quantity.removeprefix("modal_")), times)
        amplitudes = response.problem.basis.amplitudes(motion)
        return amplitudes[:, _mode_index(response, target[0])] if target else amplitudes
    name = str(target[0])
    if quantity == "gauge":
        return _gauge_strain(response, name, times)
    if quantity == "internal_variable":
        return _internal_variable(response, name, str(target[1]), times)
    return _of_law(response, quantity, response.law_index(name), times)


def _internal_variable(
    response: Response, name: str, variable: str, times: FloatArray
) -> FloatArray:
    law = response.law_index(name)
    known: tuple[str, ...] = getattr(response.problem.laws[law], "internal_variables", ())
    if not known:
        hint = "friction, plasticity, buckling and dashpots with springs do"
        raise InputError("remembers nothing", key="law", value=name, hint=hint)
    column = known.index(one_of("variable", variable, known))
    return response.history.internal_variables(law, times)[:, column].copy()


def _nodal(
    response: Response, quantity: str, node: str, dof: str, *, times: FloatArray
) -> FloatArray:
    row, derivative = response.problem.basis.row(node, dof), MOTIONS.index(quantity)
    own = _along(response, row, derivative, times)
    if not response.problem.supports_move:
        return own
    from bumpstop.carried import carried_node

    return own + carried_node(response.problem, node, dof, times, derivative)


def _gauge_strain(response: Response, name: str, times: FloatArray) -> FloatArray:
    gauges = {known.name: known for known in response.problem.gauges}
    gauge = gauges[one_of("gauge", name, tuple(gauges))]
    own = _along(response, response.problem.basis.gauge_row(gauge), 0, times)
    if not response.problem.supports_move:
        return own
    from bumpstop.carried import carried_gauge

    return own + carried_gauge(response.problem, gauge, times)


def kept_rows(response: Response, rows: FloatArray) -> FloatArray:
    """Return what rows of the basis (..., N) are by the coordinates that `Response.motion` tells.

    Raises
    ------
    InputError
        If they need coordinates of a full model that were not kept.
    """
    if response.kept is None:
        return rows
    known = rows[..., response.kept]
    if np.count_nonzero(rows) != np.count_nonzero(known):
        what = "was not kept: there are more dofs and steps than memory has room for"
        raise InputError(what, key="target", hint="name the place among the outputs")
    return known


def _along(response: Response, row: FloatArray, derivative: int, times: FloatArray) -> FloatArray:
    """Return the motion (time,) of what a row of the basis (N,) stands for."""
    row = kept_rows(response, row)
    if MOTIONS[derivative] != "acceleration":
        return response.history.project(row, times, derivative)
    # From the equations of motion, which have the laws' forces to the last digit.
    found = np.empty(len(times))
    for part in _blocks(len(times), len(row)):
        found[part] = along(row, response.motion(derivative, times[part]))
    return found


def _blocks(instants: int, modes: int) -> Iterator[slice]:
    size = max(MOST_NUMBERS // max(modes, 1), 1)
    return (slice(start, start + size) for start in range(0, instants, size))


def _of_law(response: Response, quantity: str, law: int, times: FloatArray) -> NDArray[Any]:
    history = response.history
    if quantity == "state":
        return np.array(history.law_states(law, times))
    if quantity == "friction_force":
        return history.contact_forces(law, times)[:, 1].copy()
    distance, _, force = history.law_motion(law, times)
    return force if quantity == "stop_force" else distance


def _mode_index(response: Response, mode: str | SupportsIndex) -> int:
    modes = len(response.problem.basis.labels)
    # numpy counts in integers of its own; True is no number of a mode.
    whole = isinstance(mode, Integral) and not isinstance(mode, bool)
    number = int(mode) if whole else 0
    if not 1 <= number <= modes:
        raise InputError(f"must be a mode from 1 to {modes}", key="mode", value=mode)
    return number - 1


def _check_target(quantity: str, target: tuple[str | SupportsIndex, ...]) -> None:
    others = {"state": STATE.target, "internal_variable": ("law", "variable")}
    wanted = others[quantity] if quantity in others else QUANTITIES[quantity].target
    if len(target) == len(wanted) or (wanted == ("mode",) and not target):
        return
    what = f"{quantity} is that of a {' and a '.join(wanted)}"
    raise InputError(what, key="target", value=target)
