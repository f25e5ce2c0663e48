"""The arrays that a study fills: parameters, outputs, and how each run ended."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.study.outputs import Output
from bumpstop.study.parameters import Level

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bumpstop.study.sampling import Runs

__all__ = ["STATE", "Array", "Layout", "packed_message", "unpacked_message", "worded"]

STATE = ("end_displacement", "end_velocity")
"""The state of the modes at the end of each run, where the next one starts in it."""

LONGEST_MESSAGE = 240
"""Bytes of the message of a failed run."""
_MOST_IN_CHUNK = 1024
_CHUNKS = 64
"""Chunks of a study that has few runs."""


@dataclass(frozen=True)
class Array:
    """One array of a study."""

    shape: tuple[int, ...]
    dtype: str
    fill: float
    dimensions: tuple[str, ...]
    attributes: dict[str, Any] = field(default_factory=dict)

    def empty(self) -> NDArray[Any]:
        """Return it with nothing in it yet."""
        if self.fill == 0:
            return np.zeros(self.shape, self.dtype)  # takes memory where it is written alone
        return np.full(self.shape, self.fill, self.dtype)


class Layout:
    """What arrays a study has, and in which chunks they are filled.

    Parameters
    ----------
    runs
        The runs.
    outputs
        What is kept of each.
    chunk
        Runs in a chunk; where left out a 64th of them, and 1024 at most. It does not depend
        on who makes the runs, so that a store has the same files whoever does.
    modes
        How many numbers the state of a run has, where the next one starts in it.
    units
        Units of parameters.
    """

    def __init__(
        self,
        runs: Runs,
        outputs: Mapping[str, Output],
        chunk: int | None = None,
        *,
        modes: int | None = None,
        units: Mapping[str, str] | None = None,
    ) -> None:
        self._units = units or {}
        self.count = runs.count
        self.chunk = chunk or max(1, min(_MOST_IN_CHUNK, runs.count // _CHUNKS))
        self.chunks = -(-self.count // self.chunk)
        self._words = {name: _words(runs.levels[name]) for name in runs.names}
        self.arrays = {
            **{name: self._parameter(runs, name) for name in runs.names},
            **{name: self._output(name, output) for name, output in outputs.items()},
            **({} if modes is None else dict.fromkeys(STATE, self._state(modes))),
            "message": Array((self.count, LONGEST_MESSAGE), "uint8", 0, ("run", "character")),
            "status": Array(
                (self.count,), "uint8", 0, ("run",), {"meaning": "0 not made, 1 good, 2 failed"}
            ),
        }

    def part(self, chunk: int) -> slice:
        """Return the runs of a chunk."""
        start = chunk * self.chunk
        return slice(start, min(start + self.chunk, self.count))

    def columns(self, columns: Mapping[str, Sequence[Level]]) -> dict[str, NDArray[Any]]:
        """Return values of parameters as the arrays have them: words by their numbers."""
        return {
            name: np.array([self._words[name].index(value) for value in values])
            if self._words[name]
            else np.array(values)
            for name, values in columns.items()
        }

    def _parameter(self, runs: Runs, name: str) -> Array:
        levels = runs.levels[name]
        words = self._words[name]
        if words:
            return Array((self.count,), "int64", -1, ("run",), {"words": words})
        told = {"units": self._units[name]} if name in self._units else {}
        if np.asarray(levels).dtype.kind in "iu":
            return Array((self.count,), "int64", -1, ("run",), told)
        return Array((self.count,), "float64", np.nan, ("run",), told)

    def _state(self, modes: int) -> Array:
        return Array((self.count, modes), "float64", np.nan, ("run", "mode"))

    def _output(self, name: str, output: Output) -> Array:
        shape = (self.count, *output.shape)
        dimensions = ("run", *(f"{name}_{output.dimension}" for _ in output.shape))
        times = {"times": list(output.times)} if output.times else {}
        return Array(shape, "float64", np.nan, dimensions, output.attributes | times)


def packed_message(message: str) -> NDArray[np.uint8]:
    """Return a message as the bytes of its UTF-8 text, cut off where it is too long.

    >>> unpacked_message(packed_message("déjà vu"))
    'déjà vu'
    """
    content = message.encode(errors="replace")[:LONGEST_MESSAGE]
    return np.frombuffer(content.ljust(LONGEST_MESSAGE, b"\0"), np.uint8)


def unpacked_message(content: NDArray[np.uint8]) -> str:
    """Return the text of a packed message."""
    return content.tobytes().rstrip(b"\0").decode(errors="ignore")


def worded(numbers: NDArray[Any], attributes: Mapping[str, Any]) -> NDArray[Any]:
    """Return the words that stand for numbers, where they do."""
    words = attributes.get("words")
    if words is None:
        return numbers
    return np.array([words[number] if number >= 0 else "" for number in numbers], dtype=object)


def _words(levels: Sequence[Level] | NDArray[Any]) -> list[Level]:
    """Return the different levels of a parameter that are not all numbers."""
    if isinstance(levels, np.ndarray) and levels.dtype != object:
        return []
    if not any(isinstance(level, str | bool) for level in levels):
        return []
    return list(dict.fromkeys(levels))
