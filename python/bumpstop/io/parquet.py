"""Parquet: signals as columns of doubles, compressed, for pandas, Polars, Spark and databases.

Needs pyarrow: ``pip install bumpstop[parquet]``.
"""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING

from bumpstop.files import written_whole
from bumpstop.io.needed import needed
from bumpstop.io.signals import sampled_blocks, signals

if TYPE_CHECKING:
    from bumpstop.response import Response

__all__ = ["write_parquet"]


def write_parquet(response: Response, path: str | PathLike[str]) -> None:
    """Write the signals of a response, tabulated at its times, to a Parquet file.

    Columns are called ``time``, ``displacement_B_dy`` and so on; unit and long name stand in each
    column's metadata. A row group holds one block of instants.

    Parameters
    ----------
    response
        What to write.
    path
        The file; one of that name is replaced once the new one is complete.

    Raises
    ------
    InputError
        If pyarrow is missing, or the file cannot be written there.
    """
    arrow = needed("pyarrow", "parquet")
    tables = needed("pyarrow.parquet", "parquet")
    wanted = signals(response)
    columns = [("time", {"units": "s", "long_name": "time"})]
    columns += [(each.name, {"units": each.units, "long_name": each.long_name}) for each in wanted]
    schema = arrow.schema(
        [arrow.field(name, arrow.float64(), False, told) for name, told in columns]
    )
    with written_whole(path) as part, tables.ParquetWriter(part, schema) as file:
        for times, values in sampled_blocks(response, wanted):
            file.write_table(arrow.table([times, *values], schema=schema))
