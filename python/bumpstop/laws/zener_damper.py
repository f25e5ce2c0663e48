"""ZenerDamper: springs around a dashpot whose force is a power of its speed."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, ClassVar

from bumpstop.arguments import not_negative, positive
from bumpstop.errors import InputError
from bumpstop.laws.connection import Connection

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["ZenerDamper"]


@dataclass(frozen=True)
class ZenerDamper(Connection):
    """A viscous damper with springs: the nonlinear generalised Zener model.

    A spring stands in series with two branches side by side: a spring, and a spring with a
    dashpot behind it, whose force is ``damping |w'|^exponent`` at the speed w' of its elongation.
    The adaptive methods take it and integrate w beside the motion; it is zero at the start.

    Parameters
    ----------
    name
        What the damper is called in results.
    node
        The node that it holds: a node's name or a point along a beam (``"AB@0.462"``).
    direction
        Direction along which it acts, in global axes; any length but zero, kept as a unit
        vector.
    other
        The node that holds it; the ground where left out.
    terms
        Instead of node, direction and other: the weight of each (node, dof) in the elongation.
    series_stiffness
        Stiffness in N/m of the spring in series with all else.
    parallel_stiffness
        Stiffness in N/m of the spring beside the dashpot's branch; it may be zero.
    branch_stiffness
        Stiffness in N/m of the spring in series with the dashpot.
    damping
        Force in N of the dashpot at 1 m/s.
    exponent
        Power of the speed, above 0 and at most 1, which is a linear dashpot.

    Raises
    ------
    InputError
        If a number is out of its range.

    References
    ----------
    C. Zener, *Elasticity and Anelasticity of Metals*, University of Chicago Press, 1948.

    Examples
    --------
    A mass on a damper comes to rest where the springs that are left hold it.

    >>> import bumpstop as bs
    >>> damper = ZenerDamper(
    ...     "damper", node="P", direction=(1, 0, 0), series_stiffness=300.0,
    ...     parallel_stiffness=150.0, branch_stiffness=500.0, damping=20.0, exponent=1.0,
    ... )
    >>> mass = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dx"): [1]})
    >>> pull = bs.NodalForce("pull", node="P", force=(1.0, 0, 0))
    >>> response = bs.simulate(bs.Problem(mass, laws=[damper], loads=[pull], duration=20.0))
    >>> print(f"{response.sample('displacement', 'P', 'dx', times=[20.0])[0]:.6f}")
    0.010000
    """

    kind: ClassVar[str] = "damper"
    smooth: ClassVar[str] = "its dashpot follows a rate equation"
    """Why it is not piecewise linear."""
    flows: ClassVar[bool] = True
    """The dashpot is followed beside the motion."""
    flows_in_steps: ClassVar[bool] = True
    """Nothing switches by what it remembers: explicit steps follow it, too."""
    internal_variables: ClassVar[tuple[str, ...]] = ("dashpot_elongation",)

    _: KW_ONLY
    series_stiffness: float
    parallel_stiffness: float = 0.0
    branch_stiffness: float
    damping: float
    exponent: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        for key in ("series_stiffness", "branch_stiffness", "damping", "exponent"):
            object.__setattr__(self, key, positive(key, getattr(self, key)))
        parallel = not_negative("parallel_stiffness", self.parallel_stiffness)
        object.__setattr__(self, "parallel_stiffness", parallel)
        if self.exponent > 1.0:
            hint = "a higher power has no force at small speeds; give at most 1"
            raise InputError("must not exceed 1", key="exponent", value=self.exponent, hint=hint)

    @property
    def steepest(self) -> float:
        """The largest slope in N/m that its force can have, while its dashpot is quick."""
        beside = self.parallel_stiffness + self.branch_stiffness
        return self.series_stiffness * beside / (self.series_stiffness + beside)

    def core(self, basis: ModalBasis) -> _core.ZenerDamper:
        """Return the damper as the core sees it; see `row`."""
        from bumpstop import _core

        return _core.ZenerDamper(
            self.row(basis),
            self.series_stiffness,
            self.parallel_stiffness,
            self.branch_stiffness,
            self.damping,
            self.exponent,
        )
