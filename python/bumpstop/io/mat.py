"""MATLAB: signals, impacts and events as variables of a .mat file, version 5."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.errors import InputError
from bumpstop.files import written_whole
from bumpstop.io.signals import sampled_blocks, signals
from bumpstop.post.blows import blow_table

if TYPE_CHECKING:
    from bumpstop.post.impacts import Table
    from bumpstop.response import Response

__all__ = ["write_mat"]

LARGEST = 2**31
"""Bytes that a variable of version 5 can have."""
LONGEST_NAME = 63
"""Letters of a name in MATLAB; longer ones are cut, and the long names tell them whole."""


def write_mat(response: Response, path: str | PathLike[str]) -> None:
    """Write a response, tabulated at its times, to a MATLAB file.

    It has ``time`` and each signal as columns, structs ``units`` and ``long_names`` of the
    signals, and structs ``impacts``, ``impulses`` and ``events`` of columns as in
    `Response.impacts`, `Response.impulses` and `Response.events`. The format is held in memory
    while it is written.

    Parameters
    ----------
    response
        What to write.
    path
        The file; one of that name is replaced once the new one is complete.

    Raises
    ------
    InputError
        If there are more samples than the format holds, or the file cannot be written there.
    """
    from scipy.io import savemat

    if 8 * len(response.instants) >= LARGEST:
        what = f"holds at most {LARGEST // 8:,} samples a signal"
        raise InputError(
            what, file=str(path), value=len(response.instants), hint="take a longer sample"
        )
    wanted = signals(response, LONGEST_NAME)
    blocks = [values for _, values in sampled_blocks(response, wanted)]
    columns = {
        each.name: np.concatenate([block[number] for block in blocks])
        for number, each in enumerate(wanted)
    }
    content = {
        "time": response.times,
        **columns,
        "units": {each.name: each.units for each in wanted},
        "long_names": {each.name: each.long_name for each in wanted},
        "impacts": _struct(response.impact_table()),
        "impulses": _struct(blow_table(response)),
        "events": _struct(response.event_table()),
        "method": response.method,
    }
    with written_whole(path) as part:
        savemat(str(part), content, appendmat=False, long_field_names=True, oned_as="column")


def _struct(table: Table) -> dict[str, Any]:
    """Return columns as MATLAB has them: of numbers, or cells of texts."""
    return {
        name: np.array(column, dtype=object if name in _TEXTS else float)
        for name, column in table.items()
    }


_TEXTS = ("stop", "law", "guard", "before", "after")
