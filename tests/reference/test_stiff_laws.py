"""Laws up to a trillion times stiffer than the structure: slow motions keep all their digits.

The judge takes eigenvectors of the state matrix in fifty digits, of which the stiffness of the
floor costs the structure's twelve. Floors on which something slides are up to ten billion times
stiffer: their force, known to the rounding of the displacement times the stiffness, tells where
sliding ends and decides there.
"""

import mpmath
import numpy as np
import pytest

from .problem import Array
from .several.laws.friction_stop import FrictionStop
from .several.loads import Harmonic, Polynomial
from .several.problem import SeveralStops, Stop

RATIOS = (1e4, 1e7, 1e10)
STIFFEST = 1e12
SAMPLES = np.linspace(0.1, 0.99, 5)
FRICTION = 0.3
LONG_ENOUGH = 0.05


def on_a_floor(seed: int, modes: int, ratio: float, damping: float) -> SeveralStops:
    """Return modes pressed on a floor, moving along it, under loads of all kinds.

    ``damping`` is the floor's, relative to ``sqrt(k)``.
    """
    rng = np.random.default_rng(seed)
    omega = np.sort(10 ** rng.uniform(0, 1, modes))
    row, push = rng.normal(size=(2, modes))
    row /= np.linalg.norm(row)
    stiffest = float(omega[-1] ** 2)
    stiffness = ratio * stiffest
    gap = -0.01
    along = push - row * (row @ push)
    return SeveralStops(
        omega2=omega**2,
        damping=0.02 * omega,
        stops=(Stop(row, gap, stiffness, damping * float(np.sqrt(stiffness))),),
        duration=1.0,
        displacement=-row * (gap + 0.9 * stiffest / stiffness),
        velocity=2.0 * float(omega.mean()) * along,
        force=-row * stiffest,
        loads=(Harmonic(0.1 * along, 3.0, 0.4), Polynomial(0.05 * push, (0.0, 1.0))),
    )


def rubbing(problem: SeveralStops, seed: int) -> SeveralStops:
    """Return the same with friction on the floor."""
    (stop,) = problem.stops
    tangent = np.random.default_rng([seed, 1]).normal(size=stop.row.size)
    tangent /= np.linalg.norm(tangent)
    stick = 4.0 * float(problem.omega2.max())
    return problem.but(stops=(), others=(FrictionStop(stop, tangent, FRICTION, FRICTION, stick),))


class OnTheFloor:
    """The motion while the floor pushes a row: a particular solution and eigenvectors."""

    def __init__(self, problem: SeveralStops, stop: Stop, pushed: Array) -> None:
        """Read the equations."""
        n = problem.omega2.size
        self.n = n
        stiffness, damper = mpmath.mpf(stop.stiffness), mpmath.mpf(stop.damping)
        self.stiffness = mpmath.diag(column(problem.omega2))
        self.damping = mpmath.diag(column(problem.damping))
        for i in range(n):
            for j in range(n):
                both = mpmath.mpf(pushed[i]) * mpmath.mpf(stop.row[j])
                self.stiffness[i, j] += stiffness * both
                self.damping[i, j] += damper * both
        self.force = column(problem.force) - stiffness * mpmath.mpf(stop.gap) * column(pushed)
        self.harmonic, self.ramp = problem.loads

    def particular(self, t: mpmath.mpf) -> tuple[mpmath.matrix, mpmath.matrix]:
        """Return position and velocity of the motion that the loads and nothing else make."""
        assert isinstance(self.harmonic, Harmonic)
        k, c = self.stiffness, self.damping
        rate = mpmath.lu_solve(k, column(self.ramp.shape))
        rest = mpmath.lu_solve(k, self.force - c * rate)
        omega = mpmath.mpf(self.harmonic.frequency)
        dynamic = k + 1j * omega * c - omega**2 * mpmath.eye(self.n)
        turn = mpmath.expj(omega * t + mpmath.mpf(self.harmonic.phase))
        swing = turn * mpmath.lu_solve(dynamic, column(self.harmonic.shape))
        real = swing.apply(mpmath.re), (1j * omega * swing).apply(mpmath.re)
        return rest + t * rate + real[0], rate + real[1]

    def motion(self, displacement: Array, velocity: Array, since: float, times: Array) -> Array:
        """Return displacements at times after an instant of which the state is given."""
        n, start = self.n, mpmath.mpf(since)
        matrix = mpmath.zeros(2 * n)
        for i in range(n):
            matrix[i, n + i] = 1
            for j in range(n):
                matrix[n + i, j] = -self.stiffness[i, j]
                matrix[n + i, n + j] = -self.damping[i, j]
        exponents, vectors = mpmath.eig(matrix)
        position, rate = self.particular(start)
        own = [*(column(displacement) - position), *(column(velocity) - rate)]
        amplitudes = mpmath.lu_solve(vectors, mpmath.matrix(own))
        found = []
        for t in column(times):
            turned = [mpmath.exp(e * t) * a for e, a in zip(exponents, amplitudes, strict=True)]
            free = (vectors * mpmath.matrix(turned)).apply(mpmath.re)
            whole = self.particular(start + t)[0] + free[:n, 0]
            found.append([float(x) for x in whole])
        return np.array(found)


