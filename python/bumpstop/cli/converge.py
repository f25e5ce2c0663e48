"""``bumpstop converge``."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.cli.console import Table, print_json, print_line, print_table
from bumpstop.cli.outputs import REPORT, write_convergence
from bumpstop.cli.progress import progress_display
from bumpstop.cli.solve import Stepping
from bumpstop.cli.staging import check_writable
from bumpstop.io.case import load_case
from bumpstop.post.references import REFERENCE_QUANTITIES, Check
from bumpstop.report.convergence import ladder_told, position_told, remedy_told
from bumpstop.report.words import title_of
from bumpstop.study.convergence import Convergence, Ladder, VariantConvergence, converge

__all__ = ["converge_command"]


def converge_command(
    path: Path, *, stepping: Stepping, levels: int, out: Path | None, json: bool
) -> int:
    """Find the errors of a case's results, print and write them; return the status."""
    stepping.check()
    case = load_case(path)
    stepping.check_for(case)
    if out is not None:
        check_writable(out, [REPORT])
    with progress_display(f"{case.name}, converging") as tell:
        found = converge(
            case,
            method=stepping.method,
            dt=stepping.dt,
            rtol=stepping.rtol,
            levels=levels,
            progress=_fractions(3 * len(case.bases), tell),
        )
    if out is not None:
        write_convergence(found, out)
    if json:
        print_json(_record(found))
    else:
        _print(found)
        if out is not None:
            print_line()
            print_line(f"written to {out / REPORT}")
    return 0


def _fractions(parts: int, tell: Callable[[float], None] | None) -> Callable[[str], None] | None:
    """Return what counts the parts that begin, for those who watch."""
    if tell is None:
        return None
    begun = 0

    def count(_: str) -> None:
        nonlocal begun
        tell(begun / parts)
        begun += 1

    return count


def _print(found: Convergence) -> None:
    print_line(found.case.title, style="bold")
    for variant in found.variants.values():
        print_line()
        print_line(variant.name, style="bold cyan")
        for caption, rows in _groups(variant):
            print_line(f"  {caption}")
            print_table(_table(variant, rows))
        for ladder in variant.ladders:
            print_line(f"  {ladder.part}: {ladder_told(ladder)}")
        for line in remedy_told(variant):
            print_line(f"  {line}")
        print_line(f"  {position_told(variant)}", style="bold")


def _groups(variant: VariantConvergence) -> Iterator[tuple[str, list[int]]]:
    """Yield a caption and the numbers of the values of each quantity."""
    for (target, units), group in groupby(
        range(len(variant.checks)),
        lambda row: (variant.checks[row].target, variant.checks[row].units),
    ):
        yield f"{title_of(target)}{'' if units == '1' else f', in {units}'}", list(group)


def _table(variant: VariantConvergence, rows: list[int]) -> Table:
    modes = variant.checks[rows[0]].mode is not None
    return Table(
        headers=(
            "mode" if modes else "time [s]",
            "published",
            "computed",
            "time error",
            "basis error",
            "mesh error",
            "converged",
            "+-",
        ),
        rows=[_row(variant, row) for row in rows],
    )


def _row(variant: VariantConvergence, row: int) -> tuple[str, ...]:
    check = variant.checks[row]
    return (
        f"{check.time:.6g}" if check.mode is None else str(check.mode),
        f"{check.reference:.6g}",
        _number(check.value, ".6g"),
        *(_number(ladder.error[row], ".2g") for ladder in variant.ladders),
        _number(variant.converged[row], ".6g"),
        _number(variant.uncertainty[row], ".1g"),
    )


def _number(value: float, form: str) -> str:
    return "-" if np.isnan(value) else format(value, form)


def _record(found: Convergence) -> dict[str, Any]:
    variants = [_variant_record(variant) for variant in found.variants.values()]
    return {"case": found.case.name, "variants": variants}


def _variant_record(variant: VariantConvergence) -> dict[str, Any]:
    position = variant.position
    told = None
    if position is not None:
        told = {"share": position.share, "error": position.error, "verdict": position.verdict}
    return {
        "name": variant.name,
        "method": None if variant.response is None else variant.response.method,
        "refinements": {ladder.part: _ladder_record(ladder) for ladder in variant.ladders},
        "remedy": None if variant.remedy is None else _ladder_record(variant.remedy),
        "largest": variant.largest,
        "published_values": told,
        "references": [_value_record(variant, row) for row in range(len(variant.checks))],
    }


def _ladder_record(ladder: Ladder) -> dict[str, Any]:
    return {
        "told": ladder.told,
        "sizes": [rung.size for rung in ladder.rungs],
        "values": [rung.values.tolist() for rung in ladder.rungs],
        "error": ladder.error.tolist(),
        "order": ladder.order.tolist(),
    }


def _value_record(variant: VariantConvergence, row: int) -> dict[str, Any]:
    check: Check = variant.checks[row]
    errors: dict[str, FloatArray] = {each.part: each.error for each in variant.ladders}
    return {
        "quantity": check.quantity,
        **dict(zip(REFERENCE_QUANTITIES[check.quantity], check.target[1:], strict=False)),
        "mode": check.mode,
        "time": check.time,
        "reference": check.reference,
        "value": check.value,
        "errors": {part: float(error[row]) for part, error in errors.items()},
        "converged": float(variant.converged[row]),
        "uncertainty": float(variant.uncertainty[row]),
    }
