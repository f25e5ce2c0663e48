"""``[laws.NAME]`` with ``type = "cracked_rotor"``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from bumpstop.errors import InputError
from bumpstop.io.case.build.rotation import required_rotation
from bumpstop.io.reading import in_file, read_lines
from bumpstop.laws import CrackedRotor

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.laws import CrackedRotorTable

__all__ = ["built_crack"]

_SOURCES = ("stiffness", "points", "file")


def built_crack(name: str, table: CrackedRotorTable, case: CaseFile, folder: Path) -> CrackedRotor:
    """Return the crack that a table describes; files are relative to the folder."""
    given = [key for key in _SOURCES if getattr(table, key) is not None]
    if len(given) != 1:
        what = "must have one of stiffness, points and file"
        raise InputError(what, value=", ".join(given) or "none")
    return CrackedRotor(
        name,
        node=table.node,
        other=table.other,
        axis=table.axis,
        interpolation=table.interpolation,
        rotation=required_rotation(case, folder),
        **_functions(table, folder),
    )


def _functions(table: CrackedRotorTable, folder: Path) -> dict[str, Any]:
    """Return the stiffness and its derivative."""
    if table.stiffness is not None:
        return {"stiffness": table.stiffness, "derivative": table.derivative}
    if table.derivative is not None:
        what, hint = "goes with a formula of the stiffness", "give a third number in each point"
        raise InputError(what, key="derivative", value=table.derivative, hint=hint)
    points = table.points if table.file is None else _read(folder / table.file)
    widths = {len(point) for point in points or ()}
    if len(widths) > 1:
        raise InputError("must have two numbers in each point, or three in each", key="points")
    parts: dict[str, Any] = {"stiffness": [(point[0], point[1]) for point in points or ()]}
    if widths == {3}:
        parts["derivative"] = [(point[0], point[2]) for point in points or ()]
    return parts


def _read(path: Path) -> list[tuple[float, ...]]:
    """Return the points of a file."""
    with in_file(path):
        lines = enumerate(read_lines(path, "a table of a crack"), start=1)
        bare = [(number, line.split("#")[0].replace(",", " ").split()) for number, line in lines]
        return [_point(number, words) for number, words in bare if words]


def _point(number: int, words: list[str]) -> tuple[float, ...]:
    """Return the numbers of a line."""
    try:
        point = tuple(map(float, words))
    except ValueError as error:
        raise InputError(f"holds no numbers in line {number}", value=" ".join(words)) from error
    if len(point) not in (2, 3):
        what = f"must hold two or three numbers in line {number}"
        raise InputError(what, value=" ".join(words))
    return point
