"""Responses of problems that have closed forms, through the Python API."""

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr

import bumpstop as bs

from .hinged_beam import hinged_modes

# The card of the case ball-on-spring (ANSYS VM65), in SI units.
POUND_FORCE, INCH = 4.4482216152605, 0.0254
MASS = 0.5 * POUND_FORCE / INCH
STIFFNESS = 1973.92 * POUND_FORCE / INCH
GRAVITY = 386.0 * INCH
HEIGHT = 1.0 * INCH


def ball(duration: float = 0.35) -> bs.Problem:
    basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("ball", "dy"): [MASS**-0.5]})
    spring = bs.Stop("spring", node="ball", normal=(0, 1, 0), gap=HEIGHT, stiffness=STIFFNESS)
    weight = bs.NodalForce("weight", node="ball", force=(0, -MASS * GRAVITY, 0))
    return bs.Problem(basis, laws=[spring], loads=[weight], duration=duration)


def oscillator(
    *, frequency: float = 10.0, damping: float = 0.0, speed: float = 0.5, duration: float = 0.4
) -> bs.Problem:
    """A mass of 1 kg that starts towards a stop which it touches at rest."""
    basis = bs.ModalBasis.from_modes(frequency=[frequency], shapes={("P", "dx"): [1.0]})
    stop = bs.Stop("stop", node="P", normal=(1, 0, 0), stiffness=1e5, damping=damping)
    start = bs.ModalState(velocity=[-speed])
    return bs.Problem(basis, laws=[stop], initial=start, duration=duration)


@pytest.fixture(scope="module")
def bounce() -> bs.Response:
    return bs.simulate(ball(), method="exact")


