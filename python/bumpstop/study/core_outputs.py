"""Outputs that the core reads by itself, without a response in Python."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from bumpstop import _core
from bumpstop.laws.stop import Stop
from bumpstop.post.references import IMPACT_COLUMNS

if TYPE_CHECKING:
    from bumpstop.problem import Law, Problem
    from bumpstop.study.outputs import Output

__all__ = ["core_quantities", "core_quantity"]

_OF_RUN = ("events", "steps", "energy_residual", "motion_error", "missed_penetration")
_OF_NODE = ("displacement", "velocity")
_OF_STOP = {"gap": "distance", "stop_force": "force"}
_ENERGIES = (
    "kinetic",
    "elastic",
    "stored",
    "dissipated_damping",
    "dissipated_stops",
    "load_work",
    "circulatory_work",
    "obstacle_work",
)
_EXTREMES = ("maximum", "minimum", "peak")
_STATISTICS = (None, "maximum", "minimum", "peak", "last")
"""Of impacts; means are added up in numpy's order."""


def core_quantities(
    problem: Problem, outputs: Mapping[str, Output]
) -> dict[str, _core.Quantity] | None:
    """Return all outputs as the core reads them; None where it cannot read one of them."""
    found = {key: core_quantity(problem, output) for key, output in outputs.items()}
    known = {key: quantity for key, quantity in found.items() if quantity is not None}
    return known if len(known) == len(found) else None


def core_quantity(problem: Problem, output: Output) -> _core.Quantity | None:
    """Return an output as the core reads it: the same bits as from a response.

    Parameters
    ----------
    problem
        A problem that has what the output is of.
    output
        What to keep.
    """
    what = output.quantity
    if what in _OF_RUN:
        return _core.Quantity.of_run(what)
    if what == "impacts":
        return _core.Quantity.impact_count()
    if what == "largest_force":
        law = _law(problem, output)
        # A rigid stop's force has no bound; only a stop's impacts hold all of its force.
        return _core.Quantity.largest_force(law) if _is_plain(problem.laws[law]) else None
    if what in IMPACT_COLUMNS and output.statistic in _STATISTICS:
        number = (output.impact or 1) - 1
        law = _law(problem, output)
        if output.latest is not None:
            return _core.Quantity.last_impacts(law, IMPACT_COLUMNS[what], output.latest)
        return _core.Quantity.impacts(law, IMPACT_COLUMNS[what], output.statistic, number)
    if output.times:
        times = np.clip(output.times, 0.0, problem.duration)
    elif output.statistic == "last":
        times = problem.times[-1:]
    elif output.statistic in _EXTREMES and what != "energy":
        samples = _over_time(problem, output, problem.times)
        return samples and _core.Quantity.extreme(samples, output.statistic)
    else:
        return None
    return _over_time(problem, output, times)


def _over_time(problem: Problem, output: Output, times: np.ndarray) -> _core.Quantity | None:
    """Return a quantity of time at some instants."""
    what = output.quantity
    if what in _OF_STOP:
        return _core.Quantity.law(_law(problem, output), _OF_STOP[what], times)
    if what == "energy" and output.term in _ENERGIES:
        return _core.Quantity.energy(str(output.term), times)
    if problem.supports_move:
        return None  # what the supports carry along is added in Python
    if what in _OF_NODE:
        row = problem.basis.row(str(output.node), str(output.dof))
        return _core.Quantity.motion(row, _OF_NODE.index(what), times)
    if what == "gauge":
        gauge = next(gauge for gauge in problem.gauges if gauge.name == output.gauge)
        return _core.Quantity.motion(problem.basis.gauge_row(gauge), 0, times)
    return None


def _is_plain(law: Law) -> bool:
    """Tell whether a law is a stop without friction."""
    return isinstance(law, Stop) and law.friction is None


def _law(problem: Problem, output: Output) -> int:
    return [law.name for law in problem.laws].index(str(output.stop))
