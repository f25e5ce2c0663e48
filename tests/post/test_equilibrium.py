"""Equilibrium of every node at every instant, with each of the laws that there are."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.problem import Law, Load
from bumpstop.structure.dofs import DOFS

STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = bs.Rectangle(height=0.02, width=0.01)
TIP, AXIS = "B", (1, 0, 0)


def program(_step: int, q: float, _v: float) -> float:
    """A program outside: a spring that answers from step to step."""
    return -900.0 * q


LAWS: dict[str, Callable[[], Law]] = {
    "stop": lambda: bs.Stop(
        "law", node=TIP, normal=(0, -1, 0), gap=1e-4, stiffness=3e4, damping=9.0
    ),
    "friction": lambda: bs.Stop(
        "law",
        node=TIP,
        normal=(0, -1, 0),
        gap=1e-4,
        stiffness=3e4,
        friction=0.2,
        sliding=(0, 0, 1),
        tangential_stiffness=2e4,
    ),
    "circle": lambda: bs.CircleStop(
        "law",
        node=TIP,
        axis=AXIS,
        radius=1.1e-3,
        body_radius=1e-3,
        stiffness=3e4,
        friction=0.2,
        tangential_stiffness=2e4,
    ),
    "polygon": lambda: bs.PolarStop(
        "law",
        node=TIP,
        axis=AXIS,
        profile=[(0.8 + n * np.pi / 2, 2e-4) for n in range(4)],
        stiffness=3e4,
    ),
    "plane": lambda: bs.PlaneStop(
        "law",
        node=TIP,
        normal=(0, -1, 0),
        gap=1e-4,
        stiffness=3e4,
        friction=0.2,
        tangential_stiffness=2e4,
    ),
    "hertz": lambda: bs.HertzStop("law", node=TIP, normal=(0, -1, 0), gap=1e-4, stiffness=3e6),
    "buckling": lambda: bs.BucklingStop(
        "law", node=TIP, normal=(0, -1, 0), stiffness=3e4, critical_force=3.0, post_force=2.0
    ),
    "rigid": lambda: bs.RigidStop("law", node=TIP, normal=(0, -1, 0), gap=1e-4, restitution=0.6),
    "spring": lambda: bs.SpringLaw(
        "law", node=TIP, direction=(0, 1, 0), stiffness=(800.0, 9000.0), breaks=(1e-4,)
    ),
    "damper": lambda: bs.DamperLaw(
        "law", node=TIP, direction=(0, 1, 0), damping=(30.0, 2.0), breaks=(0.0,)
    ),
    "relation": lambda: bs.ForceRelation(
        "law", node=TIP, direction=(0, 1, 0), force="-900 * x - 2e9 * x**3 - 2 * v"
    ),
    "device": lambda: bs.SeismicDevice(
        "law",
        node=TIP,
        direction=(0, 1, 0),
        first_stiffness=6e3,
        second_stiffness=900.0,
        threshold=2.0,
        damping=3.0,
        exponent=0.5,
        stroke=1e-3,
    ),
    "hardening": lambda: bs.HardeningSpring(
        "law", node=TIP, direction=(0, 1, 0), curve=[(1e-4, 2.0), (2e-3, 3.0)]
    ),
    "zener": lambda: bs.ZenerDamper(
        "law",
        node=TIP,
        direction=(0, 1, 0),
        series_stiffness=3e3,
        parallel_stiffness=500.0,
        branch_stiffness=900.0,
        damping=20.0,
        exponent=0.7,
    ),
    "user": lambda: bs.UserLaw(
        "law",
        node=TIP,
        direction=(0, 1, 0),
        further_directions=[(0, 0, 1)],
        force=lambda q, v, t: -(900.0 + 100.0 * np.cos(t)) * q - 2.0 * v,
    ),
}


WAVE = bs.Harmonic(11.0, sine=1.0)
LOADS: dict[str, Callable[[], Load]] = {
    "force": lambda: bs.NodalForce("load", node="AB@0.5", force=(0, 9, 4), time=WAVE),
    "line": lambda: bs.LineForce("load", beam="AB", force=(0, -2.0, 1.0), start=0.1, end=1.0),
    "gravity": lambda: bs.Gravity("load", acceleration=(0, -9.81, 3.0)),
    "moving": lambda: bs.MovingForce("load", beam="AB", force=(0, 9, 4), speed=13.0),
    "base": lambda: bs.BaseMotion(acceleration=(0, 5.0, 2.0), time=WAVE),
    "support": lambda: bs.SupportMotion("load", nodes="A", displacement=(0, 1e-3, 2e-4), time=WAVE),
    "turbulence": lambda: bs.Turbulence(
        "load",
        beam="AB",
        direction=(0, 1, 0),
        density=bs.SpectralDensity(frequencies=[1.0, 100.0], values=[1.0, 1.0]),
        correlation_length=0.3,
        seed=7,
        period=0.5,
    ),
}


def response(
    law: Law, method: str = "auto", dt: float | None = None, loads: Sequence[Load] = ()
) -> bs.Response:
    """A cantilever that is shaken in two directions, with a law at its tip."""
    beam = bs.Beam("AB", nodes=("A", "B"), elements=4, material=STEEL, section=BAR)
    plane = bs.Support(nodes="all", fixed=("dx", "drx"))
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1.2, 0, 0)},
        beams=[beam],
        supports=[plane, bs.Support(nodes="A", fixed=DOFS)],
    )
    basis = bs.ModalBasis.from_structure(structure, modes=4, damping=0.02)
    shaken = bs.NodalForce("f", node=TIP, force=(0, 9, 4), time=WAVE)
    weight = bs.LineForce("w", beam="AB", force=(0, -2.0, 1.0), start=0.1, end=1.0)
    given = list(loads) or [shaken, weight]
    problem = bs.Problem(basis, laws=[law], loads=given, duration=0.12, sample=1e-3)
    return bs.simulate(problem, method, dt=dt)


def lack(run: bs.Response) -> float:
    """The largest force that a free dof lacks, relative to the largest elastic one."""
    found = bs.recovery(run)
    model = found.forces.model
    sizes = model.stiffness.magnitudes() @ np.abs(found.field(run.times))
    return float(np.abs(found.lacking(run.times)[model.free]).max() / sizes.max())


@pytest.mark.parametrize("name", LAWS)
def test_every_node_is_in_equilibrium(name: str) -> None:
    run = response(LAWS[name]())
    assert np.abs(run.sample("stop_force", "law")).max() > 0.1  # else the law is not tested
    assert lack(run) < 1e-12


@pytest.mark.parametrize("name", LOADS)
def test_every_node_is_in_equilibrium_under_every_load(name: str) -> None:
    run = response(LAWS["stop"](), loads=[LOADS[name]()])
    assert np.abs(run.sample("displacement", TIP, "dy")).max() > 1e-6
    assert lack(run) < 1e-12


@pytest.mark.parametrize("method", ["central_difference", "newmark", "dop853"])
def test_other_methods_are_in_equilibrium_too(method: str) -> None:
    run = response(LAWS["stop"](), method, None if method == "dop853" else 2e-5)
    assert lack(run) < 1e-12


def test_a_program_outside_is_in_equilibrium() -> None:
    law = bs.OutsideProgram("law", node=TIP, direction=(0, 1, 0), exchange=program)
    run = response(law, "symplectic_euler", dt=2e-5)
    assert np.abs(run.sample("stop_force", "law")).max() > 0.1
    assert lack(run) < 1e-12


@pytest.mark.parametrize("name", ["friction", "circle", "stop"])
def test_a_response_that_was_read_is_in_equilibrium(name: str, tmp_path: Path) -> None:
    run = response(LAWS[name]())
    run.to_netcdf(tmp_path / "run.nc")
    again = bs.read_netcdf(tmp_path / "run.nc")
    assert again.equals(run)
    assert lack(again) < 1e-12
