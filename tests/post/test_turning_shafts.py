"""Forces on shafts whose speed changes: equilibrium, reactions, and the constant speed."""

import numpy as np
import pytest

import bumpstop as bs

STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7850.0)
MOMENT = 2e-3
TERMS = ("lagrange", "fixed_axis", "none")


def run(rotation: bs.ShaftRotation, *, stop: bool = True) -> bs.Response:
    """Return the run of a shaft with a disc out of centre, with a stop at it."""
    ends = bs.Support(nodes=("A", "B"), fixed=("dx", "dy", "dz"))
    turn = bs.Support(nodes="A", fixed=("drx",))
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "M": (0.4, 0, 0), "B": (0.8, 0, 0)},
        beams=[
            bs.Beam(
                name,
                nodes=nodes,
                elements=3,
                material=STEEL,
                section=bs.Circle(radius=0.01),
                spin=1.0,
            )
            for name, nodes in (("left", ("A", "M")), ("right", ("M", "B")))
        ],
        supports=[ends, turn],
    )
    basis = bs.ModalBasis.from_structure(structure, modes=6, damping=0.01)
    load = bs.Unbalance("unbalance", node="M", rotation=rotation, moment=MOMENT)
    law = bs.Stop("stop", node="M", normal=(0, -1, 0), gap=2e-5, stiffness=1e6)
    laws = [law] if stop else []
    problem = bs.Problem(
        basis, laws=laws, loads=[load], rotation=rotation, duration=0.1, sample=1e-3
    )
    return bs.simulate(problem, method="dop853")


@pytest.mark.parametrize("terms", TERMS)
def test_a_run_up_with_unbalance_and_a_stop_is_in_equilibrium(terms: str) -> None:
    rotation = bs.ShaftRotation(bs.Polynomial([50.0, 2000.0]), acceleration_terms=terms)
    response = run(rotation)
    sums = bs.recovery(response).resultants()
    for dofs in (["dx", "dy", "dz"], ["drx", "dry", "drz"]):
        some = sums.sel(dof=dofs)
        scale = max(float(abs(some[name]).max()) for name in ("load", "inertia", "reaction"))
        assert float(abs(some["residual"]).max()) <= 1e-8 * max(scale, 1.0)
    assert float(abs(sums["law"]).max()) > 1.0


def test_bearings_carry_the_unbalance_less_the_inertia() -> None:
    rotation = bs.ShaftRotation(bs.Polynomial([50.0, 2000.0]))
    response = run(rotation, stop=False)
    found = bs.recovery(response)
    times = response.times
    speed, angle = 50.0 + 2000.0 * times, 50.0 * times + 1000.0 * times**2
    load = MOMENT * (speed**2 * np.cos(angle) + 2000.0 * np.sin(angle))
    sums = found.resultants().sel(dof="dy")
    rest = (sums["inertia"] + sums["damping"]).values
    both = sum(found.reactions(node)["dy"].values for node in "AB")
    assert both == pytest.approx(-(load + rest), abs=1e-8 * abs(load).max())


def test_a_table_of_one_speed_is_the_constant_speed() -> None:
    table = bs.TimeTable(times=[0.0, 0.2], values=[60.0, 60.0 * (1.0 + 1e-12)])
    runs = [run(bs.ShaftRotation(speed), stop=False) for speed in (60.0, table)]
    steady, changing = (bs.recovery(each).reactions("A")["dy"].values for each in runs)
    assert changing == pytest.approx(steady, abs=1e-5 * abs(steady).max())
