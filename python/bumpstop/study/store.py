"""Where results are kept while a study runs: in memory, or in a zarr store on disk.

A chunk of a store is there once its part of ``status`` is, which is written last; zarr itself
writes each file under another name and renames it. So a study that is killed loses the chunks in
hand alone.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from bumpstop.errors import InputError
from bumpstop.files import remove_leftovers, temporary_name
from bumpstop.study.layout import Array, Layout, packed_message
from bumpstop.study.zarr_thread import zarr_module

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bumpstop.study.evaluation import Kept

__all__ = [
    "MemoryStore",
    "Reader",
    "Store",
    "ZarrStore",
    "check_definition",
    "open_zarr_store",
    "read_store",
]

DEFINITION = "bumpstop_study"
"""Attribute of a store that says which study it is of."""

_PARTIAL = "*.partial"
"""What zarr calls files that it has not written to their end."""


ALL = slice(None)


class Reader(Protocol):
    """Reads an array of a study by its name: some runs, or all."""

    def __call__(self, name: str, part: slice = ALL) -> NDArray[Any]:
        """Return what it holds."""


class Store(Protocol):
    """Keeps what is kept of runs."""

    def write(self, chunk: int, columns: Mapping[str, NDArray[Any]], kept: Kept) -> None:
        """Keep a chunk of runs with the values of their parameters."""

    def read(self, name: str, part: slice = ALL) -> NDArray[Any]:
        """Return what an array of the layout holds of some runs, or of all."""


class MemoryStore:
    """Keeps results in arrays."""

    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        self._arrays = {name: array.empty() for name, array in layout.arrays.items()}

    def write(self, chunk: int, columns: Mapping[str, NDArray[Any]], kept: Kept) -> None:
        """Keep a chunk."""
        part = self._layout.part(chunk)
        for name, values in _arrays_of(columns, kept).items():
            self._arrays[name][part] = values

    def read(self, name: str, part: slice = ALL) -> NDArray[Any]:
        """Return what an array holds."""
        return self._arrays[name][part]


class ZarrStore:
    """Keeps results in a zarr store, chunk by chunk.

    Parameters
    ----------
    path
        Its folder.
    layout
        The arrays that it has.
    filled
        Whether any chunk may be there.
    """

    def __init__(self, path: Path, layout: Layout, *, filled: bool) -> None:
        self._path = path
        self._layout = layout
        with _said(path):
            self._group = zarr_module().open_group(path, mode="r+")
            self._arrays: dict[str, Any] = {name: self._group[name] for name in layout.arrays}
            # What is NaN throughout is written, too: a file that is not there has gone.
            for name, array in self._arrays.items():
                every = {"write_empty_chunks": name != "message"}
                self._arrays[name] = array.with_config(every)
            # Kept here: to ask for a file of each chunk takes long where there are many.
            status = self._arrays["status"][ALL] if filled else layout.arrays["status"].empty()
            self._status: NDArray[np.uint8] = np.asarray(status)

    def write(self, chunk: int, columns: Mapping[str, NDArray[Any]], kept: Kept) -> None:
        """Keep a chunk: its status last, which says that the chunk is there."""
        part = self._layout.part(chunk)
        with _said(self._path):
            for name, values in _arrays_of(columns, kept).items():
                self._arrays[name][part] = values
        self._status[part] = kept.status

    def read(self, name: str, part: slice = ALL) -> NDArray[Any]:
        """Return what an array holds."""
        if name == "status":
            return self._status[part]
        with _said(self._path):
            return np.asarray(self._arrays[name][part])

    def forget_damaged(self) -> None:
        """Take chunks of which a file is gone for not made: they are made again, bit by bit."""
        made = np.flatnonzero(self.read("status")[:: self._layout.chunk]).tolist()
        for name, array in self._layout.arrays.items():
            rest = ["0"] * (len(array.shape) - 1)
            # Runs without a message leave no file of it.
            for chunk in made if name != "message" else ():
                if not self._path.joinpath(name, "c", str(chunk), *rest).exists():
                    self._status[self._layout.part(chunk)] = 0


def open_zarr_store(
    path: Path, layout: Layout, definition: dict[str, Any], *, resume: bool
) -> ZarrStore:
    """Return the store of a study, made where it is not there.

    Parameters
    ----------
    path
        Its folder.
    layout
        The arrays that it has.
    definition
        What the study is; another one cannot go on with the store.
    resume
        Whether to go on with a store that is there.

    Raises
    ------
    InputError
        If it cannot be written, is there and must not, is not there and must, or is another
        study's.
    """
    _require_zarr()
    if not path.exists():
        if resume:
            hint = "leave out --resume (resume=True) to begin one"
            raise InputError("no such store", file=str(path), key="store", hint=hint)
        _make(path, layout, definition)
        return ZarrStore(path, layout, filled=False)
    if not resume:
        hint = "go on with it by --resume (resume=True), or name another store"
        raise InputError("is there already", file=str(path), key="store", hint=hint)
    check_definition(path, definition)
    if not os.access(path, os.W_OK | os.X_OK):
        raise InputError("is read-only", file=str(path), key="store")
    for partial in path.rglob(_PARTIAL):
        partial.unlink(missing_ok=True)
    # A loss of power may leave files empty that were being written.
    for file in path.rglob("c/**/*"):
        if file.is_file() and not file.stat().st_size:
            file.unlink()
    store = ZarrStore(path, layout, filled=True)
    store.forget_damaged()
    return store


def read_store(path: Path) -> tuple[dict[str, Any], dict[str, Array], Reader]:
    """Return what study a store is of, its arrays by name, and what reads them.

    Raises
    ------
    InputError
        If there is no store, or it is not one of a study.
    """
    group = _opened(path)
    with _said(path):
        stored = dict(group.arrays())
        arrays = {name: _described(array) for name, array in stored.items()}

    def read(name: str, part: slice = ALL) -> NDArray[Any]:
        with _said(path):
            return np.asarray(stored[name][part])

    return group.attrs[DEFINITION], arrays, read


def _opened(path: Path) -> Any:
    _require_zarr()
    if not path.is_dir():
        raise InputError("no such store", file=str(path), hint="check the path")
    try:
        group = zarr_module().open_group(path, mode="r")
        _ = group.attrs[DEFINITION]
    except Exception as error:  # zarr raises many kinds
        what = "is not the store of a study"
        raise InputError(what, file=str(path), hint="name another folder") from error
    return group


def _described(array: Any) -> Array:
    names = array.metadata.dimension_names
    return Array(array.shape, str(array.dtype), array.fill_value, names, dict(array.attrs))


def _make(path: Path, layout: Layout, definition: dict[str, Any]) -> None:
    """Make an empty store under another name, and rename it once it is whole."""
    remove_leftovers(path)
    part = temporary_name(path)
    with _said(path, "make room, or name another folder"):
        path.parent.mkdir(parents=True, exist_ok=True)
        group = zarr_module().open_group(part, mode="w", attributes={DEFINITION: definition})
        for name, array in layout.arrays.items():
            group.create_array(
                name,
                shape=array.shape,
                chunks=(layout.chunk, *array.shape[1:]),
                dtype=array.dtype,
                fill_value=array.fill,
                dimension_names=array.dimensions,
                attributes=array.attributes,
            )
        part.rename(path)


def check_definition(path: Path, definition: dict[str, Any]) -> None:
    """Raise where a store is of another study, and say what differs.

    Parameters
    ----------
    path
        Its folder.
    definition
        What the study is.

    Raises
    ------
    InputError
        That says so.
    """
    found = difference(_opened(path).attrs[DEFINITION], json.loads(json.dumps(definition)))
    if found is not None:
        key, old, new = found
        raise InputError(
            f"the study has changed: {key} was {_shown(old)}, and is {_shown(new)}",
            file=str(path),
            key="store",
            hint="change it back, or name another store",
        )


_NOTHING = object()


def difference(old: Any, new: Any, above: str = "") -> tuple[str, Any, Any] | None:
    """Return the first place where two contents of JSON differ, and what stands there.

    >>> difference({"a": [1, 2]}, {"a": [1, 3]})
    ('a.1', 2, 3)
    """
    if isinstance(old, list) and isinstance(new, list):
        old, new = dict(enumerate(old)), dict(enumerate(new))
    if not (isinstance(old, dict) and isinstance(new, dict)):
        return None if type(old) is type(new) and old == new else (above, old, new)
    for key in dict.fromkeys([*old, *new]):
        place = f"{above}.{key}" if above else str(key)
        found = difference(old.get(key, _NOTHING), new.get(key, _NOTHING), place)
        if found is not None:
            return found
    return None


def _shown(value: Any) -> str:
    if value is _NOTHING:
        return "not there"
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 40 else f"{text[:37]}..."


def _arrays_of(columns: Mapping[str, NDArray[Any]], kept: Kept) -> dict[str, NDArray[Any]]:
    """Return the parts of all arrays, that of the status last."""
    told = {}
    if any(kept.messages):
        told["message"] = np.stack([packed_message(message) for message in kept.messages])
    return {**columns, **kept.values, **told, "status": kept.status}


def _require_zarr() -> None:
    from importlib.util import find_spec

    if find_spec("zarr") is None:
        hint = "pip install 'bumpstop[study]', or keep the results in memory"
        raise InputError("needs the package zarr, which is not installed", key="store", hint=hint)


_MENDED = "what is there is whole; mend it and go on with --resume (resume=True)"


@contextmanager
def _said(path: Path, hint: str = _MENDED) -> Iterator[None]:
    """Say in one line that a store cannot be read or written."""
    try:
        yield
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else str(error)
        what = f"cannot be written: {reason}"
        raise InputError(what, file=str(path), key="store", hint=hint) from error
    except (KeyError, ValueError, RuntimeError) as error:  # codecs of zarr raise the last
        raise InputError("is damaged", file=str(path), key="store", hint=str(error)) from error
