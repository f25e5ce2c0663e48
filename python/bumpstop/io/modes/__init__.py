"""Modes of other programs and of measurements: one file a format."""

from bumpstop.io.modes.identify import identify_modes
from bumpstop.io.modes.mode_set import ModeSet
from bumpstop.io.modes.read import read_modes

__all__ = ["ModeSet", "identify_modes", "read_modes"]
