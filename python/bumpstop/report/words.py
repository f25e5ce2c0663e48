"""What a quantity is called in titles and tables."""

from __future__ import annotations

from bumpstop.post.references import IMPACT_COLUMNS
from bumpstop.quantities import ENERGIES, IMPACTS, QUANTITIES, STATISTICS, dof_units

__all__ = ["shown", "title_of", "unit_of"]

STRAIN = "strain"
"""Stands for the unit of strain, which has none, so that it is shown in microstrain."""


def title_of(target: tuple[str | int, ...]) -> str:
    """Return a title for a quantity and what it is that of.

    Parameters
    ----------
    target
        As `bumpstop.Response.sample` takes it, or the target of a reference.

    Examples
    --------
    >>> title_of(("displacement", "B", "dy")), title_of(("stop_force", "guide"))
    ('Displacement dy of B', 'Force of stop guide')
    >>> title_of(("impact_start", "guide", 2))
    'Instant of closing, impact 2 on guide'
    """
    quantity, *of = target
    match quantity:
        case "displacement" | "velocity" | "acceleration":
            return f"{quantity.capitalize()} {of[1]} of {of[0]}"
        case "stop_force":
            return f"Force of stop {of[0]}"
        case "friction_force":
            return f"Friction force of stop {of[0]}"
        case "gap":
            return f"Gap at stop {of[0]}"
        case "gauge":
            return f"Strain at gauge {of[0]}"
        case "frequency":
            return "Natural frequencies"
        case "energy":
            return _capitalised(ENERGIES[str(of[0])].long_name)
    name = str(quantity)
    if name in IMPACT_COLUMNS:
        return f"{_capitalised(IMPACTS[IMPACT_COLUMNS[name]].long_name)}, impact {of[1]} on {of[0]}"
    if name in STATISTICS:
        return f"{_capitalised(STATISTICS[name].long_name)} on {of[0]}"
    which = f" of mode {of[0]}" if of else ""
    return f"{_capitalised(QUANTITIES[name].long_name)}{which}"


def unit_of(quantity: str, dof: str | None = None) -> str:
    """Return the SI unit of a quantity as it is shown.

    Examples
    --------
    >>> unit_of("acceleration", "drz"), unit_of("gauge")
    ('rad/s²', 'strain')
    """
    if quantity == "gauge":
        return STRAIN
    return shown(dof_units(quantity, dof) if dof else QUANTITIES[quantity].units)


def shown(units: str) -> str:
    """Return a unit with raised exponents.

    >>> shown("m/s^2")
    'm/s²'
    """
    return units.replace("^2", "²").replace("^3", "³")


def _capitalised(text: str) -> str:
    return text[:1].upper() + text[1:]
