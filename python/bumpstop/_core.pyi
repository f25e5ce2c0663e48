"""What the compiled core offers to Python. Arrays are float64 and C-contiguous."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Columns = tuple[Index, Index, Array]
"""Compressed columns: where each starts, the row of each entry, its value."""
Count = tuple[float, int]
"""A squared angular frequency, and how many eigenvalues lie below it."""

class CoreError(Exception):
    """The core refused its input or could not finish; the message says why."""

    dof: int
    """The coordinate of a full model that moves most where one blew up, counted from 0."""

def symmetric_modes(stiffness: Array, mass: Array, count: int) -> tuple[Array, Array]:
    """Return all eigenvalues of ``K x = omega2 M x``, and the shapes of the lowest.

    Parameters are dense (n, n) symmetric matrices, M positive definite. Returns ``omega2``
    (n,) in ascending order and shapes (n, count) with unit modal mass, the component of
    largest magnitude positive.
    """

def sparse_modes(
    stiffness: Columns,
    mass: Columns,
    rigid: Array,
    *,
    lowest: int | None = None,
    band: tuple[float, float] | None = None,
    around: tuple[float, int] | None = None,
) -> tuple[Array, Array, Count | None, Count]:
    """Return the flexible modes of a range that holds those asked for, and proves to hold all.

    ``rigid`` (n, r) are all motions that strain nothing, orthonormal in M; ``band`` and the
    shift of ``around`` are squared angular frequencies. Returns ``omega2`` (m,) in ascending
    order, shapes (n, m) with unit modal mass, and the counts of eigenvalues, rigid ones
    included, at the lower end of the range (None where it has none) and at the upper.
    """

def sturm_count(stiffness: Columns, mass: Columns, points: list[float]) -> Count:
    """Count the eigenvalues below the first of the points that is not itself one."""

class SparseFactor:
    """A factored sparse symmetric matrix (n, n), definite or not."""

    def __init__(self, matrix: Columns) -> None: ...
    @property
    def negative_pivots(self) -> int:
        """Number of negative eigenvalues of the matrix."""
    @property
    def weakest_pivot(self) -> float:
        """The smallest pivot, relative to the diagonal where it stands."""
    @property
    def singular_at(self) -> int | None:
        """Number of the unknown where nothing but rounding is left of the matrix, if any."""
    def solve(self, rhs: Array) -> Array:
        """Solve for right-hand sides (n, m); raises CoreError if the matrix is singular."""

def assemble(
    rows: Index, columns: Index, values: Array, shape: tuple[int, int]
) -> tuple[Index, Index, Array]:
    """Add up triplets, in the order given, into starts, rows and values of columns."""

def sparse_product(matrix: Columns, height: int, vectors: Array) -> Array:
    """Return the product of a matrix (height, columns) with vectors (columns, m)."""

def component_labels(size: int, rows: Index, columns: Index) -> Index:
    """Return for each vertex of a graph the lowest vertex that it is joined to, (size,)."""

class System:
    """``q'' + (diag(damping) + coupling) q' + (diag(omega2) + circulatory) q = f``.

    Unit modal mass.
    """

    def __init__(
        self,
        omega2: Array,
        damping: Array,
        coupling: Array | None = None,
        circulatory: Array | None = None,
    ) -> None:
        """Take omega2 (N,) and circulatory (N, N) in rad2/s2, the others alike in rad/s."""
    def with_rotation(
        self,
        course: Course,
        gyroscopic: tuple[Array, Array] | None = None,
        unbalance: tuple[Array, Array] | None = None,
    ) -> System:
        """Return the same with one more shaft whose speed changes.

        Take matrices (N, N) that multiply velocities at 1 rad/s and displacements at 1 rad/s2, and
        forces (N,) of masses out of centre at 1 rad/s and the angles 0 and a quarter turn.
        """

class Course:
    """How a shaft turns."""

    def __init__(self, angle: float, speeds: list[tuple[float, list[float]]]) -> None:
        """Take the angle at t = 0, and stretches of the speed.

        Each is its first instant and the coefficients in powers of the time since then.
        """
    def at(self, times: Array) -> list[Array]:
        """Return angle in rad, speed and acceleration at times, each (time,)."""

class Forcing:
    """Modal forces over time: constant ones, and vectors (N,) times functions of time."""

    def __init__(
        self,
        constant: Array,
        polynomials: list[tuple[Array, Array]] = [],
        harmonics: list[tuple[float, Array, Array]] = [],
        tables: list[tuple[Array, Array, Array, bool]] = [],
    ) -> None:
        """Take forces in N per unit modal displacement.

        Polynomials are (direction, coefficients of the powers of time), harmonics (angular
        frequency in rad/s, amplitudes of cosine and sine), tables (direction, times, values,
        whether the values at their ends hold beyond them, instead of zero).
        """
    def with_motions(
        self,
        polynomials: list[tuple[tuple[int, int], Array]],
        harmonics: list[tuple[tuple[int, int], float, float, float]],
        tables: list[tuple[tuple[int, int], Array, Array, bool]],
    ) -> Forcing:
        """Return the same with obstacles that move, in m.

        Each is told by the number of its law and that of the coordinate that the motion is taken
        off. Polynomials are (obstacle, coefficients), harmonics (obstacle, angular frequency in
        rad/s, amplitudes of cosine and sine), tables (obstacle, times, values, whether the values
        at their ends hold beyond them).
        """
    def at(self, time: float) -> Array:
        """Modal forces (N,) at a time in s; just after it where they jump."""

class Stop:
    """A unilateral spring and damper at distance ``d = gap + row . q``."""

    def __init__(self, row: Array, gap: float, stiffness: float, damping: float) -> None: ...

class RigidStop:
    """A rigid obstacle at distance ``d = gap + row . q``, with a coefficient of restitution."""

    def __init__(
        self,
        row: Array,
        gap: float,
        restitution: float,
        resolution: float | None = None,
        tangent: Array | None = None,
        friction: float = 0.0,
    ) -> None:
        """Rebounds lower than ``resolution`` of the motion, 1e-12 if left out, end in rest.

        With a ``tangent`` it rubs along ``tangent . q``, which the method of Moreau and Jean takes.
        """

class FrictionStop:
    """A stop that rubs along the coordinate ``tangent . q``, by a spring that can slide."""

    def __init__(
        self,
        normal: Stop,
        tangent: Array,
        static_coefficient: float,
        dynamic_coefficient: float,
        stiffness: float,
        damping: float,
        by_velocity_sign: bool = False,
    ) -> None: ...

class Spring:
    """A multilinear elastic spring and a damper of deformation ``row . q``."""

    def __init__(
        self, row: Array, breaks: Array, stiffness: Array, preload: float, damping: float
    ) -> None:
        """Take the stiffness of each segment between breaks, and the force at the origin."""

class Damper:
    """A multilinear damper of elongation ``row . q``."""

    def __init__(self, row: Array, breaks: Array, damping: Array, offset: float) -> None:
        """Take the damping of each segment between speeds, and the force at rest."""

class ForceRelation:
    """A force along ``row . q`` that is a formula of its position and velocity."""

    def __init__(self, row: Array, program: list[float | str]) -> None:
        """Take the words of the formula in the order of a machine with a stack."""
    def force(self, position: Array, velocity: Array) -> Array:
        """Return forces (n,) in N for positions in m and velocities in m/s."""

class SeismicDevice:
    """A spring that softens beyond a threshold, with a damper, of elongation ``row . q``."""

    def __init__(
        self,
        row: Array,
        first_stiffness: float,
        second_stiffness: float,
        threshold: float,
        damping: float,
        exponent: float,
        stroke: float,
        rest_speed: float,
    ) -> None: ...

class HardeningSpring:
    """An elastic-plastic spring of elongation ``row . q``."""

    def __init__(self, row: Array, points: list[tuple[float, float]], kinematic: bool) -> None:
        """Take elongations and tensions of a first pull, the elastic limit first."""

class BucklingStop:
    """A stop that buckles."""

    def __init__(
        self,
        elastic: Stop,
        critical_force: float,
        post_force: float,
        plateau: float,
        fall: float,
        post_damping: float,
        unloading: list[tuple[float, float]],
    ) -> None:
        """Take the stop before, and residual crushings with their unloading stiffness."""

class UserLaw:
    """A law that Python functions answer for."""

    def __init__(
        self,
        name: str,
        rows: list[Array],
        force: Callable[..., Array],
        slopes: Callable[..., Array] | None,
        memory_rate: Callable[..., Array] | None,
        start: float,
    ) -> None:
        """Take functions of positions, velocities, time and memory, which return flat arrays."""

class OutsideProgram:
    """A program that a Python function asks once a step."""

    def __init__(self, name: str, rows: list[Array], exchange: Callable[..., Array]) -> None:
        """Take a function of the step's number, positions and velocities."""

