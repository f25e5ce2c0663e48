"""The command line: ``bumpstop run``, ``modes``, ``verify``, ``report``, ``schema``."""

from __future__ import annotations

import gc
import sys
from collections.abc import Sequence

__all__ = ["main"]

INTERRUPTED = 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command.

    Parameters
    ----------
    arguments
        What follows the program's name; those of the process where left out.

    Returns
    -------
    int
        Exit status: 0 good; 1 a reference check failed; 2 the input is wrong; 3 the
        computation could not be finished; 130 interrupted.
    """
    # Most of the time of a short run goes into imports. They make many objects and no garbage,
    # so collecting it only costs.
    collecting = gc.isenabled()
    gc.disable()
    try:
        from bumpstop.cli.main import run_command_line

        status = run_command_line(arguments)
        if arguments is None:
            _finish_in_peace()
        return status
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    finally:
        gc.freeze()  # else Python goes through all of them once more when it exits
        if collecting:
            gc.enable()


def _finish_in_peace() -> None:
    """Let an interrupt be too late once the work of the process is done.

    Nothing but Python's own end is left, where it would end in a traceback.
    """
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)
