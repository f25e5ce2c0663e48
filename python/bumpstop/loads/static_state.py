"""StaticState: the structure rests under loads, pressed against what it leans on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple, Protocol, runtime_checkable

import numpy as np

from bumpstop.arguments import FloatArray, all_of
from bumpstop.errors import InputError
from bumpstop.loads.load import ForceComponent

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis

__all__ = ["StaticState"]

_ROUNDS = 200
_BALANCED = 1e-13
"""Forces left over this small, beside those that balance each other, are rounding."""
_SOFT = 1e-9
"""What holds motions without stiffness during the search, as a part of the largest stiffness."""
_FAR = 1e9
"""Steps this much longer than all motions so far lead nowhere."""


@runtime_checkable
class _StaticLaw(Protocol):
    """A law with a force at rest."""

    @property
    def name(self) -> str:
        """What it is called."""

    def row(self, basis: ModalBasis) -> FloatArray:
        """Return its coordinate per unit of each modal displacement, (N,)."""

    def static_force(self, place: float) -> tuple[float, float]:
        """Return the force at rest along its coordinate, and how it changes with that."""


@runtime_checkable
class _StaticShape(Protocol):
    """A law with a force at rest in a plane."""

    @property
    def name(self) -> str:
        """What it is called."""

    @property
    def stiffness(self) -> float:
        """Its stiffness in N/m."""

    def rows(self, basis: ModalBasis) -> FloatArray:
        """Return its coordinates per unit of each modal displacement, those of the plane first."""

    def origin(self, basis: ModalBasis) -> FloatArray:
        """Return where the structure at rest stands in the plane, (2,)."""

    def static_push(self, place: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the force at rest in the plane, (2,), and how it changes there, (2, 2)."""


@runtime_checkable
class _Load(Protocol):
    """A load."""

    def components(self, basis: ModalBasis) -> Sequence[ForceComponent]:
        """Return the forces on each mode, each with its functions of time."""


