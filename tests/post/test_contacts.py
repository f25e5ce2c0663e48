"""Impacts as they are counted, on motions whose contacts are half sines."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bumpstop as bs

STIFFNESS, SPEED = 1e4, 0.5
OMEGA = math.sqrt(STIFFNESS)
PEAK = OMEGA * SPEED
"""A free mass of 1 kg that hits with 0.5 m/s presses by a half sine of this height."""


def between_walls(duration: float = 2.0) -> bs.Response:
    """A mass flies to and fro between two walls 0.1 m from its start."""
    basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("P", "dx"): [1.0]})
    walls = [
        bs.Stop(name, node="P", normal=(side, 0, 0), gap=0.1, stiffness=STIFFNESS)
        for name, side in (("left", 1), ("right", -1))
    ]
    start = bs.ModalState(velocity=[-SPEED])
    return bs.simulate(bs.Problem(basis, laws=walls, initial=start, duration=duration))


FLIGHT, CONTACT = 0.2 / SPEED, math.pi / OMEGA
PERIOD = 2.0 * (FLIGHT + CONTACT)


@pytest.fixture(scope="module")
def response() -> bs.Response:
    return between_walls()


def test_without_threshold_they_are_the_contacts(response: bs.Response) -> None:
    counted = bs.contact_impacts(response, "left")
    contacts = response.impacts.query("stop == 'left'")
    for name in ("start", "end", "duration", "closing_speed", "peak_force", "impulse"):
        assert counted[name].tolist() == contacts[name].tolist()
    assert counted["rebounds"].tolist() == [0.0] * len(contacts)
    assert counted.attrs["units"]["impulse"] == "N s"


def test_a_threshold_cuts_the_half_sine(response: bs.Response) -> None:
    counted = bs.contact_impacts(response, "left", threshold=0.3 * PEAK)
    late = math.asin(0.3) / OMEGA
    starts = 0.1 / SPEED + PERIOD * np.arange(3)
    assert_allclose(counted["start"][:2], starts[:2] + late, rtol=1e-13)
    assert_allclose(counted["duration"][:2], CONTACT - 2.0 * late, rtol=1e-12)
    assert_allclose(counted["peak_force"][:2], PEAK, rtol=1e-12)
    assert_allclose(counted["peak_time"][:2], starts[:2] + CONTACT / 2.0, rtol=1e-7)
    assert_allclose(counted["closing_speed"][:2], SPEED * math.sqrt(1 - 0.09), rtol=1e-12)
    assert_allclose(counted["impulse"][:2], 2.0 * SPEED * math.sqrt(1 - 0.09), rtol=1e-12)


def test_no_impact_above_the_highest_peak(response: bs.Response) -> None:
    assert len(bs.contact_impacts(response, "left", threshold=1.001 * PEAK)) == 0


def test_a_rest_time_merges_rebounds(response: bs.Response) -> None:
    pause = PERIOD - CONTACT
    apart = bs.contact_impacts(response, "left", rest=0.999 * pause)
    merged = bs.contact_impacts(response, "left", rest=1.001 * pause)
    assert len(apart) == 3
    assert len(merged) == 1
    assert merged["rebounds"][0] == 2.0
    assert merged["impulse"][0] == pytest.approx(apart["impulse"].sum(), rel=1e-14)
    assert merged["contact_time"][0] == pytest.approx(apart["contact_time"].sum(), rel=1e-14)


def test_an_impact_under_way_has_no_end() -> None:
    cut = bs.contact_impacts(between_walls(0.2 + 0.25 * CONTACT), "left")
    assert math.isnan(cut["end"][0])
    assert cut["contact_time"][0] == pytest.approx(0.25 * CONTACT, rel=1e-10)


def test_two_peaks_of_one_contact_are_told_apart() -> None:
    """A light mass on a spring in front of a heavy one: the force of the contact has two humps."""
    shapes = {("P", "dx"): [1.0, 1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[2.0, 11.0], shapes=shapes)
    wall = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=0.0, stiffness=800.0)
    start = bs.ModalState(velocity=[-0.6, -0.4])
    problem = bs.Problem(basis, laws=[wall], initial=start, duration=0.2, sample=1e-5)
    response = bs.simulate(problem)
    force = response.sample("stop_force", "wall")
    inside = np.flatnonzero((force[1:-1] > force[:-2]) & (force[1:-1] > force[2:])) + 1
    dips = np.flatnonzero((force[1:-1] < force[:-2]) & (force[1:-1] <= force[2:])) + 1
    dips = dips[force[dips] > 0.0]
    assert len(dips) == 1  # else the case is not what its name says
    threshold = 0.5 * (force[dips[0]] + force[inside].min())
    assert len(response.impacts) < len(bs.contact_impacts(response, "wall", threshold=threshold))
    counted = bs.contact_impacts(response, "wall", threshold=threshold)
    sampled = bs.sampled_impacts(response.times, force, threshold=threshold)
    assert len(counted) == len(sampled)
    assert_allclose(counted["start"], sampled["start"], atol=1.1e-5)
    assert_allclose(counted["duration"], sampled["duration"], atol=1.1e-5)
    assert_allclose(counted["peak_force"], sampled["peak_force"], rtol=1e-6)
    assert_allclose(counted["impulse"], sampled["impulse"], rtol=1e-3)


def test_a_threshold_means_nothing_for_rigid_stops() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    wall = bs.RigidStop("wall", node="P", normal=(1, 0, 0), gap=0.0, restitution=1.0)
    start = bs.ModalState(velocity=[-0.5])
    run = bs.simulate(bs.Problem(basis, laws=[wall], initial=start, duration=2.0))
    with pytest.raises(bs.InputError, match="no finite force"):
        bs.contact_impacts(run, "wall", threshold=1.0)


def thrown(damping: float, *, method: str = "exact", **options: Any) -> bs.Response:
    """A free mass of 1 kg hits a stop with a damper, once."""
    basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("P", "dx"): [1.0]})
    wall = bs.Stop(
        "wall", node="P", normal=(1, 0, 0), gap=0.1, stiffness=STIFFNESS, damping=damping
    )
    start = bs.ModalState(velocity=[-SPEED])
    problem = bs.Problem(basis, laws=[wall], initial=start, duration=0.5)
    return bs.simulate(problem, method=method, **options)


@pytest.mark.parametrize("ratio", [0.1, 0.5, 0.95])
def test_an_impact_ends_where_the_damper_holds_the_push_back(ratio: float) -> None:
    """The force k d + c d' of a decaying sine vanishes before the gap opens."""
    response = thrown(2.0 * ratio * OMEGA)
    root = math.sqrt(1.0 - ratio**2)
    loaded = math.atan2(2.0 * ratio * root, 2.0 * ratio**2 - 1.0) / (OMEGA * root)
    counted = bs.contact_impacts(response, "wall")
    assert counted["duration"][0] == pytest.approx(loaded, rel=1e-12)
    assert counted["contact_time"][0] == pytest.approx(loaded, rel=1e-12)
    assert counted["peak_force"][0] == response.impacts["peak_force"][0]
    found = bs.contact_statistics(response, "wall")
    assert found["contact_fraction"] == pytest.approx(loaded / 0.5, rel=1e-12)
    momentum = float(response.sample("velocity", "P", "dx", times=[0.5])[0]) + SPEED
    assert found["mean_force_in_contact"] == pytest.approx(momentum / loaded, rel=1e-10)


