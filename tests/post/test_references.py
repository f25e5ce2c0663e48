import math
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import (
    REFERENCE_QUANTITIES,
    Check,
    Reference,
    check_frequencies,
    check_references,
)
from bumpstop.quantities import ENERGIES, IMPACTS, QUANTITIES

SPEED, STIFFNESS = 0.5, 1e4
OMEGA = math.sqrt(STIFFNESS)


@pytest.fixture(scope="module")
def response() -> bs.Response:
    """A free mass of 1 kg runs against a stop: half a sine, and off again."""
    basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("P", "dx"): [1.0]})
    stop = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=0.01, stiffness=STIFFNESS)
    start = bs.ModalState(velocity=[-SPEED])
    problem = bs.Problem(basis, laws=[stop], initial=start, duration=0.1)
    return bs.simulate(problem, method="exact")


def only(response: bs.Response, **fields: Any) -> Check:
    (check,) = check_references(response, [Reference(**({"tolerance": 1e-9} | fields))])
    return check


@pytest.mark.parametrize(
    ("fields", "value"),
    [
        ({"quantity": "displacement", "node": "P", "dof": "dx"}, -0.005),
        ({"quantity": "velocity", "node": "P", "dof": "dx"}, -SPEED),
        ({"quantity": "modal_displacement", "mode": 1}, -0.005),
        ({"quantity": "gap", "stop": "wall"}, 0.005),
        ({"quantity": "energy", "term": "kinetic"}, 0.5 * SPEED**2),
    ],
)
def test_quantities_of_time(response: bs.Response, fields: dict[str, Any], value: Any) -> None:
    check = only(response, **fields, times=[0.01], values=[value])
    assert check.passed
    assert check.time == 0.01
    assert check.value == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("quantity", "value"),
    [
        ("impact_start", 0.02),
        ("impact_end", 0.02 + math.pi / OMEGA),
        ("impact_duration", math.pi / OMEGA),
        ("closing_speed", SPEED),
        ("opening_speed", SPEED),
        ("peak_force", OMEGA * SPEED),
        ("peak_time", 0.02 + math.pi / OMEGA / 2),
        ("impulse", 2.0 * SPEED),
        ("energy_returned", 0.5 * SPEED**2),
    ],
)
def test_quantities_of_an_impact(response: bs.Response, quantity: str, value: Any) -> None:
    check = only(response, quantity=quantity, stop="wall", impact=1, values=[value])
    assert check.passed
    assert check.time == pytest.approx(0.02, rel=1e-12)
    assert check.target == (quantity, "wall", 1)


def test_every_quantity_of_an_impact_has_a_column() -> None:
    of_impacts = [name for name, target in REFERENCE_QUANTITIES.items() if "impact" in target]
    assert len(of_impacts) == len(IMPACTS)


def test_deviation_is_relative_to_the_reference(response: bs.Response) -> None:
    given = {"quantity": "gap", "stop": "wall", "times": [0.01], "values": [0.004]}
    outside = only(response, **given, tolerance=0.24)
    inside = only(response, **given, tolerance=0.26)
    assert outside.deviation == pytest.approx(0.25, rel=1e-12)
    assert (outside.passed, inside.passed) == (False, True)
    assert not outside.absolute


def test_deviation_may_be_absolute(response: bs.Response) -> None:
    given = {"quantity": "gap", "stop": "wall", "times": [0.02], "values": [0.0]}
    check = only(response, **given, tolerance=None, absolute_tolerance=1e-12)
    assert check.passed
    assert check.absolute
    assert check.deviation == abs(check.value)


def test_one_check_a_value_in_their_order(response: bs.Response) -> None:
    references = [
        Reference(
            quantity="gap", stop="wall", times=[0.0, 0.01], values=[0.01, 0.005], tolerance=1e-9
        ),
        Reference(quantity="gap", stop="wall", times=[0.005], values=[0.0075], tolerance=1e-9),
    ]
    checks = check_references(response, references)
    assert [check.time for check in checks] == [0.0, 0.01, 0.005]
    assert all(check.passed for check in checks)


def test_a_missing_impact_never_passes(response: bs.Response) -> None:
    check = only(response, quantity="impulse", stop="wall", impact=2, values=[1.0], tolerance=1e9)
    assert math.isnan(check.value)
    assert math.isnan(check.deviation)
    assert not check.passed


def test_nan_never_passes(response: bs.Response) -> None:
    """A contact cut off by the end of the run has no end."""
    problem = response.problem
    cut = bs.Problem(problem.basis, laws=problem.laws, initial=problem.initial, duration=0.03)
    check = only(
        bs.simulate(cut), quantity="impact_end", stop="wall", impact=1, values=[0.05], tolerance=1e9
    )
    assert check.time == pytest.approx(0.02)
    assert not check.passed


OF_IMPACT: dict[str, Any] = {"quantity": "impulse", "node": None, "dof": None, "stop": "wall"}
GOOD: dict[str, Any] = {
    "quantity": "displacement",
    "node": "P",
    "dof": "dx",
    "times": [0.01],
    "values": [1.0],
    "tolerance": 0.01,
}


