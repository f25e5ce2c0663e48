"""The energy ledger of every law closes: to rounding where it is exact, else to the tolerance."""

from __future__ import annotations

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.structure.dofs import DOFS

from .sound import SOUND

FREQUENCIES = (3.0, 4.0, 5.0, 2.0, 2.5, 3.5)
SPEEDS = (-0.5, 0.3, 0.2, 0.1, 0.1, 0.1)
"""Along and about each axis, so that each law is met, rubbed on, turned or torn."""
EXACT = ("Stop", "SpringLaw", "DamperLaw", "HardeningSpring")


def met(name: str) -> bs.Problem:
    """Return a body on springs in all directions that meets a law."""
    law, given = SOUND[name]
    shapes = {("P", dof): np.eye(6)[number].tolist() for number, dof in enumerate(DOFS)}
    basis = bs.ModalBasis.from_modes(frequency=FREQUENCIES, damping=0.01, shapes=shapes)
    start = bs.ModalState(velocity=SPEEDS)
    return bs.Problem(basis, laws=[law("law", **given)], initial=start, duration=1.0)


@pytest.mark.parametrize("name", EXACT)
def test_exact_runs_close_theirs_to_rounding(name: str) -> None:
    run = bs.simulate(met(name), "exact")
    assert np.abs(run.sample("stop_force", "law")).max() > 1.0
    assert run.energy_residual < 1e-13


@pytest.mark.parametrize("method", ["rk54", "dop853"])
@pytest.mark.parametrize("name", [name for name in SOUND if name != "RigidStop"])
def test_adaptive_runs_close_theirs_to_their_tolerance(name: str, method: str) -> None:
    run = bs.simulate(met(name), method, rtol=1e-12)
    assert np.abs(run.sample("stop_force", "law")).max() > 1.0
    assert run.energy_residual < 1e-10


def test_rigid_stops_close_theirs_to_rounding() -> None:
    """Without friction, which time stepping alone takes."""
    law = bs.RigidStop("law", node="P", normal=(1, 0, 0), restitution=0.5)
    problem = met("Stop")
    run = bs.simulate(
        bs.Problem(problem.basis, laws=[law], initial=problem.initial, duration=1.0), "exact"
    )
    assert len(run.impacts) > 3
    assert run.energy_residual < 1e-13
