"""Several files that appear in a folder together, or not at all."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from bumpstop.errors import InputError
from bumpstop.files import remove_leftovers, temporary_name

__all__ = ["all_or_nothing", "check_writable"]


def check_writable(folder: Path, files: Sequence[str]) -> None:
    """Refuse a folder that files cannot be written to, before anything is computed.

    Parameters
    ----------
    folder
        Where they are to be; it need not exist.
    files
        Their paths within it.

    Raises
    ------
    InputError
        If it is a file, or its nearest parent that exists is none or cannot be written to, or
        something stands where a file or its folder is to be.
    """
    nearest = _nearest(folder.absolute())
    if not nearest.is_dir():
        raise _unwritable(folder, f"{nearest} is not a folder")
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise _unwritable(folder, f"{nearest} is not writable")
    for name in files:
        _check_place(folder / name)


@contextmanager
def all_or_nothing(folder: Path) -> Iterator[Path]:
    """Give a temporary folder; its files move over to the wanted one once all are complete.

    What goes wrong meanwhile, the move included, leaves the wanted folder as it was.

    Raises
    ------
    InputError
        If something cannot be written.
    """
    target = folder.absolute()
    missing = [parent for parent in target.parents if not parent.exists()]
    # Within a folder that exists: what is beside it may be another disk, or closed to us.
    beside, within = target, target / "results"
    staging = temporary_name(within if target.exists() else beside)
    try:
        remove_leftovers(beside)
        remove_leftovers(within)
        staging.mkdir(parents=True)
        yield staging
        _move_over(staging, folder)
    except OSError as error:
        raise _unwritable(folder, error.strerror or str(error)) from error
    except InputError as error:
        if error.key is not None:
            raise
        raise _unwritable(folder, error.what) from error
    finally:
        shutil.rmtree(staging, ignore_errors=True)
        _remove_empty(missing)


def _move_over(staging: Path, folder: Path) -> None:
    target = folder.absolute()
    if not target.exists():
        staging.rename(target)
        return
    new = sorted(path for path in staging.rglob("*") if path.is_file())
    places = {file: target / file.relative_to(staging) for file in new}
    for place in places.values():
        _check_place(place)
    made = [place.parent for place in places.values() if not place.parent.exists()]
    replaced: dict[Path, Path] = {}
    written: list[Path] = []
    try:
        for number, (file, place) in enumerate(places.items()):
            place.parent.mkdir(exist_ok=True)
            if place.exists():
                older = staging / f".replaced-{number}"
                place.rename(older)
                replaced[place] = older
            file.rename(place)
            written.append(place)
    except BaseException:
        for place in written:
            place.unlink()
        for place, older in replaced.items():
            older.rename(place)
        _remove_empty(made)
        raise


def _check_place(place: Path) -> None:
    """Refuse a file's place where a folder stands, or a file in place of its folder."""
    if place.is_dir():
        raise _taken(place, "is a folder")
    nearest = _nearest(place.parent)
    if not nearest.is_dir():
        raise _taken(nearest, "is not a folder")
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise _taken(nearest, "is not writable")


def _nearest(path: Path) -> Path:
    """Return a path, or the nearest of its parents that is there."""
    return next(found for found in (path, *path.absolute().parents) if os.path.lexists(found))


def _remove_empty(folders: Sequence[Path]) -> None:
    """Remove folders that were made on the way and hold nothing."""
    for folder in folders:
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()


def _taken(path: Path, why: str) -> InputError:
    hint = "move it away, or name another folder"
    return InputError(f"nothing was written: {path} {why}", key="--out", hint=hint)


def _unwritable(folder: Path, why: str) -> InputError:
    return InputError(
        f"cannot be written to: {why}", key="--out", value=str(folder), hint="name another folder"
    )
