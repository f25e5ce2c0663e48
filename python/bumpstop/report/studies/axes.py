"""What the pictures of a study share: its parameters and outputs on axes, runs behind points."""

from __future__ import annotations

from collections.abc import Hashable
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.report.plotting import Axis, layout_of
from bumpstop.report.scales import Scale, scale_for
from bumpstop.report.words import shown

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

__all__ = [
    "check_results",
    "layout_over",
    "output_axis",
    "parameter_axis",
    "parameters_of",
    "required",
    "run_numbers",
    "units_of",
]

_LEAST_IN_LOG = 3
_DECADES = 100.0
"""From this ratio of the largest value to the smallest on, ticks are at powers of ten alone."""


def check_results(key: str, results: object) -> None:
    """Raise where something is not what a study has found."""
    if not hasattr(results, "data_vars"):
        hint = "take what a study returns"
        raise InputError("must be a Dataset", key=key, value=results, hint=hint)


def parameters_of(results: xr.Dataset) -> list[str]:
    """Return the parameters of a study, from its results."""
    grid = [str(name) for name in results.failed.dims if name != "run"]
    beside = [str(name) for name, each in results.coords.items() if each.dims == ("run",)]
    return grid or [name for name in beside if name != "run"]


def run_numbers(results: xr.Dataset) -> xr.DataArray:
    """Return the number of each run, as a study counts them."""
    if "run_number" in results.coords:
        return results.coords["run_number"]
    if "run" in results.coords:
        return results.coords["run"]
    failed = results.failed
    numbers: xr.DataArray = failed.copy(data=np.arange(failed.size).reshape(failed.shape))
    return numbers


def required(results: xr.Dataset, name: Hashable) -> xr.DataArray:
    """Return an output of a study.

    Raises
    ------
    InputError
        If it has none of that name.
    """
    if name in results.data_vars:
        found: xr.DataArray = results[name]
        return found
    known = [str(each) for each in results.data_vars if each not in ("failed", "message")]
    raise InputError("no such output", key="output", value=name, hint=did_you_mean(name, known))


def output_axis(array: xr.DataArray) -> Axis:
    """Return the axis of an output, in a unit that suits its values."""
    units = shown(str(array.attrs.get("units", "1")))
    words = str(array.name).replace("_", " ")
    values = np.asarray(array.values, dtype=float)
    scale = scale_for(units, values) if units not in ("1", "") else Scale(1.0, "1")
    return Axis(words[:1].upper() + words[1:], scale)


def units_of(parameter: xr.DataArray) -> str:
    """Return the unit of a parameter as it is shown; ``"1"`` where it has none."""
    return shown(str(parameter.attrs.get("units", "1")))


def parameter_axis(parameter: xr.DataArray) -> dict[str, Any]:
    """Return an axis for the values of a parameter, as plotly has it."""
    levels = parameter.values
    layout = Axis(str(parameter.name), Scale(1.0, units_of(parameter))).layout()
    if levels.dtype.kind not in "iuf":
        return layout | {"type": "category"}
    # Not plotly's letters, which would stand beside a unit.
    layout |= {"exponentformat": "power"}
    if not _is_log(levels):
        return layout
    # Where there are decades enough to tell, twos and fives between them would crowd narrow pages.
    wide = float(levels.max() / levels.min()) >= _DECADES
    return layout | {"type": "log"} | ({"dtick": 1} if wide else {})


def layout_over(
    title: str, x: xr.DataArray, y: dict[str, Any], subtitle: str = ""
) -> dict[str, Any]:
    """Return the layout of a figure over a parameter."""
    plain = Axis(str(x.name), Scale(1.0, "1"))
    layout = layout_of(title, plain, plain, subtitle)
    layout |= {"xaxis": parameter_axis(x), "yaxis": y, "hovermode": "closest"}
    layout["showlegend"] = False
    return layout


def _is_log(levels: NDArray[Any]) -> bool:
    """Return whether values lie in equal ratios."""
    ordered = np.unique(levels.astype(float))
    if len(ordered) < _LEAST_IN_LOG or ordered[0] <= 0.0:
        return False
    steps = np.diff(np.log(ordered))
    return bool(np.ptp(steps) < 1e-6 * steps.max()) and not np.allclose(np.diff(ordered, 2), 0.0)
