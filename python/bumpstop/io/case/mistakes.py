"""From what pydantic finds wrong to one line that a user can act on."""

from __future__ import annotations

from collections.abc import Sequence
from types import UnionType
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, Union, get_args, get_origin

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io.case.keys import KeyPath, dotted
from bumpstop.io.case.tables.check import kind_words
from bumpstop.io.case.tables.later import Later
from bumpstop.io.case.tables.table import Table, keys_of

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails, ValidationError

__all__ = ["first_mistake"]


def first_mistake(error: ValidationError, model: type[Table]) -> InputError:
    """Return the first thing that is wrong, and say how many more there are.

    Keys that the file should not have come first and those that it lacks last: a misspelt
    key is both.

    Parameters
    ----------
    error
        What pydantic found.
    model
        The table that it checked.
    """
    details = sorted(error.errors(include_url=False), key=_rank)
    mistakes = [_translated(detail, model) for detail in details]
    return _with_count(mistakes[0], len(_not_explained(mistakes)) - 1)


def _rank(detail: ErrorDetails) -> int:
    return {"extra_forbidden": 0, "missing": 2}.get(detail["type"], 1)


def _not_explained(mistakes: Sequence[InputError]) -> list[InputError]:
    """Leave out missing keys that an unknown one is a misspelling of."""
    hints = {mistake.hint for mistake in mistakes}
    return [
        mistake
        for mistake in mistakes
        if mistake.what != _MISSING or did_you_mean(_last(mistake), [_last(mistake)]) not in hints
    ]


def _last(mistake: InputError) -> str:
    return (mistake.key or "").rpartition(".")[2]


def _with_count(mistake: InputError, more: int) -> InputError:
    if more < 1:
        return mistake
    count = f"and {more} more mistake{'s' if more > 1 else ''}"
    return InputError(
        mistake.what,
        key=mistake.key,
        value=mistake.value,
        hint=f"{mistake.hint} ({count})" if mistake.hint else count,
    )


_MISSING = "is missing"


def _translated(detail: ErrorDetails, model: type[Table]) -> InputError:
    place = _place(detail["loc"], model)
    kind, value, context = detail["type"], detail["input"], detail.get("ctx", {})
    key = dotted(place.path)
    if kind == "value_error":
        return _of_field(context["error"], key)
    if kind == "missing":
        return InputError(_MISSING, key=key, hint=place.description)
    if kind == "extra_forbidden":
        hint = did_you_mean(place.path[-1], place.siblings)
        return InputError("unknown key", key=key, value=value, hint=hint)
    if kind in ("union_tag_not_found", "union_tag_invalid"):
        return _wrong_tag(key, value, context, _kinds(place.annotation))
    if kind == "list_type":
        hint = f"begin each with [[{key}]]"
        return InputError("must be a list of tables", key=key, value=value, hint=hint)
    return InputError("must be a table", key=key, value=value, hint=f"begin it with [{key}]")


def _of_field(error: object, key: str) -> InputError:
    """Return a field's own error, with the field's place before the way down in it."""
    if not isinstance(error, InputError):
        return InputError(str(error), key=key)
    inner = f"{key}.{error.key}" if error.key else key
    return InputError(error.what, key=inner, value=error.value, hint=error.hint)


def _wrong_tag(
    key: str, value: object, context: dict[str, Any], known: Sequence[str]
) -> InputError:
    tag = context["discriminator"].strip("'")
    if not isinstance(value, dict):
        return InputError("must be a table", key=key, value=value, hint=f"begin it with [{key}]")
    for wrong in value:
        hint = did_you_mean(wrong, [tag])
        if tag not in value and hint.startswith("did you mean"):
            return InputError("unknown key", key=f"{key}.{wrong}", value=value[wrong], hint=hint)
    if tag not in value:
        return InputError(_MISSING, key=f"{key}.{tag}", hint=f"known: {', '.join(known)}")
    hint = did_you_mean(value[tag], known)
    return InputError("is not a known kind", key=f"{key}.{tag}", value=value[tag], hint=hint)


class _Place(NamedTuple):
    """Where a mistake is: its path in the file, and what the models say of that place."""

    path: KeyPath
    siblings: list[str]
    description: str | None
    annotation: Any


def _place(location: KeyPath, model: type[Table]) -> _Place:
    path: list[str | int] = []
    annotation: Any = model
    siblings: list[str] = []
    description = None
    for part in location:
        if part == "[key]":  # pydantic's way of saying that the name itself is wrong
            break
        annotation = _bare(annotation)
        if _is_union(annotation):
            # pydantic puts the kind of a load into the location; it is no key of the file.
            annotation = _member(annotation, part)
            continue
        path.append(part)
        if isinstance(annotation, type) and issubclass(annotation, Table):
            keys = keys_of(annotation)
            siblings = list(keys)
            key = keys.get(str(part))
            description = key.description if key else None
            annotation = key.annotation if key else None
        else:
            annotation = get_args(annotation)[-1] if get_args(annotation) else None
    return _Place(tuple(path), siblings, description, annotation)


def _bare(annotation: Any) -> Any:
    """Return a type without its metadata and without None."""
    if get_origin(annotation) is Annotated:
        bare, *metadata = get_args(annotation)
        return next((_bare(given.table) for given in metadata if isinstance(given, Later)), bare)
    if _is_union(annotation):
        members = [member for member in get_args(annotation) if member is not type(None)]
        return _bare(members[0]) if len(members) == 1 else annotation
    return annotation


def _is_union(annotation: Any) -> bool:
    return get_origin(annotation) in (Union, UnionType)


def _kinds(annotation: Any) -> list[str]:
    """Return the words by which the tables of a tagged union say their kind."""
    members = get_args(_bare(annotation))
    return [word for member in members for word in kind_words(_bare(member))]


def _member(union: Any, tag: str | int) -> Any:
    """Return the member of a tagged union that is of the kind of the tag."""
    members = (_bare(member) for member in get_args(union))
    return next(member for member in members if tag in kind_words(member))
