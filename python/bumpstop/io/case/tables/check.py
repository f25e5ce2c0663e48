"""What pydantic's core needs to check tables: a schema of each annotation."""

from __future__ import annotations

from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin

from pydantic_core import SchemaValidator, core_schema
from pydantic_core.core_schema import CoreSchema

from bumpstop.io.case.fields.plain import Plain
from bumpstop.io.case.tables.later import Later
from bumpstop.io.case.tables.table import Key, Kinds, Table, is_table, keys_of

__all__ = ["checked", "kind_words"]

T = TypeVar("T", bound=Table)

_STRICT = core_schema.CoreConfig(strict=True, extra_fields_behavior="forbid")


def checked(table: type[T], content: object) -> T:
    """Return a table made of what a file holds.

    Raises
    ------
    ValidationError
        If something in it is wrong.
    """
    annotation: Any = table  # to mypy, a class of tables has no hash to cache by
    made: T = _validator(annotation).validate_python(content)
    return made


@cache
def _validator(annotation: Any) -> SchemaValidator:
    return SchemaValidator(_schema(annotation), _STRICT)


def _schema(annotation: Any) -> CoreSchema:
    if is_table(annotation):
        return _schema_of_table(annotation)
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _schema_of_annotated(*arguments)
    if origin in (Union, UnionType):
        (member,) = (member for member in arguments if member is not NoneType)
        return core_schema.nullable_schema(_schema(member))
    if origin is dict:
        return core_schema.dict_schema(*map(_schema, arguments))
    if origin is list:
        return core_schema.list_schema(*map(_schema, arguments))
    if origin is Literal:
        return core_schema.literal_schema(list(arguments))
    return {str: core_schema.str_schema(), Any: core_schema.any_schema()}[annotation]


def _schema_of_table(table: type[Table]) -> CoreSchema:
    fields = {
        name: core_schema.model_field(_schema_of_key(key)) for name, key in keys_of(table).items()
    }
    inner = core_schema.model_fields_schema(fields)
    return core_schema.model_schema(table, inner, config=_STRICT)


def _schema_of_key(key: Key) -> CoreSchema:
    schema = _schema(key.annotation)
    if key.is_required:
        return schema
    return core_schema.with_default_schema(schema, default=key.default)


def _schema_of_annotated(annotation: Any, mark: Plain | Later | Kinds) -> CoreSchema:
    if isinstance(mark, Plain):
        return core_schema.no_info_plain_validator_function(mark.read)
    if isinstance(mark, Later):
        # The core puts the mistakes that it finds in there among those of the whole.
        return core_schema.no_info_plain_validator_function(
            lambda value: _validator(mark.table).validate_python(value)
        )
    choices = {
        word: _schema(member) for member in get_args(annotation) for word in kind_words(member)
    }
    return core_schema.tagged_union_schema(choices, discriminator=mark.tag)


def kind_words(table: type[Table]) -> tuple[Any, ...]:
    """Return the words by which a table says its kind: in the key that is a Literal."""
    annotations = (key.annotation for key in keys_of(table).values())
    return get_args(next(each for each in annotations if get_origin(each) is Literal))
