"""Files that are there whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path

from bumpstop.errors import InputError

__all__ = ["written_whole"]

_numbers = count()


@contextmanager
def written_whole(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary name beside ``path``; rename it to ``path`` once all went well.

    Whatever goes wrong meanwhile, a file that was there before stays as it was and nothing
    new is left behind.

    Raises
    ------
    InputError
        If nothing can be written there.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> with written_whole(folder / "answer.txt") as part:
    ...     _ = part.write_text("42")
    >>> [found.name for found in folder.iterdir()]
    ['answer.txt']
    """
    final = Path(path)
    if final.is_dir():
        raise InputError("is a folder", file=str(final), hint="give the name of a file in it")
    # In the same folder, since a rename is only atomic within one file system.
    part = final.with_name(f".{final.name}.{os.getpid()}-{next(_numbers)}.part")
    try:
        part.touch()
        yield part
        part.replace(final)
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(f"cannot be written: {reason}", file=str(final)) from error
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)
