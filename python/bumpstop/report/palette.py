"""The report's colours: Okabe and Ito's set, which colour-blind readers can tell apart.

Each role has one colour for light paper and one for dark screens. Figures are made with the
light ones; the page swaps them for the dark ones by looking them up here, so roles that share
a light colour share the dark one.

Source: M. Okabe, K. Ito, "Color Universal Design", 2008.
"""

from __future__ import annotations

__all__ = ["DARK", "LIGHT", "style_rules"]

LIGHT = {
    "computed": "#0072b2",
    "published": "#1c2126",
    "contact": "#d55e00",
    "kinetic": "#56b4e9",
    "elastic": "#0072b2",
    "stored": "#e69f00",
    "damping": "#cc79a7",
    "stops": "#009e73",
    "total": "#1c2126",
    "ink": "#1c2126",
    "muted": "#59636e",
    "grid": "#e4e7eb",
    "axis": "#aab2bb",
    "paper": "#ffffff",
}

DARK = {
    "computed": "#5ab4ec",
    "published": "#e6e9ed",
    "contact": "#ff8a45",
    "kinetic": "#2b628a",
    "elastic": "#5ab4ec",
    "stored": "#dd9d1f",
    "damping": "#cf8bb3",
    "stops": "#35b98d",
    "total": "#e6e9ed",
    "ink": "#e6e9ed",
    "muted": "#9aa5b1",
    "grid": "#2b323a",
    "axis": "#5c6773",
    "paper": "#14181c",
}


def style_rules() -> str:
    """Return the style sheet that offers every role as a CSS variable.

    Print always gets the light colours, whatever the screen shows.

    Examples
    --------
    >>> "--computed: #0072b2;" in style_rules()
    True
    """
    return (
        f":root {{ {_variables(LIGHT)} }}\n"
        f"@media screen and (prefers-color-scheme: dark) {{ :root {{ {_variables(DARK)} }} }}\n"
    )


def _variables(theme: dict[str, str]) -> str:
    return " ".join(f"--{role}: {colour};" for role, colour in theme.items())