@pytest.mark.parametrize("method", ["newmark", "dop853"])
def test_other_methods_end_impacts_there_too(method: str) -> None:
    options = {"dt": 1e-5} if method == "newmark" else {}
    exact = bs.contact_impacts(thrown(100.0), "wall")
    other = bs.contact_impacts(thrown(100.0, method=method, **options), "wall")
    assert_allclose(other["duration"], exact["duration"], rtol=1e-4)


def test_a_stop_that_pushes_again_while_the_gap_is_closed() -> None:
    """A load presses a soft damped stop to and fro: two pushes in one closing of the gap."""
    basis = bs.ModalBasis.from_modes(
        frequency=[1.0, 9.3], damping=0.02, shapes={("P", "dx"): [1.0, 1.0]}
    )
    wall = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=0.01, stiffness=149.0, damping=12.9)
    load = bs.NodalForce("l", node="P", force=(600.0, 0, 0), time=bs.Harmonic(7.29, cosine=1.0))
    push = bs.NodalForce("p", node="P", force=(-50.0, 0, 0))
    problem = bs.Problem(basis, laws=[wall], loads=[load, push], duration=3.0, sample=1e-4)
    response = bs.simulate(problem)
    counted = bs.contact_impacts(response, "wall")
    force = response.sample("stop_force", "wall")
    sampled = bs.sampled_impacts(response.times, force)
    assert len(counted) == len(sampled) > len(response.impacts)
    for name in ("start", "end", "contact_time", "peak_time"):
        assert_allclose(counted[name], sampled[name], atol=1.1e-4, err_msg=name)
    # One peak is that of the damper at the closing itself, between two samples.
    assert_allclose(counted["peak_force"], sampled["peak_force"], rtol=2e-3)
    assert_allclose(counted["impulse"], sampled["impulse"], rtol=1e-2, atol=1e-4)
    assert counted["impulse"].sum() == pytest.approx(response.impacts["impulse"].sum(), rel=1e-12)


