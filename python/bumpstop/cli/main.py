"""The way in and the ways out: arguments to a command, exceptions to one line and a status."""

from __future__ import annotations

import errno
import io
import os
import sys
import traceback
from collections.abc import Sequence
from pathlib import Path

from bumpstop.cli.app import Job, job
from bumpstop.cli.console import print_error
from bumpstop.errors import BumpstopError

__all__ = ["run_command_line"]

WRONG_INPUT = 2
UNFINISHED = 3


def run_command_line(arguments: Sequence[str] | None) -> int:
    """Run a command and return the exit status; see `bumpstop.cli.main`."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    debug = "--debug" in given
    words = [word for word in given if word != "--debug"] or ["--help"]
    _open_what_is_closed()
    _replace_what_cannot_be_encoded()
    try:
        return _done(job(words))
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


def _done(work: Job) -> int:
    status = work()
    sys.stdout.flush()
    return status


def _failed(error: Exception) -> int:
    """Say in one line what went wrong, and return the exit status."""
    if isinstance(error, BumpstopError):
        print_error(str(error))
        return error.exit_status
    if isinstance(error, OSError) and error.errno == errno.ENOSPC:
        _drop_standard_output()
        print_error("no space left where the output goes; make room or write elsewhere")
        return WRONG_INPUT
    if isinstance(error, MemoryError):
        print_error("not enough memory; take fewer samples, elements or modes")
        return UNFINISHED
    print_error(
        f"this is a mistake in bumpstop itself: {type(error).__name__}: {error}; "
        "run it again with --debug and report what that prints"
    )
    return UNFINISHED


def _open_what_is_closed() -> None:
    """Send to nowhere what would be printed to a stream that the shell has closed."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            # For as long as the process lives.
            setattr(sys, name, Path(os.devnull).open("w"))  # noqa: SIM115


def _replace_what_cannot_be_encoded() -> None:
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
