"""Warn of a public name that the API page does not describe, so that none is forgotten."""

from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util import logging
from sphinx.util.typing import ExtensionMetadata

import bumpstop

logger = logging.getLogger(__name__)


def check(app: Sphinx, env: BuildEnvironment) -> None:  # noqa: ARG001 - Sphinx calls with both
    """Compare ``bumpstop.__all__`` with what the pages describe."""
    described = {name.rpartition(".")[2] for name in env.domains.python_domain.objects}
    for name in bumpstop.__all__:
        if not name.startswith("_") and name not in described:
            logger.warning("bumpstop.%s is public but not described in docs/api.md", name)


def setup(app: Sphinx) -> ExtensionMetadata:
    """Check when all pages have been read."""
    app.connect("env-check-consistency", check)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
