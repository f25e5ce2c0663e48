"""What all tables of a case file have in common: their keys are known, others are mistakes.

Tables are declared as pydantic's models are, and pydantic's core checks them (`check.py`). All of
pydantic is loaded for their JSON schema alone (`models.py`): to import it and to make models
takes longer than a small case to be simulated.
"""

from __future__ import annotations

from collections.abc import Iterator
from inspect import get_annotations
from typing import Any, NamedTuple, Self, dataclass_transform

__all__ = ["Field", "Key", "Kinds", "Table", "is_table", "keys_of", "written_keys"]

_NO_DEFAULT: Any = object()


class Key(NamedTuple):
    """A key of a table."""

    description: str
    default: Any
    annotation: Any = None

    @property
    def is_required(self) -> bool:
        """Whether the table must have it."""
        return self.default is _NO_DEFAULT


class Kinds(NamedTuple):
    """Annotates a union of tables: the key ``tag`` says which of them one is."""

    tag: str


def Field(*, description: str, default: Any = _NO_DEFAULT) -> Any:  # noqa: N802  # as in pydantic
    """Return what a key is assigned in the class of its table.

    Parameters
    ----------
    description
        What it means, in the words of the documentation.
    default
        Its value where it is left out; without one the table must have it.
    """
    return Key(description, default)


@dataclass_transform(kw_only_default=True, frozen_default=True, field_specifiers=(Field,))
class Table:
    """A table of the case file. Instances are made by `bumpstop.io.case.tables.check`."""

    # What the core writes into an instance; the values of the keys go into __dict__.
    __slots__ = (
        "__dict__",
        "__pydantic_extra__",
        "__pydantic_fields_set__",
        "__pydantic_private__",
    )

    def __iter__(self) -> Iterator[tuple[str, Any]]:
        """Yield keys and values."""
        yield from vars(self).items()

    def __eq__(self, other: object) -> bool:
        """Tell whether another table is of the same kind and says the same."""
        return type(other) is type(self) and vars(other) == vars(self)

    @classmethod
    def unchecked(cls, **values: Any) -> Self:
        """Return a table with values that are known to be good, of all its keys."""
        made = object.__new__(cls)
        vars(made).update(values)
        return made

    @classmethod
    def rules(cls) -> dict[str, Any]:
        """Return what the JSON schema of the table says beside its keys."""
        return {}

    def replaced(self, **values: Any) -> Self:
        """Return the same table with other values of some keys, which are not checked."""
        return self.unchecked(**(vars(self) | values))


def written_keys(table: Table) -> set[str]:
    """Return the keys that the file has, rather than their defaults."""
    written: set[str] = table.__pydantic_fields_set__  # type: ignore[attr-defined]  # by the core
    return written


def is_table(annotation: object) -> bool:
    """Tell whether an annotation is a table, and not how tables or values are put together."""
    return isinstance(annotation, type) and issubclass(annotation, Table)


def keys_of(table: type[Table]) -> dict[str, Key]:
    """Return the keys of a table, those of the tables that it extends first."""
    keys = {}
    for part in reversed(table.__mro__):
        for name, annotation in get_annotations(part).items():
            keys[name] = part.__dict__[name]._replace(annotation=annotation)
    return keys
