"""Contact statistics against closed forms and against sums over samples."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bumpstop as bs
from bumpstop.post.references import Reference
from bumpstop.quantities import COUNTED_IMPACTS, STATISTICS

MASS, WEIGHT, STIFFNESS, HEIGHT = 2.0, 19.62, 5e4, 0.3
SPEED = math.sqrt(2.0 * WEIGHT / MASS * HEIGHT)
OMEGA = math.sqrt(STIFFNESS / MASS)
SAG = WEIGHT / STIFFNESS
SWING = math.hypot(SAG, SPEED / OMEGA)
"""In contact the ball swings with this amplitude about its place at rest."""
CONTACT = 2.0 * (math.pi - math.atan(SPEED / (OMEGA * SAG))) / OMEGA
FALL = SPEED * MASS / WEIGHT
PERIOD = 2.0 * FALL + CONTACT


def bouncing(duration: float) -> bs.Response:
    """A ball falls on a spring, again and again; it starts at the top."""
    basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("ball", "dy"): [MASS**-0.5]})
    floor = bs.Stop("floor", node="ball", normal=(0, 1, 0), gap=HEIGHT, stiffness=STIFFNESS)
    weight = bs.NodalForce("weight", node="ball", force=(0, -WEIGHT, 0))
    return bs.simulate(bs.Problem(basis, laws=[floor], loads=[weight], duration=duration))


@pytest.fixture(scope="module")
def ball() -> bs.Response:
    return bouncing(10.0 * PERIOD)


def test_a_bouncing_ball(ball: bs.Response) -> None:
    found = bs.contact_statistics(ball, "floor", blocks=5)
    # Whole bounces: the floor carries the weight, on average.
    angle = 0.5 * CONTACT * OMEGA
    square = STIFFNESS**2 * (
        SAG**2 * CONTACT
        + 4.0 * SAG * SWING / OMEGA * math.sin(angle)
        + SWING**2 / OMEGA * (angle + 0.5 * math.sin(2.0 * angle))
    )
    expected = {
        "impact_count": 10,
        "impact_rate": 1.0 / PERIOD,
        "mean_interval": PERIOD,
        "contact_time": 10.0 * CONTACT,
        "contact_fraction": CONTACT / PERIOD,
        "mean_duration": CONTACT,
        "largest_duration": CONTACT,
        "mean_closing_speed": SPEED,
        "rms_closing_speed": SPEED,
        "largest_closing_speed": SPEED,
        "mean_peak_force": STIFFNESS * (SAG + SWING),
        "largest_force": STIFFNESS * (SAG + SWING),
        "mean_impulse": WEIGHT * PERIOD,
        "largest_impulse": WEIGHT * PERIOD,
        "mean_force": WEIGHT,
        "rms_force": math.sqrt(square / PERIOD),
        "mean_force_in_contact": WEIGHT * PERIOD / CONTACT,
        "rms_force_in_contact": math.sqrt(square / CONTACT),
    }
    assert {*expected, "deviation_peak_force"} == {*STATISTICS}
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=1e-11), name
        share = 0.2 if name in ("impact_count", "contact_time") else 1.0
        assert_allclose(found.blocks[name], share * value, rtol=1e-10, err_msg=name)
    assert abs(found["deviation_peak_force"]) < 1e-9 * STIFFNESS * SWING
    assert found.uncertainty["mean_force"] < 1e-9 * WEIGHT


@pytest.fixture(scope="module")
def rattle() -> bs.Response:
    """Two modes between a stop and a harmonic load: impacts that differ."""
    basis = bs.ModalBasis.from_modes(
        frequency=[5.0, 17.0], damping=[0.02, 0.02], shapes={("P", "dx"): [1.0, 0.7]}
    )
    stop = bs.Stop("stop", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=4e4, damping=5.0)
    load = bs.NodalForce("shaker", node="P", force=(30.0, 0, 0), time=bs.Harmonic(4.1, sine=1.0))
    return bs.simulate(bs.Problem(basis, laws=[stop], loads=[load], duration=8.0, sample=2e-5))


def test_against_sums_over_samples(rattle: bs.Response) -> None:
    threshold = 2.0
    found = bs.contact_statistics(
        rattle, "stop", threshold=threshold, rest=0.01, start=1.0, end=7.0, blocks=6
    )
    times = rattle.times
    force = np.where((f := rattle.sample("stop_force", "stop")) > threshold, f, 0.0)
    inside = (times >= 1.0) & (times < 7.0)
    impacts = bs.sampled_impacts(times, force, threshold=threshold, rest=0.01)
    impacts = impacts[(impacts["start"] >= 1.0) & (impacts["start"] < 7.0)]
    assert found["impact_count"] == len(impacts) > 20
    assert found["mean_force"] == pytest.approx(force[inside].mean(), rel=1e-4)
    rms = math.sqrt((force[inside] ** 2).mean())
    assert found["rms_force"] == pytest.approx(rms, rel=1e-4)
    assert found["contact_fraction"] == pytest.approx((force[inside] > 0.0).mean(), rel=2e-3)
    assert found["mean_peak_force"] == pytest.approx(impacts["peak_force"].mean(), rel=1e-5)
    spread = impacts["peak_force"].std()
    assert found["deviation_peak_force"] == pytest.approx(spread, rel=1e-4)
    assert found["mean_interval"] == pytest.approx(np.diff(impacts["start"]).mean(), rel=1e-4)


def test_uncertainty_is_the_scatter_of_the_blocks(rattle: bs.Response) -> None:
    found = bs.contact_statistics(rattle, "stop", blocks=4)
    halves = [
        bs.contact_statistics(rattle, "stop", start=2.0 * i, end=2.0 * i + 2.0, blocks=1)
        for i in range(4)
    ]
    alone = np.array([half["mean_force"] for half in halves])
    assert_allclose(found.blocks["mean_force"], alone, rtol=1e-12)
    assert found.uncertainty["mean_force"] == pytest.approx(alone.std(ddof=1) / 2.0, rel=1e-10)
    assert found["mean_force"] == pytest.approx(alone.mean(), rel=1e-12)
    assert math.isnan(halves[0].uncertainty["mean_force"])


@pytest.mark.parametrize("blocks", [5, 20])
def test_errors_of_sums_are_those_of_their_means(rattle: bs.Response, blocks: int) -> None:
    found = bs.contact_statistics(rattle, "stop", blocks=blocks)
    for total, mean in (("impact_count", "impact_rate"), ("contact_time", "contact_fraction")):
        assert found[total] == pytest.approx(found[mean] * 8.0, rel=1e-12)
        error = found.uncertainty[mean] * 8.0
        assert found.uncertainty[total] == pytest.approx(error, rel=1e-10), total
    assert math.isnan(found.uncertainty["largest_force"])


def test_the_largest_force_of_a_contact_that_began_before() -> None:
    """A stop pressed all the time, by a static force and a decaying swing about it."""
    basis = bs.ModalBasis.from_modes(frequency=[5.0], damping=0.02, shapes={("P", "dx"): [1.0]})
    stop = bs.Stop("stop", node="P", normal=(-1, 0, 0), gap=-1e-2, stiffness=1e4)
    push = bs.NodalForce("push", node="P", force=(300.0, 0, 0))
    problem = bs.Problem(basis, laws=[stop], loads=[push], duration=5.0)
    response = bs.simulate(problem)
    found = bs.contact_statistics(response, "stop", start=1.0)
    assert found["contact_fraction"] == 1.0
    assert found["impact_count"] == 0
    # x = X (1 - e^(-d t) (cos + d/w sin)), with peaks at odd multiples of pi / w.
    square, decay = (10.0 * math.pi) ** 2 + 1e4, 0.02 * 10.0 * math.pi
    rest, omega = (300.0 - 100.0) / square, math.sqrt(square - decay**2)
    peak = (2.0 * math.ceil(omega / math.pi / 2.0 - 0.5) + 1.0) * math.pi / omega
    largest = 1e4 * rest * (1.0 + math.exp(-decay * peak)) + 100.0
    edges = np.linspace(1.0, 5.0, 11)
    assert found["largest_force"] == pytest.approx(largest, rel=1e-10)
    assert np.isfinite(found.blocks["largest_force"]).all()
    for start, end, block in zip(edges, edges[1:], found.blocks["largest_force"], strict=False):
        force = response.sample("stop_force", "stop", times=np.linspace(start, end, 4001))
        assert block == pytest.approx(force.max(), rel=1e-5)


def test_impulses_are_those_of_the_impacts(rattle: bs.Response) -> None:
    """The integral by quadrature and the core's closed form are two ways to one number."""
    found = bs.contact_statistics(rattle, "stop", blocks=1)
    total = rattle.impacts["impulse"].sum()
    assert found["mean_force"] * 8.0 == pytest.approx(total, rel=1e-12)


