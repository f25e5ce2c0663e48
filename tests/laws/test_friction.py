"""Friction: closed forms, an independent algorithm, switches, energies, and what is refused."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import bumpstop as bs

from .sliding import Rubbing

RATE = 100.0
"""Angular frequency of a block on its spring, in rad/s; its mass is 1 kg."""


def block(
    start: float,
    duration: float,
    *,
    weight: float = 10.0,
    velocity: float = 0.0,
    preload: float = 0.0,
    **friction: Any,
) -> bs.Problem:
    """A block of 1 kg on a spring along x, pressed down by its weight on a floor."""
    basis = bs.ModalBasis.from_modes(
        frequency=[RATE / math.tau, 0.0],
        damping=[0.0, 0.0],
        shapes={("P", "dx"): [1.0, 0.0], ("P", "dz"): [0.0, 1.0]},
    )
    floor = bs.Stop("floor", node="P", normal=(0, 0, 1), gap=0.0, stiffness=1e6, **friction)
    load = bs.NodalForce("load", node="P", force=(preload, 0, -weight))
    at_rest = bs.ModalState(displacement=[start, -weight / 1e6], velocity=[velocity, 0.0])
    return bs.Problem(basis, laws=[floor], loads=[load], initial=at_rest, duration=duration)


def stiff_stick(friction: float) -> dict[str, float]:
    """A stick so stiff that it hardly gives way, and damped critically."""
    stiffness = 1e11
    damping = 2.0 * math.sqrt(stiffness)
    return {
        "friction": friction,
        "tangential_stiffness": stiffness,
        "tangential_damping": damping,
    }


def position(response: bs.Response, times: Any) -> Any:
    return response.sample("displacement", "P", "dx", times=times)


def test_amplitude_falls_by_twice_the_friction_a_half_cycle() -> None:
    """The limit of a stiff stick: 2 mu N / k every half cycle, then it stays where it is."""
    problem = block(0.85e-3, 0.2, **stiff_stick(0.1))
    response = bs.simulate(problem)
    step = 0.1 * 10.0 / RATE**2
    half_cycles = np.arange(5) * math.pi / RATE
    amplitudes = [(0.85e-3 - 2 * n * step) * (-1) ** n for n in range(5)]
    assert position(response, half_cycles) == pytest.approx(amplitudes, abs=2e-8)
    stuck = position(response, np.linspace(0.16, 0.2, 20))
    assert stuck == pytest.approx(np.full(20, amplitudes[-1]), abs=2e-8)


def test_first_half_cycle_with_a_stick_that_gives_way() -> None:
    """Sticks, breaks loose where the spring of the stick holds mu N, slides, and stops."""
    push, stick, start = 1.0, 4e5, 0.85e-3
    response = bs.simulate(block(start, 0.04, friction=0.1, tangential_stiffness=stick))
    loose, stop = map(float, response.event_table()["time"][:2])
    stiff = math.sqrt(RATE**2 + stick)
    centre = stick * start / stiff**2
    # While it sticks: x = centre + (start - centre) cos(stiff t); loose where start - x = N mu / k.
    expected = math.acos(1.0 - push / stick / (start - centre)) / stiff
    assert loose == pytest.approx(expected, rel=1e-12)
    x = centre + (start - centre) * math.cos(stiff * loose)
    v = -(start - centre) * stiff * math.sin(stiff * loose)
    # While it slides back it swings about mu N / k; it stops where the velocity vanishes.
    away = x - push / RATE**2
    phase = math.atan2(-v / RATE, away)
    assert stop == pytest.approx(loose + (math.pi - phase) / RATE, rel=1e-12)
    assert response.event_table()["after"][:2] == ["slip back", "stick"]


def test_the_static_coefficient_breaks_loose_and_the_dynamic_one_resists() -> None:
    """A pull that grows from nothing is not here: one just below and one just above mu N."""
    friction: dict[str, Any] = {"static": 0.3, "dynamic": 0.2}
    for pull, slides in ((2.9, False), (3.1, True)):
        # The spring of the stick doubles a sudden pull: half of it is enough.
        problem = block(0.0, 0.05, preload=pull / 2.0, friction=friction, tangential_stiffness=1e9)
        after = bs.simulate(problem).event_table()["after"]
        assert ("slip forward" in after) == slides
    response = bs.simulate(
        block(0.0, 0.004, velocity=1.0, friction=friction, tangential_stiffness=1e9)
    )
    slip = [i for i, name in enumerate(response.event_table()["after"]) if name != "stick"]
    assert len(slip) == 1
    times = np.linspace(1e-3, 4e-3, 7)
    acceleration = response.sample("acceleration", "P", "dx", times=times)
    expected = -0.2 * 10.0 - RATE**2 * position(response, times)
    assert acceleration == pytest.approx(expected, rel=1e-9)


def test_a_block_on_a_belt_sticks_and_slips_with_the_period_of_the_closed_form() -> None:
    """Seen from the belt, which the block sticks to: the far end of its spring moves away.

    The spring is D longer than sliding friction holds when the block breaks loose, and D shorter
    when it sticks again, with the speed V of the belt at both: slipping takes (pi + 2 p) / w with
    tan(p) = V / (w D),
    and sticking 2 D / V.
    """
    speed, beyond = 0.05, (0.3 - 0.2) * 10.0 / RATE**2
    stick: dict[str, Any] = stiff_stick(0.0) | {"friction": {"static": 0.3, "dynamic": 0.2}}
    still = block(0.0, 0.6, **stick)
    pull = bs.NodalForce(
        "pull", node="P", force=(1, 0, 0), time=bs.Polynomial([0.0, RATE**2 * speed])
    )
    response = bs.simulate(replace(still, loads=(*still.loads, pull)), "exact")
    table = response.event_table()
    loose = np.array(table["time"])[np.array(table["after"]) == "slip forward"]
    slipping = (math.pi + 2.0 * math.atan(speed / (RATE * beyond))) / RATE
    period = slipping + 2.0 * beyond / speed
    assert len(loose) >= 5
    np.testing.assert_allclose(np.diff(loose)[1:], period, rtol=1e-6)


def test_stick_slip_at_the_boundary() -> None:
    """A block that has stopped stays where its stick can turn the force around within the cone.

    Stopped with the spring pulling f mu N it swings, critically damped, to its place: the force
    goes from mu N to -f mu N, and beyond that by (1 + f) mu N / e^2. So it stays for f < tanh 1.
    """
    unit = 0.1 * 10.0 / RATE**2
    for change, again in ((-2e-3, False), (2e-3, True)):
        # From (2 + f) mu N / k it comes to f mu N / k on the other side.
        start = (2.0 + math.tanh(1.0) + change) * unit
        after = bs.simulate(block(start, 0.06, **stiff_stick(0.1))).event_table()["after"]
        assert ("slip forward" in after) == again
        assert after[0] == "slip back"


def rubbing(seed: int) -> tuple[Rubbing, bs.Problem]:
    """A few modes thrown at a stop that rubs, for both algorithms."""
    random = np.random.default_rng(seed)
    modes = int(random.integers(2, 6))
    omega = np.sort(random.uniform(20.0, 200.0, modes))
    damping = random.uniform(0.0, 0.05, modes)
    normal, tangent = random.normal(size=(2, modes))
    case = Rubbing(
        omega2=omega**2,
        damping=2.0 * damping * omega,
        normal=normal,
        tangent=tangent,
        gap=float(random.choice([0.0, 1e-3])),
        stiffness=10.0 ** random.uniform(4.0, 5.5),
        tangential_stiffness=10.0 ** random.uniform(4.0, 5.5),
        friction=float(random.uniform(0.1, 1.0)),
    )
    basis = bs.ModalBasis.from_modes(
        frequency=(omega / math.tau).tolist(),
        damping=damping.tolist(),
        shapes={("P", "dx"): tangent, ("P", "dz"): normal},
    )
    stop = bs.Stop(
        "wall",
        node="P",
        normal=(0, 0, 1),
        gap=case.gap,
        stiffness=case.stiffness,
        friction=case.friction,
        tangential_stiffness=case.tangential_stiffness,
    )
    velocity = random.normal(size=modes) * 0.5
    initial = bs.ModalState(displacement=[0.0] * modes, velocity=velocity)
    return case, bs.Problem(basis, laws=[stop], initial=initial, duration=0.1)


@pytest.mark.parametrize("seed", [0, 2, 3, 4, 5, 6])
def test_steps_that_drag_a_slider_come_to_the_same_motion(seed: int) -> None:
    case, problem = rubbing(seed)
    assert problem.initial is not None
    q, v = problem.initial.modal_state(problem.basis)
    response = bs.simulate(problem, method="exact")
    assert response.event_count > 1
    errors = []
    for steps in (4_000, 16_000):
        path = case.motion(q, v, np.zeros(len(q)), 0.1 / steps, steps)
        exact = response.motion(0, times=np.linspace(0.0, 0.1, steps + 1))
        errors.append(np.abs(path - exact).max() / np.abs(exact).max())
    # Each switch costs the steps an error of the first or second order.
    assert errors[1] < 1e-3
    assert errors[1] < 0.6 * errors[0]


@pytest.mark.parametrize("seed", range(4))
def test_fixed_steps_carry_the_anchor_along(seed: int) -> None:
    _, problem = rubbing(seed)
    times = np.linspace(0.0, 0.1, 201)
    exact = bs.simulate(problem, method="exact").motion(0, times=times)
    errors = [
        np.abs(
            bs.simulate(problem, method="central_difference", dt=dt).motion(0, times=times) - exact
        ).max()
        for dt in (2e-5, 5e-6)
    ]
    assert errors[1] < 1e-4 * np.abs(exact).max()
    assert errors[1] < 0.5 * errors[0]


def errors_of_steps(problem: bs.Problem, steps: tuple[float, ...]) -> Any:
    times = np.linspace(0.0, problem.duration, 25)
    exact = position(bs.simulate(problem, method="exact"), times)
    return [
        np.abs(
            position(bs.simulate(problem, method="central_difference", dt=dt), times) - exact
        ).max()
        for dt in steps
    ]


def test_fixed_steps_keep_their_order_while_the_contact_sticks() -> None:
    problem = block(1e-4, 0.05, friction=1.0, tangential_stiffness=4e4, tangential_damping=20.0)
    assert bs.simulate(problem).event_count == 0
    errors = errors_of_steps(problem, (1e-4, 5e-5, 2.5e-5))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx([2.0, 2.0], abs=0.05)


def test_fixed_steps_keep_their_order_while_it_slides() -> None:
    """A block that breaks loose, which costs the square of the step, and slides to the end."""
    problem = block(0.0, 0.012, velocity=1.0, friction=0.3, tangential_stiffness=1e4)
    assert bs.simulate(problem).event_table()["after"] == ["slip forward"]
    errors = errors_of_steps(problem, (8e-5, 1e-5))
    assert math.log2(errors[0] / errors[1]) / 3.0 == pytest.approx(2.0, abs=0.4)


def flutter(friction: float) -> bs.Response:
    """A mass on inclined springs that rubs on a belt: mode coupling makes it unstable.

    N. Hoffmann, M. Fischer, R. Allgaier, L. Gaul, A minimal model for studying properties of the
    mode-coupling type instability in friction induced oscillations, 2002.
    """
    stiffness = np.array([[11.0, -4.0], [-4.0, 8.0]]) * 1e4
    omega2, shapes = np.linalg.eigh(stiffness)
    basis = bs.ModalBasis.from_modes(
        frequency=(np.sqrt(omega2) / math.tau).tolist(),
        damping=[0.0, 0.0],
        shapes={("P", "dx"): shapes[0], ("P", "dz"): shapes[1]},
    )
    floor = bs.Stop(
        "belt",
        node="P",
        normal=(0, 0, 1),
        gap=-1e-3,
        stiffness=6e4,
        friction=friction,
        tangential_stiffness=1e7,
    )
    initial = bs.ModalState(displacement=[0.0, 0.0], velocity=shapes.T @ [20.0, 0.0])
    problem = bs.Problem(basis, laws=[floor], initial=initial, duration=2e-3)
    return bs.simulate(problem, method="exact")


def test_sliding_phase_of_unit_friction_is_the_exponential_of_its_unsymmetric_matrix() -> None:
    from scipy.linalg import expm

    response = flutter(1.0)
    assert response.event_table()["after"][0] == "slip forward"
    switches = [float(time) for time in response.event_table()["time"]]
    start = switches[0] + 1e-5
    stiffness = np.array([[11.0, -4.0], [-4.0, 8.0]]) * 1e4
    # T = -F = k (z + gap): it pulls along x with what presses along z.
    sliding = stiffness + np.array([[0.0, -6e4], [0.0, 6e4]])
    push = 6e4 * np.array([-1e-3, 1e-3])
    generator = np.zeros((5, 5))
    generator[:2, 2:4] = np.eye(2)
    generator[2:4, :2] = -sliding
    generator[2:4, 4] = push

    def state(time: float) -> Any:
        pairs = [
            response.sample(quantity, "P", dof, times=[time])[0]
            for quantity in ("displacement", "velocity")
            for dof in ("dx", "dz")
        ]
        return np.array([*pairs, 1.0])

    end = 2e-3 if len(switches) == 1 else switches[1]
    for time in np.linspace(start, end, 5)[1:]:
        expected = expm(generator * (time - start)) @ state(start)
        assert state(time)[:4] == pytest.approx(expected[:4], rel=1e-11, abs=1e-13)


def one_mode_on_a_wall(*dofs: str) -> bs.Problem:
    basis = bs.ModalBasis.from_modes(frequency=[5.0], shapes={("P", dof): [1.0] for dof in dofs})
    wall = bs.Stop(
        "wall", node="P", normal=(1, 0, 0), stiffness=1e5, friction=0.2, tangential_stiffness=1e5
    )
    thrown = bs.ModalState(velocity=[-1.0])
    return bs.Problem(basis, laws=[wall], initial=thrown, duration=0.01)


def test_a_free_block_that_an_obstacle_throws_off_slides_meanwhile() -> None:
    """Nothing holds it along the obstacle, and no other force acts on it: it slides from the start,
    since the damper of a contact that sticks would take more than friction holds."""
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0, 0.0],
        damping=[0.0, 0.0],
        shapes={("P", "dx"): [1.0, 0.0], ("P", "dz"): [0.0, 1.0]},
    )
    k, depth, friction, speed = 5e3, 2e-3, 0.5, 1.0
    floor = bs.Stop(
        "floor",
        node="P",
        normal=(0, 0, 1),
        stiffness=k,
        friction=friction,
        sliding=(1, 0, 0),
        tangential_stiffness=3e4,
        tangential_damping=20.0,
    )
    start = bs.ModalState(displacement=[0.0, -depth], velocity=[speed, 0.0])
    problem = bs.Problem(basis, laws=[floor], initial=start, duration=2.0)
    response = bs.simulate(problem, "exact")
    # The force k depth cos(rate t) ends with the distance, and takes its impulse times friction.
    rate = math.sqrt(k)
    end = 0.5 * math.pi / rate
    left = speed - friction * depth * rate
    place = speed * end - friction * depth
    found = [response.sample("displacement", "P", dof, times=[2.0])[0] for dof in ("dx", "dz")]
    assert response.event_count >= 1
    assert found[1] == pytest.approx(depth * rate * (2.0 - end), rel=1e-12)
    assert found[0] == pytest.approx(place + left * (2.0 - end), rel=1e-12)


def test_a_node_that_one_mode_moves_slides_or_is_refused() -> None:
    sliding = bs.simulate(one_mode_on_a_wall("dx", "dy"))
    assert float(abs(sliding.friction_force("wall")).max()) > 0
    with pytest.raises(bs.InputError, match="no mode moves this node along the obstacle"):
        one_mode_on_a_wall("dx")


def test_what_is_refused() -> None:
    plain: dict[str, Any] = {"node": "P", "normal": (0, 0, 1), "stiffness": 1e4}
    with pytest.raises(bs.InputError, match="tangential_stiffness: friction needs it"):
        bs.Stop("floor", **plain, friction=0.2)
    with pytest.raises(bs.InputError, match="tangential_stiffness: belongs to friction"):
        bs.Stop("floor", **plain, tangential_stiffness=1e4)
    with pytest.raises(bs.InputError, match="dynamic: must not exceed"):
        bs.Stop("floor", **plain, friction={"static": 0.2, "dynamic": 0.3})
    with pytest.raises(bs.InputError, match="sliding: must not be the normal"):
        bs.Stop("floor", **plain, friction=0.2, tangential_stiffness=1e4, sliding=(0, 0, 2))
    shapes = {
        ("P", dof): row for dof, row in zip(("dx", "dy", "dz"), np.eye(3).tolist(), strict=True)
    }
    basis = bs.ModalBasis.from_modes(frequency=[1, 2, 3], damping=[0, 0, 0], shapes=shapes)
    free = bs.Stop("floor", **plain, friction=0.2, tangential_stiffness=1e4)
    with pytest.raises(bs.InputError, match=r"stops.floor.sliding: .*more than one direction"):
        bs.Problem(basis, laws=[free], duration=1.0)
    told = bs.Stop("floor", **plain, friction=0.2, tangential_stiffness=1e4, sliding=(3, 4, 7))
    assert bs.Problem(basis, laws=[told], duration=1.0).laws == (told,)
    assert told.sliding_row(basis) == pytest.approx([0.6, 0.8, 0.0])


@pytest.mark.parametrize("dampers", [(0.0, 0.0), (20.0, 0.0), (0.0, 10.0), (20.0, 10.0)])
def test_ledger_closes_with_every_damper(dampers: tuple[float, float]) -> None:
    normal, tangential = dampers
    for seed in range(6):
        _, problem = rubbing(seed)
        stop = problem.laws[0]
        assert isinstance(stop, bs.Stop)
        damped = replace(stop, damping=normal, tangential_damping=tangential)
        response = bs.simulate(replace(problem, laws=[damped], duration=0.5), method="exact")
        assert response.energy_residual < 1e-11
        if dampers == (0.0, 0.0):
            dissipated = response.energy_terms()["dissipated_stops"]
            assert (np.diff(dissipated) >= -1e-13 * dissipated[-1]).all()


def test_the_friction_force_and_the_state_are_told_over_time(tmp_path: Path) -> None:
    """A block slides, stops and sticks: mu N against the motion, then what holds the spring."""
    problem = block(0.0, 0.06, velocity=0.1, friction=0.1, tangential_stiffness=4e5)
    response = bs.simulate(problem)
    times = np.linspace(0.0, 0.06, 241)
    force = response.sample("friction_force", "floor", times=times)
    states = response.sample("state", "floor", times=times)
    assert set(states.tolist()) == {"stick", "slip forward", "slip back"}
    assert force[states == "slip forward"] == pytest.approx(-1.0, rel=1e-9)
    assert force[states == "slip back"] == pytest.approx(1.0, rel=1e-9)
    assert (np.abs(force[states == "stick"]) <= 1.0 + 1e-9).all()
    # The equation of motion knows it, too: x'' = -w^2 x + T.
    acceleration = response.sample("acceleration", "P", "dx", times=times)
    assert acceleration + RATE**2 * position(response, times) == pytest.approx(force, abs=1e-9)
    sampled = response.at(times)
    assert sampled.friction_force("floor").attrs["units"] == "N"
    assert sampled.state("floor").values.tolist() == states.tolist()
    path = tmp_path / "block.nc"
    sampled.to_netcdf(path)
    with xr.open_dataset(path, engine="h5netcdf") as file:
        assert file["friction_force"].values[:, 0] == pytest.approx(force)
        meanings = file["state"].attrs["flag_meanings"].split()
        read = [meanings[flag] for flag in file["state"].values[:, 0]]
    assert read == [name.replace(" ", "_") for name in states.tolist()]


def test_the_report_shades_where_the_contact_sticks() -> None:
    from bumpstop.report import figures

    response = bs.simulate(block(0.0, 0.06, velocity=0.1, friction=0.1, tangential_stiffness=4e5))
    figure = figures.friction_force(response, "floor")
    table = response.event_table()
    spans = zip(
        [0.0, *table["time"]], [*table["time"], 0.06], ["stick", *table["after"]], strict=True
    )
    sticking = [(start, end) for start, end, state in spans if state == "stick" and end > start]
    shapes = figure["layout"]["shapes"]
    milliseconds = [(s["x0"], s["x1"]) for s in shapes]
    assert milliseconds == [pytest.approx((1e3 * a, 1e3 * b)) for a, b in sticking]
    assert figure["layout"]["title"]["text"] == "Friction force of stop floor"
