"""Pictures and pages of a response.

Names are imported when they are first used: the command line takes the words of this package
for its tables, and need not load what draws.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bumpstop.report.figures import as_plotly
    from bumpstop.report.html import write_report

__all__ = ["as_plotly", "write_report"]


def __getattr__(name: str) -> object:
    if name == "as_plotly":
        from bumpstop.report.figures import as_plotly

        return as_plotly
    if name == "write_report":
        from bumpstop.report.html import write_report

        return write_report
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
