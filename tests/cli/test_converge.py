"""``bumpstop converge``: what it prints, writes and returns."""

import json
from pathlib import Path

import pytest

from bumpstop.cli import main

SDNL32 = Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml"


def test_table(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["converge", str(SDNL32)]) == 0
    output = capsys.readouterr().out
    lines = output.splitlines()
    heads = ["time [s]", "published", "computed", "time error", "basis error", "mesh error"]
    assert all(head in lines[4] for head in heads)
    (row,) = [line.split() for line in lines if line.split()[:2] == ["0.012", "0.00499"]]
    # The computed value to six digits is that of a solution in forty digits.
    assert row[2:4] == ["0.00498249", "0"]
    assert float(row[6]) == pytest.approx(0.00498249 - float(row[4]) - float(row[5]), abs=1e-7)
    assert output.count("The published values are those of 10 modes, not of the structure") == 1
    assert output.count("are rather those of 10 modes than of the structure itself") == 1
    assert output.count("basis: 5, 10, 20, 21 vectors, the last with all modes") == 2


def test_json(capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--json", "--method", "symplectic_euler", "--levels", "2"]
    assert main(["converge", str(SDNL32), *options]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["case"] == "sdnl32"
    stiff = record["variants"][1]
    assert stiff["method"] == "symplectic_euler"
    assert stiff["published_values"]["verdict"] == "computed"
    assert stiff["refinements"]["time"]["sizes"] == pytest.approx([1e5, 2e5, 4e5])
    orders = [order for order in stiff["refinements"]["time"]["order"] if order is not None]
    assert orders == pytest.approx([1.0] * len(orders), abs=0.3)
    assert len(orders) > 6
    value = stiff["references"][11]
    assert (value["quantity"], value["node"], value["dof"]) == ("displacement", "B", "dy")
    left = value["value"] - sum(value["errors"].values())
    assert left == pytest.approx(value["converged"], rel=1e-12)


def test_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["converge", str(SDNL32), "--out", str(tmp_path / "out")]) == 0
    assert f"written to {tmp_path / 'out' / 'report.html'}" in capsys.readouterr().out
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert page.count("The published values are those of 10 modes") == 1
    for name in ("convergence-1-basis", "convergence-2-mesh"):
        assert f'data-figure="{name}"' in page


def test_report_of_a_modal_case(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case = SDNL32.parents[1] / "nafems-fv2" / "case.toml"
    assert main(["converge", str(case), "--out", str(tmp_path), "--levels", "2"]) == 0
    assert "basis: none: frequencies do not depend on" in capsys.readouterr().out
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert '<h2 id="convergence-title">Convergence</h2>' in page


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--levels", "0"], "levels: must be"),
        (["--method", "euler"], "--method: unknown method"),
        (["--dt", "1e-5"], "--dt: only methods with fixed steps take it"),
        (["--levels", "two"], "invalid int value"),
    ],
)
def test_wrong_options(
    options: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["converge", str(SDNL32), *options]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1


def test_a_case_without_references(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = SDNL32.read_text()
    (tmp_path / "case.toml").write_text(text[: text.index("[[references]]")])
    assert main(["converge", str(tmp_path / "case.toml")]) == 2
    assert "references: is missing: its values are what is refined" in capsys.readouterr().err
