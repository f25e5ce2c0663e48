"""Linear relations between dofs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from bumpstop.arguments import finite, one_of
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.forms import LinearForm

__all__ = ["Relation"]


@dataclass(frozen=True)
class Relation:
    """A weighted sum of dofs that stays zero.

    Parameters
    ----------
    terms
        The weight of each (node, dof). A node may also be a point along a beam
        (``"AB@0.462"``).

    Raises
    ------
    InputError
        If there is no term, a dof is unknown, or a weight is not finite or is zero.

    Examples
    --------
    A lever that halves a motion, and a wheel of radius 0.2 m that rolls:

    >>> lever = Relation({("A", "dy"): 2.0, ("B", "dy"): 1.0})
    >>> wheel = Relation({("hub", "dx"): 1.0, ("hub", "drz"): 0.2})
    """

    terms: Mapping[Dof, float]

    def __post_init__(self) -> None:
        if not isinstance(self.terms, Mapping):
            what = 'must map (node, dof) to weights, such as {("A", "dx"): 1.0, ("B", "dx"): -1.0}'
            raise InputError(what, key="terms", value=self.terms)
        if not self.terms:
            raise InputError("must have a term", key="terms", value=dict(self.terms))
        object.__setattr__(self, "terms", dict(map(_term, self.terms.items())))

    def form(self, displacement_form: Callable[[str, str], LinearForm]) -> LinearForm:
        """Return the sum that stays zero, by the forms of single dofs."""
        return LinearForm.sum(
            [(weight, displacement_form(node, dof)) for (node, dof), weight in self.terms.items()]
        )


def _term(item: tuple[object, object]) -> tuple[Dof, float]:
    key, weight = item
    if not isinstance(key, tuple) or len(key) != 2 or not isinstance(key[0], str):
        raise InputError("must be a node and a dof", key="terms", value=key)
    node, dof = key[0], one_of("dof", key[1], DOFS)
    number = finite(f"terms.{node}.{dof}", weight)
    if number == 0.0:
        hint = "leave the term out"
        raise InputError("must not be zero", key=f"terms.{node}.{dof}", value=weight, hint=hint)
    return (node, dof), number
