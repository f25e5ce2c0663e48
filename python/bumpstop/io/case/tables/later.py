"""Tables that are loaded when a case has them."""

from __future__ import annotations

from importlib import import_module
from typing import Annotated, Any, NamedTuple

__all__ = ["Later", "later"]


class Later(NamedTuple):
    """Stands for a table, or for the kinds of it, until one is read."""

    module: str
    """The module of the tables that it is in."""
    name: str

    @property
    def table(self) -> Any:
        """The table itself."""
        return getattr(import_module(f"bumpstop.io.case.tables.{self.module}"), self.name)


def later(module: str, name: str) -> Any:
    """Return what annotates a key in place of a table; type checkers see the table itself."""
    return Annotated[Any, Later(module, name)]
