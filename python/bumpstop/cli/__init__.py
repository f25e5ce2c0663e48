"""The command line: ``bumpstop run``, ``modes``, ``verify``, ``report``, ``schema``."""

from bumpstop.cli.main import main

__all__ = ["main"]