@pytest.mark.parametrize(
    ("changes", "key", "what"),
    [
        ({"quantity": "displacment"}, "quantity", "did you mean 'displacement'"),
        ({"node": None}, "node", "is needed for displacement"),
        ({"stop": "wall"}, "stop", "does not belong to displacement"),
        ({"times": [0.01, 0.02]}, "times", "as many as there are values, 1"),
        ({"times": ()}, "times", "as many as there are values, 1"),
        ({"values": []}, "values", "numbers"),
        ({"values": [float("nan")]}, "values", "must be finite"),
        ({"tolerance": None}, "tolerance", "either tolerance or absolute_tolerance"),
        ({"absolute_tolerance": 0.1}, "tolerance", "either tolerance or absolute_tolerance"),
        ({"tolerance": -0.1}, "tolerance", "must not be negative"),
        ({"values": [0.0]}, "tolerance", "give absolute_tolerance"),
        ({"quantity": "energy", "node": None, "dof": None, "term": "kinetics"}, "term", "kinetic"),
        (OF_IMPACT | {"impact": 0}, "impact", "must be 1 or more"),
        (OF_IMPACT | {"impact": 1}, "values", "without times"),
    ],
)
def test_refuses(changes: dict[str, Any], key: str, what: str) -> None:
    with pytest.raises(bs.InputError, match=what) as caught:
        Reference(**(GOOD | changes))
    assert caught.value.key == key


@pytest.mark.parametrize(
    ("fields", "what"),
    [
        ({"node": "Q"}, "'Q'"),
        ({"quantity": "gap", "node": None, "dof": None, "stop": "wal"}, "did you mean 'wall'"),
        ({"times": [0.2]}, "within the simulated time"),
    ],
)
def test_what_the_problem_does_not_have(
    response: bs.Response, fields: dict[str, Any], what: str
) -> None:
    with pytest.raises(bs.InputError, match=what):
        check_references(response, [Reference(**(GOOD | fields))])


@pytest.mark.parametrize(
    ("fields", "units"),
    [
        ({"quantity": "velocity", "node": "P", "dof": "drz"}, "rad/s"),
        ({"quantity": "stop_force", "stop": "wall"}, "N"),
        ({"quantity": "energy", "term": "total"}, "J"),
    ],
)
def test_units(fields: dict[str, Any], units: str) -> None:
    assert Reference(**fields, times=[0.0], values=[1.0], tolerance=0.1).units == units


def test_units_of_impacts() -> None:
    reference = Reference(quantity="impulse", stop="w", impact=1, values=[1.0], tolerance=0.1)
    assert reference.units == "N s"


def test_units_are_known_to_pint() -> None:
    import pint

    registry: pint.UnitRegistry[Any] = pint.UnitRegistry()
    for quantity in (QUANTITIES | ENERGIES | IMPACTS).values():
        registry.parse_units(quantity.units)


def test_published_values_may_come_as_an_array(response: bs.Response) -> None:
    times = np.array([0.0, 0.01])
    reference = Reference(
        quantity="gap", stop="wall", times=times, values=0.01 - SPEED * times, tolerance=1e-9
    )
    assert all(check.passed for check in check_references(response, [reference]))


def test_frequencies_are_those_of_the_numbered_modes() -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[0.0, 3.0, 7.0], shapes={("P", "dx"): [1.0, 1.0, 1.0]}
    )
    both = Reference(quantity="frequency", modes=[3, 2], values=[7.07, 3.0], tolerance=0.009)
    rigid = Reference(quantity="frequency", mode=1, values=[0.0], absolute_tolerance=1e-12)
    checks = check_frequencies(basis, [both, rigid])
    assert [check.mode for check in checks] == [3, 2, 1]
    assert [check.passed for check in checks] == [False, True, True]
    assert checks[0].deviation == pytest.approx(0.07 / 7.07)
    assert checks[2].units == "Hz"
    assert all(math.isnan(check.time) and not check.missing for check in checks)


def test_frequencies_are_checked_beside_what_runs(response: bs.Response) -> None:
    check = only(response, quantity="frequency", mode=1, values=[1.0])
    assert (check.value, check.passed) == (0.0, False)


def test_mistakes_in_frequencies(response: bs.Response) -> None:
    given: dict[str, Any] = {"quantity": "frequency", "values": [1.0], "tolerance": 0.1}
    for fields, message in (
        ({}, "modes: is needed for frequency"),
        ({"mode": 1, "modes": [1]}, "modes: give either mode or modes"),
        ({"modes": [1, 2]}, "modes: must be as many as there are values, 1"),
        ({"modes": [0]}, "modes: must be 1 or more"),
        ({"modes": [1], "times": [0.0]}, "times: frequencies have no times"),
        ({"modes": [1], "node": "P"}, "node: does not belong to frequency"),
    ):
        with pytest.raises(bs.InputError, match=message):
            Reference(**(given | fields))
    with pytest.raises(bs.InputError, match="modes: must be at most 1"):
        only(response, quantity="frequency", mode=2, values=[1.0])
    displacement = Reference(quantity="gap", stop="wall", times=[0.0], values=[1.0], tolerance=0.1)
    with pytest.raises(bs.InputError, match="quantity: is not a frequency"):
        check_frequencies(response.problem.basis, [displacement])
