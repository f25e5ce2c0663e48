"""Files that are there whole or not at all."""

from __future__ import annotations

import os
import platform
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path

from bumpstop.errors import InputError

__all__ = ["file_path", "remove_leftovers", "temporary_name", "written_whole"]

_numbers = count()


def file_path(path: object) -> Path:
    """Return the name of a file as a path.

    Raises
    ------
    InputError
        If it is none.
    """
    if not isinstance(path, str | os.PathLike) or not str(path).strip():
        raise InputError("must be the name of a file", key="path", value=path)
    return Path(path)


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
    final = file_path(path)
    if final.is_dir():
        raise InputError("is a folder", file=str(final), hint="give the name of a file in it")
    part = temporary_name(final)
    try:
        part.touch()
        yield part
        part.replace(final)
    except OSError as error:
        # Not its own words: those of HDF5 tell addresses in memory.
        reason = os.strerror(error.errno) if error.errno else str(error)
        raise InputError(f"cannot be written: {reason}", file=str(final)) from error
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)


def temporary_name(final: Path) -> Path:
    """Return a hidden name beside a file or folder that is to be renamed to it once complete.

    It lies in the same folder, since a rename is only atomic within one file system, and tells
    which process of which machine writes there.
    """
    return final.with_name(f"{_prefix(final)}{os.getpid()}-{next(_numbers)}.part")


def remove_leftovers(final: Path) -> None:
    """Remove what killed processes have left under temporary names of a file or folder.

    Those of living processes stay, and so do those of other machines, of which nobody knows.
    It looks through the whole folder: once for a run, not once for each of many files.
    """
    if not final.parent.is_dir():
        return
    written = re.compile(re.escape(_prefix(final)) + r"(\d{1,9})-\d+\.part")
    for found in final.parent.iterdir():
        writer = written.fullmatch(found.name)
        if writer and not _is_alive(int(writer[1])):
            _remove(found)


def _prefix(final: Path) -> str:
    return f".{final.name}.{platform.node()}-"


def _is_alive(process: int) -> bool:
    if os.name != "posix":  # elsewhere there is no signal that does nothing
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:  # it belongs to somebody else
        return True
    return True


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        with suppress(OSError):
            path.unlink()
