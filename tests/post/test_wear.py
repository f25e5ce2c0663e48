"""Wear of contacts whose force and sliding are known."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

import bumpstop as bs
from bumpstop.arguments import FloatArray
from bumpstop.post.wear import WearWork

WEIGHT, SPEED, FREQUENCY = 30.0, 0.6, 2.0
YEAR = 3.15576e7


def swinging(**friction: Any) -> bs.Response:
    """A mass of 1 kg rests on a floor with its weight, and swings along it."""
    shapes = {("P", "dx"): [1.0, 0.0], ("P", "dz"): [0.0, 1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[FREQUENCY, 0.0], shapes=shapes)
    floor = bs.Stop(
        "floor", node="P", normal=(0, 0, 1), gap=-WEIGHT / 1e6, stiffness=1e6, **friction
    )
    weight = bs.NodalForce("weight", node="P", force=(0, 0, -WEIGHT))
    start = bs.ModalState(velocity=[SPEED, 0.0])
    problem = bs.Problem(basis, laws=[floor], loads=[weight], initial=start, duration=1.5)
    return bs.simulate(problem)


@pytest.fixture(scope="module")
def run() -> bs.Response:
    return swinging()


def test_work_is_force_times_path(run: bs.Response) -> None:
    """Twelve quarter periods, each of the amplitude v / w."""
    found = bs.wear_work(run, "floor")
    path = 12.0 * SPEED / (2.0 * math.pi * FREQUENCY)
    assert found.distance == pytest.approx(path, rel=1e-9)
    assert found.work == pytest.approx(WEIGHT * path, rel=1e-9)
    assert found.rate == pytest.approx(WEIGHT * path / 1.5, rel=1e-9)


def test_a_part_of_the_time(run: bs.Response) -> None:
    found = bs.wear_work(run, "floor", start=0.25, end=0.5)
    assert found.distance == pytest.approx(2.0 * SPEED / (2.0 * math.pi * FREQUENCY), rel=1e-9)
    assert found.time == 0.25


def test_bouncing_and_sliding_at_an_angle() -> None:
    """A body bounces on a floor along which it flies: force and path are those of the contacts."""
    shapes = {
        ("P", dof): [float(i == k) for i in range(3)] for k, dof in enumerate(("dx", "dy", "dz"))
    }
    basis = bs.ModalBasis.from_modes(frequency=[0.0, 0.0, 0.0], shapes=shapes)
    floor = bs.Stop("floor", node="P", normal=(0, 0, 1), gap=0.0, stiffness=1e4)
    start = bs.ModalState(velocity=[0.3, 0.4, -0.2])
    run = bs.simulate(bs.Problem(basis, laws=[floor], initial=start, duration=0.1))
    found = bs.wear_work(run, "floor")
    assert found.work == pytest.approx(0.5 * run.impacts["impulse"][0], rel=1e-12)
    assert found.distance == pytest.approx(0.5 * run.impacts["duration"][0], rel=1e-12)


def test_sliding_friction_dissipates_its_share() -> None:
    """Only what slides wears: the friction's loss is its coefficient times the work."""
    run = swinging(friction=0.2, sliding=(1, 0, 0), tangential_stiffness=1e7)
    found = bs.wear_work(run, "floor")
    lost = run.energy_terms([1.5])["dissipated_stops"][0]
    # The node's sliding is the contact's but for the rate of the tangential spring, which the
    # force, constant while it slides, does not stretch.
    assert 0.2 * found.work == pytest.approx(lost, rel=1e-6)
    assert found.distance < bs.wear_work(swinging(), "floor").distance


def test_archard(run: bs.Response) -> None:
    rate = bs.wear_work(run, "floor").rate
    found = bs.wear(run, "floor", bs.ArchardWear(2e-14), [0.0, YEAR, 10.0 * YEAR])
    assert_allclose(found["volume"], 2e-14 * rate * np.array([0.0, YEAR, 10.0 * YEAR]), rtol=1e-14)
    assert found["volume"].attrs["units"] == "m^3"
    assert found.attrs["work_rate"] == rate
    assert "depth" not in found


def test_edf_slows_down(run: bs.Response) -> None:
    """The volume is the integral of a rate that falls from A W^b to S."""
    law = bs.EdfWear(coefficient=3e-13, exponent=1.1, threshold=2e-16, slowing=4e-8)
    rate = bs.wear_work(run, "floor").rate
    first = 3e-13 * rate**1.1
    at = 2.0 * YEAR
    expected, _ = quad(lambda t: 2e-16 + (first - 2e-16) * math.exp(-4e-8 * t), 0.0, at, epsabs=0)
    found = bs.wear(run, "floor", law, [at])
    assert float(found["volume"][0]) == pytest.approx(expected, rel=1e-10)
    with pytest.raises(bs.InputError, match="above the rate of wear at first"):
        bs.wear(run, "floor", bs.EdfWear(coefficient=1e-20), [at])


def sampled(force: list[float], speed: list[float]) -> WearWork:
    weight = np.full(len(force), 1.0 / len(force))
    columns: list[FloatArray] = [np.array(force), np.array(speed), weight]
    return WearWork(2.0, 1.0, 4.0, *columns)


