"""Text meshes of code_aster (.mail).

Format: code_aster, U3.01.00, "Description du fichier de maillage de Code_Aster". Free words; blocks
run from a keyword to FINSF; what follows % is a comment.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from bumpstop.arguments import Vector
from bumpstop.errors import InputError
from bumpstop.io.meshes.line_mesh import LineMesh, line_mesh
from bumpstop.io.reading import in_file, read_lines

__all__ = ["read_aster"]

_END_OF_BLOCK, _END = "FINSF", "FIN"
_COORDINATES = {"COOR_1D": 1, "COOR_2D": 2, "COOR_3D": 3}


def read_aster(path: Path) -> LineMesh:
    """Read the lines (SEG2) of a text mesh, and its groups.

    Raises
    ------
    InputError
        If the file cannot be read, is truncated, or gives a name twice.
    """
    with in_file(path):
        lines = read_lines(path, "a text mesh of code_aster")
        nodes: dict[str, Vector] = {}
        segments: dict[str, tuple[str, str]] = {}
        groups: dict[str, dict[str, list[str]]] = {"GROUP_MA": {}, "GROUP_NO": {}}
        points: dict[str, str] = {}
        for keyword, words in _blocks(lines):
            if keyword in _COORDINATES:
                _take_nodes(nodes, words, _COORDINATES[keyword])
            elif keyword == "SEG2":
                _take_segments(segments, words)
            elif keyword == "POI1":
                points.update((name, node) for name, node in _rows(words, 2, "a point"))
            elif keyword == "SEG3":
                what = "has SEG3, lines with a node between their ends"
                raise InputError(what, hint="mesh with SEG2")
            elif keyword in groups:
                group, *held = words or [""]
                groups[keyword].setdefault(group, []).extend(held)
        elements = groups["GROUP_MA"]
        return line_mesh(
            nodes,
            segments,
            _of_these(elements, {name: name for name in segments}),
            groups["GROUP_NO"] | _of_these(elements, points),
        )


def _of_these(groups: dict[str, list[str]], known: dict[str, str]) -> dict[str, list[str]]:
    """Return the groups of elements of one kind, without those that have none of it."""
    kept = {
        group: [known[name] for name in held if name in known] for group, held in groups.items()
    }
    return {group: held for group, held in kept.items() if held}


def _blocks(lines: list[str]) -> Iterator[tuple[str, list[str]]]:
    """Yield each block: its keyword and its words, without settings such as NBOBJ=4."""
    keyword = ""
    words: list[str] = []
    for line in lines:
        for word in line.partition("%")[0].replace("=", " = ").split():
            if not keyword:
                if word == _END:
                    return
                keyword, words = word, []
            elif word == _END_OF_BLOCK:
                if keyword != "TITRE":
                    yield keyword, _without_settings(words, keyword.startswith("GROUP"))
                keyword = ""
            else:
                words.append(word)
    if keyword:
        raise InputError(f"is truncated within {keyword}")
    raise InputError("is truncated: it has no FIN")


def _without_settings(words: list[str], named: bool) -> list[str]:
    """Return the words without ``NAME = value``; with the value of NOM where it is a name."""
    kept: list[str] = []
    index = 0
    while index < len(words):
        if words[index + 1 : index + 2] == ["="]:
            kept += words[index + 2 : index + 3] if named and words[index] == "NOM" else []
            index += 3
        else:
            kept.append(words[index])
            index += 1
    return kept


def _take_nodes(nodes: dict[str, Vector], words: list[str], dimension: int) -> None:
    for row in _rows(words, 1 + dimension, "a node"):
        if row[0] in nodes:
            raise InputError(f"node {row[0]} is there twice")
        try:
            x, y, z = (float(word.upper().replace("D", "E")) for word in [*row[1:], "0", "0"][:3])
        except ValueError as error:
            what = f"the coordinates of node {row[0]} cannot be read"
            raise InputError(what, value=" ".join(row[1:])) from error
        nodes[row[0]] = (x, y, z)


def _take_segments(segments: dict[str, tuple[str, str]], words: list[str]) -> None:
    for name, first, last in _rows(words, 3, "a line"):
        if name in segments:
            raise InputError(f"line {name} is there twice")
        segments[name] = (first, last)


def _rows(words: list[str], length: int, thing: str) -> Iterator[list[str]]:
    if len(words) % length:
        raise InputError(f"{thing} must have {length} words", value=" ".join(words[-length:]))
    for start in range(0, len(words), length):
        yield words[start : start + length]
