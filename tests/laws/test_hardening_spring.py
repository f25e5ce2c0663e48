"""Elastic-plastic springs, exact: closed forms, return mapping, energies, bad input."""

from typing import Any

import numpy as np
import pytest

import bumpstop as bs

from .one_mass import one_mass, shaking
from .stretches import Change, Stretch, in_stretches

CURVE = [(1e-3, 100.0), (2e-3, 140.0), (5e-3, 160.0), (9e-3, 160.0)]


def spring(**changes: Any) -> bs.HardeningSpring:
    usual: dict[str, Any] = {"node": "P", "direction": (1, 0, 0), "curve": CURVE}
    return bs.HardeningSpring("tie", **usual | changes)


def instant(response: bs.Response, guard: str) -> float:
    """Return when a guard first fell."""
    events = response.events
    return float(events["time"][events["guard"] == guard].iloc[0])


def mapped(law: bs.HardeningSpring, elongations: Any) -> tuple[Any, float]:
    """Return tensions along a path by return mapping in small steps, and what was dissipated."""
    stiffness, points = law.stiffness, np.array(law.curve)
    plastic = points[:, 0] - points[:, 1] / stiffness
    part = total = lost = 0.0
    tensions = []
    for u in elongations:
        force = stiffness * (u - part)
        if law.hardening == "kinematic":
            slope = (points[1, 1] - points[0, 1]) / (plastic[1] - plastic[0])
            excess = abs(force - slope * part) - points[0, 1]
            sign = np.sign(force - slope * part)
            growth = max(0.0, excess) / (stiffness + slope)
            lost += points[0, 1] * growth
        else:
            sign, growth = np.sign(force), 0.0
            limits = np.interp([total], plastic, points[:, 1])
            if abs(force) > limits[0]:
                low, high = 0.0, abs(force) / stiffness
                for _ in range(60):
                    middle = 0.5 * (low + high)
                    left = abs(force) - stiffness * middle
                    if left > np.interp(total + middle, plastic, points[:, 1]):
                        low = middle
                    else:
                        high = middle
                growth = high
                lost += np.interp(total + growth / 2, plastic, points[:, 1]) * growth
        part, total = part + sign * growth, total + growth
        tensions.append(stiffness * (u - part))
    return np.array(tensions), lost


def test_a_pulled_mass_follows_the_curve_and_unloads_elastically() -> None:
    """Up to the turn the tension is that of the curve; the speed follows from the energy."""
    response = bs.simulate(one_mass(spring(), speed=1.88**0.5, duration=0.2), "exact")
    turn = instant(response, "turn back")
    times = np.linspace(0.0, turn, 50)
    x = response.sample("displacement", "P", "dx", times=times)
    tension = -response.sample("stop_force", "tie", times=times)
    assert tension == pytest.approx(spring().force(x), rel=1e-12, abs=1e-12)
    below = 0.05 + 0.12 + 0.45  # the area below the curve up to 5 mm
    far = 5e-3 + (0.94 - below) / 160.0
    assert x[-1] == pytest.approx(far, rel=1e-12)
    left = far - 160.0 / 1e5
    later = response.sample("displacement", "P", "dx", times=[turn + np.pi / 2 / np.sqrt(1e5)])
    assert later[0] == pytest.approx(left, rel=1e-12)
    assert response.energy_residual < 1e-13


@pytest.mark.parametrize("kind", ["isotropic", "kinematic"])
def test_a_shaken_mass_follows_return_mapping(kind: str) -> None:
    curve = CURVE if kind == "isotropic" else CURVE[:2]
    law = spring(curve=curve, hardening=kind)
    problem = one_mass(law, loads=[shaking(110.0, 30.0)], duration=0.2)
    exact = bs.simulate(problem, "exact")
    times = np.linspace(0.0, 0.2, 6001)
    x = exact.sample("displacement", "P", "dx", times=times)
    tension = -exact.sample("stop_force", "tie", times=times)
    expected, lost = mapped(law, x)
    assert np.abs(tension - expected).max() < 0.3
    assert len(set(exact.event_table()["guard"])) >= 3
    terms = exact.energy_terms([0.2])
    assert terms["dissipated_stops"][0] == pytest.approx(lost, rel=3e-3)
    assert exact.energy_residual < 1e-12
    for method, close in (("dop853", 1e-8), ("rk54", 1e-8)):
        run = bs.simulate(problem, method, rtol=1e-12)
        found = run.sample("displacement", "P", "dx", times=times[::50])
        assert np.abs(found - x[::50]).max() < close * np.abs(x).max()
        assert run.energy_residual < 1e-9
    for method in ("newmark", "symplectic_euler"):
        run = bs.simulate(problem, method, dt=4e-6)
        found = run.sample("displacement", "P", "dx", times=times[::50])
        assert np.abs(found - x[::50]).max() < 2e-3 * np.abs(x).max(), method


