"""Forces in a beam under a force that travels along it, against closed forms and equilibrium."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bumpstop as bs
from bumpstop.structure.dofs import DOFS

LENGTH, FORCE, ELEMENTS = 20.0, 5e4, 6
STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
GIRDER = bs.Rectangle(height=0.4, width=0.8)  # the width stands along z
KNOT = LENGTH / (64 * ELEMENTS)
"""Between these places a run follows the shapes along straight lines."""
PINS = (
    bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx")),
    bs.Support(nodes="B", fixed=("dy", "dz")),
)


def bridge(
    modes: int = 3, supports: tuple[bs.Support, ...] = PINS, end: bs.Rectangle | None = None
) -> bs.ModalBasis:
    beam = bs.Beam(
        "AB",
        nodes=("A", "B"),
        elements=ELEMENTS,
        material=STEEL,
        section=GIRDER,
        end_section=end,
    )
    model = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)}, beams=[beam], supports=supports
    )
    return bs.ModalBasis.from_structure(model, modes=modes, damping=0.7)


def crossing(places: np.ndarray, speed: float = 1e-6) -> bs.Recovery:
    """So slow that what the beam does is what it does at rest."""
    axle = bs.MovingForce("axle", beam="AB", force=(0, 0, -FORCE), speed=speed)
    run = bs.simulate(bs.Problem(bridge(), loads=[axle], duration=LENGTH / abs(speed)))
    gone = places if speed > 0.0 else LENGTH - places
    return bs.recovery(run.at(gone / abs(speed)))


def moments(x: float, s: np.ndarray) -> np.ndarray:
    """The moment at x by the place of the force: x (L - s) / L beyond x, s (L - x) / L before it.

    A beam that sags is bent the negative way about y.
    """
    return -FORCE * np.where(s > x, x * (LENGTH - s), s * (LENGTH - x)) / LENGTH


@pytest.mark.parametrize("speed", [1e-6, -1e-6])
def test_influence_lines_of_a_hinged_beam(speed: float) -> None:
    places = KNOT * np.array([1, 40, 99, 100, 150, 192, 193, 200, 300, 383])
    found = crossing(places, speed)
    for x in (0.3, 100.5 * KNOT, 10.01, 13.1):
        forces = found.section_forces("AB", x)
        assert_allclose(forces["My"], moments(x, places), rtol=0, atol=1e-7 * FORCE * LENGTH / 4)
        # What is beyond the section stands on B, less the axle where it is there.
        beyond = np.where(places > x, 1.0, 0.0)
        assert_allclose(forces["Vz"], FORCE * (places / LENGTH - beyond), rtol=0, atol=1e-7 * FORCE)
    reaction = found.reactions("B")["dz"]
    assert_allclose(reaction, FORCE * places / LENGTH, rtol=0, atol=1e-7 * FORCE)


def test_stresses_and_deflections_under_the_axle_itself() -> None:
    """F s2 (L - s)2 / 3 E I L and F s (L - s) / k G A L at s, wherever that is in its element."""
    places = KNOT * np.array([20, 100, 150, 250])
    found = crossing(places)
    inertia, shear = 0.4 * 0.8**3 / 12, STEEL.shear_modulus * GIRDER.area * GIRDER.shear_factors[1]
    for number, s in enumerate(places.tolist()):
        moment = FORCE * s * (LENGTH - s) / LENGTH
        stress = found.stress("AB", s, (0.0, -0.4)).values[number]
        assert_allclose(stress, 0.4 * moment / inertia, rtol=1e-6)
        bent = moment * s * (LENGTH - s) / (3.0 * 210e9 * inertia) + moment / shear
        assert_allclose(found.displacement(f"AB@{s!r}", "dz").values[number], -bent, rtol=1e-6)


def test_between_the_knots_only_what_the_modes_feel_is_followed_by_straight_lines() -> None:
    places = KNOT * np.array([20.5, 100.5, 150.3])
    found = crossing(places)
    for x in (places[1], 11.0):
        bent = found.section_forces("AB", float(x))["My"]
        assert_allclose(bent, moments(float(x), places), rtol=0, atol=1e-5 * np.abs(bent).max())


@pytest.mark.parametrize("end", [None, bs.Rectangle(height=0.3, width=0.3)])
def test_a_fast_axle_leaves_every_node_in_equilibrium(end: bs.Rectangle | None) -> None:
    """A pulsating force on a cantilever that hits a stop, entering and leaving within the run."""
    clamp = (bs.Support(nodes="A", fixed=DOFS),)
    basis = bridge(4, clamp, end)
    axle = bs.MovingForce(
        "axle",
        beam="AB",
        force=(2e3, 3e3, -FORCE),
        speed=80.0,
        enters=0.05,
        time=bs.Harmonic(6.0, cosine=1.0),
    )
    stop = bs.Stop("stop", node="AB.4", normal=(0, 0, 1), gap=1e-3, stiffness=1e7)
    run = bs.simulate(bs.Problem(basis, loads=[axle], laws=[stop], duration=0.4, sample=1.7e-3))
    assert len(run.impacts) > 0
    found = bs.recovery(run)
    model = found.forces.model
    lacking = found.lacking(run.times)
    largest = np.abs(lacking).max()
    assert np.abs(lacking[model.free]).max() < 1e-12 * largest
    sums = found.resultants()
    assert_allclose(sums["residual"], 0.0, atol=1e-12 * largest * LENGTH)
    on = (run.times >= 0.05) & (run.times <= 0.05 + LENGTH / 80.0)
    wave = np.where(on, np.cos(12.0 * np.pi * run.times), 0.0)
    # The sums are those of the force itself, but for what the straight lines miss.
    assert_allclose(sums["load"].sel(dof="dz"), -FORCE * wave, rtol=0, atol=1e-3 * FORCE)


def test_what_is_before_and_behind_the_axle_hangs_together() -> None:
    """The shear force jumps by the force where it is, and by nothing elsewhere."""
    basis = bridge(4)
    axle = bs.MovingForce("axle", beam="AB", force=(0, 0, -FORCE), speed=50.0)
    found = bs.recovery(bs.simulate(bs.Problem(basis, loads=[axle], duration=0.3)).at([0.17]))
    s, step = 8.5, 1e-9
    for x, jump in ((s, FORCE), (3.3, 0.0), (LENGTH / ELEMENTS, 0.0), (12.0, 0.0)):
        shear = found.section_forces("AB", [x - step, x + step])["Vz"].values[0]
        assert_allclose(np.diff(shear), jump, atol=1e-5 * FORCE)
