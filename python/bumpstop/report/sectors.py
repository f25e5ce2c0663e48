"""What is told by the sectors of a circle, drawn around it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bumpstop.errors import InputError
from bumpstop.report.palette import LIGHT
from bumpstop.report.plotting import FONT
from bumpstop.report.scales import scale_for

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.report.figures import Figure

__all__ = ["sector_figure"]


def sector_figure(array: xr.DataArray) -> Figure:
    """Draw an array over angles, such as the work rate by sector, around its circle."""
    dims = getattr(array, "dims", type(array).__name__)
    if dims != ("angle",):
        hint = "take what work_by_sector gives"
        raise InputError("must be an array over angle", key="array", value=dims, hint=hint)
    values = np.asarray(array.values, dtype=float)
    scale = scale_for(str(array.attrs["units"]), values)
    degrees = np.degrees(array["angle"].values)
    title = str(array.attrs.get("title", array.attrs["long_name"]))
    title = title[:1].upper() + title[1:]
    bars = {
        "type": "barpolar",
        "r": values * scale.factor,
        "theta": degrees,
        "width": np.full(len(values), 360.0 / len(values)),
        "marker": {"color": LIGHT["computed"], "line": {"color": LIGHT["paper"], "width": 1}},
        "hovertemplate": f"%{{r:.4~g}} {scale.unit}<br>at %{{theta:.4~g}}°<extra></extra>",
    }
    axis = {"gridcolor": LIGHT["grid"], "linecolor": LIGHT["axis"]}
    where = str(array["angle"].attrs.get("long_name", ""))
    layout = {
        "title": {
            "text": f"{title} ({scale.unit})",
            "x": 0.0,
            "xref": "paper",
            "subtitle": {
                "text": where[:1].upper() + where[1:],
                "font": {"color": LIGHT["muted"]},
            },
        },
        "font": {"family": FONT, "size": 13, "color": LIGHT["ink"]},
        "paper_bgcolor": LIGHT["paper"],
        "showlegend": False,
        "margin": {"l": 40, "r": 40, "t": 84, "b": 40},
        "polar": {
            "bgcolor": LIGHT["paper"],
            "radialaxis": axis | {"rangemode": "tozero", "nticks": 5},
            "angularaxis": axis | {"rotation": 0, "direction": "counterclockwise"},
        },
    }
    return {"data": [bars], "layout": layout}
