"""How Sphinx builds the documentation; its own small extensions are in ``_ext``."""

import logging
import os
import re
import sys
from pathlib import Path

import plotly
from sphinx.application import Sphinx

import bumpstop

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_ext"))

# The pages that run `bumpstop` must find the one that belongs to this Python.
os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
os.environ["COLUMNS"] = "88"
os.environ["NO_COLOR"] = "1"
os.environ["MATPLOTLIBRC"] = str(HERE / "matplotlibrc")

# The kernels that run the examples draw in SVG and report errors only.
profile = HERE / "_build" / "ipython" / "profile_default"
profile.mkdir(parents=True, exist_ok=True)
(profile / "ipython_kernel_config.py").write_text(
    'c.InlineBackend.figure_formats = {"svg"}\nc.IPKernelApp.log_level = "ERROR"\n'
)
os.environ["IPYTHONDIR"] = str(profile.parent)
logging.getLogger("traitlets").setLevel(logging.WARNING)

project = "bumpstop"
author = "The bumpstop developers"
project_copyright = f"2026, {author}"
release = version = bumpstop.__version__

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "myst_nb",
    "mathml",
    "cases",
    "case_file",
    "public_names",
]
exclude_patterns = ["_build", "_ext"]

html_theme = "furo"
html_title = "bumpstop"
# The drawings of the pages are those of the package, and work without a network.
html_static_path = ["_static", str(Path(plotly.__file__).parent / "package_data" / "plotly.min.js")]
html_css_files = ["bumpstop.css"]
html_math_renderer = "mathml"
html_copy_source = False
html_show_sourcelink = False

myst_enable_extensions = ["dollarmath", "amsmath", "deflist"]
myst_heading_anchors = 3

# Examples run anew at every build: what a page shows is what this version computes.
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 120
nb_execution_show_tb = True
nb_merge_streams = True

napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_attr_annotations = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_type_aliases = {
    name: name for name in ("ArrayLike", "FloatArray", "IndexArray", "Table", "Vector")
}
ALIAS = re.compile(r"TypeAliasForwardRef\('(\w+)'\)")
python_maximum_signature_line_length = 88
python_use_unqualified_type_names = True


def setup(app: Sphinx) -> None:
    """Let signatures show the names of type aliases also where they are nested."""
    app.connect("autodoc-process-signature", show_alias_names)


def show_alias_names(
    _app: Sphinx,
    _what: str,
    _name: str,
    _object: object,
    _options: object,
    signature: str | None,
    returns: str | None,
) -> tuple[str | None, str | None]:
    """Take away the wrapper that autodoc leaves around an alias within another type."""
    plain = [text and ALIAS.sub(r"\1", text) for text in (signature, returns)]
    return plain[0], plain[1]
