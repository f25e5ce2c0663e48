"""Columns of a file: numbers and texts that are checked as they are read."""

from __future__ import annotations

from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.instants import Grid
from bumpstop.io.netcdf_format import CHECKSUM, checksum
from bumpstop.structure.sparse import IndexArray

__all__ = ["Column", "Instants", "check_pieces", "numbers", "texts"]

HELD = 64_000_000
"""Bytes of a column at most that are held in memory; others are read as they are asked for."""


def texts(dataset: h5py.Dataset) -> list[str]:
    """Return texts of a file.

    Raises
    ------
    InputError
        If they are not those that were written.
    """
    check_pieces(dataset)
    words = [bytes(word) for word in dataset[()]]
    told = dataset.attrs.get(CHECKSUM)
    if told is not None and (told.decode() if isinstance(told, bytes) else told) != checksum(words):
        raise _damaged(dataset)
    return [word.decode() for word in words]


def numbers(dataset: h5py.Dataset, rows: object = ()) -> NDArray[Any]:
    """Return numbers of a file.

    Raises
    ------
    InputError
        If they are not those that were written: HDF5 looks at its checksums.
    """
    if rows == ():
        check_pieces(dataset)
    try:
        found: NDArray[Any] = dataset[rows]
    except OSError as error:
        raise _damaged(dataset) from error
    return found


def check_pieces(dataset: h5py.Dataset) -> None:
    """Raise InputError where a piece of a dataset is not where it belongs.

    The index of the pieces has no checksum of its own, and HDF5 reads zeros for those that it does
    not find.
    """
    if dataset.chunks is None:
        return
    sizes = np.array(dataset.chunks)
    wanted = int(np.prod(-(-np.array(dataset.shape) // sizes)))
    starts: set[tuple[int, ...]] = set()

    def visit(piece: Any) -> None:
        starts.add(tuple(piece.chunk_offset))

    try:
        dataset.id.chunk_iter(visit)
    except (OSError, RuntimeError) as error:
        raise _damaged(dataset) from error
    places = np.array(sorted(starts), dtype=np.uint64).reshape(-1, len(sizes))
    inside = (places < np.array(dataset.shape, dtype=np.uint64)).all()
    if len(places) != wanted or not inside or (places % sizes.astype(np.uint64)).any():
        raise _damaged(dataset)


def _damaged(dataset: h5py.Dataset) -> InputError:
    what = "is damaged: what it holds has not the checksum that it was written with"
    hint = "take another copy of the file, or write it again"
    name = str(dataset.name).removeprefix("/")
    return InputError(what, key=name, file=str(dataset.file.filename), hint=hint)


class Column:
    """Numbers over time, held in memory where they are few.

    Parameters
    ----------
    dataset
        Rows of numbers, one an instant.
    """

    def __init__(self, dataset: h5py.Dataset) -> None:
        self._dataset = dataset
        self.is_held = dataset.nbytes <= HELD
        check_pieces(dataset)
        self._held = numbers(dataset, ...) if self.is_held else np.zeros(0)

    def at(self, rows: IndexArray) -> NDArray[Any]:
        """Return some rows.

        Raises
        ------
        InputError
            If they are damaged.
        """
        if self.is_held:
            return self._held[rows]
        if not len(rows):
            return numbers(self._dataset, slice(0, 0))
        first, last = int(rows.min()), int(rows.max())
        return numbers(self._dataset, slice(first, last + 1))[rows - first]


class Instants:
    """Instants of a file, and the rows in which they are.

    Parameters
    ----------
    times
        Evenly spaced ones, of which nothing is held, or any others.
    """

    def __init__(self, times: Grid | FloatArray) -> None:
        self.times = times
        self._order = None if isinstance(times, Grid) else np.argsort(times, kind="stable")

    def hold(self, wanted: FloatArray) -> bool:
        """Return whether all of some instants are in the file."""
        return bool((self._nearest(wanted)[1] == wanted).all())

    def rows(self, wanted: FloatArray) -> IndexArray:
        """Return the rows of instants.

        Raises
        ------
        InputError
            If one is not in the file.
        """
        found, known = self._nearest(wanted)
        if (known != wanted).any():
            raise InputError(
                "is not among the instants of the file",
                key="times",
                value=float(wanted[known != wanted][0]),
                hint="to read it anywhere, simulate the response's problem again",
            )
        return found

    def _nearest(self, wanted: FloatArray) -> tuple[IndexArray, FloatArray]:
        """Return rows near some instants, and the instants of these."""
        if isinstance(self.times, Grid):
            last = len(self.times) - 1
            found = np.clip(np.rint(wanted / self.times.step), 0, last).astype(np.intp)
            # The last step may be a short one.
            found[wanted == self.times.end] = last
            return found, np.where(found == last, self.times.end, found * self.times.step)
        ordered = self.times[self._order]
        place = np.searchsorted(ordered, wanted).clip(0, max(len(ordered) - 1, 0))
        return np.arange(len(ordered))[self._order][place], ordered[place]
