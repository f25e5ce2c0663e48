"""What can be read from a response: names, units and words for axes and files."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from bumpstop.structure.dofs import DOFS

__all__ = [
    "COUNTED_IMPACTS",
    "ENERGIES",
    "FREQUENCY",
    "IMPACTS",
    "INTERNAL_VARIABLES",
    "MOST_BLOCKS",
    "MOST_CLASSES",
    "QUANTITIES",
    "STATE",
    "STATISTICS",
    "STOP_ENERGIES",
    "Quantity",
    "dof_units",
    "modal_attributes",
    "plain_name",
    "plain_names",
]


class Quantity(NamedTuple):
    """What a quantity is.

    Its unit, written so that both UDUNITS and pint read it; its name in words; what it is
    the quantity of.
    """

    units: str
    long_name: str
    target: tuple[str, ...] = ()

    @property
    def attributes(self) -> dict[str, str]:
        """Unit and long name, as attributes of an array or of a variable in a file."""
        return {"units": self.units, "long_name": self.long_name}


QUANTITIES = {
    "displacement": Quantity("m", "displacement", ("node", "dof")),
    "velocity": Quantity("m/s", "velocity", ("node", "dof")),
    "acceleration": Quantity("m/s^2", "acceleration", ("node", "dof")),
    # Modes have unit modal mass. UDUNITS knows no square roots; there is no truer unit.
    "modal_displacement": Quantity("kg^0.5 m", "modal displacement", ("mode",)),
    "modal_velocity": Quantity("kg^0.5 m/s", "modal velocity", ("mode",)),
    "modal_acceleration": Quantity("kg^0.5 m/s^2", "modal acceleration", ("mode",)),
    "stop_force": Quantity("N", "force of the stop on the structure along its normal", ("stop",)),
    "friction_force": Quantity(
        "N", "force of the stop on the structure along its sliding direction", ("stop",)
    ),
    "gap": Quantity("m", "distance to the stop, negative while it is pressed", ("stop",)),
    "gauge": Quantity("1", "axial strain", ("gauge",)),
}
"""Quantities that are functions of time."""

STATE = Quantity("1", "state of the law", ("stop",))
"""What a law does at an instant, in a word: a function of time, but no number."""

INTERNAL_VARIABLES = {
    "anchor": Quantity("m", "where the slider of the friction stands along its direction"),
    "stretch_around": Quantity("m", "stretch of what rubs, around the obstacle or along its plane"),
    "stretch_axial": Quantity("m", "stretch of what rubs, along the axis of the obstacle"),
    "plastic_elongation": Quantity("m", "plastic elongation"),
    "plastic_path": Quantity("m", "plastic elongation summed up, back and forth"),
    "largest_crushing": Quantity("m", "largest crushing since the stop has buckled"),
    "residual_crushing": Quantity("m", "crushing that is left without force"),
    "dashpot_elongation": Quantity("m", "elongation of the dashpot"),
    "bending_direction": Quantity("rad", "direction in which the crack is bent, in the shaft"),
    "memory": Quantity("1", "memory of the law"),
}
"""What laws remember, beside the state that they are in: functions of time.

A law says which it has by its ``internal_variables``, at most two, in the order of the core's.
"""

FREQUENCY = Quantity("Hz", "natural frequency")
"""A property of each mode."""

ENERGIES = {
    "kinetic": Quantity("J", "kinetic energy"),
    "elastic": Quantity("J", "elastic energy of the linear structure"),
    "stored": Quantity("J", "energy stored in the stops"),
    "dissipated_damping": Quantity("J", "energy dissipated by modal damping"),
    "dissipated_stops": Quantity("J", "energy dissipated by the stops"),
    "load_work": Quantity("J", "work of the loads"),
    "circulatory_work": Quantity("J", "work of circulatory forces"),
    "obstacle_work": Quantity("J", "work of obstacles that move"),
    "total": Quantity("J", "kinetic, elastic, stored and dissipated energy together"),
    "total_initial": Quantity("J", "kinetic, elastic and stored energy at t = 0"),
    "residual": Quantity("J", "total less its initial value and the work put in"),
}
"""Terms of the energy ledger, functions of time."""

STOP_ENERGIES = {
    "stored_in_stop": Quantity("J", "energy stored in each stop"),
    "dissipated_in_stop": Quantity("J", "energy dissipated by each stop"),
}
"""What each stop has of the ledger, functions of time."""

IMPACTS = {
    "start": Quantity("s", "instant of closing"),
    "end": Quantity("s", "instant of opening"),
    "duration": Quantity("s", "time closed"),
    "closing_speed": Quantity("m/s", "speed towards the stop at closing"),
    "opening_speed": Quantity("m/s", "speed away from the stop at opening"),
    "peak_force": Quantity("N", "largest force"),
    "impulse": Quantity("N s", "integral of the force over the contact"),
    "energy_returned": Quantity("J", "work of the stop on the structure while it pushes it off"),
    "peak_time": Quantity("s", "instant of the largest force"),
}
"""Columns of the impact table beside the stop's name."""