class HertzStop:
    """A stop at distance ``d = gap + row . q`` whose force is a power of its depth."""

    def __init__(
        self, row: Array, gap: float, stiffness: float, exponent: float, hunt_crossley: float
    ) -> None: ...

class ZenerDamper:
    """Springs around a dashpot whose force is a power of its speed, of elongation ``row . q``."""

    def __init__(
        self,
        row: Array,
        in_series: float,
        in_parallel: float,
        in_branch: float,
        damping: float,
        exponent: float,
    ) -> None: ...

class CrackedRotor:
    """A crack across a shaft that turns, with the rotations ``rows . q``."""

    def __init__(
        self,
        rows: tuple[Array, Array],
        stiffness: tuple[list[float], list[list[float]]],
        derivative: tuple[list[float], list[list[float]]],
        course: Course,
    ) -> None:
        """Take functions of the direction as breaks, and coefficients of cubics from each on."""

class Shape:
    """The shape of an obstacle about the origin of a plane."""

    @staticmethod
    def plane(gap: float) -> Shape:
        """Across the first coordinate."""

    @staticmethod
    def circle(radius: float, inside: bool) -> Shape:
        """With the structure inside or outside."""

    @staticmethod
    def polygon(corners: Sequence[tuple[float, float]]) -> Shape:
        """Of corners in the order of their angles."""

