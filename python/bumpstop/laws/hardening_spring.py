"""HardeningSpring: an elastic-plastic spring from a table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bumpstop.arguments import FloatArray, one_of, pair, positive
from bumpstop.errors import InputError
from bumpstop.laws.connection import Connection

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["HARDENING", "HardeningSpring"]

HARDENING = ("isotropic", "kinematic")
MOST_SEGMENTS = 127
"""The core tells states apart by a byte: two for each segment beside the elastic one."""
FINEST = 1e-12
"""The least deviation that is tried for curves of more segments, relative to their force."""


@dataclass(frozen=True)
class HardeningSpring(Connection):
    """A spring that yields, and hardens as it does, along a table of force against elongation.

    With the elongation U and its plastic part Up the tension is ``F = K (U - Up)``. The curve is
    what a first, steady pull follows; its first point is the elastic limit, which tells K, and
    beyond its last one the last slope goes on. Isotropic hardening: it yields where ``|F|`` reaches
    the force of the curve at the plastic elongation summed up so far. Kinematic hardening: it
    yields where F is the force at the elastic limit away from a centre that moves with Up; the
    curve then has two points, and springs side by side make more. The exact method takes it.

    Parameters
    ----------
    name
        What the spring is called in results.
    node
        The node that it holds: a node's name or a point along a beam (``"AB@0.462"``).
    direction
        Direction along which it acts, in global axes; any length but zero, kept as a unit
        vector: along the line between the nodes, or across.
    other
        The node that holds it; the ground where left out.
    terms
        Instead of node, direction and other: the weight of each (node, dof) in the elongation.
    curve
        Points [elongation, force] in m and N, increasing, without the origin.
    hardening
        ``"isotropic"`` or ``"kinematic"``.

    Raises
    ------
    InputError
        If the points do not increase, fall, or rise more steeply than the elastic part.

    References
    ----------
    J. C. Simo and T. J. R. Hughes, *Computational Inelasticity*, Springer, 1998, chapter 1.

    Examples
    --------
    A mass stretches a spring to twice its elastic limit, and comes to swing about 0.5 mm.

    >>> import bumpstop as bs
    >>> tie = HardeningSpring(
    ...     "tie", node="P", direction=(1, 0, 0), curve=[(1e-3, 100.0), (2e-3, 100.0)]
    ... )
    >>> mass = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dx"): [1]})
    >>> start = bs.ModalState(velocity=[(2 * (0.05 + 0.05)) ** 0.5])
    >>> response = bs.simulate(bs.Problem(mass, laws=[tie], initial=start, duration=0.1))
    >>> states = response.sample("state", "tie", times=[0.0, 0.004, 0.1])
    >>> [str(state) for state in states]
    ['elastic', 'yields in tension, segment 1', 'elastic']
    """

    kind: ClassVar[str] = "spring"
    internal_variables: ClassVar[tuple[str, ...]] = ("plastic_elongation", "plastic_path")

    _: KW_ONLY
    curve: Sequence[Sequence[float]]
    hardening: str = "isotropic"

    def __post_init__(self) -> None:
        super().__post_init__()
        one_of("hardening", self.hardening, HARDENING)
        points = tuple(pair(f"curve[{i}]", point) for i, point in enumerate(self.curve))
        object.__setattr__(self, "curve", points)
        if len(points) < 2:
            hint = "the elastic limit, and at least one beyond it"
            raise InputError("must have at least two points", key="curve", value=points, hint=hint)
        if self.hardening == "kinematic" and len(points) > 2:
            what = "must have two points where hardening is kinematic"
            hint = "springs side by side make curves of more"
            raise InputError(what, key="curve", value=points, hint=hint)
        for part, value in zip(("elongation", "force"), points[0], strict=True):
            positive(f"curve[0].{part}", value)
        self._check_slopes()

    @property
    def stiffness(self) -> float:
        """The stiffness in N/m of its elastic part."""
        elongation, force = self.curve[0]
        return force / elongation

    @cached_property
    def thinned(self) -> tuple[FloatArray, float]:
        """The points that the core follows, (P, 2), and their largest deviation in N.

        All of them and no deviation, where the curve has no more than 127 segments beyond the
        elastic limit.
        """
        points = np.array(self.curve)
        if len(points) <= MOST_SEGMENTS + 1:
            return points, 0.0
        low, high = FINEST * points[:, 1].max(), points[:, 1].max()
        while high > 1.01 * low:
            middle = float(np.sqrt(low * high))
            if len(_along(points, middle)) <= MOST_SEGMENTS + 1:
                high = middle
            else:
                low = middle
        return points[_along(points, high)], high

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know of it, a line each."""
        deviation = self.thinned[1]
        if deviation == 0.0:
            return ()
        kept = len(self.thinned[0])
        return (f"follows {kept} of its {len(self.curve)} points, within {deviation:.2g} N",)

    def force(self, elongation: FloatArray | Sequence[float]) -> FloatArray:
        """Return the tension in N of a first, steady pull, for elongations in m."""
        x = np.asarray(elongation, dtype=np.float64)
        points = np.vstack([[0.0, 0.0], np.array(self.curve)])
        end, before = points[-1], points[-2]
        slope = (end[1] - before[1]) / (end[0] - before[0])
        beyond = np.maximum(np.abs(x) - end[0], 0.0) * slope
        return np.asarray(np.sign(x) * (np.interp(np.abs(x), *points.T) + beyond))

    @property
    def steepest(self) -> float:
        """The largest slope in N/m that its force can have, up to its elastic limit."""
        return self.curve[0][1] / self.curve[0][0]

    def static_force(self, place: float) -> tuple[float, float]:
        """Return the force in N on the structure, ``place`` m along in one pull, and its slope."""
        points = np.vstack([[0.0, 0.0], np.array(self.curve)])
        slopes = np.diff(points[:, 1]) / np.diff(points[:, 0])
        segment = int(np.searchsorted(points[1:-1, 0], abs(place), side="right"))
        return -float(self.force([place])[0]), -float(slopes[segment])

    def core(self, basis: ModalBasis) -> _core.HardeningSpring:
        """Return the spring as the core sees it; see `row`."""
        from bumpstop import _core

        points = [(float(x), float(f)) for x, f in self.thinned[0]]
        return _core.HardeningSpring(self.row(basis), points, self.hardening == "kinematic")

    def _check_slopes(self) -> None:
        steps = np.diff(np.array(self.curve), axis=0)
        wrong = (steps[:, 0] <= 0.0) | (steps[:, 1] < 0.0)
        if wrong.any():
            at = int(np.argmax(wrong)) + 1
            what = "must increase from point to point, the force at least not fall"
            raise InputError(what, key=f"curve[{at}]", value=self.curve[at])
        steep = steps[:, 1] >= self.stiffness * steps[:, 0]
        if steep.any():
            at = int(np.argmax(steep)) + 1
            what = "must rise less steeply than up to the elastic limit"
            hint = f"the elastic stiffness is {self.stiffness:g} N/m"
            raise InputError(what, key=f"curve[{at}]", value=self.curve[at], hint=hint)


def _along(points: FloatArray, tolerance: float) -> list[int]:
    """Return the numbers of points whose chords stray from the others by no more than that.

    Each chord is as long as it can be, found by doubling and halving its length.
    """
    kept, last = [0], len(points) - 1
    while kept[-1] < last:
        start = kept[-1]
        good, bad = 1, 2
        while start + bad <= last and _close(points, start, start + bad, tolerance):
            good, bad = bad, 2 * bad
        bad = min(bad, last - start + 1)
        while bad - good > 1:
            middle = (good + bad) // 2
            if _close(points, start, start + middle, tolerance):
                good = middle
            else:
                bad = middle
        kept.append(start + good)
    return kept


def _close(points: FloatArray, start: int, end: int, tolerance: float) -> bool:
    between = points[start : end + 1]
    chord = np.interp(between[:, 0], between[[0, -1], 0], between[[0, -1], 1])
    return bool(np.abs(chord - between[:, 1]).max() <= tolerance)
