"""Signals: what a response has over time, one column each, for the formats that hold columns.

They are read in blocks of instants, so that a file of any length takes the memory of one block.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from bumpstop.quantities import INTERNAL_VARIABLES, QUANTITIES, dof_units, plain_names
from bumpstop.sampling import MOTIONS

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.response import Response

__all__ = ["BLOCK", "Signal", "sampled_blocks", "signals"]

BLOCK = 65_536
"""Instants in a block."""


class Signal(NamedTuple):
    """One function of time."""

    quantity: str
    target: tuple[str, ...]
    """What it is the quantity of, as `Response.sample` takes it."""
    units: str
    long_name: str

    name: str
    """A name of letters, digits and underscores, which no other has: ``displacement_B_dy``."""


def signals(response: Response, longest: int | None = None) -> list[Signal]:
    """Return the signals of a response, whose names have at most so many letters.

    Motions of the problem's outputs and of the nodes at the stops; of the dof that the modes
    know first, where there is neither; forces and gaps of the stops, with friction their forces
    along the obstacles; what laws remember; strains of the gauges.
    """
    problem = response.problem
    places = [*problem.outputs, *(dof for law in problem.laws for dof in law.coordinate.dofs)]
    found: list[tuple[str, ...]] = [
        (quantity, *place)
        for place in dict.fromkeys(places or problem.basis.dofs[:1])
        for quantity in MOTIONS
    ]
    for law in problem.laws:
        found += [(quantity, law.name) for quantity in ("stop_force", "gap")]
        if getattr(law, "friction", None) is not None:
            found.append(("friction_force", law.name))
        remembered: tuple[str, ...] = getattr(law, "internal_variables", ())
        found += [("internal_variable", law.name, each) for each in remembered]
    found += [("gauge", gauge.name) for gauge in problem.gauges]
    names = plain_names(("_".join(_named(*parts)) for parts in found), longest)
    return [_signal(name, *parts) for name, parts in zip(names, found, strict=True)]


def sampled_blocks(
    response: Response, wanted: Sequence[Signal]
) -> Iterator[tuple[FloatArray, list[FloatArray]]]:
    """Yield the instants of each block, and the values (instants,) of every signal at them."""
    for start in range(0, len(response.instants), BLOCK):
        times = response.instants[start : start + BLOCK]
        yield times, [response.sample(each.quantity, *each.target, times=times) for each in wanted]


def _named(quantity: str, *target: str) -> tuple[str, ...]:
    """Return the parts of a name: an internal variable goes by its own."""
    if quantity == "internal_variable":
        law, variable = target
        return variable, law
    return quantity, *target


def _signal(name: str, quantity: str, *target: str) -> Signal:
    if quantity in MOTIONS:
        node, dof = target
        told = f"{quantity} of {node} along {dof}"
        return Signal(quantity, target, dof_units(quantity, dof), told, name)
    what = (
        INTERNAL_VARIABLES[target[1]] if quantity == "internal_variable" else QUANTITIES[quantity]
    )
    return Signal(quantity, target, what.units, f"{what.long_name} ({target[0]})", name)
