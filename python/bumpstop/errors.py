"""What can go wrong, in words that a user can act on."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

__all__ = ["BumpstopError", "ComputationError", "InputError", "ModellingWarning", "blamed"]


class BumpstopError(Exception):
    """Base of every error that bumpstop raises on purpose.

    The message is one line: what is wrong, where, and how to mend it.
    """

    exit_status = 3


class InputError(BumpstopError, ValueError):
    """The user's input is wrong.

    Parameters
    ----------
    what
        What is wrong, without a full stop: ``"stiffness must be positive"``.
    file
        The file that holds the mistake, where there is one.
    key
        The dotted path of the key in that file, or the argument's name.
    value
        The offending value, shown as written.
    hint
        How to mend it: ``"did you mean 'stiffness'?"``.
    """

    exit_status = 2

    def __init__(
        self,
        what: str,
        *,
        file: str | None = None,
        key: str | None = None,
        value: object = None,
        hint: str | None = None,
    ) -> None:
        self.what = what
        self.file = file
        self.key = key
        self.value = value
        self.hint = hint
        super().__init__(self._line())

    def located(self, *, file: str | None = None, key: str | None = None) -> InputError:
        """Return the same error with the place filled in where it was not known yet."""
        return InputError(
            self.what,
            file=self.file or file,
            key=self.key or key,
            value=self.value,
            hint=self.hint,
        )

    def _line(self) -> str:
        where = ": ".join(part for part in (self.file, self.key) if part)
        shown = "" if self.value is None else f" (got {_shorten(repr(_as_written(self.value)))})"
        mend = f"; {self.hint}" if self.hint else ""
        return f"{where}: {self.what}{shown}{mend}" if where else f"{self.what}{shown}{mend}"


@contextmanager
def blamed(key: str) -> Iterator[None]:
    """Say of mistakes found inside that they stand at ``key``.

    Examples
    --------
    >>> with blamed("relations[0].terms"):
    ...     raise InputError("unknown node", key="node", value="C")
    Traceback (most recent call last):
    bumpstop.errors.InputError: relations[0].terms: unknown node (got 'C')
    """
    try:
        yield
    except InputError as error:
        raise InputError(error.what, key=key, value=error.value, hint=error.hint) from error


class ModellingWarning(UserWarning):
    """A problem can be run, but its user should know something of it: one line."""


class ComputationError(BumpstopError):
    """The input is good but the computation could not be finished."""


def _as_written(value: object) -> object:
    """Return what a user may have written: numbers of numpy have a longer ``repr``.

    Examples
    --------
    >>> _as_written([np.float64(1.0), (np.int32(2), "a")])
    [1.0, (2, 'a')]
    """
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    if type(value) is list:
        return [_as_written(part) for part in value]
    if type(value) is tuple:
        return tuple(_as_written(part) for part in value)
    return value


def _shorten(text: str, longest: int = 80) -> str:
    one_line = " ".join(text.split())
    return one_line if len(one_line) <= longest else one_line[: longest - 3] + "..."
