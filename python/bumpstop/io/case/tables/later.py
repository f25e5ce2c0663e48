"""Tables that are loaded when a case has them: making one takes longer than reading it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from typing import TYPE_CHECKING, Annotated, Any

from pydantic_core.core_schema import definitions_schema, no_info_plain_validator_function

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, TypeAdapter
    from pydantic_core import CoreSchema

__all__ = ["Later", "later"]


@dataclass(frozen=True, eq=False)
class Later:
    """Stands for a table, or for the kinds of it, until one is read.

    Parameters
    ----------
    module
        The module of the tables that it is in.
    name
        Its name there.
    """

    module: str
    name: str

    @property
    def table(self) -> Any:
        """The table itself."""
        return getattr(import_module(f"bumpstop.io.case.tables.{self.module}"), self.name)

    @cached_property
    def _adapter(self) -> TypeAdapter[Any]:
        from pydantic import TypeAdapter

        return TypeAdapter(self.table)

    def read(self, value: object) -> Any:
        """Return what the table makes of a value; pydantic puts its mistakes among the others."""
        return self._adapter.validate_python(value)

    def __get_pydantic_core_schema__(
        self, _source: object, _handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Let pydantic call ``read`` where it finds the table."""
        return no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, _core: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Refer to the description of the table itself."""
        # A schema with definitions, of which it has none: pydantic describes what such a one
        # holds among the definitions of the whole file.
        return handler(definitions_schema(self._adapter.core_schema, []))


def later(module: str, name: str) -> Any:
    """Return what annotates a field in place of a table; type checkers see the table itself."""
    return Annotated[Any, Later(module, name)]
