"""Directives ``case-file-keys`` and ``study-file-keys``: every key, from the JSON schema."""

from collections.abc import Callable, Iterator
from typing import Any, ClassVar

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from sphinx.util.typing import ExtensionMetadata

from bumpstop.io.schema import case_schema
from bumpstop.study.schema import study_schema

Schema = dict[str, Any]


class FileKeys(SphinxDirective):
    """One section a table of the file, with its keys."""

    schema: ClassVar[Callable[[], Schema]]

    def run(self) -> list[nodes.Node]:
        """Write the sections as Markdown and let the page's parser read them."""
        text = "\n".join(Reference(self.schema()).sections())
        return self.parse_text_to_nodes(text, allow_section_headings=True)


class CaseFileKeys(FileKeys):
    """Those of a case file."""

    schema = staticmethod(case_schema)


class StudyFileKeys(FileKeys):
    """Those of a study file."""

    schema = staticmethod(study_schema)


class Reference:
    """The schema as Markdown."""

    def __init__(self, schema: Schema) -> None:
        self.definitions = schema["$defs"]
        self.schema = schema
        self.described: set[str] = set()

    def sections(self) -> Iterator[str]:
        """Describe the keys at the top of the file, then each table."""
        fields = self.schema["properties"]
        plain = {key: field for key, field in fields.items() if not _holds_tables(field)}
        yield from _section("At the top", "", plain, self.schema)
        for key, field in fields.items():
            if key not in plain:
                yield from self._tables(key, field)

    def _tables(self, path: str, field: Schema) -> Iterator[str]:
        """Describe what stands under one key: a table, tables by name, or a list of tables."""
        title = f"[[{path}]]" if field.get("type") == "array" else f"[{path}]"
        named = _named(field)
        if named is not None and not _references(named):
            if field.get("description") not in self.described:
                self.described.add(field["description"])
                yield from _section(f"`{title}`", field["description"], {"NAME": named}, {})
            return
        if named is not None:
            path = f"{path}.NAME"
            title = f"[{path}]"
        for reference in _references(field):
            # A component has the tables of a structure, which were described at the top.
            if reference not in self.described:
                self.described.add(reference)
                table = self.definitions[reference.rpartition("/")[2]]
                yield from self._table(title, path, table)

    def _table(self, title: str, path: str, table: Schema) -> Iterator[str]:
        fields = table["properties"]
        kinds = [
            f'{key} = "{fields[key]["const"]}"' for key in _KIND if "const" in fields.get(key, {})
        ]
        heading = " with ".join(f"`{part}`" for part in (title, *kinds))
        plain = {key: field for key, field in fields.items() if not _holds_tables(field)}
        yield from _section(heading, table.get("description", ""), plain, table)
        for key, field in fields.items():
            if key not in plain:
                yield from self._tables(f"{path}.{key}", field)


_KIND = ("type", "shape")
"""Keys by which a table says of what kind it is."""


def _section(title: str, text: str, fields: dict[str, Schema], table: Schema) -> Iterator[str]:
    yield f"\n### {title}\n\n{text}\n"
    if fields:
        yield "| key | value | default | |\n|---|---|---|---|"
    for key, field in fields.items():
        default = "*required*" if key in table.get("required", ()) else _default(field)
        yield f"| `{key}` | {_value(field)} | {default} | {field.get('description', '')} |"


def _named(field: Schema) -> Schema | None:
    """Return what stands under the names of a table whose keys the user chooses."""
    patterns = list(field.get("patternProperties", {}).values())
    return patterns[0] if patterns else None


def _holds_tables(field: Schema) -> bool:
    return _named(field) is not None or bool(_references(field))


def _references(field: Schema) -> list[str]:
    """Return the names of the tables that a field holds, alone, by name or in a list."""
    inner = [field, *field.get("anyOf", []), *field.get("oneOf", []), field.get("items", {})]
    found = [part["$ref"] for part in inner if "$ref" in part]
    named = _named(field)
    return found + (_references(named) if named else [])


def _value(field: Schema) -> str:
    """Say in words what may be written."""
    if "enum" in field:
        return " or ".join(f'`"{word}"`' for word in field["enum"])
    if "const" in field:
        return f'`"{field["const"]}"`'
    if "anyOf" in field:
        kinds = [_value(kind) for kind in field["anyOf"] if kind.get("type") != "null"]
        return _with_examples(" or ".join(dict.fromkeys(kinds)), field)
    kind = field.get("type", "any")
    if "prefixItems" in field:
        return f"list: {', '.join(map(_value, field['prefixItems']))}"
    if kind == "array":
        count = field.get("minItems")
        some = f"{count} " if count and count == field.get("maxItems") else ""
        return f"list of {some}({_value(field.get('items', {}))})"
    if kind == "object":
        return "table"
    return _with_examples(" or ".join(kind) if isinstance(kind, list) else kind, field)


def _with_examples(text: str, field: Schema) -> str:
    """Add the examples that are strings: a number without a unit says nothing."""
    examples = [f'`"{text}"`' for text in field.get("examples", []) if isinstance(text, str)]
    return f"{text} such as {', '.join(examples)}" if examples else text


def _default(field: Schema) -> str:
    default = field.get("default")
    if default is None or default in ({}, [], ""):
        return ""
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    return f'`"{default}"`' if isinstance(default, str) else f"`{default}`"


def setup(app: Sphinx) -> ExtensionMetadata:
    """Register the directive."""
    app.add_directive("case-file-keys", CaseFileKeys)
    app.add_directive("study-file-keys", StudyFileKeys)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