def test_histogram(rattle: bs.Response) -> None:
    found = bs.contact_statistics(rattle, "stop", classes=8)
    histogram = found.histogram("closing_speed")
    counts, edges = np.histogram(rattle.impacts["closing_speed"], bins=8)
    assert histogram.values.tolist() == counts.tolist()
    assert histogram["from"].values.tolist() == edges[:-1].tolist()
    assert histogram["closing_speed"].attrs["units"] == "m/s"


def test_values_that_are_the_same_are_one_class() -> None:
    """A ball that rebounds without loss for long: its speeds differ by rounding."""
    for duration in (10.0 * PERIOD, 30.0 * PERIOD):
        found = bs.contact_statistics(bouncing(duration), "floor")
        histogram = found.histogram("closing_speed")
        assert histogram.values.tolist() == [found["impact_count"]]
        assert_allclose([histogram["from"][0], histogram["to"][0]], SPEED, rtol=1e-12)
        assert bs.plot(histogram) is not None


def test_what_is_no_stop_has_no_statistics() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[5.0], shapes={("P", "dx"): [1.0]})
    spring = bs.SpringLaw(
        "spring", node="P", direction=(1, 0, 0), stiffness=(1e3, 2e3), breaks=(0,)
    )
    start = bs.ModalState(velocity=[0.5])
    run = bs.simulate(bs.Problem(basis, laws=[spring], initial=start, duration=1.0))
    asked: list[Callable[[], object]] = [
        lambda: bs.contact_statistics(run, "spring"),
        lambda: bs.contact_impacts(run, "spring"),
        lambda: bs.wear_work(run, "spring"),
        lambda: bs.impact_section(run, "spring"),
        lambda: Reference(
            quantity="mean_force", stop="spring", values=[1.0], tolerance=0.1
        ).check_target(run.problem),
    ]
    for ask in asked:
        with pytest.raises(bs.InputError) as caught:
            ask()
        assert caught.value.key == "stop"


