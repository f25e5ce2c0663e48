"""PipedProgram: a program that answers over a pipe, step by step."""

from __future__ import annotations

import subprocess
import weakref
from collections.abc import Sequence
from dataclasses import dataclass, field
from os import PathLike, fspath

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError, InputError

__all__ = ["PipedProgram"]


@dataclass(eq=False)
class PipedProgram:
    """A program behind an `OutsideProgram`: it reads a line and writes a line, once a step.

    It is told the number of the step, the displacements in m and the velocities in m/s, parted by
    blanks, with as many digits as it takes to read the same numbers, and answers with the
    forces in N. It is started anew at each step 0, so that every run finds it as it begins, and
    sees the end of its input when it is not needed any more.

    Parameters
    ----------
    command
        The program and its arguments, as a list.
    folder
        Where it is started; the present folder where left out.

    Raises
    ------
    InputError
        If the command is empty, or holds something else than texts.

    Examples
    --------
    >>> import sys
    >>> spring = '''
    ... for line in iter(input, ""):
    ...     step, q, v = line.split()
    ...     print(-40.0 * float(q), flush=True)
    ... '''
    >>> program = PipedProgram([sys.executable, "-c", spring])
    >>> program(0, 0.5, 0.0).tolist()
    [-20.0]
    """

    command: Sequence[str]
    folder: str | PathLike[str] | None = None
    _running: subprocess.Popen[str] | None = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        given = self.command
        texts = isinstance(given, list | tuple) and all(isinstance(each, str) for each in given)
        if not texts or not given or not given[0]:
            what = "must be a list of texts, the program first"
            raise InputError(what, key="command", value=given)
        self.command = tuple(given)

    def __call__(
        self, step: int, displacement: float | FloatArray, velocity: float | FloatArray
    ) -> FloatArray:
        """Return the answer to a step, one force a direction, in N.

        Raises
        ------
        ComputationError
            If the program cannot be started, has ended, or answers with something else.
        """
        if step == 0 or self._running is None:
            self._start()
        numbers = [*np.ravel(displacement), *np.ravel(velocity)]
        answer = self._asked(" ".join([str(step), *(repr(float(each)) for each in numbers)]))
        try:
            return np.array([float(part) for part in answer.split()])
        except ValueError as error:
            what = f"answers step {step} with {answer.strip()!r}, which is no list of numbers"
            raise ComputationError(f"{self._words} {what}") from error

    @property
    def _words(self) -> str:
        return f"the program {' '.join(self.command)!r}"

    def _start(self) -> None:
        self._stop()
        folder = None if self.folder is None else fspath(self.folder)
        pipe = subprocess.PIPE
        try:
            self._running = subprocess.Popen(  # the user asks for it
                self.command, stdin=pipe, stdout=pipe, text=True, cwd=folder
            )
        except OSError as error:
            what = f"cannot be started: {error.strerror or error}"
            raise ComputationError(f"{self._words} {what}") from error
        weakref.finalize(self, _end, self._running)

    def _stop(self) -> None:
        if self._running is not None:
            _end(self._running)
            self._running = None

    def _asked(self, line: str) -> str:
        """Return the line that the program writes after it has read one."""
        assert self._running is not None
        to, back = self._running.stdin, self._running.stdout
        assert to is not None
        assert back is not None
        try:
            to.write(f"{line}\n")
            to.flush()
            answer = back.readline()
        except OSError:
            answer = ""
        if not answer:
            self._stop()
            what = "has ended without an answer; it must read a line and write one for each step"
            raise ComputationError(f"{self._words} {what}")
        return answer


def _end(running: subprocess.Popen[str]) -> None:
    """Close a program's input, which tells it to end, and do not wait for ever."""
    for pipe in (running.stdin, running.stdout):
        if pipe is not None:
            try:
                pipe.close()
            except OSError:  # it has ended by itself, with something left to read
                continue
    try:
        running.wait(timeout=1.0)
    except subprocess.TimeoutExpired:
        running.kill()
        running.wait()
