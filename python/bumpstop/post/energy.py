"""The energy ledger over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop.errors import ComputationError
from bumpstop.labelled import time_coordinate
from bumpstop.quantities import ENERGIES, STOP_ENERGIES

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.arguments import FloatArray
    from bumpstop.response import Response

__all__ = ["LEAST_TOLD", "Ledger", "energy_dataset", "ledger", "residual_told"]

LEAST_TOLD = 1e-15
"""Residuals below this are told as less than it: two sums that happen to agree to the last
digit make them zero, which says no more."""


class Ledger(NamedTuple):
    """The energies of a response, in J."""

    terms: dict[str, FloatArray]
    """Each term of the whole, (time,)."""
    stops: dict[str, FloatArray]
    """What each stop stores and has dissipated, (time, stop)."""


def ledger(response: Response, times: FloatArray) -> Ledger:
    """Return the ledger, whole and stop by stop.

    The core integrates each term from its own power; this only adds them up:
    ``total = kinetic + elastic + stored + dissipated_damping + dissipated_stops``, which
    without rounding equals ``total_initial + load_work + circulatory_work + obstacle_work``;
    ``residual`` is what it misses.

    Parameters
    ----------
    response
        The response whose energies are asked for.
    times
        Instants in s within the simulated time.

    Raises
    ------
    ComputationError
        If energies have left the range of numbers.
    """
    # One call, with the start put first, so that the initial energy is summed as the others.
    core = response.history.energy(np.concatenate(([0.0], times)))
    stored = core["law_stored"].sum(axis=0)
    dissipated = core["law_dissipated"].sum(axis=0)
    present = core["kinetic"] + core["elastic"] + stored
    total = present + core["modal_dissipation"] + dissipated
    given = core["load_work"] + core["circulatory_work"] + core["obstacle_work"]
    terms = {
        "kinetic": core["kinetic"],
        "elastic": core["elastic"],
        "stored": stored,
        "dissipated_damping": core["modal_dissipation"],
        "dissipated_stops": dissipated,
        "load_work": core["load_work"],
        "circulatory_work": core["circulatory_work"],
        "obstacle_work": core["obstacle_work"],
        "total": total,
        "total_initial": np.full_like(total, present[0]),
        "residual": total - present[0] - given,
    }
    if not np.isfinite(terms["residual"]).all():
        raise ComputationError("the energies leave the range of numbers; check the units")
    stops = {"stored_in_stop": core["law_stored"].T, "dissipated_in_stop": core["law_dissipated"].T}
    return Ledger(
        terms={name: values[1:] for name, values in terms.items()},
        stops={name: values[1:] for name, values in stops.items()},
    )


def residual_told(residual: float) -> str:
    """Return the energy residual of a response as people are told it.

    Examples
    --------
    >>> residual_told(0.0), residual_told(3.14e-9), residual_told(float("nan"))
    ('< 1e-15', '3.1e-09', 'nan')
    """
    return f"< {LEAST_TOLD:.0e}" if residual < LEAST_TOLD else f"{residual:.1e}"


def energy_dataset(response: Response) -> xr.Dataset:
    """Return the ledger at the response's times, with the share of each stop."""
    import xarray as xr

    times = response.times
    found = ledger(response, times)
    terms = {
        name: ("time", values, ENERGIES[name].attributes) for name, values in found.terms.items()
    }
    shares = {
        name: (("time", "stop"), values, STOP_ENERGIES[name].attributes)
        for name, values in found.stops.items()
    }
    stops = [law.name for law in response.problem.laws]
    return xr.Dataset(terms | shares, coords={"time": time_coordinate(times), "stop": stops})
