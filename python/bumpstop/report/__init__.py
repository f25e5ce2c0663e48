"""Pictures and pages of a response."""

from bumpstop.report.figures import as_plotly
from bumpstop.report.html import write_report

__all__ = ["as_plotly", "write_report"]
