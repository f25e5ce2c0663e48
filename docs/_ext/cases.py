"""Make one page of each validation case from its README and its case file."""

import re
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util.typing import ExtensionMetadata

CASES = Path(__file__).parents[2] / "cases"
LOCAL_LINK = re.compile(r"\]\((?![a-z]+:|#)")


def write_pages(app: Sphinx) -> None:
    """Write ``validation/NAME.md`` for every folder of ``cases`` that has a case file."""
    pages = Path(app.srcdir) / "validation"
    pages.mkdir(exist_ok=True)
    wanted = {case.parent.name: page(case.parent) for case in sorted(CASES.glob("*/case.toml"))}
    for stale in pages.glob("*.md"):
        if stale.stem not in wanted:
            stale.unlink()
    for name, text in wanted.items():
        target = pages / f"{name}.md"
        if not target.exists() or target.read_text(encoding="utf-8") != text:
            target.write_text(text, encoding="utf-8")


def page(folder: Path) -> str:
    """Return the README with its links seen from the documentation, and the case file below."""
    here = f"../../cases/{folder.name}"
    readme = (folder / "README.md").read_text(encoding="utf-8")
    return (
        f"{LOCAL_LINK.sub(f']({here}/', readme).rstrip()}\n\n"
        "## The case file\n\n"
        f"```{{literalinclude}} {here}/case.toml\n:language: toml\n```\n"
    )


def setup(app: Sphinx) -> ExtensionMetadata:
    """Write the pages before Sphinx looks for documents."""
    app.connect("builder-inited", write_pages)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
