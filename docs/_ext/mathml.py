"""Show mathematics as MathML: no script, no download, readable offline.

docutils converts the LaTeX; every current browser draws the result.
"""

import re

from docutils import nodes
from docutils.utils.math import latex2mathml
from sphinx.application import Sphinx
from sphinx.util.typing import ExtensionMetadata
from sphinx.writers.html5 import HTML5Translator

# What docutils reads otherwise than LaTeX does, and how to say it so that both agree:
REWRITTEN = [
    # \frac12 is one half.
    (re.compile(r"\\([td]?frac)\s*(\d)\s*(\d)"), r"\\\1{\2}{\3}"),
    (re.compile(r"\\([td]?frac)\s*(\d)"), r"\\\1{\2}"),
    # docutils would draw the accent of a bold symbol over what follows.
    (re.compile(r"\\boldsymbol\s*(\\[A-Za-z]+)"), r"\\mathbf{\1}"),
    # An index of an accented letter stands beside it, not below.
    (re.compile(r"(\\(?:d?dot|hat|tilde|bar)\s*(?:\{[^{}]*\}|\\?[A-Za-z]+))(?=[_^])"), r"\1{}"),
]


def to_mathml(latex: str, as_block: bool = False) -> str:
    """Return a formula as MathML."""
    for pattern, replacement in REWRITTEN:
        latex = pattern.sub(replacement, latex)
    mathml: str = latex2mathml.tex2mathml(latex, as_block=as_block)
    return mathml


def visit_inline(translator: HTML5Translator, node: nodes.math) -> None:
    """Write a formula in running text."""
    translator.body.append(to_mathml(node.astext()))
    raise nodes.SkipNode


def visit_display(translator: HTML5Translator, node: nodes.math_block) -> None:
    """Write a displayed formula, with its number where it has a label."""
    translator.body.append(translator.starttag(node, "div", CLASS="math"))
    if number := node.get("number"):
        translator.body.append(f'<span class="eqno">({number})</span>')
    # amsmath blocks bring an outer environment that only matters to a LaTeX document.
    source = node.astext().replace("{align*}", "{aligned}").replace("{equation*}", "{aligned}")
    translator.body.append(to_mathml(source, as_block=True))
    translator.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> ExtensionMetadata:
    """Register the renderer as ``html_math_renderer = "mathml"``."""
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
