"""The check that what a function reads is a run."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from bumpstop.errors import InputError

__all__ = ["check_run", "of_run"]

P = ParamSpec("P")
T = TypeVar("T")


def check_run(value: object) -> None:
    """Raise InputError where a value is no response."""
    from bumpstop.response import Response

    if not isinstance(value, Response):
        hint = "bs.simulate makes one of a problem, bs.read_netcdf reads one"
        what = "must be a response"
        raise InputError(what, key="response", value=type(value).__name__, hint=hint)


def of_run(function: Callable[P, T]) -> Callable[P, T]:
    """Return a function of a response, its first argument, that takes nothing else for one."""

    @wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> T:
        if args or "response" in kwargs:
            check_run(args[0] if args else kwargs["response"])
        return function(*args, **kwargs)

    return checked
