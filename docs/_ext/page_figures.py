"""Run in the first cell of a page: plotly figures take plotly from it, not from the network."""

from typing import Any

import plotly.io as pio
from plotly.io.base_renderers import MimetypeRenderer


class Page(MimetypeRenderer):  # type: ignore[misc]  # plotly has no types
    """Figures as pieces of HTML, without plotly itself."""

    def to_mimebundle(self, figure: dict[str, Any]) -> dict[str, str]:
        """Return what a cell shows of a figure."""
        options = {"include_plotlyjs": False, "include_mathjax": False, "auto_play": False}
        return {"text/html": pio.to_html(figure, full_html=False, **options)}


pio.renderers["page"] = Page()
pio.renderers.default = "page"