def test_kwu_epri_sorts_force_and_speed() -> None:
    law = bs.KwuEpriWear(1e-15, impact=0.3, sliding=0.7, hardening=5.0, reference_force=10.0)
    # Classes are 20 N and 0.2 m/s wide: middles 10 ... 90 N, 0.1 ... 0.9 m/s.
    work = sampled([100.0, 95.0, 5.0, 30.0], [0.05, 1.0, 0.5, 0.01])
    struck = 0.25 * 0.3 * 5.0 * (9.0**3 + 3.0**3)
    rubbed = 0.25 * 0.7 * (90.0 * 0.9**2 + 10.0 * 0.5**2)
    factor = rubbed**2 / (rubbed + struck)
    assert law.factor(work) == pytest.approx(factor, rel=1e-12)
    volume = law.volume(work, np.array([8.0]))
    assert volume[0] == pytest.approx(1e-15 * factor * 0.5 * 8.0, rel=1e-12)
    assert law.factor(sampled([100.0], [0.0])) == 0.0


def test_kwu_epri_of_a_run(run: bs.Response) -> None:
    """The force is even: its class is the highest; speeds are those of a cosine."""
    law = bs.KwuEpriWear(1e-15, impact=1.0, sliding=1.0)
    middles = SPEED * (np.arange(5) + 0.5) / 5
    angles = np.arcsin(np.arange(6) / 5) / (0.5 * math.pi)
    part = np.diff(angles)
    rubbed = 0.9 * WEIGHT * float(part[1:] @ middles[1:] ** 2)
    struck = part[0] * 5.0 * (0.9 * WEIGHT / 10.0) ** 3
    expected = rubbed**2 / (rubbed + struck)
    assert law.factor(bs.wear_work(run, "floor")) == pytest.approx(expected, rel=2e-2)


class TestScars:
    radius, hole, length = 0.011, 0.0114, 0.025

    def test_a_pad(self) -> None:
        assert bs.PadScar(2e-4).depth(1e-9) == pytest.approx(5e-6, rel=1e-15)

    @pytest.mark.parametrize("depth", [1e-9, 1e-6, 3e-4, 5e-3, 0.02])
    def test_a_flat(self, depth: float) -> None:
        r = self.radius
        area, _ = quad(
            lambda h: 2.0 * math.sqrt(h * (2.0 * r - h)), 0.0, depth, epsabs=0, epsrel=1e-12
        )
        scar = bs.FlatScar(radius=r, length=self.length)
        assert scar.depth(area * self.length) == pytest.approx(depth, rel=1e-9)

    @pytest.mark.parametrize("depth", [1e-7, 1e-5, 3e-4, 2e-3])
    def test_a_crescent(self, depth: float) -> None:
        """In polar coordinates about the tube's middle: the tube's edge less the hole's."""
        r, hole = self.radius, self.hole
        apart = hole - r + depth

        def width(angle: float) -> float:
            edge = -apart * math.cos(angle) + math.sqrt(hole**2 - (apart * math.sin(angle)) ** 2)
            return 0.5 * max(r * r - edge * edge, 0.0)

        end = math.acos((hole**2 - r**2 - apart**2) / (2.0 * apart * r))
        area, _ = quad(width, 0.0, end, epsabs=0, epsrel=1e-11)
        scar = bs.HoleScar(radius=r, hole_radius=hole, length=self.length)
        assert scar.depth(2.0 * area * self.length) == pytest.approx(depth, rel=1e-6)

    def test_a_wide_hole_is_a_plane(self) -> None:
        wide = bs.HoleScar(radius=self.radius, hole_radius=1e3, length=self.length)
        flat = bs.FlatScar(radius=self.radius, length=self.length)
        assert wide.depth(1e-9) == pytest.approx(flat.depth(1e-9), rel=1e-4)

    def test_no_more_than_there_is(self) -> None:
        scar = bs.FlatScar(radius=self.radius, length=self.length)
        assert scar.depth(0.0) == 0.0
        with pytest.raises(bs.InputError, match=r"volume: is more than there is .*\(got 1\.5\)"):
            scar.depth(1.5)

    def test_a_hole_is_wider_than_its_tube(self) -> None:
        with pytest.raises(bs.InputError, match="more than the tube's"):
            bs.HoleScar(radius=0.01, hole_radius=0.01, length=1.0)


def test_depth_of_a_run(run: bs.Response) -> None:
    scar = bs.FlatScar(radius=0.01, length=0.02)
    found = bs.wear(run, "floor", bs.ArchardWear(1e-15), [YEAR], scar=scar)
    volume = float(found["volume"][0])
    assert float(found["depth"][0]) == pytest.approx(scar.depth(volume), rel=1e-14)


def test_refuses() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    wall = bs.RigidStop("wall", node="P", normal=(1, 0, 0), gap=0.0, restitution=1.0)
    start = bs.ModalState(velocity=[-0.5])
    rigid = bs.simulate(bs.Problem(basis, laws=[wall], initial=start, duration=2.0))
    with pytest.raises(bs.InputError, match="is rigid"):
        bs.wear_work(rigid, "wall")
    # Nor where it comes to rest, and is loaded for a time.
    damped = replace(wall, restitution=0.3)
    weight = bs.NodalForce("weight", node="P", force=(-50.0, 0, 0))
    problem = bs.Problem(basis, laws=[damped], loads=[weight], initial=start, duration=2.0)
    resting = bs.simulate(problem)
    assert float(bs.contact_impacts(resting, "wall")["contact_time"].max()) > 0.5
    with pytest.raises(bs.InputError, match="is rigid"):
        bs.wear_work(resting, "wall")
    sum_of_dofs = bs.Stop("sum", terms={("P", "dx"): 1.0}, stiffness=1e3)
    run = bs.simulate(bs.Problem(basis, laws=[sum_of_dofs], initial=start, duration=1.0))
    with pytest.raises(bs.InputError, match="no known direction"):
        bs.wear_work(run, "sum")
