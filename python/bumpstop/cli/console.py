"""Printing: tables in colour on a terminal, aligned text in a pipe, JSON where asked for."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

if TYPE_CHECKING:
    from rich.console import Console

__all__ = ["Table", "print_error", "print_json", "print_line", "print_table"]


WIDEST = 10_000
"""Columns of text that no table exceeds."""


class Table(NamedTuple):
    """Rows of texts.

    Where it is known which rows are good, their last cells say so in colour. The first
    ``labels`` columns are words and start at the left, the others are numbers.
    """

    headers: Sequence[str]
    rows: Sequence[Sequence[str]]
    good: Sequence[bool] | None = None
    labels: int = 0


def print_json(value: dict[str, Any]) -> None:
    """Print one JSON object. What is not a finite number becomes null, as JSON has no NaN."""
    import json

    print(json.dumps(_finite(value), allow_nan=False))


def print_line(text: str = "", *, style: str = "") -> None:
    """Print a line, in a style where the output is a terminal."""
    if sys.stdout.isatty():
        _rich_console().print(text, style=style, markup=False, highlight=False, soft_wrap=True)
    else:
        print(text)


def print_error(what: str) -> None:
    """Say in one line on standard error what went wrong."""
    one_line = "".join(char if char.isprintable() else " " for char in f"error: {what}")
    with suppress(OSError):  # nobody can be told that nothing can be told
        print(one_line, file=sys.stderr)


def print_table(table: Table) -> None:
    """Print a table."""
    if sys.stdout.isatty():
        _print_rich(table)
    else:
        _print_plain(table)


def _print_plain(table: Table) -> None:
    lines = [table.headers, *table.rows]
    widths = [max(len(cell) for cell in column) for column in zip(*lines, strict=True)]
    for line in lines:
        cells = [
            cell.ljust(width) if number < table.labels else cell.rjust(width)
            for number, (cell, width) in enumerate(zip(line, widths, strict=True))
        ]
        print("  " + "  ".join(cells).rstrip())


def _print_rich(table: Table) -> None:
    from rich import box
    from rich.measure import Measurement
    from rich.padding import Padding
    from rich.table import Table as RichTable
    from rich.text import Text

    drawn = RichTable(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False)
    for number, header in enumerate(table.headers):
        side: Literal["left", "right"] = "left" if number < table.labels else "right"
        drawn.add_column(Text(header), justify=side)
    for number, row in enumerate(table.rows):
        style = "" if table.good is None else "green" if table.good[number] else "bold red"
        drawn.add_row(*map(Text, row[:-1]), Text(row[-1], style=style))
    indented = Padding(drawn, (0, 0, 0, 2))
    console = _rich_console()
    # Where the terminal is too narrow it breaks the lines; rich would leave out numbers.
    unlimited = console.options.update(max_width=WIDEST)
    console.width = max(console.width, Measurement.get(console, unlimited, indented).maximum)
    console.print(indented, crop=False)


def _rich_console() -> Console:
    from rich.console import Console

    console = Console()
    console.width = max(console.width, 1)  # some terminals say 0, and rich then shows nothing
    return console


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
