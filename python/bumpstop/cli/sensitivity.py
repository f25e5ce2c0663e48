"""Which parameter matters, as ``bumpstop sweep`` tells it of studies that are made for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from bumpstop.cli.console import Table
from bumpstop.study.indices import indices_of_runs
from bumpstop.study.sampling import SIDES

if TYPE_CHECKING:
    from bumpstop.study.store import Reader
    from bumpstop.study.study import Study

__all__ = ["Sensitivities", "sensitivities", "sensitivity_table"]

Sensitivities: TypeAlias = dict[str, dict[str, dict[str, float | None]]]
"""Output, parameter, what is told of it; None where a run has no such number."""

_COLUMNS = {"saltelli": ("alone", "with_others"), "one_at_a_time": SIDES}
"""What is told of each parameter, by the method of sampling."""


def sensitivities(study: Study, read: Reader) -> Sensitivities:
    """Return what each parameter does to each single number; nothing where no runs tell."""
    columns = _COLUMNS.get(study.sampling.method, ())
    numbers = [name for name, output in study.outputs.items() if not output.shape]
    if not columns:
        return {}
    return {
        output: {
            parameter: {
                column: float(number) if np.isfinite(number) else None
                for column, number in zip(columns, row, strict=True)
            }
            for parameter, row in zip(study.runs.names, _rows(study, read(output)), strict=True)
        }
        for output in numbers
    }


def sensitivity_table(told: Sensitivities) -> Table:
    """Return a table of them."""
    lines = [
        (output, parameter, columns)
        for output, parameters in told.items()
        for parameter, columns in parameters.items()
    ]
    headers = [column.replace("_", " ") for column in lines[0][2]]
    rows = [
        (output, parameter, *("-" if each is None else f"{each:.4g}" for each in columns.values()))
        for output, parameter, columns in lines
    ]
    return Table(headers=("output", "parameter", *headers), rows=rows, labels=2)


def _rows(study: Study, values: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return the numbers of each parameter, (parameter, column)."""
    if study.sampling.method == "one_at_a_time":
        return values.reshape(-1, len(SIDES))
    return np.transpose(indices_of_runs(values, study.sampling.count or 0))
