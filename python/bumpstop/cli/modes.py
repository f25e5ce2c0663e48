"""``bumpstop modes``."""

from __future__ import annotations

from pathlib import Path

from bumpstop.cli.console import Table, print_json, print_line, print_table
from bumpstop.io.case import load_case
from bumpstop.modal.basis import ModalBasis

__all__ = ["modes_command"]


def modes_command(path: Path, *, json: bool) -> int:
    """Print the frequencies and damping of each basis of a case; return the status.

    Variants that change nothing of the structure share a basis. The JSON object has the
    first variant's on top, and each variant's under its name.
    """
    case = load_case(path)
    bases = {name: problem.basis for name, problem in case.problems.items()}
    if json:
        records = {name: _record(basis) for name, basis in bases.items()}
        first = next(iter(records.values()))
        print_json({"case": case.name, **first, "variants": records})
        return 0
    print_line(case.title, style="bold")
    for basis in dict.fromkeys(bases.values()):
        print_line()
        print_line(", ".join(name for name in bases if bases[name] is basis), style="bold cyan")
        print_table(_table(basis))
        if basis.sturm is not None:
            print_line(str(basis.sturm))
    return 0


def _record(basis: ModalBasis) -> dict[str, object]:
    return {
        "frequencies": basis.frequencies.tolist(),
        "damping": basis.damping_ratio.tolist(),
        "sturm": None if basis.sturm is None else str(basis.sturm),
    }


def _table(basis: ModalBasis) -> Table:
    pairs = zip(basis.frequencies, basis.damping_ratio, strict=True)
    return Table(
        headers=("mode", "frequency [Hz]", "damping [%]"),
        rows=[
            (str(mode), f"{frequency:.6g}", f"{100 * ratio:.4g}")
            for mode, (frequency, ratio) in enumerate(pairs, start=1)
        ],
    )
