"""The commands and their options. Each command's work is in the file of its name.

Reading the arguments does nothing yet: it gives the work back, so that what goes wrong in it is
never taken for a mistake in the arguments. A command's module is imported by its work.
"""

from __future__ import annotations

import re
from argparse import ArgumentParser, ArgumentTypeError, BooleanOptionalAction, Namespace
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn, TypeAlias

from bumpstop.arguments import did_you_mean
from bumpstop.cli.console import print_line
from bumpstop.errors import InputError

if TYPE_CHECKING:
    from bumpstop.cli.solve import Stepping

__all__ = ["Job", "job"]

Job: TypeAlias = Callable[[], int]
"""What a command does; it returns the exit status."""

PROGRAM = "bumpstop"
NEGATIVE = re.compile(r"-\.?\d|-inf|-nan")
"""How a negative number begins."""
WHAT_IT_IS = "How flexible structures vibrate when they hit stops."


def job(words: Sequence[str]) -> Job:
    """Return what a command line asks for.

    Parameters
    ----------
    words
        The command and its arguments, at least one word.

    Raises
    ------
    InputError
        If there is no such command, or it does not take these arguments.
    """
    command, *arguments = words
    if command in ("-h", "--help"):
        return _print_overview
    if command == "--version":
        return _print_version
    if command not in COMMANDS:
        kind = "option" if command.startswith("-") else "command"
        hint = did_you_mean(command, (*COMMANDS, "--help", "--version", "--debug"))
        raise InputError(f"there is no {kind} {command!r}", hint=hint)
    parser = _parser(command)
    if not {"-h", "--help"}.isdisjoint(arguments):
        return partial(_print_help, parser)
    given, unknown = parser.parse_known_intermixed_args(_with_values(arguments))
    if unknown:
        parser.refuse(unknown[0])
    return partial(parser.work, given)


def _with_values(arguments: Sequence[str]) -> list[str]:
    """Return arguments with negative numbers joined to the options in front of them.

    An option that begins with a minus and a digit there is none, but argparse takes ``-1e-5`` for
    one.
    """
    joined: list[str] = []
    for word in arguments:
        option = joined[-1] if joined else ""
        if NEGATIVE.match(word) and option.startswith("--") and "=" not in option:
            joined[-1] = f"{option}={word}"
        else:
            joined.append(word)
    return joined


class _Parser(ArgumentParser):
    """Reads the arguments of one command, and raises what is wrong with them."""

    work: Callable[[Namespace], int]

    def error(self, message: str) -> NoReturn:
        switch = re.fullmatch("argument (.*): ignored explicit argument (.*)", message)
        if switch:
            message = f"{switch[1]} takes no value (got {switch[2]})"
        raise InputError(message, hint=f"see '{self.prog} --help'")

    def refuse(self, word: str) -> NoReturn:
        """Raise the error for a word that is neither an argument nor an option."""
        if not word.startswith("-"):
            self.error(f"there is one argument too many, {word!r}")
        options = [option for option in self._option_string_actions if option.startswith("--")]
        name = word.partition("=")[0]
        raise InputError(f"there is no option {name!r}", hint=did_you_mean(name, options))


def _parser(command: str) -> _Parser:
    define = COMMANDS[command]
    program = f"{PROGRAM} {command}"
    parser = _Parser(
        prog=program, description=_summary(command), allow_abbrev=False, add_help=False
    )
    parser.add_argument("-h", "--help", action="help", help="Show this message.")
    parser.work = define(parser)
    return parser


def _summary(command: str) -> str:
    return (COMMANDS[command].__doc__ or "").strip()


def _print_overview() -> int:
    width = max(map(len, COMMANDS))
    commands = [f"  {name.ljust(width)}  {_summary(name)}" for name in COMMANDS]
    options = [
        "  --help     Show this message, or after a command what it takes.",
        "  --version  Print the version.",
        "  --debug    Show where in the program an error arose.",
    ]
    lines = [f"usage: {PROGRAM} [--debug] COMMAND ...", "", WHAT_IT_IS]
    _print_in_sections([*lines, "", "commands:", *commands, "", "options:", *options])
    return 0


def _print_help(parser: ArgumentParser) -> int:
    _print_in_sections(parser.format_help().splitlines())
    return 0


def _print_in_sections(lines: Sequence[str]) -> None:
    for line in lines:
        heading = line.endswith(":") and not line.startswith(" ")
        print_line(line, style="bold cyan" if heading else "")


def _print_version() -> int:
    from bumpstop import __version__

    print(f"{PROGRAM} {__version__}")
    return 0


def _run(parser: ArgumentParser) -> Callable[[Namespace], int]:
    """Simulate a case and check it against its references."""
    _takes_case(parser)
    _takes_method(parser)
    _takes_folder(parser, None, "Write DIR/<variant>/response.nc and DIR/report.html.")
    told = "Write responses in these formats, too: csv, parquet, uff, vtk, mat, wav."
    parser.add_argument("--export", metavar="F,F", help=told)
    _takes_json(parser)
    parser.add_argument(
        "--report", action=BooleanOptionalAction, default=True, help="Write the report or not."
    )

    def work(given: Namespace) -> int:
        from bumpstop.cli.run import run_command

        return run_command(
            given.case,
            stepping=_stepping(given),
            out=given.out,
            export=given.export,
            json=given.json,
            report=given.report,
        )

    return work


def _modes(parser: ArgumentParser) -> Callable[[Namespace], int]:
    """Print the natural frequencies of a case."""
    _takes_case(parser)
    _takes_folder(parser, None, "Write DIR/modes.html, which draws the modes.")
    _takes_json(parser)

    def work(given: Namespace) -> int:
        from bumpstop.cli.modes import modes_command

        return modes_command(given.case, json=given.json, out=given.out)

    return work


