"""Pictures and pages of a response.

Names are imported when they are first used: the command line takes the words of this package
for its tables, and need not load what draws.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.lazy import lazy_names

if TYPE_CHECKING:
    from bumpstop.report.figures import as_plotly
    from bumpstop.report.html import write_comparison, write_modes, write_report, write_study

__all__ = ["as_plotly", "write_comparison", "write_modes", "write_report", "write_study"]

__getattr__ = lazy_names(
    __name__,
    {
        "as_plotly": "figures",
        "write_comparison": "html",
        "write_modes": "html",
        "write_report": "html",
        "write_study": "html",
    },
)
