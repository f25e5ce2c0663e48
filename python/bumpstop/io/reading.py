"""Reading files that people hand over: whatever is wrong is one line that names the file."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from bumpstop.errors import InputError

__all__ = ["MOST_ROWS", "in_file", "read_content", "read_lines"]

MOST_ROWS = 50_000_000
"""Most rows of a matrix that a file may announce."""


@contextmanager
def in_file(path: Path) -> Iterator[None]:
    """Say which file is wrong, and turn what the system refuses into a user's line.

    Examples
    --------
    >>> with in_file(Path("K.mtx")):
    ...     raise InputError("is empty")
    Traceback (most recent call last):
    bumpstop.errors.InputError: K.mtx: is empty
    """
    try:
        yield
    except InputError as error:
        raise error.located(file=str(path)) from error
    except FileNotFoundError as error:
        raise InputError("no such file", file=str(path), hint="check the path") from error
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"cannot be read: {reason}", file=str(path)) from error
    except MemoryError as error:
        raise InputError("asks for more memory than there is", file=str(path)) from error


def read_content(path: Path, kind: str) -> bytes:
    """Return the bytes of a file.

    Parameters
    ----------
    path
        The file.
    kind
        What it should be: ``"a Matrix Market file"``.

    Raises
    ------
    InputError
        If it is a folder or nothing regular, or is empty.
    """
    if path.is_dir():
        raise InputError(f"is a folder, not {kind}")
    if path.exists() and not path.is_file():
        raise InputError(f"is not a regular file, but should be {kind}")
    content = path.read_bytes()
    if not content.strip():
        raise InputError(f"is empty, but should be {kind}")
    return content


def read_lines(path: Path, kind: str) -> list[str]:
    """Return the lines of a text file, without the blanks at their ends.

    Raises
    ------
    InputError
        If it is empty, is not a regular file, or holds no text.
    """
    content = read_content(path, kind)
    if b"\0" in content:
        raise InputError(f"is a binary file, not {kind}")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("latin-1")  # what older programs write in titles and comments
    return [line.rstrip() for line in text.splitlines()]