def test_tables_and_blocks_have_units(rattle: bs.Response) -> None:
    found = bs.contact_statistics(rattle, "stop")
    assert found.table.loc["rms_force", "units"] == "N"
    assert found.by_block["impact_rate"].attrs["units"] == "1/s"
    assert list(found.impacts.columns) == list(COUNTED_IMPACTS)
    assert "rms force" in found._repr_html_()


def test_rigid_stops_have_impulses_but_no_rms_force() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("ball", "dy"): [1.0]})
    floor = bs.RigidStop("floor", node="ball", normal=(0, 1, 0), gap=1.0, restitution=0.5)
    weight = bs.NodalForce("weight", node="ball", force=(0, -9.81, 0))
    problem = bs.Problem(basis, laws=[floor], loads=[weight], duration=3.0)
    found = bs.contact_statistics(bs.simulate(problem), "floor", blocks=3)
    # The last rebound, of 4e-6 m/s, is below the stop's resolution and left out.
    assert found["mean_force"] * 3.0 == pytest.approx(3.0 * 9.81, abs=1e-5)
    assert math.isinf(found["largest_force"])
    assert math.isnan(found["rms_force"])
    assert math.isnan(found.uncertainty["rms_force"])
    assert "without 20 that have no finite one" in found.histogram().attrs["title"]
    # It rests from 1.35 s on.
    assert found.blocks["mean_force"][2] == pytest.approx(9.81, rel=1e-12)
    assert found.blocks["rms_force"][2] == pytest.approx(9.81, rel=1e-12)


def test_the_last_blow_before_a_rest_is_one_of_the_impacts() -> None:
    """It and the rest begin at one instant; each keeps its own speed and impulse."""
    basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("ball", "dy"): [1.0]})
    floor = bs.RigidStop("floor", node="ball", normal=(0, 1, 0), gap=1.0, restitution=0.5)
    weight = bs.NodalForce("weight", node="ball", force=(0, -9.81, 0))
    run = bs.simulate(bs.Problem(basis, laws=[floor], loads=[weight], duration=3.0))
    blows = run.impacts[run.impacts["stop"] == "floor"]
    counted = bs.contact_impacts(run, "floor")
    assert len(counted) == len(blows)
    for column in ("closing_speed", "impulse", "peak_force"):
        np.testing.assert_array_equal(counted[column], blows[column])
    speed = np.sqrt(2.0 * 9.81)
    assert counted["closing_speed"][:5].to_numpy() == pytest.approx(speed * 0.5 ** np.arange(5))


def test_a_stop_that_is_never_hit() -> None:
    found = bs.contact_statistics(bouncing(0.1), "floor")
    assert found["impact_count"] == found["mean_force"] == found["contact_fraction"] == 0.0
    assert math.isnan(found["mean_peak_force"])
    with pytest.raises(bs.InputError, match="no impact has"):
        found.histogram()


@pytest.mark.parametrize(
    ("options", "key"),
    [
        ({"stop": "flor"}, "stop"),
        ({"threshold": -1.0}, "threshold"),
        ({"rest": -1.0}, "rest"),
        ({"start": 2.0, "end": 1.0}, "end"),
        ({"end": 1e6}, "end"),
        ({"blocks": 0}, "blocks"),
        ({"classes": 0}, "classes"),
        ({"blocks": 10**12}, "blocks"),
        ({"classes": 10**12}, "classes"),
    ],
)
def test_refuses(ball: bs.Response, options: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        bs.contact_statistics(ball, **({"stop": "floor"} | options))
    assert caught.value.key == key


def test_units_are_known_to_pint() -> None:
    import pint

    registry: pint.UnitRegistry[Any] = pint.UnitRegistry()
    for quantity in (STATISTICS | COUNTED_IMPACTS).values():
        registry.parse_units(quantity.units)