class ShapedStop:
    """A stop on an obstacle of a shape, at the place ``origin + rows . q`` of its plane."""

    def __init__(
        self,
        rows: Sequence[Array],
        origin: tuple[float, float],
        shape: Shape,
        stiffness: float,
        damping: float,
        friction: tuple[float, float, float, float] | None = None,
    ) -> None:
        """Friction is (static coefficient, dynamic coefficient, stiffness, damping)."""

Law = (
    Stop
    | RigidStop
    | FrictionStop
    | Spring
    | HertzStop
    | ZenerDamper
    | CrackedRotor
    | ShapedStop
    | Damper
    | ForceRelation
    | SeismicDevice
    | HardeningSpring
    | BucklingStop
    | UserLaw
    | OutsideProgram
)

class History:
    """What a run leaves behind; it can be sampled anywhere in [0, duration]."""

    @property
    def method(self) -> str: ...
    @property
    def duration(self) -> float: ...
    @property
    def steps(self) -> int:
        """Certified cells of the exact method, or time steps."""
    @property
    def motion_error(self) -> float | None:
        """Bound at the laws, in m, of how far any phase is from the solution of its equations.

        ``None`` for methods with steps, infinite where there is no bound.
        """
    @property
    def missed_penetration(self) -> float | None:
        """Deepest penetration that rounding could have hidden from the certificate, in m."""
    @property
    def event_count(self) -> int: ...
    @property
    def seconds(self) -> float:
        """Core time spent so far on this run: integration and everything read since."""
    def motion(self, times: Array, derivative: int) -> Array:
        """Modal displacement (0), velocity (1) or acceleration (2), shape (time, mode)."""
    def project(self, row: Array, times: Array, derivative: int) -> Array:
        """One linear combination of the modal coordinates, (time,), as cheap as it can be."""
    def law_motion(self, law: int, times: Array) -> tuple[Array, Array, Array]:
        """Distance in m, its rate in m/s, and force in N of one law, each (time,)."""
    def law_forces(self, law: int, times: Array) -> Array:
        """Force of one law along each of its coordinates in N, (time, coordinate)."""
    def contact_forces(self, law: int, times: Array) -> Array:
        """Return the force along the normal of the contact and across it, (time, 3)."""

    def states(self, time: float) -> list[tuple[int, int, float, float]]:
        """States of all laws: number, part of the obstacle and both internal variables."""
    def internal_variables(self, law: int, times: Array) -> Array:
        """Return what a law remembers, brought up to the motion, (time, 2); NaN where nothing."""
    def law_states(self, law: int, times: Array) -> list[str]:
        """Name of one law's state at each time."""
    def energy(self, times: Array) -> dict[str, Array]:
        """Ledger terms in J.

        ``kinetic``, ``elastic``, ``modal_dissipation``, ``load_work`` are (time,);
        ``law_stored`` and ``law_dissipated`` are (law, time).
        """
    def energy_residual(self) -> float:
        """Largest imbalance of the ledger relative to the largest energy seen."""
    def events(self) -> dict[str, list[float] | list[int] | list[str]]:
        """Columns ``time``, ``law`` (index), ``guard``, ``before``, ``after``."""
    def impacts(self, law: int) -> dict[str, Array]:
        """Impacts of one stop, in the order of closing.

        Columns ``start``, ``end`` (NaN while still closed), ``closing_speed``,
        ``opening_speed``, ``peak_force``, ``peak_time``, ``impulse``,
        ``energy_absorbed``, ``energy_returned``.
        """

