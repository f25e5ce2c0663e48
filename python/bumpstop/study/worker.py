"""A process that makes runs for another: it reads what to do, and writes what is kept.

It is started by name, not forked: a fork would copy threads' locks but not the threads, and needs
no protection of the user's script against being imported again. When whoever started it
is gone, its input ends, and so does it.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress

from bumpstop.study.evaluation import Evaluator
from bumpstop.study.frames import receive, send

__all__ = ["main"]


def main() -> None:
    """Serve until the input ends."""
    results = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what anybody prints is no result
    with suppress(EOFError, BrokenPipeError):
        evaluator = Evaluator(receive(sys.stdin.buffer))
        while True:
            send(results, evaluator.kept(receive(sys.stdin.buffer)))


if __name__ == "__main__":
    main()
