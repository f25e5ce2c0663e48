"""Fields that a plain function checks, so that their errors are in our own words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pydantic_core.core_schema import no_info_plain_validator_function

from bumpstop.errors import InputError

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic_core import CoreSchema

__all__ = ["Plain", "read_list"]


@dataclass(frozen=True, slots=True, eq=False)
class Plain:
    """Annotates a field that ``read`` validates and ``schema`` describes to editors.

    Parameters
    ----------
    read
        Returns the clean value or raises InputError. The error's key is empty where the value
        itself is wrong, and the way down to the mistake where the value is a list.
    schema
        JSON schema of what users may write.
    """

    read: Callable[[Any], Any]
    schema: dict[str, Any]

    def __get_pydantic_core_schema__(
        self, _source: object, _handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Let pydantic call ``read`` and nothing else."""
        return no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, _core: CoreSchema, _handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Hand over the JSON schema as it was given."""
        return dict(self.schema)


def read_list(
    value: object, read: Callable[[Any], Any], things: str, length: int | None = None
) -> list[Any]:
    """Return a list whose items were all read; an error's key is the item's index.

    Raises
    ------
    InputError
        If it is not a list, is empty, has another length than asked for, or an item is wrong.
    """
    if not isinstance(value, list) or not value or (length and len(value) != length):
        wanted = things if length is None else f"{length} {things}"
        raise InputError(f"must be a list of {wanted}", value=value)
    return [_read_item(index, item, read) for index, item in enumerate(value)]


def _read_item(index: int, item: object, read: Callable[[Any], Any]) -> object:
    try:
        return read(item)
    except InputError as error:
        raise error.located(key=str(index)) from error
