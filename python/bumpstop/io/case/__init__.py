"""Case files: what users write in TOML, checked, and turned into problems."""

from bumpstop.io.case.case import Case
from bumpstop.io.case.load import load_case

__all__ = ["Case", "load_case"]
