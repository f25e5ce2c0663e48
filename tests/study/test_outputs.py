"""What studies keep of a run, against the run itself and closed forms."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import bumpstop as bs
from bumpstop import Output
from tests.study.bouncing import written

SPEED, MASS, GAP, STIFFNESS = 3.0, 2.0, 0.5, 200.0
RATE = math.sqrt(STIFFNESS / MASS)


@pytest.fixture(scope="module")
def ball(tmp_path_factory: pytest.TempPathFactory) -> bs.Response:
    folder = tmp_path_factory.mktemp("ball")
    written(folder)
    return bs.simulate(bs.load_case(folder / "case.toml").problems["base"])


@pytest.mark.parametrize(
    ("output", "expected"),
    [
        ({"quantity": "impacts"}, 1.0),
        ({"quantity": "events"}, 2.0),
        ({"quantity": "peak_force", "stop": "spring", "impact": 1}, SPEED * MASS * RATE),
        (
            {"quantity": "peak_force", "stop": "spring", "statistic": "maximum"},
            SPEED * MASS * RATE,
        ),
        ({"quantity": "opening_speed", "stop": "spring", "statistic": "last"}, SPEED),
        ({"quantity": "impact_count", "stop": "spring"}, 1.0),
        (
            {"quantity": "displacement", "node": "P", "dof": "dz", "statistic": "minimum"},
            -GAP - SPEED / RATE,
        ),
        ({"quantity": "stop_force", "stop": "spring", "statistic": "peak"}, SPEED * MASS * RATE),
        ({"quantity": "velocity", "node": "P", "dof": "dz", "statistic": "last"}, SPEED),
        ({"quantity": "velocity", "node": "P", "dof": "dz", "statistic": "peak"}, SPEED),
        (
            {"quantity": "energy", "term": "stored", "statistic": "maximum"},
            0.5 * MASS * SPEED**2,
        ),
    ],
)
def test_closed_forms(output: dict[str, object], expected: float, ball: bs.Response) -> None:
    assert Output(**output).value(ball) == pytest.approx(expected, rel=1e-10)  # type: ignore[arg-type]


def test_means_over_time(ball: bs.Response) -> None:
    place = {"quantity": "displacement", "node": "P", "dof": "dz"}
    mean = Output(**place, statistic="mean").value(ball)  # type: ignore[arg-type]
    rms = Output(**place, statistic="rms").value(ball)  # type: ignore[arg-type]
    times = np.linspace(0.0, 2.0, 400_001)
    fine = ball.sample("displacement", "P", "dz", times=times)
    assert mean == pytest.approx(fine.mean(), rel=1e-4)
    assert rms == pytest.approx(math.sqrt(np.mean(fine**2)), rel=1e-4)


def test_extremes_are_found_between_samples() -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[3.0, 7.3], damping=[0.01, 0.02], shapes={("P", "dx"): [1.0, -0.7]}
    )
    start = bs.ModalState(velocity=[1.0, 2.0])
    problem = bs.Problem(basis, initial=start, duration=1.0, sample=0.02)
    response = bs.simulate(problem)
    found = Output(quantity="displacement", node="P", dof="dx", statistic="maximum").value(response)
    best = response.times[np.argmax(response.sample("displacement", "P", "dx"))]
    refined = minimize_scalar(
        lambda time: -float(response.sample("displacement", "P", "dx", times=[time])[0]),
        bounds=(best - 0.02, best + 0.02),
        method="bounded",
        options={"xatol": 1e-12},
    )
    assert found == pytest.approx(-refined.fun, rel=1e-12)
    assert found > response.sample("displacement", "P", "dx").max()


def test_no_impact_has_no_statistic(tmp_path: Path) -> None:
    written(tmp_path)
    outputs = {"speed": Output(quantity="closing_speed", stop="spring", statistic="mean")}
    far = {"stops.spring.gap": [100.0]}
    found = bs.study(tmp_path / "case.toml", far, outputs, workers=1)
    assert np.isnan(found.speed.values).all()
    assert not found.failed.any()


def test_units_and_words() -> None:
    output = Output(quantity="velocity", node="P", dof="drz", statistic="rms")
    assert output.attributes == {"units": "rad/s", "long_name": "rms velocity of P drz"}
    assert Output(quantity="energy_residual").attributes["units"] == "1"
    assert Output(quantity="gap", stop="a", times=[0.0, 1.0]).shape == (2,)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"quantity": "displacment"}, "did you mean 'displacement'?"),
        ({"quantity": "displacement", "statistic": "peak"}, "node: is needed for displacement"),
        ({"quantity": "displacement", "node": "P", "dof": "dz"}, "statistic: is needed"),
        (
            {"quantity": "gap", "stop": "a", "statistic": "peek"},
            "(got 'peek'); did you mean 'peak'?",
        ),
        ({"quantity": "gap", "stop": "a", "statistic": "peak", "times": [1.0]}, "times are given"),
        ({"quantity": "impacts", "stop": "a"}, "impacts has no node, stop or part"),
        ({"quantity": "impacts", "statistic": "peak"}, "does not belong to one value of impacts"),
        ({"quantity": "peak_force", "stop": "a"}, "or the number of an impact"),
        ({"quantity": "mean_force", "stop": "a", "times": [1.0]}, "one value of the whole run"),
        ({"quantity": "frequency"}, "modes: is needed for frequency"),
    ],
)
def test_what_is_refused(given: dict[str, object], told: str) -> None:
    with pytest.raises(bs.InputError) as error:
        Output(**given)  # type: ignore[arg-type]
    assert told in str(error.value)
