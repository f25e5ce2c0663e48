"""Results of a study as an xarray Dataset over the swept parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.study.basins import SECTION, Basins, Classes, classified
from bumpstop.study.evaluation import FAILED
from bumpstop.study.layout import Array, unpacked_message
from bumpstop.study.parameters import recorded_parameter

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from bumpstop.study.store import Reader

__all__ = ["labelled"]

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
        beside it. What has not been run yet is NaN.
    """
    import xarray as xr

    names = list(definition["parameters"])
    shaped = _Shape(_levels(definition))
    found: dict[str, Any] = {}
    coordinates: dict[str, Any] = dict(shaped.coordinates)
    for name, array in arrays.items():
        if name in _OWN:
            continue
        if name in names:
            if name not in coordinates:
                coordinates[name] = ("run", _worded(read(name), array.attributes))
            continue
        attributes = dict(array.attributes)
        if "times" in attributes:
            dimension = f"{name}_time"
            instants = np.array(attributes.pop("times"))
            told = {"units": "s", "long_name": "time"}
            coordinates[dimension] = (dimension, instants, told)
        found[name] = (*shaped.placed(read(name), array.dimensions[1:]), attributes)
    failed = read("status") == FAILED
    found["failed"] = shaped.placed(failed, ())
    found["message"] = shaped.placed(_messages(failed, read), ())
    if "basins" in definition:
        classes = classified(Basins(**definition["basins"]), *map(read, SECTION))
        found["attractor"] = (*shaped.placed(classes.numbers, ()), _ATTRACTOR)
        found |= _attractors(classes)
    dataset = xr.Dataset(found, coordinates, attrs={"case": definition["title"]})
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
    """Return the values of each parameter on a grid, the slowest first; none without a grid."""
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


def _as_coordinate(levels: Sequence[Any]) -> NDArray[Any]:
    has_words = any(isinstance(level, str) for level in levels)
    return np.array(levels, dtype=object if has_words else None)


def _worded(numbers: NDArray[Any], attributes: Mapping[str, Any]) -> NDArray[Any]:
    """Return the words that stand for numbers, where they do."""
    words = attributes.get("words")
    if words is None:
        return numbers
    return np.array([words[number] if number >= 0 else "" for number in numbers], dtype=object)


def _messages(failed: NDArray[np.bool_], read: Reader) -> NDArray[Any]:
    """Return why runs failed; only what is said of failed ones is read."""
    texts = np.full(len(failed), "", dtype=object)
    for start in range(0, len(failed), _BLOCK):
        runs = np.flatnonzero(failed[start : start + _BLOCK])
        if len(runs):
            block = read("message", slice(start, start + _BLOCK))
            texts[start + runs] = [unpacked_message(block[run]) for run in runs]
    return texts
