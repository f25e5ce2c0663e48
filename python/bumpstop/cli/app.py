"""The commands and their options. Each command's work is in the file of its name.

A command gives its job back instead of doing it, so that nothing that goes wrong in it is
taken for a mistake in the arguments.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import typer

__all__ = ["Job", "app"]

Job: TypeAlias = Callable[[], int]
"""What a command does; it returns the exit status."""

# Help is dressed up by rich on a terminal; loading rich for anything else would cost time.
_MARKUP: Literal["rich"] | None = "rich" if sys.stdout.isatty() else None

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=_MARKUP,
    pretty_exceptions_enable=False,
    help="How flexible structures vibrate when they hit stops.",
)

CasePath = Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Method = Annotated[
    str | None,
    typer.Option(
        "--method", metavar="M", help="How to integrate time; the case's own if left out."
    ),
]


def _print_version(wanted: bool) -> None:
    if wanted:
        from bumpstop import __version__

        typer.echo(f"bumpstop {__version__}")
        raise typer.Exit


@app.callback()
def _common(
    _version: Annotated[
        bool,
        typer.Option(
            "--version", is_eager=True, callback=_print_version, help="Print the version."
        ),
    ] = False,
    _debug: Annotated[
        bool, typer.Option("--debug", help="Show where in the program an error arose.")
    ] = False,
) -> None:
    pass


@app.command()
def run(
    case: CasePath,
    method: Method = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write DIR/<variant>/response.nc and DIR/report.html."),
    ] = None,
    json: Json = False,
    report: Annotated[bool, typer.Option(help="Write the report.")] = True,
) -> Job:
    """Simulate a case and check it against its references."""
    from bumpstop.cli.run import run_command

    return partial(run_command, case, method=method, out=out, json=json, report=report)


@app.command()
def modes(case: CasePath, json: Json = False) -> Job:
    """Print the natural frequencies of a case."""
    from bumpstop.cli.modes import modes_command

    return partial(modes_command, case, json=json)


@app.command()
def verify(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[NAME]...", help="Cases; all if left out.")
    ] = None,
    cases: Annotated[
        Path, typer.Option(metavar="DIR", help="The folder that holds the cases.")
    ] = Path("cases"),
    method: Method = None,
    json: Json = False,
) -> Job:
    """Check cases against their references."""
    from bumpstop.cli.verify import verify_command

    return partial(verify_command, names or [], folder=cases, method=method, json=json)


@app.command()
def report(
    case: CasePath,
    method: Method = None,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Write DIR/report.html.")] = Path(),
) -> Job:
    """Simulate a case and write its report alone."""
    from bumpstop.cli.report import report_command

    return partial(report_command, case, method=method, out=out)


@app.command()
def schema() -> Job:
    """Print the JSON schema of case files, for editors."""
    from bumpstop.cli.schema import schema_command

    return schema_command
