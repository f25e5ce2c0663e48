"""The way in and the ways out: arguments to a command, exceptions to one line and a status."""

from __future__ import annotations

import errno
import io
import os
import sys
import traceback
from collections.abc import Sequence

import typer
from typer.main import get_command

from bumpstop.cli.app import Job, app
from bumpstop.errors import BumpstopError

__all__ = ["run_command_line"]

WRONG_INPUT = 2
UNFINISHED = 3

# The base class of all mistakes in arguments; typer names only this child of it.
_UsageError: type[typer.BadParameter] = typer.BadParameter.__mro__[1]


def run_command_line(arguments: Sequence[str] | None) -> int:
    """Run a command and return the exit status; see `bumpstop.cli.main`."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    debug = "--debug" in given
    words = [word for word in given if word != "--debug"] or ["--help"]
    _replace_what_cannot_be_encoded()
    try:
        return _done(get_command(app).main(words, prog_name="bumpstop", standalone_mode=False))
    except BrokenPipeError:
        # Whoever read our output has seen enough; leave nothing for Python to flush at exit.
        _drop_standard_output()
        return 0
    except Exception as error:
        if debug:
            traceback.print_exc()
        return _failed(error)


def _drop_standard_output() -> None:
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _done(command: Job | int) -> int:
    """Do what a command wants done; --help and --version come as a status, done already."""
    status = command if isinstance(command, int) else command()
    sys.stdout.flush()
    return status


def _failed(error: Exception) -> int:
    """Say in one line what went wrong, and return the exit status."""
    if isinstance(error, BumpstopError):
        _say(f"error: {error}")
        return error.exit_status
    if isinstance(error, _UsageError):
        _say(f"error: {error.format_message().rstrip('.')}; see 'bumpstop --help'")
        return WRONG_INPUT
    if isinstance(error, OSError) and error.errno == errno.ENOSPC:
        _drop_standard_output()
        _say("error: no space left where the output goes; make room or write elsewhere")
        return WRONG_INPUT
    if isinstance(error, MemoryError):
        _say("error: not enough memory; take fewer samples, elements or modes")
        return UNFINISHED
    _say(
        f"error: this is a mistake in bumpstop itself: {type(error).__name__}: {error}; "
        "run it again with --debug and report what that prints"
    )
    return UNFINISHED


def _say(line: str) -> None:
    one_line = "".join(char if char.isprintable() else " " for char in line)
    print(one_line, file=sys.stderr)


def _replace_what_cannot_be_encoded() -> None:
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
