"""``bumpstop schema``."""

from __future__ import annotations

import json

from bumpstop.io.schema import case_schema

__all__ = ["schema_command"]


def schema_command() -> int:
    """Print the JSON schema of case files; return the status."""
    print(json.dumps(case_schema(), indent=2))
    return 0
