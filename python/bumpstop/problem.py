"""Problem: everything that a simulation needs, as numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import KW_ONLY, dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from bumpstop.arguments import FloatArray, all_of, listed, name, positive, refuse_twins
from bumpstop.errors import InputError, blamed
from bumpstop.instants import SNAP, Grid
from bumpstop.modal.basis import ModalBasis
from bumpstop.structure.gauge import Gauge

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.laws.coordinate import Coordinate
    from bumpstop.loads.load import ForceComponent
    from bumpstop.loads.shaft_rotation import ShaftRotation

__all__ = ["InitialState", "Law", "Load", "Problem"]


DEFAULT_SAMPLES = 1000
MOST_SAMPLES = 1_000_000_000


@runtime_checkable
class Law(Protocol):
    """A local nonlinearity."""

    @property
    def name(self) -> str:
        """What the law is called."""

    @property
    def table(self) -> str:
        """Where a problem keeps it, in words for messages."""

    @property
    def coordinate(self) -> Coordinate:
        """What it sees of the motion."""

    def core(self, basis: ModalBasis) -> _core.Law:
        """Return it as the core sees it."""


@runtime_checkable
class Load(Protocol):
    """A force that does not depend on the motion: vectors times functions of time."""

    @property
    def name(self) -> str:
        """What the load is called."""

    def components(self, basis: ModalBasis) -> Sequence[ForceComponent]:
        """Return the forces on each mode, each with its functions of time."""


@runtime_checkable
class InitialState(Protocol):
    """Where the structure is and how it moves at t = 0."""

    def modal_state(self, basis: ModalBasis) -> tuple[FloatArray, FloatArray]:
        """Return modal displacement and velocity, each (N,)."""

    def remarks(self, basis: ModalBasis) -> tuple[str, ...]:
        """Return what a user should know of the state on a basis, a line each."""


PARTS: dict[str, type[Law | Load | Gauge]] = {"laws": Law, "loads": Load, "gauges": Gauge}


@dataclass(frozen=True, eq=False)
class Problem:
    """A basis with its laws, loads and initial state, and for how long to watch it.

    Whatever names a node is looked up when the problem is made, so that a problem that
    exists can be run.

    Parameters
    ----------
    basis
        The modes of the linear structure.
    laws
        Its local nonlinearities; names must differ.
    loads
        Forces, constant or changing in time, and motions of the supports; names must differ.
    initial
        State at t = 0; at rest and undeformed where left out.
    duration
        Time to simulate, in s.
    sample
        Interval in s of the grid on which responses are tabulated; a thousandth of the
        duration where left out. It has no influence on the solution.
    gauges
        Strain gauges; names must differ.
    outputs
        Pairs (node, dof) whose motion is written to files beside the nodes of the stops.
    rotation
        How the shafts turn; where left out the gyroscopic matrix of the basis is taken as it is.

    Raises
    ------
    InputError
        If a name is used twice, a node or dof is unknown to the basis, or a number is out
        of its range.

    Examples
    --------
    >>> from bumpstop.laws import Stop
    >>> from bumpstop.loads import ModalState
    >>> from bumpstop.modal.basis import ModalBasis
    >>> basis = ModalBasis.from_modes(frequency=[3.0], damping=[0.01], shapes={("P", "dx"): [1.0]})
    >>> stop = Stop("guide", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=1e6)
    >>> problem = Problem(basis, laws=[stop], initial=ModalState(velocity=[0.2]), duration=1.0)
    >>> len(problem.times)
    1001
    """

    basis: ModalBasis = field(repr=False)
    _: KW_ONLY
    laws: Sequence[Law] = ()
    loads: Sequence[Load] = ()
    initial: InitialState | None = None
    duration: float
    sample: float | None = None
    gauges: Sequence[Gauge] = ()
    outputs: Sequence[tuple[str, str]] = ()
    rotation: ShaftRotation | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.basis, ModalBasis):
            raise InputError("must be a ModalBasis", key="basis", value=type(self.basis).__name__)
        if not isinstance(self.initial, InitialState | None):
            raise InputError("must be an initial state", key="initial", value=self.initial)
        for key, kind in PARTS.items():
            parts = all_of(key, kind, getattr(self, key))
            refuse_twins(key, [part.name for part in parts])
            object.__setattr__(self, key, parts)
        outputs = tuple(_pair("outputs", pair) for pair in listed("outputs", self.outputs))
        object.__setattr__(self, "outputs", outputs)
        object.__setattr__(self, "duration", positive("duration", self.duration))
        if self.sample is not None:
            object.__setattr__(self, "sample", positive("sample", self.sample))
        self._check_sample()
        self._check_rotation()
        self._check_targets()

    @property
    def grid(self) -> Grid:
        """The sample grid: 0, sample, 2 sample, ... and always the duration, last."""
        sample = self.duration / DEFAULT_SAMPLES if self.sample is None else self.sample
        return Grid(step=sample, end=self.duration)

    @property
    def times(self) -> FloatArray:
        """The instants of the sample grid in s."""
        return self.grid[:]

    @property
    def stop_names(self) -> list[str]:
        """Names of the laws that are stops: those that impacts, statistics and wear are of."""
        return [law.name for law in self.laws if law.table == "stops"]

    @property
    def supports_move(self) -> bool:
        """Whether some load moves supports."""
        # By a name that only those have, so that they are not imported where nobody has any.
        return any(hasattr(load, "travel") for load in self.loads)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know, a line each: of the basis, the initial state, loads, stops."""
        return (*self.basis.remarks, *self.initial_remarks, *self.warnings)

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """What a user should think twice about, a line each: of loads and of stops.

        `simulate` gives these as Python warnings too.
        """
        from bumpstop.checks import contact_warnings

        return (*self.load_remarks, *contact_warnings(self))

    @property
    def load_remarks(self) -> tuple[str, ...]:
        """What a user should know of the functions of time, a line each."""
        functions = {
            function: load.name
            for load in self.loads
            for component in load.components(self.basis)
            for function in component.functions
        }
        # Few functions have any.
        return tuple(
            f"{name}: {remark}"
            for function, name in functions.items()
            for remark in getattr(function, "remarks", ())
        )

    @property
    def initial_remarks(self) -> tuple[str, ...]:
        """What a user should know of the initial state on this basis, a line each."""
        return () if self.initial is None else self.initial.remarks(self.basis)

    def _check_sample(self) -> None:
        if self.sample is None:
            return
        if self.sample > self.duration * (1.0 + SNAP):
            raise InputError(
                "must not exceed the duration",
                key="sample",
                value=self.sample,
                hint=f"the duration is {self.duration:g} s",
            )
        if self.duration / self.sample > MOST_SAMPLES:
            raise InputError(
                f"gives more than {MOST_SAMPLES:,} samples",
                key="sample",
                value=self.sample,
                hint=f"take at least {self.duration / MOST_SAMPLES:.3g} s; "
                "the solution itself does not depend on it",
            )

    def _check_rotation(self) -> None:
        turns = self.rotation is not None or any(hasattr(load, "rotation") for load in self.loads)
        if not turns:
            return
        from bumpstop.loads.shaft_rotation import ShaftRotation
        from bumpstop.turning import check_rotation

        if not isinstance(self.rotation, ShaftRotation | None):
            raise InputError("must be a ShaftRotation", key="rotation", value=self.rotation)
        check_rotation(self)

    def _check_targets(self) -> None:
        for law in self.laws:
            with _at(f"{law.table}.{law.name}"):
                law.core(self.basis)
                # Few laws have it: an obstacle that moves.
                motion = getattr(law, "functions", ())
                if motion:
                    from bumpstop.loads.time import check_steady, resolved

                    with blamed("motion"):
                        check_steady(resolved(motion, self.duration), "motion")
        for load in self.loads:
            with _at(f"loads.{load.name}"):
                for component in load.components(self.basis):
                    if component.functions:
                        from bumpstop.loads.time import resolved

                        resolved(component.functions, self.duration)
        if self.supports_move:
            from bumpstop.carried import check_supports

            check_supports(self)
        for gauge in self.gauges:
            with _at(f"gauges.{gauge.name}"):
                self.basis.gauge_row(gauge)
        for number, (node, dof) in enumerate(self.outputs):
            with _at(f"outputs[{number}]"):
                self.basis.row(node, dof)
        if self.initial is not None:
            with _at("initial"):
                self.initial.modal_state(self.basis)


def _pair(key: str, value: object) -> tuple[str, str]:
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise InputError("must hold pairs of a node and a dof", key=key, value=value)
    return name(key, value[0]), name(key, value[1])


@contextmanager
def _at(place: str) -> Iterator[None]:
    """Say in which part of the problem an argument was wrong."""
    try:
        yield
    except InputError as error:
        key = f"{place}.{error.key}" if error.key else place
        raise InputError(error.what, key=key, value=error.value, hint=error.hint) from error
