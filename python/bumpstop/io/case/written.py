"""A case file's content as TOML again."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

__all__ = ["toml_text"]


def toml_text(document: Mapping[str, Any]) -> str:
    r"""Return what a TOML file holds as the text of one; numbers keep every bit.

    Parameters
    ----------
    document
        Tables, lists, texts, numbers and truth values, as `tomllib` reads them.

    Examples
    --------
    >>> print(toml_text({"title": "a", "stops": {"left": {"gap": 0.1, "normal": [1, 0]}}}), end="")
    title = "a"
    <BLANKLINE>
    [stops.left]
    gap = 0.1
    normal = [1, 0]
    """
    return "\n".join(_lines(document, ())).lstrip("\n") + "\n"


def _lines(table: Mapping[str, Any], above: tuple[str, ...]) -> Iterator[str]:
    """Yield a table: what it says itself, then the tables in it."""
    inner = {key: value for key, value in table.items() if isinstance(value, dict)}
    own = {key: value for key, value in table.items() if key not in inner}
    if above and (own or not inner):
        yield ""
        yield f"[{'.'.join(map(_key, above))}]"
    for key, value in own.items():
        yield f"{_key(key)} = {_value(value)}"
    for key, value in inner.items():
        yield from _lines(value, (*above, key))


def _key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _text(key)


def _value(value: Any) -> str:
    if isinstance(value, dict):
        pairs = ", ".join(f"{_key(key)} = {_value(item)}" for key, item in value.items())
        return f"{{ {pairs} }}" if pairs else "{}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return _text(value) if isinstance(value, str) else repr(value)


def _text(text: str) -> str:
    """Return a basic string; JSON's differ from TOML's by the delete character alone."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