class TestBall:
    """A ball falls from rest on a massless spring and bounces for ever."""

    speed = math.sqrt(2.0 * GRAVITY * HEIGHT)
    omega = math.sqrt(STIFFNESS / MASS)
    sag = MASS * GRAVITY / STIFFNESS
    peak = sag + math.sqrt(sag**2 + 2.0 * sag * HEIGHT)
    half_contact = (math.pi - math.atan(speed * omega / GRAVITY)) / omega
    fall = math.sqrt(2.0 * HEIGHT / GRAVITY)

    def test_published_values(self) -> None:
        assert self.fall == pytest.approx(0.071982, rel=1e-5)
        assert self.peak / INCH == pytest.approx(0.55067, rel=1e-5)
        assert self.fall + self.half_contact == pytest.approx(0.10044, rel=1e-4)

    def test_impacts(self, bounce: bs.Response) -> None:
        impacts = bounce.impacts
        starts = self.fall + 2.0 * (self.fall + self.half_contact) * np.arange(2)
        assert impacts["stop"].tolist() == ["spring", "spring"]
        np.testing.assert_allclose(impacts["start"], starts, rtol=1e-12)
        np.testing.assert_allclose(impacts["end"], starts + 2 * self.half_contact, rtol=1e-12)
        np.testing.assert_allclose(impacts["duration"], 2 * self.half_contact, rtol=1e-11)
        np.testing.assert_allclose(impacts["closing_speed"], self.speed, rtol=1e-11)
        np.testing.assert_allclose(impacts["opening_speed"], self.speed, rtol=1e-11)
        np.testing.assert_allclose(impacts["peak_force"], STIFFNESS * self.peak, rtol=1e-11)
        np.testing.assert_allclose(impacts["peak_time"], starts + self.half_contact, rtol=1e-9)
        impulse = 2.0 * MASS * (self.speed + GRAVITY * self.half_contact)
        np.testing.assert_allclose(impacts["impulse"], impulse, rtol=1e-11)
        returned = 0.5 * STIFFNESS * self.peak**2
        np.testing.assert_allclose(impacts["energy_returned"], returned, rtol=1e-11)

    def test_columns_have_their_agreed_order(self, bounce: bs.Response) -> None:
        columns = "stop start end duration closing_speed opening_speed peak_force impulse"
        assert " ".join(bounce.impacts.columns) == f"{columns} energy_returned peak_time"

    def test_free_fall(self, bounce: bs.Response) -> None:
        times = np.linspace(0.0, self.fall, 7)
        fall = bounce.at(times)
        np.testing.assert_allclose(
            fall.displacement("ball", "dy"), -0.5 * GRAVITY * times**2, rtol=1e-13
        )
        np.testing.assert_allclose(fall.velocity("ball", "dy"), -GRAVITY * times, rtol=1e-13)
        np.testing.assert_allclose(fall.acceleration("ball", "dy")[:-1], -GRAVITY, rtol=1e-13)
        np.testing.assert_allclose(
            fall.gap("spring"), HEIGHT - 0.5 * GRAVITY * times**2, atol=1e-15
        )
        assert (fall.stop_force("spring") == 0.0)[:-1].all()

    def test_in_contact_force_and_gap_agree(self, bounce: bs.Response) -> None:
        times = self.fall + self.half_contact * np.array([0.3, 1.0, 1.5])
        pressed = bounce.at(times)
        elapsed = times - self.fall
        expected = self.sag * (np.cos(self.omega * elapsed) - 1.0)
        expected -= self.speed / self.omega * np.sin(self.omega * elapsed)
        np.testing.assert_allclose(pressed.gap("spring"), expected, rtol=1e-11)
        np.testing.assert_allclose(pressed.stop_force("spring"), -STIFFNESS * expected, rtol=1e-11)
        acceleration = -STIFFNESS * expected / MASS - GRAVITY
        np.testing.assert_allclose(pressed.acceleration("ball", "dy"), acceleration, rtol=1e-11)

    def test_energy_is_weight_times_height(self, bounce: bs.Response) -> None:
        lowest = self.fall + self.half_contact
        energy = bounce.at([0.0, self.fall, lowest]).energy
        work = MASS * GRAVITY * np.array([0.0, HEIGHT, HEIGHT + self.peak])
        kinetic = [0.0, MASS * GRAVITY * HEIGHT, 0.0]
        np.testing.assert_allclose(energy["load_work"], work, rtol=1e-12)
        np.testing.assert_allclose(energy["kinetic"], kinetic, atol=1e-12 * work[2])
        np.testing.assert_allclose(energy["stored"], [0.0, 0.0, work[2]], atol=1e-12 * work[2])
        assert energy["total_initial"].values.tolist() == [0.0, 0.0, 0.0]
        assert np.abs(energy["residual"]).max() < 1e-13 * work[2]
        assert bounce.energy_residual < 1e-13

    def test_a_contact_that_is_not_over_has_no_end(self) -> None:
        cut = bs.simulate(ball(duration=self.fall + self.half_contact), method="exact")
        assert len(cut.impacts) == 1
        assert cut.impacts[["end", "duration", "opening_speed"]].isna().all(axis=None)
        np.testing.assert_allclose(cut.impacts["start"], self.fall, rtol=1e-12)

    @pytest.mark.parametrize("method", ["symplectic_euler", "central_difference"])
    def test_fixed_steps_come_near(self, method: str) -> None:
        response = bs.simulate(ball(duration=0.2), method=method, dt=1e-5)
        row = response.impacts.iloc[0]
        assert row["start"] == pytest.approx(self.fall, abs=1e-5)
        assert row["duration"] == pytest.approx(2 * self.half_contact, abs=2e-5)
        assert row["peak_force"] == pytest.approx(STIFFNESS * self.peak, rel=1e-3)


