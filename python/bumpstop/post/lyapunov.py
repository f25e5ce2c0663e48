"""Lyapunov exponents: how fast neighbouring motions part, from the variational equations.

Between switches a piecewise-linear problem is linear, and the difference of two neighbouring
motions goes with the exponential of its matrix, whatever the loads are. At a switch it jumps by a
saltation matrix (P. C. Müller, Chaos, Solitons & Fractals 5 (1995) 1671-1681; R. I. Leine and H.
Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, Springer, 2004, chapter 7):

    S = G + (f+ - G f-) h' / (dh/dt)

with the jump G of the state by impact, the rates f of the state before and after, and the gradient
h' and the rate dh/dt of the guard. Exponents are those of orthonormal vectors that are made
orthonormal anew after each switch (G. Benettin and others, Meccanica 15 (1980) 9-30).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray, count, not_negative
from bumpstop.canonical import velocity_matrix
from bumpstop.errors import InputError
from bumpstop.laws.damper import DamperLaw
from bumpstop.laws.rigid_stop import RigidStop
from bumpstop.laws.spring import SpringLaw
from bumpstop.laws.stop import Stop
from bumpstop.post.impacts import impacts_of
from bumpstop.post.of_run import of_run
from bumpstop.turning import turned_basis

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.response import Response

__all__ = ["LyapunovExponents", "lyapunov_exponents"]

LONGEST = 0.5
"""Of a stretch between two renormalisations, in periods of the slowest mode."""
SEED = 1
"""Of the first vectors: any will do that are not special."""


@dataclass(frozen=True, eq=False)
class LyapunovExponents:
    """What `lyapunov_exponents` found.

    Attributes
    ----------
    values
        The largest exponents in 1/s, falling, (k,); positive where motions part: chaos.
    times
        Instants in s, (n,).
    running
        Estimates from the start up to these instants, (n, k).
    """

    values: FloatArray
    times: FloatArray = field(repr=False)
    running: FloatArray = field(repr=False)

    @property
    def largest(self) -> float:
        """The largest exponent in 1/s."""
        return float(self.values[0])

    @cached_property
    def convergence(self) -> xr.DataArray:
        """The running estimates over ``time`` and ``exponent``, counted from 1."""
        import xarray as xr

        return xr.DataArray(
            self.running,
            dims=("time", "exponent"),
            coords={
                "time": ("time", self.times, {"units": "s", "long_name": "time"}),
                "exponent": np.arange(1, len(self.values) + 1),
            },
            name="lyapunov",
            attrs={"units": "1/s", "long_name": "Lyapunov exponent"},
        )


@of_run
def lyapunov_exponents(
    response: Response, *, exponents: int = 1, start: float = 0.0
) -> LyapunovExponents:
    """Return the largest Lyapunov exponents of a motion.

    Parameters
    ----------
    response
        A run of the exact method whose laws are stops without friction, rigid stops that do not
        come to rest, and springs and dampers of one or several slopes. What rubs or yields has
        states beside the motion, and is not taken.
    exponents
        How many, at most twice the number of modes.
    start
        When to begin, in s: the transient before it is left out.

    Raises
    ------
    InputError
        If a law rubs, rests or remembers, laws switch together, or the method is another one.

    Examples
    --------
    Without impacts the exponents of an oscillator are those of its decay.

    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[1.0], damping=0.1, shapes={("P", "dx"): [1.0]})
    >>> run = bs.simulate(bs.Problem(basis, duration=200.0))
    >>> found = bs.lyapunov_exponents(run, exponents=2)
    >>> print((found.values.sum() / (-2 * 0.1 * 2 * np.pi)).round(9))
    1.0
    """
    modes = len(response.problem.basis.omega2)
    wanted = count("exponents", exponents)
    if wanted > 2 * modes:
        raise InputError(f"must be at most {2 * modes}", key="exponents", value=exponents)
    if not_negative("start", start) >= response.problem.duration:
        raise InputError("must be before the end of the run", key="start", value=start)
    motion = _Tangents(response)
    scale = motion.scale
    vectors = np.linalg.qr(np.random.default_rng(SEED).normal(size=(2 * modes, wanted)))[0]
    growth, times, running = np.zeros(wanted), [], []
    for step in motion.steps(start):
        moved = step.jump @ (motion.propagator(step) @ (vectors / scale[:, np.newaxis]))
        vectors, upper = np.linalg.qr(scale[:, np.newaxis] * moved)
        growth += np.log(np.abs(upper.diagonal()))
        times.append(step.end)
        running.append(growth / (step.end - start))
    order = np.argsort(-running[-1], kind="stable")
    history = np.array(running)[:, order]
    return LyapunovExponents(history[-1], np.array(times), history)


class _Step(NamedTuple):
    """A stretch of time without switch, and the jump of differences at its end."""

    start: float
    end: float
    jump: FloatArray


class _Switch(NamedTuple):
    time: float
    law: int
    jumps: bool
    """Whether forces may jump at it: at impacts, and at closings of gaps. Where a damper that
    held the push back lets a stop push again, the force rises from zero."""


class _Tangents:
    """The linear motion of differences from a run, in displacements and velocities."""

    def __init__(self, response: Response) -> None:
        if response.method != "exact":
            what = "must be a run of the exact method, whose switches are exact"
            raise InputError(what, key="response", value=response.method)
        self._response = response
        basis = response.problem.basis
        self._laws = response.problem.laws
        self._rows = [self._row(number) for number in range(len(self._laws))]
        self._damping = velocity_matrix(turned_basis(response.problem))
        self._stiffness = np.diag(basis.omega2)
        if basis.circulatory is not None:
            self._stiffness = self._stiffness + basis.circulatory
        self._known: dict[tuple[object, ...], FloatArray] = {}

    @property
    def scale(self) -> FloatArray:
        """What makes displacements velocities, (2 N,): norms of energies."""
        omega = np.sqrt(np.abs(self._response.problem.basis.omega2))
        moving = omega[omega > 0.0]
        usual = float(moving.min()) if len(moving) else 1.0
        return np.concatenate([np.where(omega > 0.0, omega, usual), np.ones(len(omega))])

    def steps(self, start: float) -> list[_Step]:
        """Return the stretches from a start to the end of the run."""
        identity = np.eye(2 * len(self._damping))
        omega = self.scale[: len(self._damping)].min()
        longest = LONGEST * 2.0 * np.pi / omega
        switches = [switch for switch in self._switches() if switch.time > start]
        steps, now = [], start
        for switch in [*switches, None]:
            end = self._response.problem.duration if switch is None else switch.time
            pieces = max(int(np.ceil((end - now) / longest)), 1)
            marks = np.linspace(now, end, pieces + 1).tolist()
            jump = identity if switch is None else self._jump(switch)
            jumps = [identity] * (pieces - 1) + [jump]
            steps += [_Step(*each) for each in zip(marks[:-1], marks[1:], jumps, strict=True)]
            now = end
        return [step for step in steps if step.end > step.start]

    def propagator(self, step: _Step) -> FloatArray:
        """Return how differences move along a stretch, (2 N, 2 N)."""
        from scipy.linalg import expm

        matrix = self._matrix(0.5 * (step.start + step.end))
        moved: FloatArray = expm(matrix * (step.end - step.start))
        return moved

    def _matrix(self, time: float) -> FloatArray:
        """Return the matrix of the linear motion at an instant, (2 N, 2 N)."""
        slopes = tuple(self._slopes(number, time) for number in range(len(self._laws)))
        if slopes not in self._known:
            stiffness, damping = self._stiffness.copy(), self._damping.copy()
            for row, (spring, damper) in zip(self._rows, slopes, strict=True):
                stiffness += spring * np.outer(row, row)
                damping += damper * np.outer(row, row)
            zero, one = np.zeros_like(damping), np.eye(len(damping))
            self._known[slopes] = np.block([[zero, one], [-stiffness, -damping]])
        return self._known[slopes]

    def _slopes(self, number: int, time: float) -> tuple[float, float]:
        """Return stiffness and damping of a law at an instant."""
        law, history = self._laws[number], self._response.history
        at = np.array([time])
        if isinstance(law, SpringLaw):
            deformation = float(history.law_motion(number, at)[0][0])
            segment = int(np.searchsorted(law.breaks, deformation))
            return law.stiffness[segment], law.damping
        if isinstance(law, DamperLaw):
            speed = float(history.law_motion(number, at)[1][0])
            return 0.0, law.damping[int(np.searchsorted(law.breaks, speed))]
        if isinstance(law, Stop) and history.law_states(number, at)[0] == "closed":
            return law.stiffness, law.damping
        return 0.0, 0.0

    def _switches(self) -> list[_Switch]:
        events = self._response.event_table()
        names = [law.name for law in self._laws]
        found = [
            _Switch(
                time,
                names.index(str(law)),
                guard == "impact" or (before, after) == ("open", "closed"),
            )
            for time, law, guard, before, after in zip(
                np.array(events["time"], dtype=float).tolist(),
                events["law"],
                events["guard"],
                events["before"],
                events["after"],
                strict=True,
            )
        ]
        for one, other in pairwise(found):
            if one.time == other.time and one.law != other.law:
                what = "two laws switch together, where neighbouring motions have no order"
                raise InputError(what, key="response", value=f"t = {one.time:g} s")
        return found

    def _jump(self, switch: _Switch) -> FloatArray:
        """Return how differences jump at a switch, (2 N, 2 N)."""
        law, row = self._laws[switch.law], self._rows[switch.law]
        modes = len(row)
        jump = np.eye(2 * modes)
        if isinstance(law, RigidStop):
            return self._impact(law, row, switch.time)
        if isinstance(law, Stop) and switch.jumps:
            # The damper's force sets in with the speed: (f+ - f-) / (dh/dt) is -c row.
            jump[modes:, :modes] = -law.damping * np.outer(row, row)
        return jump

    def _impact(self, law: RigidStop, row: FloatArray, time: float) -> FloatArray:
        """Return how differences jump where velocities do."""
        at = np.array([time])
        after = self._response.motion(1, at)[0]
        across = np.outer(row, row) / float(row @ row)
        mirror = np.eye(len(row)) - (1.0 + law.restitution) * across
        speed = float(row @ after) / law.restitution
        before = after - (1.0 + law.restitution) * speed * row / float(row @ row)
        damping = -self._matrix(np.nextafter(time, np.inf))[len(row) :, len(row) :]
        rate_after = self._response.motion(2, at)[0]
        rate_before = rate_after + damping @ (after - before)
        turned = np.outer(mirror @ rate_before - rate_after, row) / speed
        zero = np.zeros_like(mirror)
        return np.block([[mirror, zero], [turned, mirror]])

    def _row(self, number: int) -> FloatArray:
        """Return the row of a law whose differences can be followed."""
        law, basis = self._laws[number], self._response.problem.basis
        if isinstance(law, Stop) and law.friction is None:
            return law.row(basis)
        # Forces without jumps: neither do differences jump where their slopes change.
        if isinstance(law, SpringLaw | DamperLaw):
            return law.row(basis)
        if isinstance(law, RigidStop):
            if law.restitution == 0.0:
                what = "leaves no difference of neighbouring motions"
                raise InputError(what, key="restitution", value=law.restitution)
            if np.any(impacts_of(self._response, number)["duration"] != 0.0):
                what = "comes to rest, where neighbouring motions become one"
                raise InputError(what, key="law", value=law.name)
            return law.row(basis)
        what = "remembers more than displacements and velocities: no differences are followed"
        if isinstance(law, Stop):
            what = "rubs, and its slider is a state of its own: no differences are followed"
        hint = "stops without friction, rigid ones, and springs and dampers of slopes are taken"
        raise InputError(what, key="law", value=law.name, hint=hint)