def _verify(parser: ArgumentParser) -> Callable[[Namespace], int]:
    """Check cases against their references."""
    parser.add_argument("names", nargs="*", metavar="NAME", help="Cases; all if left out.")
    parser.add_argument(
        "--cases",
        type=_path,
        metavar="DIR",
        default=Path("cases"),
        help="The folder that holds the cases; 'cases' if left out.",
    )
    _takes_method(parser)
    _takes_json(parser)

    def work(given: Namespace) -> int:
        from bumpstop.cli.verify import verify_command

        return verify_command(
            given.names, folder=given.cases, stepping=_stepping(given), json=given.json
        )

    return work


def _converge(parser: ArgumentParser) -> Callable[[Namespace], int]:
    """Tell how wrong a case's results are: errors of time, basis and mesh."""
    _takes_case(parser)
    _takes_method(parser)
    told = "How often steps and elements are halved; 3 if left out."
    parser.add_argument("--levels", type=int, metavar="N", default=3, help=told)
    _takes_folder(parser, None, "Write DIR/report.html, with the errors drawn.")
    _takes_json(parser)

    def work(given: Namespace) -> int:
        from bumpstop.cli.converge import converge_command

        return converge_command(
            given.case,
            stepping=_stepping(given),
            levels=given.levels,
            out=given.out,
            json=given.json,
        )

    return work


def _sweep(parser: ArgumentParser) -> Callable[[Namespace], int]:
    """Make the many runs of a study."""
    parser.add_argument("study", type=_path, metavar="STUDY.toml", help="The study file.")
    told = "The zarr store of the results; as the study says if left out."
    parser.add_argument("--store", type=_path, metavar="DIR", default=None, help=told)
    told = "How many processes; as many as there are cores if left out."
    parser.add_argument("--workers", type=int, metavar="N", default=None, help=told)
    told = "Open one run: write it as a case file beside the store, make it, and report on it."
    parser.add_argument("--open", type=int, metavar="RUN", default=None, help=told)
    told = "A dask scheduler whose workers make the runs: its address or scheduler file."
    parser.add_argument("--scheduler", metavar="ADDRESS", default=None, help=told)
    told = "Go on with a store, which must be there."
    parser.add_argument("--resume", action="store_true", help=told)
    _takes_json(parser)
    told = "Write the report, a page beside the store, or not."
    parser.add_argument("--report", action=BooleanOptionalAction, default=True, help=told)

    def work(given: Namespace) -> int:
        if given.open is not None:
            from bumpstop.cli.open_run import open_command

            return open_command(given.study, given.open, store=given.store, json=given.json)
        from bumpstop.cli.sweep import sweep_command

        return sweep_command(
            given.study,
            store=given.store,
            workers=given.workers,
            scheduler=given.scheduler,
            resume=given.resume,
            json=given.json,
            report=given.report,
        )

    return work


def _report(parser: ArgumentParser) -> Callable[[Namespace], int]:
    """Simulate a case and write its report alone, or compare several runs."""
    told = "A case file, or responses (response.nc) and case files to compare."
    parser.add_argument("runs", type=_path, nargs="+", metavar="RUN", help=told)
    _takes_method(parser)
    told = "Write DIR/report.html, or DIR/compare.html, or the page of this name; here if left out."
    parser.add_argument("-o", "--out", type=_path, metavar="DIR", default=Path(), help=told)

    def work(given: Namespace) -> int:
        from bumpstop.cli.report import report_command

        return report_command(given.runs, stepping=_stepping(given), out=given.out)

    return work


def _schema(_: ArgumentParser) -> Callable[[Namespace], int]:
    """Print the JSON schema of case files, for editors."""

    def work(_: Namespace) -> int:
        from bumpstop.cli.schema import schema_command

        return schema_command()

    return work


COMMANDS: dict[str, Callable[[ArgumentParser], Callable[[Namespace], int]]] = {
    "run": _run,
    "modes": _modes,
    "verify": _verify,
    "converge": _converge,
    "sweep": _sweep,
    "report": _report,
    "schema": _schema,
}
"""What each command takes, and what it does with that."""


def _path(text: str) -> Path:
    if not text:  # a variable of the shell that nobody has set
        raise ArgumentTypeError("is empty")
    return Path(text)


def _seconds(text: str) -> float:
    """Return a time, which may have a unit as in a case file."""
    try:
        return float(text)
    except ValueError:
        from bumpstop.errors import InputError
        from bumpstop.io.case.fields.quantities import read_time

        try:
            return read_time(text)
        except InputError as error:
            raise ArgumentTypeError(str(error)) from error


def _takes_case(parser: ArgumentParser) -> None:
    parser.add_argument("case", type=_path, metavar="CASE.toml", help="The case file.")


def _takes_method(parser: ArgumentParser) -> None:
    told = "How to integrate time; as the case says if left out."
    parser.add_argument("--method", metavar="M", help=told)
    told = "The step of that method, in s or with a unit (10us); as the case says if left out."
    parser.add_argument("--dt", type=_seconds, metavar="S", help=told)
    told = "The relative tolerance of that method; as the case says if left out."
    parser.add_argument("--rtol", type=float, metavar="R", help=told)


def _stepping(given: Namespace) -> Stepping:
    from bumpstop.cli.solve import Stepping

    return Stepping(given.method, given.dt, given.rtol)


def _takes_folder(parser: ArgumentParser, default: Path | None, told: str) -> None:
    parser.add_argument("--out", type=_path, metavar="DIR", default=default, help=told)


def _takes_json(parser: ArgumentParser) -> None:
    told = "Print one JSON object and nothing else."
    parser.add_argument("--json", action="store_true", help=told)