class TestOscillator:
    """Half sines: of the stop's frequency while closed, of its own while open."""

    closed = math.sqrt((2.0 * math.pi * 10.0) ** 2 + 1e5)
    contact = math.pi / closed

    def test_half_sines(self) -> None:
        response = bs.simulate(oscillator(), method="exact")
        period = self.contact + 0.5 / 10.0
        starts = period * np.arange(7)
        impacts = response.impacts
        np.testing.assert_allclose(impacts["start"], starts, rtol=1e-12, atol=1e-15)
        np.testing.assert_allclose(impacts["duration"], self.contact, rtol=1e-10)
        np.testing.assert_allclose(impacts["closing_speed"], 0.5, rtol=1e-12)
        np.testing.assert_allclose(impacts["opening_speed"], 0.5, rtol=1e-12)
        np.testing.assert_allclose(impacts["peak_force"], 1e5 * 0.5 / self.closed, rtol=1e-12)
        np.testing.assert_allclose(impacts["peak_time"], starts + self.contact / 2, rtol=1e-9)
        impulse = 2.0 * 1e5 * 0.5 / self.closed**2
        np.testing.assert_allclose(impacts["impulse"], impulse, rtol=1e-12)

    def test_a_stop_that_presses_from_the_start_closes_without_speed(self) -> None:
        basis = bs.ModalBasis.from_modes(frequency=[10.0], shapes={("P", "dx"): [1.0]})
        stop = bs.Stop("stop", node="P", normal=(1, 0, 0), gap=-1e-3, stiffness=1e5)
        response = bs.simulate(bs.Problem(basis, laws=[stop], duration=0.1))
        (speed, *_) = response.impact_table()["closing_speed"]
        assert str(speed) == "0.0"

    def test_events_tell_their_states(self) -> None:
        events = bs.simulate(oscillator(duration=0.02), method="exact").events
        assert list(events.columns) == ["time", "law", "guard", "before", "after"]
        opening = events.iloc[-1]
        assert opening["time"] == pytest.approx(self.contact, rel=1e-12)
        assert (opening["law"], opening["before"], opening["after"]) == ("stop", "closed", "open")

    def test_a_damper_releases_before_the_gap_opens(self) -> None:
        """Without springs of its own, the mass leaves the damped stop at constant speed."""
        problem = oscillator(frequency=0.0, damping=100.0, duration=0.05)
        response = bs.simulate(problem, method="exact")
        omega, decay = math.sqrt(1e5), 50.0
        swing = math.sqrt(omega**2 - decay**2)
        released = math.atan2(2 * decay * swing, decay**2 - swing**2) / swing
        amplitude = 0.5 / swing * math.exp(-decay * released)
        place = -amplitude * math.sin(swing * released)
        speed = -amplitude * (
            swing * math.cos(swing * released) - decay * math.sin(swing * released)
        )
        impact = response.impacts.iloc[0]
        assert place < 0.0 < speed
        assert impact["end"] == pytest.approx(released - place / speed, rel=1e-12)
        assert impact["opening_speed"] == pytest.approx(speed, rel=1e-12)
        assert impact["impulse"] == pytest.approx(0.5 + speed, rel=1e-12)
        last = response.at([0.05]).energy.isel(time=0)
        lost = 0.5 * (0.5**2 - speed**2)
        assert last["dissipated_stops"].item() == pytest.approx(lost, rel=1e-12)
        assert last["dissipated_in_stop"].sel(stop="stop").item() == pytest.approx(lost, rel=1e-12)
        assert last["stored"].item() == 0.0
        assert response.energy_residual < 1e-13
        after = response.sample("stop_force", "stop", times=[released * (1 + 1e-9), 0.05])
        assert after.tolist() == [0.0, 0.0]

    def test_two_stops_share_a_table_in_the_order_of_closing(self) -> None:
        basis = bs.ModalBasis.from_modes(frequency=[10.0], shapes={("P", "dx"): [1.0]})
        walls = [
            bs.Stop(name, node="P", normal=(side, 0, 0), gap=1e-3, stiffness=1e5)
            for name, side in (("left", 1), ("right", -1))
        ]
        start = bs.ModalState(velocity=[-0.5])
        problem = bs.Problem(basis, laws=walls, initial=start, duration=0.1)
        response = bs.simulate(problem, method="exact")
        impacts = response.impacts
        omega = 2.0 * math.pi * 10.0
        way = math.asin(1e-3 * omega / 0.5) / omega
        assert impacts["stop"].tolist() == ["left", "right"] * 4
        assert impacts["start"][0] == pytest.approx(way, rel=1e-12)
        flights = impacts["start"][1:].to_numpy() - impacts["end"][:-1].to_numpy()
        np.testing.assert_allclose(flights, 2.0 * way, rtol=1e-10)
        assert response.events["law"].tolist()[:4] == ["left", "left", "right", "right"]


