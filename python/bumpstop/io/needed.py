"""Packages that only some formats need."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from bumpstop.errors import InputError

__all__ = ["needed"]


def needed(module: str, extra: str) -> ModuleType:
    """Return a module that users install with an extra.

    Raises
    ------
    InputError
        If it is not installed.

    Examples
    --------
    >>> needed("absent", "parquet")
    Traceback (most recent call last):
    bumpstop.errors.InputError: absent is needed and not installed; pip install 'bumpstop[parquet]'
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        package = module.partition(".")[0]
        hint = f"pip install 'bumpstop[{extra}]'"
        raise InputError(f"{package} is needed and not installed", hint=hint) from error