def column(values: Array) -> mpmath.matrix:
    """Return numbers as they are, in many digits."""
    return mpmath.matrix([mpmath.mpf(float(x)) for x in values])


def error(found: Array, expected: Array) -> float:
    """Return the largest difference, relative to the largest displacement."""
    return float(np.abs(found - expected).max() / np.abs(expected).max())


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize(("seed", "modes"), [(3, 6), (5, 4)])
def test_slides_on_stiff_floors_keep_their_digits(seed: int, modes: int, ratio: float) -> None:
    """A modal structure slides on a floor, from the instant at which it does so for long."""
    problem = rubbing(on_a_floor(seed, modes, ratio, 0.1), seed)
    law = problem.laws[0]
    assert isinstance(law, FrictionStop)
    history = problem.solve()
    events = dict(history.events())
    times = np.append(events["time"], problem.duration)
    long = np.flatnonzero(np.diff(times) > LONG_ENOUGH)
    after = [str(state) for state in events["after"]]
    slides = [i for i in long if after[i].startswith("slip")]
    assert slides
    since, until = times[slides[0]], times[slides[0] + 1]
    sign = 1.0 if "forward" in after[slides[0]] else -1.0
    with mpmath.workdps(50):
        pushed = law.normal.row - sign * law.dynamic * law.tangent
        judge = OnTheFloor(problem, law.normal, pushed)
        start = [history.motion(np.array([since]), order)[0] for order in (0, 1)]
        samples = SAMPLES * (until - since)
        expected = judge.motion(start[0], start[1], since, samples)
    assert error(history.motion(since + samples, 0), expected) < 1e-13


@pytest.mark.parametrize("ratio", [*RATIOS, STIFFEST])
@pytest.mark.parametrize(("seed", "modes"), [(1, 4), (3, 10)])
def test_heavily_damped_stiff_stops_keep_their_digits(seed: int, modes: int, ratio: float) -> None:
    """A stop whose damper lets nothing swing holds a modal structure."""
    problem = on_a_floor(seed, modes, ratio, 3.0)
    (stop,) = problem.stops
    history = problem.solve()
    until = float(np.append(history.events()["time"], problem.duration)[0])
    with mpmath.workdps(50):
        judge = OnTheFloor(problem, stop, stop.row)
        times = SAMPLES * until
        expected = judge.motion(problem.displacement, problem.velocity, 0.0, times)
    assert error(history.motion(times, 0), expected) < 1e-13


@pytest.mark.parametrize("ratio", [*RATIOS, STIFFEST])
@pytest.mark.parametrize(("seed", "modes"), [(1, 4), (3, 10)])
def test_stiff_stops_without_dampers_keep_their_digits(seed: int, modes: int, ratio: float) -> None:
    """A stop that nothing damps swings beneath a modal structure."""
    problem = on_a_floor(seed, modes, ratio, 0.0)
    (stop,) = problem.stops
    history = problem.solve()
    until = float(np.append(history.events()["time"], problem.duration)[0])
    with mpmath.workdps(50):
        judge = OnTheFloor(problem, stop, stop.row)
        times = SAMPLES * until
        expected = judge.motion(problem.displacement, problem.velocity, 0.0, times)
    assert error(history.motion(times, 0), expected) < 1e-13
