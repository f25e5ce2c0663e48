"""Three problems: a force with a kink, one that jumps, and several stops."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

import bumpstop as bs
from benchmarks.sdnl32_problems import beam
from bumpstop.canonical import canonical_form
from tests.reference.problem import Array

INSTANTS = 50


@dataclass(frozen=True)
class Watched:
    """A problem of modes and stops, with the displacement that is watched."""

    title: str
    told: str
    problem: bs.Problem
    node: str
    dof: str

    @property
    def times(self) -> Array:
        """Instants in s at which errors are measured, (T,)."""
        return np.linspace(0.0, self.problem.duration, INSTANTS + 1)[1:]

    @cached_property
    def row(self) -> Array:
        """The watched displacement of each mode, (N,)."""
        return self.problem.basis.row(self.node, self.dof)

    @cached_property
    def stops(self) -> list[bs.Stop]:
        """The stops."""
        return [law for law in self.problem.laws if isinstance(law, bs.Stop)]

    @cached_property
    def exact(self) -> Array:
        """The watched displacement by the exact method, (T,)."""
        response = bs.simulate(self.problem, "exact")
        return response.sample("displacement", self.node, self.dof, times=self.times)

    @cached_property
    def start(self) -> tuple[Array, Array]:
        """Modal displacement and velocity at t = 0, each (N,)."""
        form = canonical_form(self.problem)
        return form.displacement, form.velocity

    def error(self, found: Array) -> float:
        """Return the largest error of the watched displacement, over the largest of it."""
        return float(np.abs(found - self.exact).max() / np.abs(self.exact).max())


def _sdnl32() -> Watched:
    stop = bs.Stop("stop", node="B", normal=(0, 1, 0), stiffness=45e3)
    swing = bs.RigidRotation(about="A", rate=(0, 0, -3.8))
    problem = bs.Problem(beam(), laws=[stop], initial=swing, duration=0.02)
    told = "Ten modes, one stop of 45 kN/m: its force has a kink where the beam leaves it."
    return Watched("SDNL32", told, problem, "B", "dy")


def _damped() -> Watched:
    basis = bs.ModalBasis.from_modes(
        frequency=[12.0, 55.0, 130.0], damping=0.01, shapes={("P", "dx"): [1.0, -0.8, 0.5]}
    )
    stop = bs.Stop("stop", node="P", normal=(-1, 0, 0), gap=2e-3, stiffness=2e5, damping=60.0)
    state = bs.ModalState(velocity=[0.5, 0.0, 0.1])
    problem = bs.Problem(basis, laws=[stop], initial=state, duration=0.1)
    told = "Three modes, one stop with a damper: its force jumps where it closes."
    return Watched("A damped stop", told, problem, "P", "dx")


def _several() -> Watched:
    numbers = np.arange(1, 6)
    places = {f"P{at}": np.sin(np.pi * numbers * at / 5.0).tolist() for at in (1, 2, 3, 4)}
    basis = bs.ModalBasis.from_modes(
        frequency=(8.0 * numbers**2).tolist(),
        damping=0.005,
        shapes={(node, "dx"): row for node, row in places.items()},
    )
    stops = [
        bs.Stop(f"s{node}", node=node, normal=(side, 0, 0), gap=gap, stiffness=1e5)
        for node, side, gap in (
            ("P1", -1, 3e-3),
            ("P2", 1, 4e-3),
            ("P3", -1, 5e-3),
            ("P4", 1, 2e-3),
        )
    ]
    state = bs.ModalState(velocity=[0.6, -0.3, 0.1, 0.0, 0.0])
    problem = bs.Problem(basis, laws=stops, initial=state, duration=0.15)
    told = "Five modes of a tube between four stops on both sides, some of them closed together."
    return Watched("Four stops", told, problem, "P2", "dx")


PROBLEMS = (_sdnl32(), _damped(), _several())
