"""The case SDNL32, through the whole chain from the file to the tip."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

FOLDER = Path(__file__).parents[2] / "cases" / "sdnl32"

EXACT = {
    "soft": [
        -0.0026630074754697424,
        -0.004335434178442924,
        -0.004952964893569209,
        -0.004782798954063054,
        -0.00382512588955237,
        -0.0028753903293462202,
        -0.0027099607167028715,
        -0.0030877305847437316,
        -0.0034066092932065954,
        -0.003364211840662438,
        -0.0026433186577396912,
        -0.0007442702007923218,
    ],
    "stiff": [
        -0.0022501408478655996,
        -0.002657796120160796,
        -0.0019651832717182847,
        -0.0011570312221391701,
        -0.00012291384262992373,
        -0.00036273951615495623,
        -0.002007473268830859,
        -0.002740656054817856,
        -0.0018950775201947362,
        -0.0003538920573262055,
        0.001700341352540431,
        0.00498249244645018,
    ],
}
"""Deflection of the tip at 1 to 12 ms, in m: 40-digit arithmetic on an independent model."""

LOST = {"soft": 0.012302783633707, "stiff": 0.010222552119430}
"""When contact is lost, in s; of the same origin."""


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(FOLDER / "case.toml")


@pytest.fixture(scope="module")
def responses(case: bs.Case) -> dict[str, bs.Response]:
    return {name: bs.simulate(problem, "exact") for name, problem in case.problems.items()}


@pytest.mark.parametrize("variant", ["soft", "stiff"])
@pytest.mark.parametrize(
    ("method", "dt"), [("exact", None), ("symplectic_euler", 1e-5), ("central_difference", 1e-5)]
)
def test_published_values(variant: str, method: str, dt: float | None, case: bs.Case) -> None:
    response = bs.simulate(case.problems[variant], method, dt=dt)
    checks = check_references(response, case.references[variant])
    assert len(checks) == 12
    assert [check.time for check in checks] == pytest.approx(np.arange(1, 13) * 1e-3, rel=1e-15)
    assert {check.tolerance for check in checks} == {0.008 if variant == "soft" else 0.012}
    assert all(check.passed for check in checks)


@pytest.mark.parametrize("variant", ["soft", "stiff"])
def test_exact_solution(variant: str, responses: dict[str, bs.Response]) -> None:
    response = responses[variant]
    times = np.arange(1, 13) * 1e-3
    tip = response.sample("displacement", "B", "dy", times=times)
    largest = np.abs(response.sample("displacement", "B", "dy")).max()
    assert np.abs(tip - EXACT[variant]).max() < 1e-9 * largest
    impacts = response.impact_table()
    assert impacts["start"][0] == 0.0
    assert impacts["end"][0] == pytest.approx(LOST[variant], abs=1e-10)
    assert response.energy_residual < 1e-11


@pytest.mark.parametrize("variant", ["soft", "stiff"])
def test_strain_follows_from_the_rotation(variant: str, responses: dict[str, bs.Response]) -> None:
    response = responses[variant]
    step = 1e-4
    before, after = (
        response.sample("displacement", f"AB@{place!r}", "drz")
        for place in (0.462 - step, 0.462 + step)
    )
    strain = response.sample("gauge", "strain")
    # The rotation is a parabola along an element, so its central difference is exact.
    np.testing.assert_allclose(strain, -0.007 * (after - before) / (2 * step), atol=1e-10)
    assert 5e-4 < np.abs(strain).max() < 5e-3


def test_a_static_shape_is_worth_more_than_five_modes() -> None:
    """By the table of the README, which another test computes anew."""
    errors = {
        row[1].strip(): [float(cell.split()[0]) for cell in row[2:4]]
        for row in (line.split("|") for line in (FOLDER / "README.md").read_text().splitlines())
        if len(row) == 5 and "modes" in row[1] and "%" in row[2]
    }
    five, ten = errors["5 modes and the static shape of the stop"], errors["10 modes"]
    for enriched, plain, bare in zip(five, ten, errors["5 modes"], strict=True):
        assert enriched < 0.7 * plain
        assert enriched < 0.1 * bare
