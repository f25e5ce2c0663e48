"""Forces on shafts whose speed changes: equilibrium, reactions, and the constant speed."""

import numpy as np
import pytest

import bumpstop as bs

STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7850.0)
MOMENT = 2e-3
TERMS = ("lagrange", "fixed_axis", "none")


def run(
    rotation: bs.ShaftRotation, *, stop: bool = True, damping: float = 0.01, duration: float = 0.1
) -> bs.Response:
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
    basis = bs.ModalBasis.from_structure(structure, modes=6, damping=damping)
    load = bs.Unbalance("unbalance", node="M", rotation=rotation, moment=MOMENT)
    law = bs.Stop("stop", node="M", normal=(0, -1, 0), gap=2e-5, stiffness=1e6)
    laws = [law] if stop else []
    problem = bs.Problem(
        basis, laws=laws, loads=[load], rotation=rotation, duration=duration, sample=duration / 100
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


@pytest.mark.parametrize("terms", TERMS)
def test_slices_between_nodes_turn_as_their_angular_momentum_does(terms: str) -> None:
    """Of a slice: ``[M] + x cross V = d/dt (I theta' + Ip Omega t)`` with the shaft's tangent t.

    The last term is Ip (Omega theta_z' + alpha theta_z) about y, and the opposite of the like about
    z; ``"lagrange"`` has the part of alpha about y alone, ``"none"`` has none.
    """
    rotation = bs.ShaftRotation(bs.Polynomial([50.0, 2e6]), acceleration_terms=terms)
    response = run(rotation, stop=False, damping=0.0, duration=2e-3)
    found = bs.recovery(response)
    ends = np.array([0.02, 0.11])  # within the first element
    nodes, weights = np.polynomial.legendre.leggauss(8)
    places = ends.mean() + 0.5 * np.ptp(ends) * nodes
    weights = 0.5 * np.ptp(ends) * weights
    section = bs.Circle(radius=0.01)
    inertia = STEEL.density * section.inertia_y
    at_ends = found.section_forces("left", ends.tolist())
    along = found.section_forces("left", places.tolist())
    speed = (50.0 + 2e6 * response.times)[:, np.newaxis]
    about_y, about_z = {"lagrange": (1.0, 0.0), "fixed_axis": (1.0, 1.0), "none": (0.0, 0.0)}[terms]

    def motion(kind: str, dof: str) -> np.ndarray:
        return np.stack([response.sample(kind, f"left@{x!r}", dof) for x in places.tolist()], 1)

    for moment, shear, sign, own, other, part in (
        ("My", "Vz", 1.0, "dry", "drz", about_y),
        ("Mz", "Vy", -1.0, "drz", "dry", about_z),
    ):
        change = np.diff(at_ends[moment].values, axis=1)[:, 0]
        left = change - sign * along[shear].values @ weights
        spinning = speed * motion("velocity", other) + part * 2e6 * motion("displacement", other)
        gained = inertia * (motion("acceleration", own) + sign * 2.0 * spinning)
        assert left == pytest.approx(gained @ weights, abs=1e-9 * np.abs(left).max())
        accelerated = 2.0 * inertia * 2e6 * motion("displacement", other) @ weights
        assert np.abs(accelerated).max() > 1e-4 * np.abs(left).max()


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