class TestLedger:
    def test_modal_damping_takes_what_a_free_vibration_loses(self) -> None:
        """x = v/w_d exp(-xi w t) sin(w_d t), for a mass of 1 kg far from its stop."""
        basis = bs.ModalBasis.from_modes(frequency=[3.0], damping=0.05, shapes={("P", "dx"): [1]})
        wall = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=1.0, stiffness=1e5)
        start = bs.ModalState(velocity=[0.5])
        problem = bs.Problem(basis, laws=[wall], initial=start, duration=1.0)
        omega, ratio, times = 2.0 * math.pi * 3.0, 0.05, np.linspace(0.0, 1.0, 23)
        swing = omega * math.sqrt(1.0 - ratio**2)
        shrunk, angle = np.exp(-ratio * omega * times), swing * times
        place = 0.5 / swing * shrunk * np.sin(angle)
        speed = 0.5 * shrunk * (np.cos(angle) - ratio * omega / swing * np.sin(angle))
        kinetic, elastic = 0.5 * speed**2, 0.5 * omega**2 * place**2
        energy = bs.simulate(problem, method="exact").energy_terms(times)
        np.testing.assert_allclose(energy["kinetic"], kinetic, atol=1e-14)
        np.testing.assert_allclose(energy["elastic"], elastic, atol=1e-14)
        lost = 0.125 - kinetic - elastic
        np.testing.assert_allclose(energy["dissipated_damping"], lost, atol=1e-14)

    @pytest.mark.parametrize("method", ["symplectic_euler", "central_difference"])
    def test_the_residual_is_what_the_terms_miss(self, method: str) -> None:
        """Coarse steps miss some: the terms are integrated from their own powers."""
        response = bs.simulate(ball(duration=0.2), method=method, dt=1e-3)
        energy = response.energy_terms()
        present = sum(energy[name] for name in ("kinetic", "elastic", "stored"))
        lost = energy["dissipated_damping"] + energy["dissipated_stops"]
        missed = present + lost - energy["total_initial"] - energy["load_work"]
        largest = energy["load_work"].max()
        np.testing.assert_allclose(energy["residual"], missed, atol=1e-13 * largest)
        assert np.abs(energy["residual"]).max() > 1e-5 * largest


class TestLabels:
    def test_displacement(self, bounce: bs.Response) -> None:
        array = bounce.displacement("ball", "dy")
        assert array.dims == ("time",)
        assert array.name == "displacement"
        assert array.attrs["units"] == "m"
        assert array.attrs["long_name"] == "displacement of ball along dy"
        assert array["time"].attrs == {"units": "s", "long_name": "time"}
        np.testing.assert_array_equal(array["time"], bounce.times)
        np.testing.assert_array_equal(array, bounce.sample("displacement", "ball", "dy"))

    @pytest.mark.parametrize(
        ("read", "units"),
        [
            (lambda r: r.velocity("ball", "dy"), "m/s"),
            (lambda r: r.acceleration("ball", "dy"), "m/s^2"),
            (lambda r: r.stop_force("spring"), "N"),
            (lambda r: r.gap("spring"), "m"),
            (lambda r: r.modal_displacement(), "kg^0.5 m"),
            (lambda r: r.energy["stored"], "J"),
        ],
    )
    def test_units(self, bounce: bs.Response, read: Any, units: str) -> None:
        assert read(bounce).attrs["units"] == units

    def test_modes_are_counted_from_one(self, bounce: bs.Response) -> None:
        array = bounce.modal_displacement()
        assert array.dims == ("time", "mode")
        assert array["mode"].values.tolist() == [1]
        assert array["frequency"].attrs["units"] == "Hz"
        np.testing.assert_array_equal(array.sel(mode=1), bounce.sample("modal_displacement", 1))
        ones: tuple[Any, ...] = (np.int64(1), np.uint8(1))
        for one in ones:
            np.testing.assert_array_equal(
                array.sel(mode=1), bounce.sample("modal_displacement", one)
            )

    def test_energy_is_a_dataset(self, bounce: bs.Response) -> None:
        energy = bounce.energy
        assert isinstance(energy, xr.Dataset)
        for name, values in bounce.energy_terms().items():
            np.testing.assert_array_equal(energy[name], values)
        parts = energy[["kinetic", "elastic", "stored", "dissipated_damping", "dissipated_stops"]]
        np.testing.assert_allclose(parts.to_array().sum("variable"), energy["total"], rtol=1e-14)
        np.testing.assert_array_equal(energy["stored_in_stop"].sum("stop"), energy["stored"])

    def test_card(self, bounce: bs.Response) -> None:
        card = bounce._repr_html_()
        for words in ("exact", "0.35 s", "spring", "energy residual"):
            assert words in card
        assert repr(bounce).startswith("<Response: 0.35 s by the exact method")

    def test_card_escapes_names(self) -> None:
        basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
        stop = bs.Stop("<b>", node="P", normal=(1, 0, 0), gap=1.0, stiffness=1.0)
        problem = bs.Problem(basis, laws=[stop], duration=1.0)
        assert "&lt;b&gt;" in bs.simulate(problem)._repr_html_()


