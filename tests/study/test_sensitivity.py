"""Sobol's indices and worst cases, against closed forms."""

import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import bumpstop as bs
from bumpstop.study.indices import indices_of
from bumpstop.study.sampling import Sampling, unit_samples
from tests.study.bouncing import written

FORCE = bs.Output(quantity="largest_force", stop="spring")
STIFFNESS, MASS, GAP = "stops.spring.stiffness", "masses.ball.mass", "stops.spring.gap"


@pytest.fixture
def case(tmp_path: Path) -> bs.Case:
    written(tmp_path)
    return bs.load_case(tmp_path / "case.toml")


def test_indices_of_ishigamis_function() -> None:
    # T. Ishigami, T. Homma, ISUMA '90: f = sin x + a sin^2 y + b z^4 sin x on (-pi, pi)^3.
    a, b = 7.0, 0.1

    def function(shares: np.ndarray) -> np.ndarray:
        x, y, z = (2.0 * shares.T - 1.0) * math.pi
        value: np.ndarray = np.sin(x) + a * np.sin(y) ** 2 + b * z**4 * np.sin(x)
        return value

    shares = unit_samples(Sampling("sobol", 2**14, 1), 6)
    one, other = shares[:, :3], shares[:, 3:]
    mixed = []
    for number in range(3):
        samples = one.copy()
        samples[:, number] = other[:, number]
        mixed.append(function(samples))
    found = indices_of(function(one), function(other), np.array(mixed))
    alone_x = 0.5 * (1 + b * math.pi**4 / 5) ** 2
    alone_y = a**2 / 8
    together = b**2 * math.pi**8 * (1 / 18 - 1 / 50)
    variance = alone_x + alone_y + together
    assert found.first == pytest.approx(np.array([alone_x, alone_y, 0]) / variance, abs=0.01)
    expected = np.array([alone_x + together, alone_y, together]) / variance
    assert found.total == pytest.approx(expected, abs=0.01)


def test_indices_of_a_case(case: bs.Case) -> None:
    # The force is 3 sqrt(k m): its logarithm is a sum, and small scatter makes it one, too. The
    # gap does nothing.
    scattered = {
        STIFFNESS: bs.Distribution("lognormal", median=200.0, sigma=0.02),
        MASS: bs.Distribution("lognormal", median=2.0, sigma=0.01),
        GAP: bs.Range(0.4, 0.5),
    }
    found = bs.sobol_indices(case, scattered, {"force": FORCE}, count=64, workers=1)
    assert found.parameter.values.tolist() == [STIFFNESS, MASS, GAP]
    assert found.force_first.values == pytest.approx([0.8, 0.2, 0.0], abs=0.05)
    assert found.force_total.values == pytest.approx([0.8, 0.2, 0.0], abs=0.05)


def test_a_study_of_saltellis_design_tells_the_same_indices(case: bs.Case, tmp_path: Path) -> None:
    heavy = bs.Distribution("normal", mean=2.0, standard_deviation=0.1)
    scattered = {STIFFNESS: bs.Range(100.0, 300.0), MASS: heavy}
    signal = bs.Output(quantity="gap", stop="spring", times=[0.1, 0.2])
    study = bs.Study(
        case, scattered, {"force": FORCE, "gap": signal}, sampling=bs.Sampling("saltelli", 16, 3)
    )
    found = study.run(tmp_path / "study.zarr", workers=2)
    assert found.force.shape == (16 * 4,)
    alone = bs.sobol_indices(case, scattered, {"force": FORCE}, count=16, seed=3, workers=1)
    for part in ("force_first", "force_total"):
        xr.testing.assert_identical(found[part], alone[part])
    xr.testing.assert_identical(found, bs.open_study(tmp_path / "study.zarr"))
    # The third block is the first sample with the stiffness of the second.
    stiffness, mass = (found[key].values.reshape(4, 16) for key in (STIFFNESS, MASS))
    assert np.array_equal(stiffness[2], stiffness[1])
    assert np.array_equal(mass[2], mass[0])
    with pytest.raises(bs.InputError, match="this name is taken"):
        bs.Study(case, scattered, {"f": FORCE, "f_total": FORCE}, sampling=study.sampling)


