"""Joint: two nodes of different parts that move as one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass

from bumpstop.arguments import listed, name, one_of, refuse_twins
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS

__all__ = ["Joint"]


@dataclass(frozen=True)
class Joint:
    """Two interface nodes, at one place, that move as one.

    Parameters
    ----------
    first, second
        The nodes, with their parts: ``"left.B"``.
    dofs
        Which dofs they share, along and about the global axes; all that their interfaces have
        where left out. A hinge shares ``("dx", "dy", "dz")`` only.

    Raises
    ------
    InputError
        If a name or dof cannot be used, or the node is joined to itself.

    Examples
    --------
    >>> Joint("left.B", "right.A", dofs=("dx", "dy", "dz"))
    Joint(first='left.B', second='right.A', dofs=('dx', 'dy', 'dz'))
    """

    first: str
    second: str
    _: KW_ONLY
    dofs: Sequence[str] | None = None

    def __post_init__(self) -> None:
        for key in ("first", "second"):
            name(key, getattr(self, key))
        if self.first == self.second:
            raise InputError("joins a node to itself", value=self.first)
        if self.dofs is not None:
            object.__setattr__(self, "dofs", _dofs(self.dofs))


def _dofs(value: object) -> tuple[str, ...]:
    dofs = (value,) if isinstance(value, str) else listed("dofs", value)
    if not dofs:
        raise InputError("must list at least one dof", key="dofs", value=value)
    for dof in dofs:
        one_of("dof", dof, DOFS)
    refuse_twins("dofs", dofs)
    return dofs
