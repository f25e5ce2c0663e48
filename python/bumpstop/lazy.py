"""Names of a package that are imported when they are first used.

What a run does not use, it does not wait for.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module

__all__ = ["lazy_names"]


def lazy_names(package: str, homes: Mapping[str, str]) -> Callable[[str], object]:
    """Return the ``__getattr__`` of a package whose names live in its modules.

    Parameters
    ----------
    package
        Its ``__name__``.
    homes
        The module of each name, relative to the package. No name is that of a module of the
        package itself, which Python would bind there instead.

    Examples
    --------
    >>> get = lazy_names("bumpstop", {"Stop": "laws.stop"})
    >>> get("Stop").__module__
    'bumpstop.laws.stop'
    """

    def get(name: str) -> object:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value = getattr(import_module(f"{package}.{homes[name]}"), name)
        setattr(sys.modules[package], name, value)
        return value

    return get