class FullProblem:
    """A structure of N dofs, with laws that see the kept ones of them, (K,)."""

    def __init__(
        self,
        matrices: Sequence[Columns],
        forcing: Forcing,
        start: Array,
        kept: NDArray[np.intp],
        laws: Sequence[Law],
        obstacles: Forcing,
        duration: float,
    ) -> None:
        """Take mass, damping and stiffness, loads on all dofs and the start, (2, N).

        The rows of the laws are over the kept dofs, and so is ``obstacles``, which has no forces
        but the motions of obstacles.
        """
    def stability_limit(self, method: str, parameters: Mapping[str, float]) -> float:
        """Largest stable step in s, with every stop closed; it may be inf."""
    def simulate(
        self,
        method: str,
        dt: float,
        beyond_stability_limit: bool,
        parameters: Mapping[str, float],
        progress: Callable[[float], None] | None,
    ) -> History:
        """Integrate; releases the GIL. The history has the motion of the kept dofs."""

def simulate(
    system: System,
    laws: Sequence[Law],
    forcing: Forcing,
    displacement: Array,
    velocity: Array,
    duration: float,
    method: str,
    dt: float | None = None,
    beyond_stability_limit: bool = False,
    tolerances: tuple[float, float | None] | None = None,
    parameters: Mapping[str, float] | None = None,
    progress: Callable[[float], None] | None = None,
    exact_flights: bool = True,
    states: Sequence[tuple[int, int, float, float]] | None = None,
) -> History:
    """Integrate; releases the GIL.

    ``method`` is ``exact``, one with fixed steps, which needs ``dt`` and may have ``parameters``,
    ``rk32``, ``rk54``, ``dop853`` or ``exprk43``, which need ``tolerances``, the relative and the
    absolute one, or ``adaptive_central_difference``, with its own parameter. Those with tolerances
    leave flights between smooth contacts to the exact method if ``exact_flights``.
    ``progress`` is called with the fraction done, about ten times a second. ``states`` are those
    of the laws at t = 0, as `History.states` tells them; the motion decides where left out.
    """

def stability_limit(
    system: System,
    laws: Sequence[Law],
    method: str,
    parameters: Mapping[str, float] | None = None,
) -> float:
    """Largest stable step of a fixed-step method with every stop closed, in s; it may be inf."""

class Quantity:
    """Something that is kept of each run of a batch: one number, or one an instant."""

    @staticmethod
    def motion(row: Array, derivative: int, times: Array) -> Quantity:
        """Displacement (0), velocity (1) or acceleration (2) of ``row . q``."""
    @staticmethod
    def law(law: int, what: str, times: Array) -> Quantity:
        """``distance`` in m, its ``rate`` in m/s or the ``force`` in N of a law."""
    @staticmethod
    def energy(term: str, times: Array) -> Quantity:
        """Return a term of the ledger, in J."""
    @staticmethod
    def extreme(of: Quantity, statistic: str) -> Quantity:
        """Return the ``maximum``, ``minimum`` or ``peak`` of a quantity of time.

        Its instants are samples; the value is looked for between those next to the largest.
        """
    @staticmethod
    def impacts(law: int, column: str, statistic: str | None = None, impact: int = 0) -> Quantity:
        """Return a number of an impact, counted from 0, or a statistic of those of all.

        ``maximum``, ``minimum``, ``peak`` or ``last``; NaN where there is none.
        """
    @staticmethod
    def last_impacts(law: int, column: str, count: int) -> Quantity:
        """Return a number of each of the last impacts; NaN in front where there are fewer."""
    @staticmethod
    def largest_force(law: int) -> Quantity:
        """Return the largest force of a law, in N; NaN where it never pushes."""
    @staticmethod
    def impact_count(law: int | None = None) -> Quantity:
        """How many impacts there are on a law, or on all."""
    @staticmethod
    def of_run(name: str) -> Quantity:
        """``events``, ``steps``, ``energy_residual``, ``motion_error``, ``missed_penetration``."""

def batch(
    system: System,
    laws: Sequence[Law],
    forcing: Forcing,
    displacement: Array,
    velocity: Array,
    duration: float,
    quantities: Sequence[Quantity],
    runs: int,
    stops: Sequence[tuple[int, str, Array]],
    displacements: tuple[bool, Array] | None = None,
    velocities: tuple[bool, Array] | None = None,
    loads: Array | None = None,
    pace: Array | None = None,
    chain: int = 1,
    lanes: bool = False,
    threads: int = 1,
    progress: Callable[[float], None] | None = None,
) -> tuple[Array, list[tuple[int, str]]]:
    """Make many runs by the exact method; releases the GIL.

    ``stops`` are (law, ``gap``, ``stiffness`` or ``damping``, one value a run), all of plain
    stops. ``displacements`` and ``velocities`` are (True, factors of those of the problem) or
    (False, a number for each mode of each run, run by run); ``loads`` are factors.
    ``pace`` tells how many times as fast loads are; runs and instants are as much shorter. Of each
    ``chain`` of runs each but the first starts where the one before it ended. With ``lanes`` eight
    runs are made at a time where all of them are of the common shape. Returns the numbers of
    each run, (run, number), and those runs that failed, each with its message.
    """