@pytest.mark.parametrize("kind", ["isotropic", "kinematic"])
def test_a_shaken_mass_is_that_of_scipy(kind: str) -> None:
    """Plastic flow by its own rate, from event to event: tension, motion and plastic elongation."""
    law = spring(curve=CURVE if kind == "isotropic" else CURVE[:2], hardening=kind)
    points, stiffness = np.array(law.curve), law.stiffness
    knots = points[:, 0] - points[:, 1] / stiffness
    slopes = np.diff(points[:, 1]) / np.diff(knots)
    isotropic = kind == "isotropic"

    def tension(y: Any) -> float:
        return float(stiffness * (y[0] - y[2]))

    def limit(y: Any, sign: float) -> float:
        """Return how far the tension is below its limit on one side."""
        if isotropic:
            return float(np.interp(y[3], knots, points[:, 1]) - sign * tension(y))
        return float(points[0, 1] - sign * (tension(y) - slopes[0] * y[2]))

    def below(sign: float) -> Any:
        return lambda y: limit(y, sign)

    def rates(t: float, y: Any, flow: float) -> Any:
        pull = 110.0 * np.sin(60.0 * np.pi * t)
        return [y[1], pull - tension(y), flow * y[1], abs(flow * y[1])]

    def elastic(_: Any) -> Stretch:
        ends = [Change(below(sign), -1.0, plastic(sign)) for sign in (1.0, -1.0)]
        return Stretch(lambda t, y: rates(t, y, 0.0), ends)

    def plastic(sign: float) -> Any:
        def begins(y: Any) -> Stretch:
            path = y[3] + 1e-13
            segment = min(int(np.searchsorted(knots, path, "right")) - 1, len(slopes) - 1)
            slope = slopes[segment if isotropic else 0]
            ends = [Change(lambda y: y[1], -sign, elastic)]
            if isotropic and segment + 1 < len(slopes):
                end = knots[segment + 1]
                ends.append(Change(lambda y: y[3] - end, 1.0, begins))
            return Stretch(lambda t, y: rates(t, y, stiffness / (stiffness + slope)), ends)

        return begins

    times = np.linspace(0.0, 0.2, 101)
    states = in_stretches(elastic(None), [0.0, 0.0, 0.0, 0.0], times)
    assert states[-1, 3] > 2e-3
    problem = one_mass(law, loads=[shaking(110.0, 30.0)], duration=0.2)
    for method in ("exact", "dop853"):
        response = bs.simulate(problem, method, rtol=None if method == "exact" else 1e-12)
        found = response.sample("displacement", "P", "dx", times=times)
        assert np.abs(found - states[:, 0]).max() < 1e-8 * np.abs(states[:, 0]).max()
        acting = -response.sample("stop_force", "tie", times=times)
        expected = stiffness * (states[:, 0] - states[:, 2])
        assert np.abs(acting - expected).max() < 1e-8 * np.abs(expected).max()
        for column, name in ((2, "plastic_elongation"), (3, "plastic_path")):
            inner = response.sample("internal_variable", "tie", name, times=times)
            assert np.abs(inner - states[:, column]).max() < 1e-8 * states[-1, 3]


@pytest.mark.parametrize("kind", ["isotropic", "kinematic"])
def test_kinematic_hardening_shifts_what_isotropic_hardening_widens(kind: str) -> None:
    """Pulled to F and back, the one yields at -F, the other 200 N below F."""
    law = spring(curve=CURVE[:2], hardening=kind)
    pull = bs.TimeTable([0.0, 1.0, 3.0], [0.0, 1.0, -1.2])
    load = bs.NodalForce("pull", node="P", force=(140.0, 0, 0), time=pull)
    damper = bs.DamperLaw("damper", node="P", direction=(1, 0, 0), damping=[600.0])
    response = bs.simulate(one_mass(law, damper, loads=[load], duration=3.0), "exact")
    turned, yielded = (
        -response.sample("stop_force", "tie", times=[instant(response, guard)])[0]
        for guard in ("turn back", "yield in compression")
    )
    assert turned > 135.0
    assert yielded == pytest.approx(-turned if kind == "isotropic" else turned - 200.0, rel=1e-12)


def test_long_curves_are_thinned_within_what_is_told() -> None:
    plastic = np.arange(0.0, 40.0, 0.01)
    force = 200.0 + 400.0 * plastic / (1.0 + (400.0 * plastic / 250.0) ** 1.5) ** (1 / 1.5)
    law = spring(curve=np.column_stack([plastic + 0.5, force]).tolist())
    points, deviation = law.thinned
    assert len(points) <= 128
    assert 0.0 < deviation < 0.02
    line = np.interp(plastic + 0.5, *points.T)
    assert np.abs(line - force).max() <= deviation * (1 + 1e-9)
    assert "of its 4000 points" in law.remarks[0]


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ({"curve": [(1e-3, 100.0)]}, "curve"),
        ({"curve": [(0.0, 0.0), (1e-3, 100.0)]}, "curve[0].elongation"),
        ({"curve": [(1e-3, 100.0), (1e-3, 120.0)]}, "curve[1]"),
        ({"curve": [(1e-3, 100.0), (2e-3, 90.0)]}, "curve[1]"),
        ({"curve": [(1e-3, 100.0), (2e-3, 300.0)]}, "curve[1]"),
        ({"hardening": "kinematic"}, "curve"),
        ({"hardening": "mixed"}, "hardening"),
    ],
)
def test_bad_input_is_refused(wrong: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        spring(**wrong)
    assert caught.value.key == key


def test_a_run_goes_on_with_what_has_yielded() -> None:
    unbroken = bs.simulate(one_mass(spring(), speed=0.9, duration=0.2), rtol=1e-11)
    first = bs.simulate(one_mass(spring(), speed=0.9, duration=0.1), rtol=1e-11)
    rest = bs.simulate(bs.continued(first, duration=0.1), rtol=1e-11)
    times = np.linspace(0.0, 0.1, 41)
    found, expected = rest.motion(0, times), unbroken.motion(0, 0.1 + times)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())
