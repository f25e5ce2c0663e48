"""Measured functions become modes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bumpstop.arguments import all_of
from bumpstop.io.modes.mode_set import ModeSet
from bumpstop.modal.frequency_response import FrequencyResponse
from bumpstop.modal.identification import identified

__all__ = ["identify_modes"]


def identify_modes(
    functions: Sequence[FrequencyResponse],
    *,
    band: tuple[float, float] | None = None,
    count: int | None = None,
) -> ModeSet:
    """Return the modes that measured functions show, of unit modal mass.

    Parameters
    ----------
    functions
        All of one reference and over the same frequencies; one of them at the reference itself.
    band
        Lowest and highest frequency in Hz to look at; all where left out.
    count
        How many modes to keep, those with the greatest part in the functions; all that are
        stable where left out.

    Raises
    ------
    InputError
        If the functions do not belong together, the drive point is missing, the band holds too
        few frequencies, no or fewer stable modes are found than wanted, or a mode is complex.
    """
    modes = identified(all_of("functions", FrequencyResponse, functions), band, count)
    return ModeSet(
        frequency=modes.frequency,
        damping=modes.damping,
        modal_mass=np.ones(len(modes.frequency)),
        dofs=modes.dofs,
        shapes=modes.shapes,
    )
