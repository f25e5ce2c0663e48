"""Work by sectors of a body that whirls in a square hole, and of one that swings on a floor."""

import math

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.wear import WearLaw

SIDES = {"east": (-1, 0, 0), "north": (0, -1, 0), "west": (1, 0, 0), "south": (0, 1, 0)}


def whirling() -> bs.Response:
    """A mass on an isotropic spring whirls on a circle that reaches into four walls alike."""
    shapes = {("P", "dx"): [1.0, 0.0], ("P", "dy"): [0.0, 1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[2.0, 2.0], damping=0.2, shapes=shapes)
    walls = [
        bs.Stop(name, node="P", normal=normal, gap=0.09, stiffness=50.0)
        for name, normal in SIDES.items()
    ]
    turning = [
        bs.NodalForce("x", node="P", force=(15.0, 0, 0), time=bs.Harmonic(1.0, cosine=1.0)),
        bs.NodalForce("y", node="P", force=(0, 15.0, 0), time=bs.Harmonic(1.0, sine=1.0)),
    ]
    return bs.simulate(bs.Problem(basis, laws=walls, loads=turning, duration=20.0))


@pytest.fixture(scope="module")
def run() -> bs.Response:
    return whirling()


def test_four_walls_get_the_same(run: bs.Response) -> None:
    found = bs.work_by_sector(run, list(SIDES), sectors=8, axes=("dx", "dy"), start=10.0)
    total = sum(bs.wear_work(run, name, start=10.0).rate for name in SIDES)
    assert float(found.sum()) == pytest.approx(total, rel=1e-6)
    # The motion has the symmetry of the square: quarters are alike, halves of them are not.
    halves = found.values.reshape(4, 2)
    np.testing.assert_allclose(halves[:, 0], halves[0, 0], rtol=1e-5)
    np.testing.assert_allclose(halves[:, 1], halves[0, 1], rtol=1e-5)
    assert halves[0, 0] > 0.0
    assert found.attrs["units"] == "W"


def test_a_wall_is_worn_on_its_own_side(run: bs.Response) -> None:
    found = bs.work_by_sector(run, "north", sectors=4, axes=("dx", "dy"), start=10.0)
    assert found.values[2] == found.values[3] == 0.0
    assert found.values[0] + found.values[1] == pytest.approx(
        bs.wear_work(run, "north", start=10.0).rate, rel=1e-6
    )


def test_against_sums_over_samples(run: bs.Response) -> None:
    found = bs.work_by_sector(run, "east", sectors=12, axes=("dx", "dy"), start=10.0)
    times = np.linspace(10.0, 20.0, 200_001)
    x, y = (run.sample("displacement", "P", dof, times=times) for dof in ("dx", "dy"))
    power = run.sample("stop_force", "east", times=times)
    power *= np.abs(run.sample("velocity", "P", "dy", times=times))
    turned = np.mod(np.arctan2(y, x), 2.0 * math.pi)
    sums, _ = np.histogram(turned, bins=12, range=(0.0, 2.0 * math.pi), weights=power)
    np.testing.assert_allclose(found, sums / len(times), rtol=1e-3, atol=1e-6 * sums.max())


def test_refuses(run: bs.Response) -> None:
    with pytest.raises(bs.InputError, match="unknown stop"):
        bs.work_by_sector(run, "up")
    with pytest.raises(bs.InputError, match="at one node"):
        bs.work_by_sector(run, [])
    with pytest.raises(bs.InputError, match="unknown axes"):
        bs.work_by_sector(run, "east", axes=("dx", "drz"))
    for axes in (("dy", "dy"), ("dy",), ("dx", "dy", "dz")):
        with pytest.raises(bs.InputError, match="two different dofs"):
            bs.work_by_sector(run, "east", axes=axes)
    with pytest.raises(bs.InputError, match="used twice"):
        bs.work_by_sector(run, ["east", "east"])


def test_a_hole_that_another_node_carries() -> None:
    """Both nodes fly along together: the place that counts is that of the one in the other."""
    shapes = {
        ("P", "dx"): [1.0, 0.0, 0.0, 0.0],
        ("P", "dy"): [0.0, 1.0, 0.0, 0.0],
        ("Q", "dx"): [0.0, 0.0, 1.0, 0.0],
        ("Q", "dy"): [0.0, 0.0, 0.0, 1.0],
    }
    basis = bs.ModalBasis.from_modes(frequency=[0.0] * 4, shapes=shapes)
    wall = bs.Stop("wall", node="P", other="Q", normal=(-1, 0, 0), gap=0.02, stiffness=50.0)
    start = bs.ModalState(velocity=[2.0, 0.1, 1.0, -0.1])
    response = bs.simulate(bs.Problem(basis, laws=[wall], initial=start, duration=1.0))
    times = np.linspace(0.0, 1.0, 200_001)
    apart = {
        (quantity, dof): response.sample(quantity, "P", dof, times=times)
        - response.sample(quantity, "Q", dof, times=times)
        for quantity in ("displacement", "velocity")
        for dof in ("dx", "dy")
    }
    power = response.sample("stop_force", "wall", times=times) * np.abs(apart["velocity", "dy"])
    turned = np.arctan2(apart["displacement", "dy"], apart["displacement", "dx"])
    turned = np.mod(turned, 2.0 * math.pi)
    sums, _ = np.histogram(turned, bins=40, range=(0.0, 2.0 * math.pi), weights=power)
    found = bs.work_by_sector(response, "wall", sectors=40, axes=("dx", "dy"))
    np.testing.assert_allclose(found, sums / len(times), rtol=1e-3, atol=1e-4 * sums.max())
    assert np.count_nonzero(found) > 2


def test_archard_wears_each_sector_by_its_work(run: bs.Response) -> None:
    rates = bs.work_by_sector(run, "east", sectors=12, axes=("dx", "dy"), start=10.0)
    law, pad = bs.ArchardWear(3e-14), bs.PadScar(area=2e-4)
    found = bs.wear_by_sector(
        run, "east", law, 1e7, scar=pad, sectors=12, axes=("dx", "dy"), start=10.0
    )
    np.testing.assert_array_equal(found["work_rate"], rates)
    np.testing.assert_allclose(found["volume"], 3e-14 * rates * 1e7, rtol=1e-6)
    np.testing.assert_allclose(found["depth"], found["volume"] / 2e-4, rtol=1e-14)
    assert [found[name].attrs["units"] for name in found] == ["W", "m^3", "m"]
    assert bs.draw_sectors(found["depth"]).data[0].type == "barpolar"


@pytest.mark.parametrize(
    "law",
    [
        bs.KwuEpriWear(1e-15, impact=1.0, sliding=2.0),
        bs.EdfWear(coefficient=2e-14, exponent=1.2, threshold=1e-19),
    ],
    ids=["KWU-EPRI", "EDF"],
)
def test_sectors_share_what_the_stops_wear(run: bs.Response, law: WearLaw) -> None:
    found = bs.wear_by_sector(run, list(SIDES), law, 1e6, sectors=12, axes=("dx", "dy"), start=10.0)
    whole = sum(float(bs.wear(run, name, law, [1e6], start=10.0)["volume"][0]) for name in SIDES)
    assert float(found["volume"].sum()) == pytest.approx(whole, rel=1e-12)
    # Walls are alike, so that work and wear are distributed alike.
    shares = found["work_rate"] / found["work_rate"].sum()
    np.testing.assert_allclose(found["volume"] / whole, shares, rtol=1e-4)


def test_wear_by_sector_refuses(run: bs.Response) -> None:
    archard = bs.ArchardWear(1e-15)
    with pytest.raises(bs.InputError, match=r"^law: "):
        bs.wear_by_sector(run, "east", "archard", 1.0)  # type: ignore[arg-type]
    with pytest.raises(bs.InputError, match=r"^service: "):
        bs.wear_by_sector(run, "east", archard, -1.0)
    with pytest.raises(bs.InputError, match=r"^scar: "):
        bs.wear_by_sector(run, "east", archard, 1.0, scar=0.1)  # type: ignore[arg-type]