class TestSampling:
    def test_the_same_instant_gives_the_same_bits_on_any_grid(self, bounce: bs.Response) -> None:
        whole = bounce.sample("displacement", "ball", "dy")
        alone = [bounce.sample("displacement", "ball", "dy", times=[t])[0] for t in bounce.times]
        assert whole.tolist() == alone

    def test_at_keeps_the_run_and_changes_the_grid(self, bounce: bs.Response) -> None:
        times = [0.25, 0.1, 0.0]
        again = bounce.at(times)
        assert again.times.tolist() == times
        assert again.history is bounce.history
        expected = bounce.sample("gap", "spring", times=times)
        np.testing.assert_array_equal(again.gap("spring"), expected)

    def test_instants_beyond_the_end_by_rounding_are_put_on_it(self, bounce: bs.Response) -> None:
        assert bounce.at([0.35 * (1.0 + 1e-15)]).times.tolist() == [0.35]

    @pytest.mark.parametrize(
        ("times", "what"),
        [
            ([0.1, 0.36], r"within the simulated time, 0 to 0.35 s \(got 0.36\)"),
            ([-1e-9], "within the simulated time"),
            ([float("nan")], "within the simulated time"),
            (["soon"], "must be numbers"),
            ("0.1", "must be numbers, not text"),
            ([[0.1]], "a list of instants"),
        ],
    )
    def test_instants_that_cannot_be(self, bounce: bs.Response, times: Any, what: str) -> None:
        with pytest.raises(bs.InputError, match=what) as caught:
            bounce.at(times)
        assert caught.value.key == "times"

    @pytest.mark.parametrize(
        ("quantity", "target", "what"),
        [
            ("displacment", ("ball", "dy"), "did you mean 'displacement'"),
            ("displacement", ("ball",), "a node and a dof"),
            ("displacement", ("bal", "dy"), "did you mean 'ball'"),
            ("stop_force", ("sprig",), "did you mean 'spring'"),
            ("gap", (), "that of a stop"),
            ("gauge", ("g",), "none are defined"),
            ("modal_displacement", (2,), "a mode from 1 to 1"),
            ("modal_displacement", (0,), "a mode from 1 to 1"),
            ("modal_displacement", (True,), "a mode from 1 to 1"),
            ("modal_displacement", (1.0,), "a mode from 1 to 1"),
        ],
    )
    def test_what_cannot_be_asked_for(
        self, bounce: bs.Response, quantity: str, target: Any, what: str
    ) -> None:
        with pytest.raises(bs.InputError, match=what):
            bounce.sample(quantity, *target)


def test_the_example_of_the_design() -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[3.0, 7.5], damping=[0.01, 0.01], shapes={("P", "dx"): [1.0, 0.4]}
    )  # Hz, unit modal mass
    stop = bs.Stop("guide", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=1e6, damping=0.0)
    problem = bs.Problem(
        basis,
        laws=[stop],
        initial=bs.ModalState(displacement=[0.0, 0.0], velocity=[0.2, 0.0]),
        duration=1.0,
    )
    response = bs.simulate(problem, method="exact")
    assert response.gap("guide").min() < 0.0
    assert response.impacts["closing_speed"].gt(0.0).all()
    np.testing.assert_allclose(
        response.gap("guide"), 1e-3 - response.displacement("P", "dx"), atol=1e-15
    )
    np.testing.assert_allclose(
        response.stop_force("guide"), np.maximum(0.0, -1e6 * response.gap("guide")), atol=1e-9
    )
    assert response.energy_residual < 1e-11


def test_a_gauge_reads_the_rate_at_which_the_section_turns() -> None:
    """Strain = -y d(drz)/dx; the rotation is quadratic in an element, so differences are exact."""
    problem = bs.Problem(
        hinged_modes(elements=4, modes=3, damping=0.0),
        initial=bs.ModalState(displacement=[0.0, 1e-3, 2e-3]),
        duration=0.01,
        gauges=[bs.Gauge("strain", beam="AB", at=0.462, fibre=(0.007, 0.0))],
    )
    response = bs.simulate(problem)
    before, after = (response.displacement(f"AB@{x}", "drz") for x in (0.452, 0.472))
    strain = response.gauge("strain")
    np.testing.assert_allclose(strain, -0.007 * (after - before) / 0.02, rtol=1e-9, atol=1e-15)
    assert np.abs(strain).max() > 1e-5
    assert strain.attrs["units"] == "1"
    assert strain.attrs["gauge"] == "strain"
