"""All validation cases pass, and those about modes find each multiple frequency in its place."""

import json
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.cli import main

CASES = Path(__file__).parents[2] / "cases"


def test_every_case_meets_its_published_values(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--cases", str(CASES), "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["passed"]
    names = [case["case"] for case in record["cases"]]
    assert names == sorted(file.parent.name for file in CASES.glob("*/case.toml"))
    for case in record["cases"]:
        assert all(variant["references"] for variant in case["variants"])


@pytest.mark.parametrize(
    ("name", "multiplicities"),
    [
        ("nafems-fv2", [1, 2, 5, 1, 2, 5]),
        ("nafems-fv3", [3, 1, 1, 2, 1, 1, 2]),
        ("nafems-fv5", [2, 1, 1, 2, 1, 2]),
        ("sdll09", [1, 1, 1, 1, 1]),
    ],
)
def test_multiple_frequencies(name: str, multiplicities: list[int]) -> None:
    basis = next(iter(bs.load_case(CASES / name / "case.toml").bases.values()))
    apart = np.diff(basis.frequencies) > 1e-9 * basis.frequencies[-1]
    groups = np.split(basis.frequencies, np.flatnonzero(apart) + 1)
    assert [len(group) for group in groups] == multiplicities


def test_a_free_frame_has_three_rigid_modes() -> None:
    basis = bs.load_case(CASES / "nafems-fv3" / "case.toml").bases["base"]
    assert basis.frequencies[:3].tolist() == [0.0, 0.0, 0.0]
    assert len(basis.rigid_modes) == 3


def test_the_deep_beam_follows_the_closed_form_of_timoshenko() -> None:
    modulus, ratio, density, side, length = 200e9, 0.3, 8000.0, 2.0, 10.0
    area, inertia = side**2, side**4 / 12
    shear = 10 * (1 + ratio) / (12 + 11 * ratio) * modulus / (2 * (1 + ratio)) * area
    expected = []
    for waves in (1, 2, 3):
        q = waves * np.pi / length
        quadratic = [
            density**2 * area * inertia,
            -density * (area * (modulus * inertia * q**2 + shear) + inertia * shear * q**2),
            modulus * inertia * shear * q**4,
        ]
        expected.append(np.sqrt(np.roots(quadratic).min()) / (2 * np.pi))
    basis = bs.load_case(CASES / "nafems-fv5" / "case.toml").bases["base"]
    np.testing.assert_allclose(basis.frequencies[[0, 4, 7]], expected, rtol=3e-4)
