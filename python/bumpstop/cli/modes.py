"""``bumpstop modes``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from bumpstop.arguments import FloatArray
from bumpstop.cli.console import Table, print_json, print_line, print_table
from bumpstop.errors import InputError
from bumpstop.io.case import load_case
from bumpstop.modal.basis import ModalBasis, mode_labels
from bumpstop.modal.masses import generalised_mass, participation
from bumpstop.modal.oscillation import ComplexModes, complex_modes
from bumpstop.modal.spin import angular_momentum
from bumpstop.report.remarks import remarks

__all__ = ["modes_command"]

PLANAR = 0.005
"""A motion that turns less than this swings to and fro."""


def modes_command(path: Path, *, json: bool, out: Path | None) -> int:
    """Print the modes of each basis of a case, and what is to be said of them; return the status.

    Variants that change nothing of the structure share a basis. The JSON object has the
    first variant's on top, and each variant's under its name. In the folder `out`, where one
    is given, a page draws the modes.
    """
    case = load_case(path)
    bases = {name: basis for name, basis in case.bases.items() if not basis.unreduced}
    if not bases:
        what = "a full model has no modes"
        raise InputError(what, file=str(path), key="basis.model", hint='ask for model = "modal"')
    if out is not None:
        from bumpstop.cli.outputs import MODES, write_modes_page
        from bumpstop.cli.staging import check_writable

        check_writable(out, [MODES])
        write_modes_page(case, out)
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
        if basis.couples:
            print_line("  with the damping and the gyroscopic forces that couple these modes:")
            print_table(_complex_table(basis))
        for remark in remarks(basis):
            print_line(f"  {remark}")
    if out is not None:
        print_line()
        print_line(f"written to {out / 'modes.html'}")
    return 0


def _record(basis: ModalBasis) -> dict[str, Any]:
    record: dict[str, Any] = {
        "frequencies": basis.frequencies.tolist(),
        "damping": basis.damping_ratio.tolist(),
        "rigid_modes": list(basis.rigid_modes),
        "labels": list(basis.canonical_labels),
        "generalised_mass": generalised_mass(basis).tolist(),
        "remarks": remarks(basis),
        "sturm": None if basis.sturm is None else str(basis.sturm),
    }
    if basis.has_masses:
        part = participation(basis)
        totals = zip(part.directions, part.total.tolist(), strict=True)
        masses = zip(part.directions, part.effective_mass.T.tolist(), strict=True)
        record |= {"total_mass": dict(totals), "effective_mass": dict(masses)}
    if basis.couples:
        modes = complex_modes(basis)
        whirl = _whirl(basis, modes)
        record["complex_modes"] = {
            "frequencies": modes.frequencies.tolist(),
            "damping": modes.damping_ratio.tolist(),
            "whirl": None if whirl is None else whirl.tolist(),
        }
    return record


def _table(basis: ModalBasis) -> Table:
    """Return a row a mode, and a last one that adds up what can be added."""
    columns = [
        _Column("mode", [str(number) for number in range(1, len(basis.omega2) + 1)]),
        _Column("frequency [Hz]", [f"{value:.6g}" for value in basis.frequencies]),
        _Column("damping [%]", [f"{100 * value:.4g}" for value in basis.damping_ratio]),
        _Column("mass [kg]", [f"{value:.4g}" for value in generalised_mass(basis)]),
    ]
    if basis.has_masses:
        part = participation(basis)
        shares = zip(part.directions, part.fractions.T, part.sums, strict=True)
        columns += [
            _Column(f"{name} [%]", [_percent(value) for value in values], _percent(total))
            for name, values, total in shares
        ]
    if basis.canonical_labels != mode_labels(len(basis.omega2)):
        columns.append(_Column("what", basis.canonical_labels))
    rows = list(zip(*(column.cells for column in columns), strict=True))
    if basis.has_masses:
        rows.append(("sum", *(column.total for column in columns[1:])))
    return Table(headers=[column.header for column in columns], rows=rows)


def _complex_table(basis: ModalBasis) -> Table:
    """Return a row for each motion that the coupled modes make."""
    modes = complex_modes(basis)
    whirl = _whirl(basis, modes)
    columns = [
        _Column("number", [str(number) for number in range(1, len(modes.eigenvalues) + 1)]),
        _Column("frequency [Hz]", [f"{value:.6g}" for value in modes.frequencies]),
        _Column("damping [%]", [f"{100 * value:.4g}" for value in modes.damping_ratio]),
    ]
    if whirl is not None:
        columns.append(_Column("whirl", [_turning(value) for value in whirl]))
    rows = list(zip(*(column.cells for column in columns), strict=True))
    return Table(headers=[column.header for column in columns], rows=rows)


def _whirl(basis: ModalBasis, modes: ComplexModes) -> FloatArray | None:
    """Return how the motions turn about the axis of the spin, where something spins."""
    if basis.model is None or basis.gyroscopic is None:
        return None
    try:
        momentum = angular_momentum(basis.model)
    except InputError:  # matrices from elsewhere, with positions that are not known
        return None
    return modes.whirl(momentum.tolist()) if momentum.any() else None


def _turning(whirl: float) -> str:
    if abs(whirl) < PLANAR:
        return "-"
    return f"{'forward' if whirl > 0.0 else 'backward'} {abs(whirl):.2f}"


class _Column(NamedTuple):
    header: str
    cells: Sequence[str]
    total: str = ""


def _percent(share: float) -> str:
    return f"{100.0 * share:.2f}"
