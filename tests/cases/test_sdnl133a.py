"""The case sdnl133a."""

import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.canonical import velocity_matrix
from bumpstop.methods import usable_options
from bumpstop.post.references import check_references

FOLDER = Path(__file__).parents[2] / "cases" / "sdnl133a"


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(FOLDER / "case.toml")


@pytest.mark.parametrize("variant", ["splines", "lines", "published"])
def test_references(case: bs.Case, variant: str) -> None:
    method = case.methods[variant]
    response = bs.simulate(
        case.problems[variant], method.name, **usable_options(*method, case.problems[variant])
    )
    checks = check_references(response, case.references[variant])
    assert len(checks) == 4
    assert all(check.passed for check in checks)
    assert response.energy_residual < {"splines": 1e-9, "lines": 1e-4, "published": 1e-3}[variant]


def test_by_the_published_scheme_the_table_alone_is_left(case: bs.Case) -> None:
    """Where the crack is closed the coarser table is as good: seven digits are the deck's."""
    method = case.methods["published"]
    response = bs.simulate(
        case.problems["published"],
        method.name,
        **usable_options(*method, case.problems["published"]),
    )
    closed = response.sample("displacement", "tip", "dz", times=[1.0])[0]
    assert closed == pytest.approx(1.84420269199e-9, rel=4e-7)


def test_its_files_are_those_of_the_script(case: bs.Case) -> None:
    script: dict[str, Any] = runpy.run_path(str(FOLDER / "model.py"))
    mass, damping, stiffness = map(script["both_planes"], script["reduced"]())
    basis = case.problems["splines"].basis
    dofs = ["C dry", "tip dry", "tip dz", "C drz", "tip drz", "tip dy"]
    rows = [basis.dofs.index((dof.split()[0], dof.split()[1])) for dof in dofs]
    shapes = basis.shapes[rows]
    assert shapes.T @ mass @ shapes == pytest.approx(np.eye(6), abs=1e-10)
    largest = np.abs(basis.omega2).max()
    assert shapes.T @ stiffness @ shapes == pytest.approx(
        np.diag(basis.omega2), abs=1e-10 * largest
    )
    whole = velocity_matrix(basis)
    assert shapes.T @ damping @ shapes == pytest.approx(whole, abs=1e-10 * np.abs(whole).max())
    crack = np.loadtxt(FOLDER / "crack.csv", delimiter=",")
    assert script["crack"]() == pytest.approx(crack, rel=1e-12)
