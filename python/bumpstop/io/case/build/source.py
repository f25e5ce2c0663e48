"""What the modes of a case come from: one source, and only what goes with it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from bumpstop.errors import InputError
from bumpstop.io.case.tables.structure import StructureTables
from bumpstop.io.case.tables.table import keys_of

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile

__all__ = ["SOURCES", "require_one_source"]

_BESIDE = {
    "nodes": (*keys_of(StructureTables), "basis"),
    "mesh": (*(table for table in keys_of(StructureTables) if table != "nodes"), "basis"),
    "matrices": ("supports", "basis"),
    "modes": ("basis",),
    "parts": ("components", "materials", "sections", "supports", "joints", "basis"),
}
"""Which tables go with a source."""

SOURCES = tuple(_BESIDE)
"""What modes can come from."""


def require_one_source(case: CaseFile, tables: Sequence[str]) -> None:
    """Raise unless the case has one source of modes, and no table that it has no use for.

    Parameters
    ----------
    case
        The case.
    tables
        All tables that modes can be made of.

    Raises
    ------
    InputError
        If there is no source, or more than one, or a table beside it that does not go with it.
    """
    sources = [source for source in _BESIDE if getattr(case, source)]
    if not sources:
        hint = "name points there, place [parts], or take a [mesh], [matrices] or [modes]"
        raise InputError("is missing", key="nodes", hint=hint)
    if len(sources) > 1:
        names = " and ".join(f"[{source}]" for source in sources)
        raise InputError(f"{names} exclude each other", key=sources[1], hint="keep one of them")
    source = sources[0]
    for table in tables:
        if table not in (source, *_BESIDE[source]) and getattr(case, table):
            raise InputError(f"does not go with [{source}]", key=table, hint="leave it out")
