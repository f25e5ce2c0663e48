"""Pydantic's models of the tables, from which it makes their JSON schema."""

from __future__ import annotations

from functools import cache, reduce
from operator import or_
from typing import Annotated, Any, get_args, get_origin

from pydantic import BaseModel, ConfigDict, create_model
from pydantic import Field as ModelField

from bumpstop.io.case.tables.later import Later
from bumpstop.io.case.tables.table import Key, Kinds, Table, is_table, keys_of

__all__ = ["model_of"]


@cache
def model_of(table: type[Table]) -> type[BaseModel]:
    """Return the model of a table."""
    fields: dict[str, Any] = {
        name: (_annotation(key.annotation), _field(key)) for name, key in keys_of(table).items()
    }
    made: type[BaseModel] = create_model(
        table.__name__,
        __config__=ConfigDict(extra="forbid", json_schema_extra=table.rules()),
        __doc__=table.__doc__,
        __module__=table.__module__,
        **fields,
    )
    return made


def _field(key: Key) -> Any:
    if key.is_required:
        return ModelField(description=key.description)
    return ModelField(default=key.default, description=key.description)


def _annotation(annotation: Any) -> Any:
    """Return an annotation with models in place of tables."""
    if is_table(annotation):
        return model_of(annotation)
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        inner, mark = arguments
        if isinstance(mark, Later):
            return _annotation(mark.table)
        if isinstance(mark, Kinds):
            kinds = reduce(or_, map(_annotation, get_args(inner)))
            return Annotated[kinds, ModelField(discriminator=mark.tag)]
        return annotation
    if origin in (dict, list):
        return origin[tuple(map(_annotation, arguments))]
    if arguments and type(None) in arguments:
        return reduce(or_, map(_annotation, arguments))
    return annotation
