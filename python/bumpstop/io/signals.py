"""Signals: what a response has over time, one column each, for the formats that hold columns.

They are read in blocks of instants, so that a file of any length takes the memory of one block.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from bumpstop.projection import along
from bumpstop.quantities import QUANTITIES, dof_units, plain_name
from bumpstop.response import MOTIONS

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

    @property
    def name(self) -> str:
        """A name of letters, digits and underscores: ``displacement_B_dy``."""
        return plain_name("_".join((self.quantity, *self.target)))


def signals(response: Response) -> list[Signal]:
    """Return the signals of a response.

    Motions of the problem's outputs and of the nodes at the stops; of the dof that the modes
    know first, where there is neither; forces and gaps of the stops, with friction their forces
    along the obstacles; strains of the gauges.
    """
    problem = response.problem
    places = [*problem.outputs, *(dof for law in problem.laws for dof in law.coordinate.dofs)]
    found = [
        _signal(quantity, *place)
        for place in dict.fromkeys(places or problem.basis.dofs[:1])
        for quantity in MOTIONS
    ]
    for law in problem.laws:
        found += [_signal(quantity, law.name) for quantity in ("stop_force", "gap")]
        if getattr(law, "friction", None) is not None:
            found.append(_signal("friction_force", law.name))
    return [*found, *(_signal("gauge", gauge.name) for gauge in problem.gauges)]


def sampled_blocks(
    response: Response, wanted: Sequence[Signal]
) -> Iterator[tuple[FloatArray, list[FloatArray]]]:
    """Yield the instants of each block, and the values (instants,) of every signal at them."""
    times = response.times
    for start in range(0, len(times), BLOCK):
        block = times[start : start + BLOCK]
        yield block, _sampled(response, wanted, block)


def _signal(quantity: str, *target: str) -> Signal:
    if quantity in MOTIONS:
        node, dof = target
        return Signal(
            quantity, target, dof_units(quantity, dof), f"{quantity} of {node} along {dof}"
        )
    what = QUANTITIES[quantity]
    return Signal(quantity, target, what.units, f"{what.long_name} ({target[0]})")


def _sampled(response: Response, wanted: Sequence[Signal], times: FloatArray) -> list[FloatArray]:
    if response.problem.supports_move:
        return [response.sample(each.quantity, *each.target, times=times) for each in wanted]
    # Motions once for all nodes: to read them takes longer than to project them.
    derivatives = {MOTIONS.index(each.quantity) for each in wanted if each.quantity in MOTIONS}
    motions = {derivative: response.motion(derivative, times) for derivative in derivatives}
    basis = response.problem.basis
    return [
        along(basis.row(*each.target), motions[MOTIONS.index(each.quantity)])
        if each.quantity in MOTIONS
        else response.sample(each.quantity, *each.target, times=times)
        for each in wanted
    ]