@dataclass(frozen=True, eq=False)
class StaticState:
    """Equilibrium at rest under loads, with the laws that take part.

    A beam that is pushed onto its stop and let go at t = 0 starts in the equilibrium under the
    push, which is then no load of the problem. Stops with friction hold nothing along their
    obstacle. The equilibrium is found as the least of the potential energy, by Newton's
    iterations with a line search, whose set of closed stops settles after a few of them.

    Parameters
    ----------
    loads
        The loads, as they are at t = 0.
    laws
        The laws that take part: stops, springs, devices, relations, functions of a user; plastic
        springs and stops that buckle as after one steady pull, dampers with what they push at no
        speed.

    Raises
    ------
    InputError
        If a law has no force at rest that is known here.

    Examples
    --------
    >>> from bumpstop import ModalBasis, NodalForce, Stop
    >>> basis = ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    >>> push = NodalForce("push", node="P", force=(-3.0, 0, 0))
    >>> stop = Stop("wall", node="P", normal=(1, 0, 0), stiffness=100.0 - (2 * np.pi) ** 2)
    >>> state = StaticState(loads=[push], laws=[stop]).modal_state(basis)[0]
    >>> print(f"{state[0]:.12f}")
    -0.030000000000
    """

    _: KW_ONLY
    loads: Sequence[object] = ()
    laws: Sequence[object] = ()

    may_press: ClassVar[bool] = True
    """Stops may be closed in it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "loads", all_of("loads", _Load, self.loads))
        for law in self.laws:
            if not isinstance(law, _StaticLaw | _StaticShape):
                what = "has no force at rest that could be balanced"
                value = getattr(law, "name", law)
                hint = "stops, springs, devices, relations, dampers and functions of a user have"
                raise InputError(what, key="laws", value=value, hint=hint)
        object.__setattr__(self, "laws", tuple(self.laws))

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        names = ", ".join(str(getattr(load, "name", "a load")) for load in self.loads)
        return f"at rest under {names or 'no load'}"

    def modal_state(self, basis: ModalBasis) -> tuple[FloatArray, FloatArray]:
        """Return modal displacement, and velocity, which is zero, each (N,).

        Those of a full model are of its independent dofs.

        Raises
        ------
        InputError
            If nothing holds the structure, or it has no equilibrium that it would stay in.
        """
        if basis.unreduced:
            return self._on_all_dofs(basis)
        return self._place(basis, self._force(basis)), np.zeros(len(basis.omega2))

    def _on_all_dofs(self, full: ModalBasis) -> tuple[FloatArray, FloatArray]:
        """Return displacement and velocity of the independent dofs, each (N,)."""
        from bumpstop.loads.full_equilibrium import static_basis

        along = [each for law in self.laws for each in _rows(full, law)]
        force, still = self._force(full), np.zeros(len(full.omega2))
        acting = [each for each in (force, *along) if each.any()]
        if not acting:
            return still, still
        basis = static_basis(full, np.stack(acting, axis=1))
        # Not the forces of the loads on that basis: its masses may be others.
        place = self._place(basis, force @ full.project_field(basis.shapes))
        return full.project_field(basis.shapes @ place), still

    def _place(self, basis: ModalBasis, force: FloatArray) -> FloatArray:
        """Return the displacement of the modes under forces on them, (N,)."""
        return _Balance(basis, force, [_held(basis, law) for law in self.laws]).found()

    def remarks(self, _: ModalBasis) -> tuple[str, ...]:
        """Return nothing: the basis has all of an equilibrium of its own."""
        return ()

    def _force(self, basis: ModalBasis) -> FloatArray:
        """Return the forces on the modes at t = 0, (N,)."""
        total = np.zeros(len(basis.omega2))
        start = np.zeros(1)
        for load in self.loads:
            assert isinstance(load, _Load)  # checked when it was made
            for force, functions in load.components(basis):
                size = sum(float(each.at(start)[0]) for each in functions) if functions else 1.0
                total += size * force
        return total


def _rows(basis: ModalBasis, law: object) -> FloatArray:
    """Return the coordinates of a law per unit of each modal displacement, (n, N)."""
    if isinstance(law, _StaticLaw):
        return law.row(basis)[np.newaxis]
    assert isinstance(law, _StaticShape)  # checked when it was made
    return law.rows(basis)[:2]


class _Held(NamedTuple):
    """What a law does at rest."""

    rows: FloatArray
    """Motion along each of its coordinates by the modes, (coordinates, N)."""
    push: Callable[[FloatArray], tuple[FloatArray, FloatArray]]
    """From the coordinates to the forces along them, and how these change, (n,) and (n, n)."""
    stiffness: float
    """The largest that it can have on a mode."""


def _held(basis: ModalBasis, law: object) -> _Held:
    """Return what a law does at rest on a basis."""
    rows = _rows(basis, law)
    if isinstance(law, _StaticLaw):
        told = law.static_force
        # Formulas may grow without limit: these tell a scale of their own.
        scale = getattr(law, "static_stiffness", None)
        far = max(abs(told(x)[1]) for x in (-1e9, 1e9)) if scale is None else scale

        def along(place: FloatArray) -> tuple[FloatArray, FloatArray]:
            push, change = told(float(place[0]))
            return np.array([push]), np.array([[change]])

        return _Held(rows, along, far * float((rows**2).max(initial=0.0)))
    assert isinstance(law, _StaticShape)  # checked when it was made
    shape, origin = law, law.origin(basis)
    stiffest = shape.stiffness * float((rows**2).max(initial=0.0))
    return _Held(rows, lambda place: shape.static_push(origin + place), stiffest)


class _Balance:
    """The search for an equilibrium."""

    def __init__(self, basis: ModalBasis, force: FloatArray, laws: Sequence[_Held]) -> None:
        self._stiffness = np.diag(basis.omega2)
        if basis.circulatory is not None:
            self._stiffness = self._stiffness + basis.circulatory
        self._force, self._laws = force, laws

    def found(self) -> FloatArray:
        """Return the displacement (N,) at which all forces are in balance.

        Raises
        ------
        InputError
            If there is none, or nothing holds the structure.
        """
        place = np.zeros(len(self._force))
        left, scale, slope = self._left(place)
        for _ in range(_ROUNDS):
            if np.abs(left).max(initial=0.0) <= _BALANCED * scale:
                return place
            step = self._step(left, slope)
            if not np.isfinite(step).all() or np.abs(step).max() > _FAR * self._reach(place):
                break
            place, left, scale, slope = self._searched(place, step)
        if np.abs(left).max() <= 1e3 * _BALANCED * scale:
            return place
        what = "finds no equilibrium: nothing holds the structure, or it moves away by itself"
        hint = "stops must take what rigid motions are pushed by"
        raise InputError(what, key="static", hint=hint)

    def _left(self, place: FloatArray) -> tuple[FloatArray, float, FloatArray]:
        """Return the forces that are left over, their scale, and how they change, (N, N)."""
        elastic = self._stiffness @ place
        left, scale = self._force - elastic, np.abs(self._force).max() + np.abs(elastic).max()
        slope = -self._stiffness
        for rows, push_at, _ in self._laws:
            push, change = push_at(rows @ place)
            left = left + push @ rows
            scale += np.abs(push).max() * np.abs(rows).max()
            slope = slope + rows.T @ change @ rows
        return left, float(scale) or 1.0, slope

    def _step(self, left: FloatArray, slope: FloatArray) -> FloatArray:
        """Return Newton's step; motions that nothing holds are held softly."""
        soft = _SOFT * max(np.abs(slope.diagonal()).max(), self._stiffest())
        if np.linalg.cond(slope) < 1e14:
            soft = 0.0
        step: FloatArray = np.linalg.solve(soft * np.eye(len(left)) - slope, left)
        return step

    def _stiffest(self) -> float:
        """Return the largest stiffness that a law can have on a mode."""
        return max((law.stiffness for law in self._laws), default=0.0) or 1.0

    def _reach(self, place: FloatArray) -> float:
        """Return the size of motions that lead somewhere."""
        pushed = float(np.abs(self._left(np.zeros(len(place)))[0]).max())
        return max(float(np.abs(place).max()), pushed / (_SOFT * self._stiffest()))

    def _searched(
        self, place: FloatArray, step: FloatArray
    ) -> tuple[FloatArray, FloatArray, float, FloatArray]:
        """Return the place on a step where the forces do no more work along it."""
        low, high = 0.0, 1.0
        found = self._left(place + step)
        # Past the least of the energy the forces push back: where they do no work it lies.
        work = float(found[0] @ step)
        first = float(self._left(place)[0] @ step)
        if work >= -1e-3 * abs(first):
            return place + step, *found
        for _ in range(60):
            middle = 0.5 * (low + high)
            found = self._left(place + middle * step)
            work = float(found[0] @ step)
            if abs(work) <= 1e-3 * abs(first):
                break
            low, high = (middle, high) if work > 0.0 else (low, middle)
        return place + middle * step, *found