class TestSamples:
    times = np.arange(0.0, 2.0, 1e-4)

    def test_they_converge_to_the_solution(self, response: bs.Response) -> None:
        at = response.at(self.times)
        speed = -at.velocity("P", "dx")
        sampled = bs.sampled_impacts(self.times, at.stop_force("left"), speed)
        counted = bs.contact_impacts(response, "left")
        assert_allclose(sampled["start"], counted["start"], atol=1e-4)
        assert_allclose(sampled["impulse"][:2], counted["impulse"][:2], rtol=1e-4)
        assert_allclose(sampled["closing_speed"], SPEED, rtol=1e-3)

    def test_rest_and_threshold(self) -> None:
        force = [0, 3, 0, 5, 1, 0, 0, 0, 2]
        counted = bs.sampled_impacts(range(9), force, threshold=1.0, rest=2.0)
        assert counted["start"].tolist() == [1.0, 8.0]
        assert counted["rebounds"].tolist() == [1.0, 0.0]
        assert counted["end"].tolist()[0] == 4.0
        assert counted["contact_time"].tolist() == [2.0, 0.0]
        assert counted["impulse"].tolist() == [8.0, 1.0]

    def test_nothing_is_hit(self) -> None:
        assert len(bs.sampled_impacts([0, 1, 2], [0, 0, 0])) == 0

    @pytest.mark.parametrize(
        ("times", "force", "key"),
        [([0, 0], [1, 1], "times"), ([0, 1], [1], "force"), ([0], [1], "times")],
    )
    def test_refuses(self, times: Any, force: Any, key: str) -> None:
        with pytest.raises(bs.InputError) as caught:
            bs.sampled_impacts(times, force)
        assert caught.value.key == key


@pytest.mark.parametrize("shape", ["circle", "square"])
def test_obstacles_in_two_directions(shape: str) -> None:
    """Their states tell the side that is touched, too; the damper lets go before the gap opens."""
    shapes = {("P", "dx"): [1.0, 0.0], ("P", "dy"): [0.0, 1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[5.0, 5.0], damping=0.02, shapes=shapes)
    contact: dict[str, Any] = {"node": "P", "axis": (0, 0, 1), "stiffness": 1e4, "damping": 100.0}
    corners = [(math.radians(45.0 + 90.0 * side), 3e-3) for side in range(4)]
    hole = (
        bs.CircleStop("hole", radius=2e-3, **contact)
        if shape == "circle"
        else bs.PolarStop("hole", profile=corners, **contact)
    )
    loads = [
        bs.NodalForce("x", node="P", force=(30.0, 0, 0), time=bs.Harmonic(4.1, sine=1.0)),
        bs.NodalForce("y", node="P", force=(0, 20.0, 0), time=bs.Harmonic(3.1, sine=1.0)),
    ]
    problem = bs.Problem(basis, laws=[hole], loads=loads, duration=1.0, sample=1e-5)
    run = bs.simulate(problem, "dop853")
    assert any(str(state).startswith("released") for state in run.events["after"])
    force = run.sample("stop_force", "hole")
    found = bs.contact_statistics(run, "hole", blocks=1)
    assert found["contact_time"] == pytest.approx(float((force > 0.0).mean()), abs=2e-4)
    assert found["mean_force"] == pytest.approx(force.mean(), rel=1e-4)
    # At a jump of the damper's force the largest is between two samples.
    assert found["largest_force"] == pytest.approx(force.max(), rel=1e-3)
    assert found["largest_force"] >= force.max() * (1.0 - 1e-12)
    assert found["contact_time"] < 0.999
