"""Arrays over time with names, units and words: what users and plots like to get."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bumpstop.quantities import INTERNAL_VARIABLES, QUANTITIES, modal_attributes

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.response import Response

__all__ = ["internal_variables", "modes_over_time", "over_time", "time_coordinate"]


def time_coordinate(times: FloatArray) -> xr.Variable:
    """Return instants in s as a coordinate."""
    import xarray as xr

    return xr.Variable("time", times, {"units": "s", "long_name": "time"})


def over_time(
    quantity: str, times: FloatArray, values: FloatArray, **attributes: str
) -> xr.DataArray:
    """Return values (time,) of a quantity; attributes add to its unit and long name."""
    import xarray as xr

    return xr.DataArray(
        values,
        coords={"time": time_coordinate(times)},
        name=quantity,
        attrs=QUANTITIES[quantity].attributes | attributes,
    )


def internal_variables(response: Response, name: str) -> xr.Dataset:
    """Return what a law remembers; see `Response.internal_variables`."""
    import xarray as xr

    law = response.problem.laws[response.law_index(name)]
    # Where it remembers nothing, the first reading says so.
    names: tuple[str, ...] = getattr(law, "internal_variables", ()) or ("memory",)
    found = {
        each: (
            "time",
            response.sample("internal_variable", name, each),
            INTERNAL_VARIABLES[each].attributes,
        )
        for each in names
    }
    return xr.Dataset(found, {"time": time_coordinate(response.times)}, {"law": name})


def modes_over_time(
    quantity: str, times: FloatArray, values: FloatArray, basis: ModalBasis
) -> xr.DataArray:
    """Return values (time, mode), modes counted from 1 and with what each of them is.

    Where the modes are as the user gave them, their frequencies in Hz are there too.
    """
    import xarray as xr

    coordinates = {
        "time": time_coordinate(times),
        "mode": np.arange(1, len(basis.labels) + 1),
        "label": ("mode", list(basis.labels)),
    }
    if basis.coordinates is None:
        hertz = {"units": "Hz", "long_name": "natural frequency"}
        coordinates["frequency"] = ("mode", basis.frequencies, hertz)
    return xr.DataArray(
        values,
        dims=("time", "mode"),
        coords=coordinates,
        name=quantity,
        attrs=modal_attributes(quantity, unit_mass=basis.coordinates is None),
    )
