"""``bumpstop modes``, ``verify``, ``report`` and ``schema``."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.cli import main
from bumpstop.errors import ComputationError
from bumpstop.io.case import load_case
from bumpstop.io.schema import case_schema

CASES = Path(__file__).parents[2] / "cases"
SDNL32 = CASES / "sdnl32" / "case.toml"


def test_modes(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["modes", str(SDNL32)]) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["soft,", "stiff"] in lines
    # The rigid rotation of a rod takes three quarters of its mass, its generalised mass is a third.
    assert ["1", "0", "1", "0.1228", "0.00", "74.99", "0.00"] in lines
    assert ["2", "85.4068", "1"] in [line[:3] for line in lines]
    assert lines[-3][0] == "sum"
    assert " ".join(lines[-2]).startswith("10 modes below ")
    assert lines[-1] == ["1", "rigid", "mode:", "rotation", "about", "z", "through", "A"]


def test_modes_of_a_band(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "case.toml"
    banded = SDNL32.read_text().replace("modes = 10\n", "modes = { band = [80, '600 Hz'] }\n")
    file.write_text(banded)
    assert main(["modes", str(file)]) == 0
    said = capsys.readouterr().out
    assert "3 modes from 80 Hz to 600 Hz, none missed" in said
    assert "276.393" in said


def test_modes_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["modes", str(SDNL32), "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    basis = load_case(SDNL32).problems["soft"].basis
    assert record["case"] == "sdnl32"
    assert record["frequencies"] == basis.frequencies.tolist()
    assert record["damping"] == [0.01] * 10
    assert record["rigid_modes"] == ["rotation about z through A"]
    assert record["variants"]["stiff"]["frequencies"] == record["frequencies"]
    mass = 2400 * 0.014**2 * 0.783
    assert record["total_mass"]["dy"] == pytest.approx(mass)
    assert record["effective_mass"]["dy"][0] == pytest.approx(0.75 * mass, rel=1e-3)
    assert record["generalised_mass"][0] == pytest.approx(mass / 3, rel=1e-3)
    assert record["labels"][9] == "mode 10"
    assert [remark[:12] for remark in record["remarks"]] == ["10 modes bel", "1 rigid mode"]


def test_modes_with_static_shapes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "case.toml"
    shapes = 'modes = 4\nstatic_shapes = [["B", "dy"], ["B", "drz"], ["B", [0, 3, 0]]]\n'
    file.write_text(SDNL32.read_text().replace("modes = 10\n", shapes))
    assert main(["modes", str(file)]) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert lines[3][-1] == "what"
    assert lines[4][-2:] == ["mode", "1"]
    assert lines[8][-1] == lines[9][-1] == "combination"
    dropped = "static shape of B.dy is left out: it depends on those before it"
    assert " ".join(lines[-1]) == dropped


def test_modes_that_damping_and_spin_couple(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    skew = np.zeros((4, 4))
    skew[2, 3], skew[3, 2] = 2.0, -2.0
    model = bs.Matrices(
        stiffness=np.diag([50.0, 50.0, 8.0, 8.0]),
        mass=np.diag([2.0, 2.0, 0.5, 0.5]),
        gyroscopic=skew,
        dofs=[("P", "dy"), ("P", "dz"), ("P", "dry"), ("P", "drz")],
        positions={"P": (0, 0, 0)},
    )
    basis = bs.ModalBasis.from_structure(model, modes=4, damping=0.01)
    problem = bs.Problem(basis, duration=1.0)
    case = replace(load_case(SDNL32), bases={"base": basis}, problems={"base": problem})
    monkeypatch.setattr("bumpstop.cli.modes.load_case", lambda _path: case)
    assert main(["modes", "rotor.toml"]) == 0
    lines = capsys.readouterr().out.splitlines()
    start = next(number for number, line in enumerate(lines) if "that couple these modes" in line)
    whirls = [line.split()[3:] for line in lines[start + 2 : start + 6]]
    # A disc on springs: its two tilts part, its translations do not.
    assert whirls == [["backward", "1.00"], ["-"], ["-"], ["forward", "1.00"]]
    assert main(["modes", "rotor.toml", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)["complex_modes"]
    roots = np.sqrt(4.0 + 16.0) + np.array([-2.0, 2.0])
    assert record["frequencies"][::3] == pytest.approx(roots / (2 * np.pi), rel=1e-3)


def test_modes_of_variants_with_other_structures(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "case.toml"
    file.write_text(SDNL32.read_text() + "\n[variants.light]\nmaterials.alloy.density = 600\n")
    assert main(["modes", str(file)]) == 0
    output = capsys.readouterr().out
    assert "\nsoft, stiff\n" in output
    assert "\nlight\n" in output
    assert " 85.4068 " in output
    assert " 170.814 " in output


@pytest.fixture
def cases(tmp_path: Path) -> Path:
    """Return a folder of two cases, the second with a reference that nothing can meet."""
    for name in ("good", "wrong"):
        text = SDNL32.read_text().replace('method = "exact"', 'method = "symplectic_euler"')
        if name == "wrong":
            text = text.replace("-2.66e-3, -4.33e-3", "-2.66e-3, +4.33e-3")
        (tmp_path / name).mkdir()
        (tmp_path / name / "case.toml").write_text(text)
    (tmp_path / "notes").mkdir()
    return tmp_path


def test_verify(cases: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--cases", str(cases)]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split()[:3] == ["case", "variant", "method"]
    assert [line.split()[:2] for line in lines[1:5]] == [
        ["good", "soft"],
        ["good", "stiff"],
        ["wrong", "soft"],
        ["wrong", "stiff"],
    ]
    assert lines[1].endswith("all 12 checks passed")
    assert lines[3].endswith("1 of 12 checks FAILED")
    assert lines[-1] == "FAILED"


def test_verify_by_name(cases: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--json", "good", "--cases", str(cases)]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["passed"] is True
    assert [case["case"] for case in record["cases"]] == ["good"]
    assert len(record["cases"][0]["variants"]) == 2


def test_a_case_that_cannot_be_run_does_not_hide_the_others(
    cases: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    broken = cases / "a-broken-one" / "case.toml"
    broken.parent.mkdir()
    broken.write_text("title = 3\n")
    assert main(["verify", "--cases", str(cases)]) == 2
    output, error = capsys.readouterr()
    lines = output.splitlines()
    assert lines[1].split() == ["a-broken-one", "could", "NOT", "be", "run"]
    assert lines[2].endswith("all 12 checks passed")
    assert lines[4].endswith("1 of 12 checks FAILED")
    assert lines[-1] == "FAILED"
    assert error.startswith(f"error: {broken}: title: ")
    assert error.count("\n") == 1
    assert main(["verify", "--json", "--cases", str(cases), "a-broken-one", "good"]) == 2
    output, error = capsys.readouterr()
    record = json.loads(output)
    assert record["passed"] is False
    first, second = record["cases"]
    assert (first["case"], first["variants"], first["passed"]) == ("a-broken-one", [], False)
    assert error == f"error: {first['error']}\n"
    assert second["passed"] is True


def test_a_case_that_could_not_be_finished_has_its_own_status(
    cases: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise ComputationError("no way")

    monkeypatch.setattr("bumpstop.cli.solve.check_references", fail)
    assert main(["verify", "--cases", str(cases)]) == 3
    assert capsys.readouterr().err.count("variant soft: no way\n") == 2


def test_verify_by_a_method_with_steps(capsys: pytest.CaptureFixture[str]) -> None:
    method = "central_difference"
    arguments = ["verify", "ball-on-spring", "--cases", str(CASES), "--method", method]
    assert main(arguments) == 2
    assert f"run.dt: the {method} method needs a step" in capsys.readouterr().err
    assert main([*arguments, "--dt", "1e-6"]) == 0
    assert method in capsys.readouterr().out


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (["--dt", "1e-5"], "--dt: only methods with fixed steps take it; give --method, too"),
        (["--dt", "1e-5", "--method", "exact"], "--dt: only methods with fixed steps take it"),
        (["--dt", "-1", "--method", "symplectic_euler"], "--dt: must be positive"),
        (["--dt", "-1e-5", "--method", "newmark"], "--dt: must be positive (got -1e-05)"),
        (["--dt", "-.5us", "--method", "newmark"], "--dt: must be positive"),
        (["--rtol", "-1e-3", "--method", "dop853"], "--rtol: must be positive (got -0.001)"),
        (["--dt", "-inf", "--method", "newmark"], "--dt: must be finite"),
        (
            ["--dt", "a", "--method", "symplectic_euler"],
            "argument --dt: is not a number with a unit",
        ),
        (["--dt", "1kg", "--method", "symplectic_euler"], "argument --dt: wrong unit: 'kg' is"),
    ],
)
def test_steps_that_nothing_takes(
    given: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(SDNL32), *given]) == 2
    output, error = capsys.readouterr()
    assert output == ""
    assert error.startswith(f"error: {says}")


def test_the_step_on_the_command_line_is_taken(capsys: pytest.CaptureFixture[str]) -> None:
    stepped = ["run", str(SDNL32), "--method", "central_difference", "--dt", "2e-6", "--json"]
    assert main(stepped) == 0
    assert json.loads(capsys.readouterr().out)["variants"][0]["steps"] == 10_000


def test_verify_takes_the_folder_named_cases(
    cases: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    cases.rename(cases.parent / "cases")
    monkeypatch.chdir(cases.parent)
    assert main(["verify", "good"]) == 0
    assert capsys.readouterr().out.endswith("\npassed\n")


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["god"], "did you mean 'good'?"),
        (["--cases", "nowhere"], "--cases: no such folder (got 'nowhere')"),
        (["--cases", "notes"], "--cases: holds no cases (got 'notes')"),
        (["good", "--method", "rk4"], "--method: unknown method"),
    ],
)
def test_verify_refuses(
    arguments: list[str],
    says: str,
    cases: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(cases)
    assert (
        main(["verify", *(["--cases", "."] if "--cases" not in arguments else []), *arguments]) == 2
    )
    output, error = capsys.readouterr()
    assert output == ""
    assert says in error
    assert error.count("\n") == 1


@pytest.fixture
def written(tmp_path: Path) -> Path:
    """The folder of a run of SDNL32."""
    assert main(["run", str(SDNL32), "--out", str(tmp_path / "run"), "--no-report"]) == 0
    return tmp_path / "run"


def test_report_of_several_runs(
    written: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "pages" / "both.html"
    capsys.readouterr()
    files = [str(written / name / "response.nc") for name in ("soft", "stiff")]
    assert main(["report", *files, str(SDNL32), "-o", str(page)]) == 0
    assert capsys.readouterr().out == f"written to {page}\n"
    assert [file.name for file in page.parent.iterdir()] == ["both.html"]
    text = page.read_text()
    for name in ("run/soft", "run/stiff", "sdnl32/soft", "sdnl32/stiff"):
        assert f'<th scope="col">{name}</th>' in text


def test_runs_of_one_name_are_told_apart(written: Path, tmp_path: Path) -> None:
    file = str(written / "soft" / "response.nc")
    assert main(["report", file, file, "--out", str(tmp_path)]) == 0
    assert "run/soft (2)" in (tmp_path / "compare.html").read_text()


def test_one_run_is_not_compared(written: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", str(written / "soft" / "response.nc")]) == 2
    assert "one run alone to compare" in capsys.readouterr().err


def test_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["report", str(SDNL32), "--method", "symplectic_euler", "--out", str(tmp_path)]
    assert main(arguments) == 0
    assert [file.name for file in tmp_path.iterdir()] == ["report.html"]
    assert "SDNL32" in (tmp_path / "report.html").read_text()
    assert capsys.readouterr().out == f"written to {tmp_path / 'report.html'}\n"


def test_schema(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema"]) == 0
    schema = json.loads(capsys.readouterr().out)
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert schema["required"] == ["basis"]
    stop = schema["$defs"]["StopTable"]
    assert "required" not in stop  # node and normal or terms, stiffness or restitution
    assert stop["properties"]["stiffness"]["description"].startswith("Contact stiffness, in N/m")
    for table in [schema, *schema["$defs"].values()]:
        assert table["additionalProperties"] is False
        for key, field in table["properties"].items():
            assert "description" in field or "$ref" in field, key
    assert "null" not in json.dumps(schema)  # TOML has none


def test_the_schema_of_a_stop_knows_what_belongs_together() -> None:
    place, kind = case_schema()["$defs"]["StopTable"]["allOf"]
    assert [each["required"] for each in kind["oneOf"]] == [["stiffness"], ["restitution"]]
    assert [each["required"] for each in place["oneOf"]] == [["normal"], ["axis"], ["terms"]]
    nodes = [{"required": ["node"]}, {"required": ["nodes"]}]
    assert [each.get("oneOf") for each in place["oneOf"]] == [nodes, nodes, None]


@pytest.mark.parametrize(
    ("text", "good"),
    [
        ("18 kN/m", True),
        ("18kN/m", True),
        ("-1.5e-3 N/m", True),
        (".5 N/m", True),
        ("much", False),
        ("18", False),
        ("1e5", False),
        ("kN/m", False),
    ],
)
def test_the_schema_knows_how_units_are_written(text: str, good: bool) -> None:
    number, written = case_schema()["$defs"]["StopTable"]["properties"]["stiffness"]["anyOf"]
    assert number == {"type": "number", "exclusiveMinimum": 0}
    assert (re.search(written["pattern"], text) is not None) == good


def test_the_schema_takes_what_the_cases_write() -> None:
    """Quantities of all shipped cases, where one stands alone: in lists they are alike. Matrices
    are files, under names that elsewhere are those of quantities.
    """
    properties = {
        key: field
        for table in case_schema()["$defs"].values()
        for key, field in table["properties"].items()
    }
    seen = 0
    for file in CASES.glob("*/case.toml"):
        written = re.sub(r"(?ms)^\[matrices\].*?(?=^\[)", "", file.read_text(encoding="utf-8"))
        for key, text in re.findall(r'^(\w+) = "([^"]*)"', written, re.MULTILINE):
            patterns = [
                kind["pattern"]
                for kind in properties.get(key, {}).get("anyOf", ())
                if "pattern" in kind
            ]
            seen += len(patterns)
            assert all(re.search(pattern, text) for pattern in patterns), (file, key, text)
    assert seen > 0


FRAME = CASES / "nafems-fv3" / "case.toml"


def test_a_modal_case_runs_nothing(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["run", str(FRAME), "--json", "--out", str(tmp_path)]) == 0
    (variant,) = json.loads(capsys.readouterr().out)["variants"]
    assert (variant["method"], variant["steps"], variant["events"]) == (None, 0, 0)
    assert (variant["impacts"], variant["energy_residual"]) == (0, None)
    row = variant["references"][3]
    assert (row["quantity"], row["mode"], row["time"]) == ("frequency", 4, None)
    assert row["value"] == pytest.approx(row["reference"], rel=row["tolerance"])
    assert [file.name for file in tmp_path.iterdir()] == ["report.html"]


def test_a_modal_case_in_words(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(FRAME)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[3] == "  Natural frequencies, in Hz"
    assert lines[4].split() == ["mode", "published", "computed", "deviation", "tolerance", "ok"]
    assert lines[-1] == "  all 11 checks passed"
    assert main(["verify", "nafems-fv3", "--cases", str(CASES)]) == 0
    assert " modes " in capsys.readouterr().out.splitlines()[1]


def test_a_frequency_that_is_missed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "case.toml"
    file.write_text(FRAME.read_text().replace("3.261", "3.271"))
    assert main(["run", str(file)]) == 1
    assert "1 of 11 checks FAILED" in capsys.readouterr().out


def test_modes_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["modes", str(SDNL32), "--out", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == f"written to {tmp_path}/out/modes.html"
    page = (tmp_path / "out" / "modes.html").read_text()
    assert "rotation about z through A" in page
    assert "none missed" in page


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "modes = [1, 2, 3]",
            "modes = [1, 2]",
            "references.0.modes: must be as many as there are values, 3",
        ),
        ("modes = [1, 2, 3]", "modes = [1, 2, 12]", "references.0.modes.2: must be at most 11"),
        ("modes = [1, 2, 3]", "times = [1, 2, 3]", "references.0.modes: is needed for frequency"),
        (
            'quantity = "frequency"\nmodes = [1, 2, 3]',
            'quantity = "displacement"\nnode = "A"\ndof = "dx"\ntimes = [1, 2, 3]',
            "references.0.quantity: is never computed (got 'displacement'); without [run]",
        ),
        (
            "[basis] ",
            '[loads.weight]\ntype = "gravity"\nacceleration = [0, -9.81, 0]\n[basis] ',
            "run: is missing, and there are loads; say how long to simulate",
        ),
        (
            "[basis] ",
            '[variants.long]\n"run" = { duration = 1.0 }\n[basis] ',
            'variants.long."run": is given in a variant alone; give [run] in the case itself',
        ),
    ],
)
def test_mistakes_in_modal_cases(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, message: str
) -> None:
    file = tmp_path / "case.toml"
    file.write_text(FRAME.read_text().replace(old, new, 1))
    assert main(["run", str(file)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert message in error
