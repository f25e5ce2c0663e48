"""Results of a study as an xarray Dataset over the swept parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.study.basins import SECTION, Basins, Classes, classified
from bumpstop.study.evaluation import FAILED
from bumpstop.study.indices import PARTS, indices_of_runs
from bumpstop.study.layout import STATE, Array, unpacked_message, worded
from bumpstop.study.parameters import recorded_parameter
from bumpstop.study.sampling import SIDES

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from bumpstop.study.store import Reader

__all__ = ["labelled"]

NOT_MADE = "not made yet"
"""Message of a run that is still to be made."""
_OWN = ("message", "status")
_BLOCK = 4096
"""Runs whose messages are read at a time."""


def labelled(
    definition: Mapping[str, Any], arrays: Mapping[str, Array], read: Reader
) -> xr.Dataset:
    """Return the results of a study.

    Parameters
    ----------
    definition
        What the study is.
    arrays
        Its arrays.
    read
        Reads what is in them.

    Returns
    -------
    xarray.Dataset
        The outputs, whether a run ``failed``, and its ``message``; over the parameters of a
        grid, with the number of each ``run`` beside them, or over ``run`` with the parameters
        beside it. Of runs that follow one another: over ``way`` and ``run``. Of each parameter
        alone: over ``parameter`` and ``side``, with its ``value``. Sobol's indices,
        where the runs are those that tell them, as ``NAME_first`` and ``NAME_total`` over
        ``parameter``; NaN where a run has no such result. What has not been run yet is NaN, and
        its message says so.
    """
    import xarray as xr

    names = list(definition["parameters"])
    sampling, in_order = definition["sampling"], definition["slowest_first"]
    follows = sampling["method"] == "continuation"
    shaped = _Ways(arrays["status"].shape[0]) if follows else _Shape(_levels(definition))
    found: dict[str, Any] = {}
    coordinates: dict[str, Any] = dict(shaped.coordinates)
    for name, array in arrays.items():
        if name in _OWN or (follows and name in STATE):
            continue
        if name in names:
            if name not in coordinates:
                coordinates[name] = shaped.beside(worded(read(name), array.attributes))
            continue
        attributes = dict(array.attributes)
        if "times" in attributes:
            dimension = f"{name}_time"
            instants = np.array(attributes.pop("times"))
            told = {"units": "s", "long_name": "time"}
            coordinates[dimension] = (dimension, instants, told)
        values = read(name)
        found[name] = (*shaped.placed(values, array.dimensions[1:]), attributes)
        if sampling["method"] == "saltelli" and values.ndim == 1:
            coordinates["parameter"] = in_order
            indices = indices_of_runs(values, sampling["count"])._asdict()
            for part, told_part in PARTS.items():
                found[f"{name}_{part}"] = ("parameter", indices[part], {"long_name": told_part})
    status = read("status")
    failed = status == FAILED
    found["failed"] = shaped.placed(failed, ())
    messages = _messages(failed, read)
    messages[status == 0] = NOT_MADE
    found["message"] = shaped.placed(messages, ())
    if "basins" in definition:
        classes = classified(Basins(**definition["basins"]), *map(read, SECTION))
        found["attractor"] = (*shaped.placed(classes.numbers, ()), _ATTRACTOR)
        found |= _attractors(classes)
    dataset = xr.Dataset(found, coordinates, attrs={"case": definition["title"]})
    for name in names:
        if "units" in arrays[name].attributes:
            dataset[name].attrs["units"] = arrays[name].attributes["units"]
    if sampling["method"] == "one_at_a_time":
        own = [dataset[name].values[at] for at, name in enumerate(in_order)]
        return dataset.assign(value=(shaped.names, np.array(own, dtype=object)))
    return dataset.transpose(*names, ...) if shaped.names else dataset


_ATTRACTOR = {"units": "1", "long_name": "attractor reached, 0 where none was found"}


def _attractors(classes: Classes) -> dict[str, Any]:
    """Return what is told of each attractor, counted from 1, over ``attractors``."""
    most = max((each.periods for each in classes.attractors), default=0)
    sections = np.full((2, len(classes.attractors), most), np.nan)
    for number, each in enumerate(classes.attractors):
        sections[:, number, : each.periods] = each.displacement, each.velocity
    whole = {"units": "1"}
    return {
        "attractor_periods": (
            "attractors",
            np.array([each.periods for each in classes.attractors], dtype=np.int64),
            whole | {"long_name": "periods after which it comes back"},
        ),
        "attractor_runs": (
            "attractors",
            np.array([each.runs for each in classes.attractors], dtype=np.int64),
            whole | {"long_name": "runs that end on it"},
        ),
        "attractor_displacement": (("attractors", "point"), sections[0], {"units": "m"}),
        "attractor_velocity": (("attractors", "point"), sections[1], {"units": "m/s"}),
    }


def _levels(definition: Mapping[str, Any]) -> dict[str, Sequence[Any]]:
    """Return what runs on a grid lie over, the slowest first; nothing without a grid."""
    if definition["sampling"]["method"] == "one_at_a_time":
        return {"parameter": definition["slowest_first"], "side": SIDES}
    if definition["sampling"]["method"] != "grid":
        return {}
    records = definition["parameters"]
    return {name: recorded_parameter(records[name]).levels for name in definition["slowest_first"]}


class _Shape:
    """How runs lie in an array: side by side, or on a grid."""

    def __init__(self, levels: Mapping[str, Sequence[Any]]) -> None:
        self.names = tuple(levels)
        self._sizes = tuple(map(len, levels.values()))
        self.coordinates: dict[str, Any] = {
            name: (name, _as_coordinate(each)) for name, each in levels.items()
        }
        if levels:
            numbers = np.arange(math.prod(self._sizes))
            self.coordinates["run"] = self.placed(numbers, ())

    def placed(
        self, values: NDArray[Any], more: Sequence[str]
    ) -> tuple[tuple[str, ...], NDArray[Any]]:
        """Return values with the names of their dimensions."""
        if not self.names:
            return ("run", *more), values
        return (*self.names, *more), values.reshape(*self._sizes, *values.shape[1:])

    def beside(self, values: NDArray[Any]) -> tuple[tuple[str, ...], NDArray[Any]]:
        """Return values of a parameter with the names of their dimensions."""
        return self.placed(values, ())


class _Ways(_Shape):
    """A way up and one down through the same values: both over these as they go up."""

    def __init__(self, runs: int) -> None:
        super().__init__({})
        self.coordinates = {"way": ["up", "down"], "run_number": self.placed(np.arange(runs), ())}

    def placed(
        self, values: NDArray[Any], more: Sequence[str]
    ) -> tuple[tuple[str, ...], NDArray[Any]]:
        """Return values over ways and runs."""
        up, down = np.split(values, 2)
        return ("way", "run", *more), np.stack([up, down[::-1]])

    def beside(self, values: NDArray[Any]) -> tuple[tuple[str, ...], NDArray[Any]]:
        """Return values over the runs of the way up."""
        return ("run",), values[: len(values) // 2]


def _as_coordinate(levels: Sequence[Any]) -> NDArray[Any]:
    has_words = any(isinstance(level, str) for level in levels)
    return np.array(levels, dtype=object if has_words else None)


def _messages(failed: NDArray[np.bool_], read: Reader) -> NDArray[Any]:
    """Return why runs failed; only what is said of failed ones is read."""
    texts = np.full(len(failed), "", dtype=object)
    for start in range(0, len(failed), _BLOCK):
        runs = np.flatnonzero(failed[start : start + _BLOCK])
        if len(runs):
            block = read("message", slice(start, start + _BLOCK))
            texts[start + runs] = [unpacked_message(block[run]) for run in runs]
    return texts