def test_each_parameter_alone_in_a_study(case: bs.Case, tmp_path: Path) -> None:
    given = {STIFFNESS: bs.Range(100.0, 300.0), MASS: [1.0, 2.0, 3.0]}
    sampling = bs.Sampling("one_at_a_time", share=0.25)
    study = bs.Study(case, given, {"force": FORCE}, sampling=sampling)
    found = study.run(tmp_path / "study.zarr", workers=1)
    assert found.force.dims == ("parameter", "side")
    assert found["value"].values.tolist() == [[150.0, 200.0, 250.0], [1.0, 2.0, 3.0]]
    stiffness = np.array([[150.0, 200.0, 250.0], [200.0, 200.0, 200.0]])
    mass = np.array([[2.0, 2.0, 2.0], [1.0, 2.0, 3.0]])
    np.testing.assert_array_equal(found[STIFFNESS].values, stiffness)
    np.testing.assert_array_equal(found[MASS].values, mass)
    np.testing.assert_allclose(found.force.values, 3.0 * np.sqrt(stiffness * mass), rtol=1e-12)
    xr.testing.assert_identical(found, bs.open_study(tmp_path / "study.zarr"))
    with pytest.raises(bs.InputError, match="this name is taken"):
        bs.Study(case, given, {"value": FORCE}, sampling=sampling)


def test_indices_need_all_runs_and_single_numbers(case: bs.Case) -> None:
    with pytest.raises(bs.ComputationError, match="runs failed: stops"):
        bs.sobol_indices(
            case, {STIFFNESS: bs.Range(-1.0, 1.0)}, {"force": FORCE}, count=4, workers=1
        )
    signal = bs.Output(quantity="gap", stop="spring", times=[0.1, 0.2])
    with pytest.raises(bs.InputError, match="must be a single number"):
        bs.sobol_indices(case, {GAP: bs.Range(0.1, 0.2)}, {"gap": signal}, count=4)


def test_the_worst_case_is_found_within(case: bs.Case) -> None:
    # After the impact, -gap + 3 (t - gap / 3 - pi sqrt(m / k)) is largest for a gap of 0 and the
    # stiffest spring.
    last = bs.Output(quantity="displacement", node="P", dof="dz", statistic="last")
    ranges = {GAP: bs.Range(0.0, 0.5), STIFFNESS: bs.Range(50.0, 800.0)}
    found = bs.worst_case(case, ranges, last, runs=800)
    best = 3.0 * (2.0 - math.pi * math.sqrt(2.0 / 800.0))
    assert found.value == pytest.approx(best, rel=2e-3)
    assert found.value <= best * (1 + 1e-12)
    assert found.parameters[STIFFNESS] == pytest.approx(800.0, rel=0.02)
    assert found.runs <= 800
    assert found == bs.worst_case(case, ranges, last, runs=800)


def test_searches_that_cannot_be(case: bs.Case) -> None:
    with pytest.raises(bs.InputError, match="runs: a generation has 8 runs, 8 for each parameter"):
        bs.worst_case(case, {GAP: bs.Range(0.1, 0.2)}, FORCE, runs=3)
    with pytest.raises(bs.InputError, match="output: must be an Output"):
        bs.worst_case(case, {GAP: bs.Range(0.1, 0.2)}, {"force": FORCE})  # type: ignore[arg-type]
    with pytest.raises(bs.ComputationError, match="all of the first 8 runs failed: stops"):
        bs.worst_case(case, {STIFFNESS: bs.Range(-2.0, -1.0)}, FORCE, runs=16)
    with pytest.raises(bs.ComputationError, match="none of 80 runs has a value of what is looked"):
        bs.worst_case(case, {GAP: bs.Range(100.0, 200.0)}, FORCE, runs=80)


def test_a_search_goes_on_where_there_is_no_impact_yet(case: bs.Case) -> None:
    # A ball of 3 m/s reaches 6 m in the 2 s of the run.
    found = bs.worst_case(case, {GAP: bs.Range(0.0, 100.0)}, FORCE, runs=160)
    assert found.runs == 160
    assert found.value == pytest.approx(3.0 * math.sqrt(200.0 * 2.0), rel=1e-3)


def test_indices_need_the_result_of_every_run(case: bs.Case) -> None:
    with pytest.raises(bs.ComputationError, match="runs have no force: variances need all"):
        bs.sobol_indices(case, {GAP: bs.Range(1, 12)}, {"force": FORCE}, count=16, workers=1)
