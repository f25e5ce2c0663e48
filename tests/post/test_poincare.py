"""Sections of motions that are known: a ball that keeps step with a table, an oscillator."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bumpstop as bs

GRAVITY, FREQUENCY, RESTITUTION = 9.81, 10.0, 0.7
PERIOD = 1.0 / FREQUENCY


def driven(frequency: float = 3.0, damping: float = 0.2, duration: float = 60.0) -> bs.Response:
    basis = bs.ModalBasis.from_modes(frequency=[5.0], damping=damping, shapes={("P", "dx"): [1.0]})
    load = bs.NodalForce("load", node="P", force=(8.0, 0, 0), time=bs.Harmonic(frequency, sine=1.0))
    return bs.simulate(bs.Problem(basis, loads=[load], duration=duration))


def test_full_models_repeat_themselves_as_their_loads_do() -> None:
    beam = bs.Beam(
        "AB",
        nodes=("A", "B"),
        elements=3,
        section=bs.Rectangle(height=0.02, width=0.01),
        material=bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0),
    )
    clamped = bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (0.5, 0, 0)}, beams=[beam], supports=[clamped]
    )
    damping = bs.RayleighDamping(alpha=100.0)
    model = bs.FullModel.from_structure(structure, damping=damping)
    loads = [
        bs.NodalForce(f"{rate} Hz", node="B", force=(0, 5.0, 5.0), time=bs.Harmonic(rate, sine=1.0))
        for rate in (50.0, 100.0)
    ]
    for given, multiple in ((loads[1:], 1), (loads, 2)):
        run = bs.simulate(bs.Problem(model, loads=given, duration=0.6), "newmark", dt=1e-4)
        found = bs.periodicity(run, 0.01, start=0.5, tolerance=1e-5)
        assert found.multiple == multiple
    early = bs.periodicity(run, 0.01, most=2)
    assert early.multiple is None
    assert 0.01 < early.distance < 2.0


def test_a_linear_motion_is_one_point() -> None:
    """The steady state of 8 sin(w t) on an oscillator, at a quarter of the period."""
    run = driven()
    found = bs.stroboscopic_section(run, "P", "dx", 1.0 / 3.0, phase=0.25, start=20.0)
    natural, omega = 2.0 * math.pi * 5.0, 2.0 * math.pi * 3.0
    reply = 8.0 / complex(natural**2 - omega**2, 2.0 * 0.2 * natural * omega)
    assert_allclose(found["displacement"], reply.real, rtol=1e-9)
    assert_allclose(found["velocity"], -omega * reply.imag, rtol=1e-8)
    assert_allclose(np.diff(found["time"]), 1.0 / 3.0, rtol=1e-9)
    assert found["velocity"].attrs["units"] == "m/s"
    assert bs.plot(found["displacement"]).data[0].mode == "markers"


def test_how_often_it_repeats() -> None:
    run = driven()
    assert bs.periodicity(run, 1.0 / 3.0, start=20.0).multiple == 1
    # Seen with another clock: 3 Hz meet 2 Hz after 1 s, and 4 Hz too.
    assert bs.periodicity(run, 0.5, start=20.0).multiple == 2
    assert bs.periodicity(run, 0.25, start=20.0).multiple == 4
    early = bs.periodicity(run, 1.0 / 3.0, most=4)
    assert early.multiple is None
    assert not early
    assert early.distance > 1e-3


def half_as_often() -> bs.Response:
    """An impact oscillator at a frequency where it hits every second period."""
    basis = bs.ModalBasis.from_modes(frequency=[1.0], damping=0.02, shapes={("P", "dx"): [1.0]})
    wall = bs.RigidStop("wall", node="P", normal=(1, 0, 0), gap=0.0, restitution=0.8)
    # A body on a spring that just touches a wall swings with twice its natural frequency: at
    # four times that the response is subharmonic of order 2 (Shaw and Holmes 1983).
    load = bs.NodalForce("load", node="P", force=(100.0, 0, 0), time=bs.Harmonic(4.0, cosine=1.0))
    return bs.simulate(bs.Problem(basis, laws=[wall], loads=[load], duration=400.0))


def test_a_subharmonic_motion() -> None:
    run = half_as_often()
    found = bs.periodicity(run, 0.25, start=250.0)
    assert found.multiple == 2
    closings = bs.impact_section(run, "wall", period=0.25, start=250.0)
    assert_allclose(np.diff(closings["time"]), 0.5, rtol=1e-7)
    assert_allclose(closings["phase"], closings["phase"].iloc[0], atol=1e-7)
    contacts = run.impacts.query("start >= 250")
    assert_allclose(contacts["opening_speed"], 0.8 * contacts["closing_speed"], rtol=1e-12)


def test_bifurcation_data_has_a_row_a_point() -> None:
    runs = {2.0: driven(2.0), 3.0: driven(3.0)}
    table = bs.bifurcation(
        runs.items(),
        lambda run: bs.stroboscopic_section(run, "P", "dx", 1.0, start=55.0)["displacement"],
        parameter="frequency",
        units="Hz",
    )
    assert list(table.columns) == ["frequency", "value"]
    assert table.groupby("frequency").size().to_dict() == {2.0: 6, 3.0: 6}
    assert table.attrs["units"] == {"frequency": "Hz"}


def test_refuses() -> None:
    run = driven(duration=1.0)
    with pytest.raises(bs.InputError, match="no instant"):
        bs.stroboscopic_section(run, "P", "dx", 0.5, start=1.4)
    with pytest.raises(bs.InputError, match=r"period: must leave two periods"):
        bs.periodicity(run, 0.6)
    with pytest.raises(bs.InputError, match=r"start: must leave two periods"):
        bs.periodicity(run, 0.3, start=0.8)
    with pytest.raises(bs.InputError, match="must be positive"):
        bs.stroboscopic_section(run, "P", "dx", 0.0)


def test_a_section_of_words_is_refused() -> None:
    with pytest.raises(bs.InputError, match=r"section: must return numbers \(got 'closed'\)"):
        bs.bifurcation({1.0: driven(2.0)}, lambda _run: "closed")


@pytest.mark.parametrize(
    ("runs", "said"),
    [
        (5, "runs: must be responses by the value of a parameter"),
        ([1.0], "runs: must be pairs"),
        ([(1.0, 2.0)], "must be a response"),
        ({"gap": 3}, "must be a response"),
    ],
)
def test_bifurcation_refuses(runs: Any, said: str) -> None:
    with pytest.raises(bs.InputError, match=said):
        bs.bifurcation(runs, lambda run: run, parameter="gap")
