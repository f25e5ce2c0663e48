"""Stops between two nodes, on rotations, and on sums of dofs."""

import math

import numpy as np
import pytest

import bumpstop as bs


def test_two_masses_bounce_off_each_other() -> None:
    """A moving mass meets an equal one at rest: they swap velocities within half a period."""
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0, 0.0],
        damping=[0.0, 0.0],
        shapes={("A", "dx"): [1.0, 0.0], ("B", "dx"): [0.0, 1.0]},
    )
    between = bs.Stop("buffer", node="B", other="A", normal=(1, 0, 0), gap=2e-3, stiffness=1e6)
    initial = bs.ModalState(displacement=[0.0, 0.0], velocity=[0.5, 0.0])
    response = bs.simulate(bs.Problem(basis, laws=[between], initial=initial, duration=0.02))
    (start,), (duration,) = (response.impact_table()[key] for key in ("start", "duration"))
    assert start == pytest.approx(4e-3, rel=1e-13)
    assert duration == pytest.approx(math.pi / math.sqrt(2e6), rel=1e-12)
    velocities = [response.sample("velocity", node, "dx", times=[0.02])[0] for node in "AB"]
    assert velocities == pytest.approx([0.0, 0.5], abs=1e-13)
    assert response.energy_residual < 1e-13


def test_backlash_of_gears_is_a_sum_of_rotations() -> None:
    """The teeth meet where r1 theta1 + r2 theta2 has used up the backlash."""
    inertia, radius = np.array([2e-3, 8e-3]), np.array([0.05, 0.1])
    scale = 1.0 / np.sqrt(inertia)
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0, 0.0],
        damping=[0.0, 0.0],
        shapes={("pinion", "drz"): [scale[0], 0.0], ("wheel", "drz"): [0.0, scale[1]]},
    )
    teeth = bs.Stop(
        "teeth",
        terms={("pinion", "drz"): -radius[0], ("wheel", "drz"): -radius[1]},
        gap=1e-4,
        stiffness=1e7,
    )
    spin = 3.0
    initial = bs.ModalState(displacement=[0.0, 0.0], velocity=[spin / scale[0], 0.0])
    response = bs.simulate(bs.Problem(basis, laws=[teeth], initial=initial, duration=0.01))
    (impact,) = response.impact_table()["start"]
    assert impact == pytest.approx(1e-4 / (radius[0] * spin), rel=1e-13)
    # An elastic impact along the line of action with the masses J / r^2.
    masses = inertia / radius**2
    line = radius[0] * spin
    after = line * (masses[0] - masses[1]) / masses.sum(), line * 2 * masses[0] / masses.sum()
    rates = [
        response.sample("velocity", node, "drz", times=[0.01])[0] for node in ("pinion", "wheel")
    ]
    assert rates == pytest.approx([after[0] / radius[0], -after[1] / radius[1]], rel=1e-12)


def test_point_within_a_beam() -> None:
    """A stop at a quarter of a pinned beam feels the shapes there."""
    steel = bs.Material(young_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
    structure = bs.Structure(
        nodes={"A": (0.0, 0.0, 0.0), "B": (1.0, 0.0, 0.0)},
        beams=[
            bs.Beam(
                "AB",
                nodes=("A", "B"),
                elements=8,
                theory="euler_bernoulli",
                material=steel,
                section=bs.Rectangle(height=0.01, width=0.02),
            )
        ],
        supports=[
            bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry")),
            bs.Support(nodes=("A", "B"), fixed=("dy",)),
        ],
    )
    basis = bs.ModalBasis.from_structure(structure, modes=3, damping=0.0)
    stop = bs.Stop("guide", node="AB@0.3", normal=(0, 1, 0), gap=1e-4, stiffness=1e5)
    shapes = [math.sin(n * math.pi * 0.3) for n in (1, 2, 3)]
    row = np.abs(stop.row(basis))
    expected = np.abs(shapes) * math.sqrt(2 / (7800.0 * 0.01 * 0.02))
    assert row == pytest.approx(expected, rel=2e-3)


def test_case_file_says_the_same(tmp_path: object) -> None:
    from pathlib import Path

    path = Path(str(tmp_path)) / "case.toml"
    path.write_text(
        """
[nodes]
A = [0, 0, 0]
B = ["0.1 m", 0, 0]
[masses.a]
node = "A"
mass = 1.0
[masses.b]
node = "B"
mass = 1.0
[[supports]]
nodes = "all"
fixed = ["dz", "drx", "dry", "drz"]
[basis]
modes = 4
rigid_modes = 4
[stops.buffer]
node = "B"
other = "A"
normal = [1, 0, 0]
gap = "2 mm"
stiffness = "1 MN/m"
friction = { static = 0.3, dynamic = 0.2 }
tangential_stiffness = "1 MN/m"
tangential_damping = 3.0
[stops.sum]
terms = { A.dx = 1.0, B.dx = "50 cm" }
gap = 1.0
stiffness = 10.0
[laws.pad]
type = "spring"
node = "A"
direction = [0, 1, 0]
stiffness = ["1 kN/m", 0, "2 kN/m"]
breaks = ["-1 mm", "1 mm"]
damping = 2.0
[laws.curve]
type = "spring"
node = "B"
direction = [0, 1, 0]
curve = [[0, 0], ["1 mm", "5 N"], ["3 mm", 45]]
[run]
duration = 0.01
"""
    )
    (problem,) = bs.load_case(path).problems.values()
    buffer, total, pad, curve = problem.laws
    friction = bs.Friction(0.3, 0.2)
    assert buffer == bs.Stop(
        "buffer",
        node="B",
        other="A",
        normal=(1, 0, 0),
        gap=2e-3,
        stiffness=1e6,
        friction=friction,
        tangential_stiffness=1e6,
        tangential_damping=3.0,
    )
    terms = {("A", "dx"): 1.0, ("B", "dx"): 0.5}
    assert total == bs.Stop("sum", terms=terms, gap=1.0, stiffness=10.0)
    assert pad == bs.SpringLaw(
        "pad",
        node="A",
        direction=(0, 1, 0),
        stiffness=(1e3, 0.0, 2e3),
        breaks=(-1e-3, 1e-3),
        damping=2.0,
    )
    assert isinstance(curve, bs.SpringLaw)
    assert curve.stiffness == pytest.approx((5e3, 2e4))
    assert bs.simulate(problem).energy_residual < 1e-12
