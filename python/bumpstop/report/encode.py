"""Data for the page: JSON that is safe inside a script element, arrays as base64."""

from __future__ import annotations

import json
from base64 import b64encode

import numpy as np

__all__ = ["script_json"]


def script_json(data: object) -> str:
    r"""Return data as JSON that may stand between ``<script>`` tags.

    NumPy arrays become base64 of 32-bit numbers (about seven digits), in the form that
    plotly reads: ``{"dtype": "f4", "bdata": "..."}``, with a ``shape`` where there are rows. No
    ``<`` is left, so that nothing a user wrote can end the script element or open a comment.

    Raises
    ------
    ValueError
        If a number outside an array is not finite; JSON has no way to say that.

    Examples
    --------
    >>> script_json({"name": "</script>", "values": np.array([1.0])})
    '{"name":"\\u003c/script>","values":{"dtype":"f4","bdata":"AACAPw=="}}'
    >>> script_json(np.eye(1))
    '{"dtype":"f4","bdata":"AACAPw==","shape":"1, 1"}'
    """
    text = json.dumps(
        data, default=_plain, ensure_ascii=False, allow_nan=False, separators=(",", ":")
    )
    return text.replace("<", "\\u003c")


def _plain(value: object) -> object:
    if isinstance(value, np.ndarray):
        kind = "<i4" if value.dtype.kind in "iu" else "<f4"
        data = np.ascontiguousarray(value, dtype=kind).tobytes()
        told = {"dtype": kind[1:], "bdata": b64encode(data).decode("ascii")}
        if value.ndim > 1:
            told["shape"] = ", ".join(map(str, value.shape))
        return told
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"cannot be written as JSON: {type(value).__name__}")
