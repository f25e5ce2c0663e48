"""Laws that a Python file beside the case computes, or another program."""

from __future__ import annotations

from pathlib import Path
from runpy import run_path
from typing import TYPE_CHECKING, Any

from bumpstop.errors import InputError

if TYPE_CHECKING:
    from bumpstop.laws import OutsideProgram, UserLaw

__all__ = ["outside_program", "user_law"]

_FUNCTIONS = ("force", "jacobian", "memory_rate")
"""What a file of a law may define; the first it must."""


def user_law(name: str, given: dict[str, Any], folder: Path) -> UserLaw:
    """Return the law whose functions a Python file defines.

    Raises
    ------
    InputError
        If there is no such file, it cannot be run, or defines no force.
    """
    from bumpstop.laws import UserLaw

    told = given.pop("file")
    file = folder / told
    if not file.is_file():
        raise InputError("no such file", key="file", value=told)
    try:
        defined = run_path(str(file))
    except Exception as error:  # whatever a user's program may raise
        what = f"cannot be run: {type(error).__name__}: {error}"
        raise InputError(what, key="file", value=told) from error
    functions = {key: defined[key] for key in _FUNCTIONS if key in defined}
    if "force" not in functions:
        hint = "define force(q, v, t)"
        raise InputError("defines no force", key="file", value=told, hint=hint)
    return UserLaw(name, **functions, **given)


def outside_program(name: str, given: dict[str, Any], folder: Path) -> OutsideProgram:
    """Return the law whose force a program in the case's folder answers with, step by step."""
    from bumpstop.laws import OutsideProgram, PipedProgram

    program = PipedProgram(given.pop("command"), folder)
    return OutsideProgram(name, exchange=program, **given)
