"""Statements: a problem as data, from which the same problem can be made again.

A statement is a tree of plain values, with arrays beside it; a sparse array of SciPy stands there
by the three arrays of its compressed rows. Objects of ours, all of them
dataclasses or named tuples, stand in it by their class and their fields; no other class is ever
looked up when it is read, so that a file can hold no program.
"""

from __future__ import annotations

import io
import json
from dataclasses import fields, is_dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from bumpstop.errors import InputError

if TYPE_CHECKING:
    from scipy.sparse import csr_array

__all__ = ["packed", "unpacked"]

_TEXT = "statement"
_PLAIN = (bool, int, float, str, type(None))
_COMPRESSED_ROWS = ("data", "indices", "indptr")


def packed(thing: object) -> bytes:
    """Return an object as NumPy's npz: the text of the tree, and the arrays.

    Raises
    ------
    InputError
        If something in it is no data: a function, or an object of somebody else.
    """
    arrays: dict[str, NDArray[Any]] = {}
    text = json.dumps(_stated(thing, arrays))
    arrays[_TEXT] = np.frombuffer(text.encode(), dtype=np.uint8)
    content = io.BytesIO()
    np.savez(content, allow_pickle=False, **arrays)
    return content.getvalue()


def unpacked(content: bytes) -> Any:
    """Return the object that `packed` packed.

    Raises
    ------
    ValueError, KeyError, TypeError, AttributeError, ImportError, OSError
        If it is damaged, or of a version with other classes.

    Examples
    --------
    >>> from bumpstop.laws.stop import Stop
    >>> stop = Stop("guide", node="P", normal=(0, 1, 0), gap=1e-3, stiffness=1e6)
    >>> unpacked(packed(stop)) == stop
    True
    """
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        tree = json.loads(arrays[_TEXT].tobytes())
        return _made(tree, {name: arrays[name] for name in arrays.files})


def _stated(value: Any, arrays: dict[str, NDArray[Any]]) -> Any:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, _PLAIN):
        return value
    if isinstance(value, list):
        return [_stated(item, arrays) for item in value]
    if isinstance(value, np.ndarray):
        arrays[f"array_{len(arrays)}"] = value
        return {"array": f"array_{len(arrays) - 1}"}
    if getattr(value, "format", None) == "csr":
        of = [_stated(getattr(value, part), arrays) for part in _COMPRESSED_ROWS]
        return {"csr": of, "shape": [int(length) for length in value.shape]}
    if isinstance(value, dict):
        return {"dict": [[_stated(part, arrays) for part in item] for item in value.items()]}
    parts = _parts_of(value)
    if parts is not None:
        named = {name: _stated(part, arrays) for name, part in parts.items()}
        return {"class": f"{type(value).__module__}:{type(value).__qualname__}", "of": named}
    if isinstance(value, tuple):
        return {"tuple": [_stated(item, arrays) for item in value]}
    raise InputError(f"a {type(value).__name__} is no data that a file could hold")


def _parts_of(value: Any) -> dict[str, Any] | None:
    """Return what an object of ours is made of; None of anything else."""
    if not type(value).__module__.startswith("bumpstop."):
        return None
    if is_dataclass(value):
        return {each.name: getattr(value, each.name) for each in fields(value)}
    names = getattr(value, "_fields", None)
    return None if names is None else {name: getattr(value, name) for name in names}


def _made(tree: Any, arrays: dict[str, NDArray[Any]]) -> Any:
    if isinstance(tree, list):
        return [_made(item, arrays) for item in tree]
    if not isinstance(tree, dict):
        return tree
    if "array" in tree:
        return arrays[tree["array"]]
    if "csr" in tree:
        return _compressed_rows([_made(part, arrays) for part in tree["csr"]], tree["shape"])
    if "dict" in tree:
        return {_made(key, arrays): _made(item, arrays) for key, item in tree["dict"]}
    if "tuple" in tree:
        return tuple(_made(item, arrays) for item in tree["tuple"])
    parts = {name: _made(part, arrays) for name, part in tree["of"].items()}
    return _with_parts(_class(tree["class"]), parts)


def _compressed_rows(parts: list[NDArray[Any]], shape: list[int]) -> csr_array:
    from scipy.sparse import csr_array

    rows = csr_array(tuple(parts), shape=tuple(shape))
    # SciPy itself does not look at them: products would read beside the arrays.
    rows.check_format(full_check=True)
    return rows


def _with_parts(kind: type, parts: dict[str, Any]) -> Any:
    """Return an object of these parts, as they are: a unit vector made unit again may differ."""
    if not is_dataclass(kind):
        return kind(**parts)
    if {each.name for each in fields(kind)} != parts.keys():
        raise ValueError(f"{kind.__name__} has other parts")
    made = object.__new__(kind)
    for name, part in parts.items():
        object.__setattr__(made, name, part)
    return made


def _class(name: str) -> type:
    """Return a class of ours; no other is ever made."""
    module, _, path = name.partition(":")
    if not module.startswith("bumpstop."):
        raise ValueError(f"{name} is no class of bumpstop")
    found = getattr(import_module(module), path)
    if not isinstance(found, type) or not (is_dataclass(found) or hasattr(found, "_fields")):
        raise ValueError(f"{name} is no class of data")
    return found
