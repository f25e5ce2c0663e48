"""CSV: signals as columns of text, with their units in the heading."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.files import written_whole
from bumpstop.io.signals import sampled_blocks, signals

if TYPE_CHECKING:
    from bumpstop.response import Response

__all__ = ["write_csv"]


def write_csv(response: Response, path: str | PathLike[str]) -> None:
    """Write the signals of a response, tabulated at its times, as comma-separated values.

    The first line names the columns with their units, such as ``displacement_B_dy [m]``; numbers
    have the seventeen digits that give them back to the bit.

    Parameters
    ----------
    response
        What to write.
    path
        The file; one of that name is replaced once the new one is complete.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    wanted = signals(response)
    heading = ["time [s]", *(f"{signal.name} [{signal.units}]" for signal in wanted)]
    with written_whole(path) as part, part.open("w", encoding="utf-8", newline="\n") as file:
        file.write(",".join(heading) + "\n")
        for times, values in sampled_blocks(response, wanted):
            np.savetxt(file, np.column_stack([times, *values]), fmt="%.17g", delimiter=",")