COUNTED_IMPACTS = {
    "start": Quantity("s", "instant at which the force exceeds the threshold"),
    "end": Quantity("s", "instant from which on the force stays below it"),
    "duration": Quantity("s", "from start to end, pauses between rebounds included"),
    "contact_time": Quantity("s", "time loaded"),
    "rebounds": Quantity("1", "returns within the rest time"),
    "closing_speed": Quantity("m/s", "speed towards the stop at the start"),
    "peak_time": Quantity("s", "instant of the largest force"),
    "peak_force": Quantity("N", "largest force"),
    "impulse": Quantity("N s", "integral of the force while it exceeds the threshold"),
}
"""Columns of impacts as statistics count them, above a threshold and merged by a rest time."""

STATISTICS = {
    "impact_count": Quantity("1", "number of impacts", ("stop",)),
    "impact_rate": Quantity("1/s", "impacts a second", ("stop",)),
    "mean_interval": Quantity("s", "mean time from one impact to the next", ("stop",)),
    "contact_time": Quantity("s", "time loaded", ("stop",)),
    "contact_fraction": Quantity("1", "part of the time loaded", ("stop",)),
    "mean_duration": Quantity("s", "mean duration of an impact", ("stop",)),
    "largest_duration": Quantity("s", "largest duration of an impact", ("stop",)),
    "mean_closing_speed": Quantity("m/s", "mean closing speed", ("stop",)),
    "rms_closing_speed": Quantity("m/s", "rms of the closing speeds", ("stop",)),
    "largest_closing_speed": Quantity("m/s", "largest closing speed", ("stop",)),
    "mean_peak_force": Quantity("N", "mean of the impacts' peak forces", ("stop",)),
    "deviation_peak_force": Quantity("N", "standard deviation of the peak forces", ("stop",)),
    "largest_force": Quantity("N", "largest force", ("stop",)),
    "mean_impulse": Quantity("N s", "mean impulse of an impact", ("stop",)),
    "largest_impulse": Quantity("N s", "largest impulse of an impact", ("stop",)),
    "mean_force": Quantity("N", "mean force over all the time", ("stop",)),
    "rms_force": Quantity("N", "rms force over all the time", ("stop",)),
    "mean_force_in_contact": Quantity("N", "mean force over the time loaded", ("stop",)),
    "rms_force_in_contact": Quantity("N", "rms force over the time loaded", ("stop",)),
}
"""Statistics of the impacts on a stop over a run, or over a block of its time."""
MOST_BLOCKS = 10_000
MOST_CLASSES = 100_000


def dof_units(quantity: str, dof: str) -> str:
    """Return the unit of a displacement, velocity or acceleration along a dof.

    >>> dof_units("velocity", "dy"), dof_units("velocity", "drz")
    ('m/s', 'rad/s')
    """
    units = QUANTITIES[quantity].units
    return units if dof in DOFS[:3] else units.replace("m", "rad", 1)


def modal_attributes(quantity: str, *, unit_mass: bool) -> dict[str, str]:
    """Return unit and long name of a modal displacement, velocity or acceleration.

    Amplitudes of vectors that a user gave in some scale of theirs have no unit that we know.

    >>> modal_attributes("modal_displacement", unit_mass=False)
    {'long_name': 'modal displacement, in the scale of the vectors given'}
    """
    if unit_mass:
        return QUANTITIES[quantity].attributes
    long_name = QUANTITIES[quantity].long_name
    return {"long_name": f"{long_name}, in the scale of the vectors given"}


def plain_name(name: str) -> str:
    """Return a name of letters, digits and underscores, as the CF conventions want them.

    >>> plain_name("displacement_AB@0.462_dy")
    'displacement_AB_0_462_dy'
    """
    return re.sub(r"\W", "_", name, flags=re.ASCII)


def plain_names(names: Iterable[str], longest: int | None = None) -> list[str]:
    """Return plain names that differ, whatever others they are of: some get a number.

    Parameters
    ----------
    names
        Names, each another.
    longest
        Letters of a name at most; any number where left out.

    Examples
    --------
    >>> plain_names(["gap_s-1", "gap_s_1", "gap_t"])
    ['gap_s_1', 'gap_s_1_2', 'gap_t']
    >>> plain_names(["displacement_of_one", "displacement_of_two"], longest=12)
    ['displacement', 'displaceme_2']
    """
    found: dict[str, None] = {}
    for name in names:
        first = plain_name(name)[:longest]
        plain, number = first, 1
        while plain in found:
            number += 1
            tail = f"_{number}"
            plain = (first if longest is None else first[: longest - len(tail)]) + tail
        found[plain] = None
    return list(found)
