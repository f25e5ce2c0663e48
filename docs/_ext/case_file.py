"""Directive ``case-file-keys``: every key of a case file, from the JSON schema."""

from collections.abc import Iterator
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from sphinx.util.typing import ExtensionMetadata

from bumpstop.io.schema import case_schema

Schema = dict[str, Any]


class CaseFileKeys(SphinxDirective):
    """One section a table of the case file, with its keys."""

    def run(self) -> list[nodes.Node]:
        """Write the sections as Markdown and let the page's parser read them."""
        text = "\n".join(Reference(case_schema()).sections())
        return self.parse_text_to_nodes(text, allow_section_headings=True)


class Reference:
    """The schema as Markdown."""

    def __init__(self, schema: Schema) -> None:
        self.schema = schema

    def sections(self) -> Iterator[str]:
        """Describe the keys at the top of the file, then each table."""
        top = {key: field for key, field in self._fields(self.schema) if not self._table(field)}
        yield from self._section("At the top", "", top, self.schema)
        for key, field in self._fields(self.schema):
            if key not in top:
                yield from self._table_section(key, field)

    def _table_section(self, path: str, field: Schema) -> Iterator[str]:
        table = self._table(field)
        assert table is not None
        named, listed = "additionalProperties" in field, field.get("type") == "array"
        path = f"{path}.NAME" if named else path
        title = f"`[[{path}]]`" if listed else f"`[{path}]`"
        fields = dict(self._fields(table))
        inner = {key: field for key, field in fields.items() if self._table(field)}
        plain = {key: field for key, field in fields.items() if key not in inner}
        yield from self._section(title, table.get("description", ""), plain, table)
        for key, field in inner.items():
            yield from self._table_section(f"{path}.{key}", field)

    def _section(
        self, title: str, text: str, fields: dict[str, Schema], table: Schema
    ) -> Iterator[str]:
        yield f"\n### {title}\n\n{text}\n"
        if fields:
            yield "| key | value | default | |\n|---|---|---|---|"
        for key, field in fields.items():
            default = "*required*" if key in table.get("required", ()) else _default(field)
            yield f"| `{key}` | {self._value(field)} | {default} | {field.get('description', '')} |"

    def _fields(self, table: Schema) -> Iterator[tuple[str, Schema]]:
        yield from table.get("properties", {}).items()

    def _table(self, field: Schema) -> Schema | None:
        """Return the table that a field holds, alone, by name or in a list; None for a value."""
        for inner in [field, *field.get("anyOf", []), field.get("items"), _values(field)]:
            if isinstance(inner, dict) and "$ref" in inner:
                found: Schema = self.schema["$defs"][inner["$ref"].rpartition("/")[2]]
                return found if "properties" in found else None
        return None

    def _value(self, field: Schema) -> str:
        if "enum" in field:
            return " or ".join(f'`"{word}"`' for word in field["enum"])
        if "const" in field:
            return f'`"{field["const"]}"`'
        if "anyOf" in field:
            kinds = [self._value(kind) for kind in field["anyOf"] if kind.get("type") != "null"]
            return _with_example(" or ".join(dict.fromkeys(kinds)), field)
        if field.get("type") == "array":
            length = field.get("minItems")
            count = f"{length} " if length == field.get("maxItems") and length else ""
            return f"list of {count}({self._value(field.get('items', {}))})"
        if field.get("type") == "object":
            return "table"
        kind = field.get("type", "any")
        return _with_example(" or ".join(kind) if isinstance(kind, list) else kind, field)


def _values(field: Schema) -> Schema | None:
    values = field.get("additionalProperties")
    return values if isinstance(values, dict) else None


def _with_example(text: str, field: Schema) -> str:
    examples = ", ".join(f'`"{example}"`' for example in field.get("examples", []))
    return f"{text}, such as {examples}" if examples else text


def _default(field: Schema) -> str:
    default = field.get("default")
    if default is None or default in ({}, [], ""):
        return "none"
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    return f'`"{default}"`' if isinstance(default, str) else f"`{default}`"


def setup(app: Sphinx) -> ExtensionMetadata:
    """Register the directive."""
    app.add_directive("case-file-keys", CaseFileKeys)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
