"""Whatever is wrong with a case file: status 2, one line that says where, nothing left behind."""

import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from bumpstop.cli import main

from .mutations import Document, Mutation, mutations, toml_text, toml_value

SDNL32 = Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml"
DOCUMENT: Document = tomllib.loads(SDNL32.read_text())
MUTATIONS = list(mutations(DOCUMENT))

Refusal = Callable[[Path], str]


@pytest.fixture
def refusal(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Refusal:
    """Run a file that must be refused and return the one line that says why."""

    def run(file: Path) -> str:
        before = sorted(tmp_path.rglob("*"))
        assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 2
        output, error = capsys.readouterr()
        assert output == ""
        assert error.startswith(f"error: {file}: ")
        assert error.endswith("\n")
        assert error.count("\n") == 1
        assert sorted(tmp_path.rglob("*")) == before
        return error

    return run


def test_there_are_many_mutations() -> None:
    assert len({mutation.name for mutation in MUTATIONS}) == len(MUTATIONS) > 300


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.name)
def test_mutations_are_refused(mutation: Mutation, tmp_path: Path, refusal: Refusal) -> None:
    file = tmp_path / "case.toml"
    file.write_text(toml_text(mutation.document))
    line = refusal(file)
    for part in mutation.says:
        assert part in line


def test_what_is_mutated_is_good(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "case.toml"
    file.write_text(toml_text(DOCUMENT))
    assert main(["modes", str(file)]) == 0
    assert "sdnl32" in capsys.readouterr().out.lower()


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "is empty"),
        (b" \n\n", "is empty"),
        (b"# nothing but a comment\n", "basis: is missing"),
        (bytes(range(256)) * 4, "is a binary file"),
        (b"title = 'caf\xe9'\n", "line 1: is not UTF-8 text"),
        (b"title = 'a'\ntitle = 'b'\n", "line 2"),
        (b"title = 'a'\n[nodes]\nA = [0.0, 0.0\n", "is not TOML: unclosed array"),
        (b"[stops.spring]\nstiffness = 18 kN/m\n", "line 2, column 16: is not TOML"),
        (b"a = " + b"[" * 5000, "is nested too deeply"),
        (b"\na = -" + b"9_" * 4999 + b"9", "line 2: a whole number of 5,000 digits is too large"),
        (b"a = 0x" + b"f" * 5000, "a: is too large for a whole number"),
        (b"nodes = 3\n", "nodes: must be a table (got 3); begin it with [nodes]"),
        (b"supports = {}\n", "supports: must be a list of tables (got {}); begin each with"),
        (b"[loads.x]\nforce = [0, 0, 1]\n", "loads.x.type: is missing"),
        (b"[loads.x]\ntype = 'gravty'\n", "loads.x.type: is not a known kind (got 'gravty')"),
        (b"[loads.x]\ntype = 'force'\nfroce = 3\n", "loads.x.froce: unknown key (got 3)"),
        (b"loads = 3\n", "loads: must be a table"),
        (b"[loads]\nx = 3\n", "loads.x: must be a table"),
        (b"when = 2020-01-01\n", "when: unknown key"),
        (b'"two\\nlines" = 1\n', '"two\\nlines": unknown key'),
    ],
)
def test_files_that_are_no_case(
    content: bytes, says: str, tmp_path: Path, refusal: Refusal
) -> None:
    file = tmp_path / "case.toml"
    file.write_bytes(content)
    assert says in refusal(file)


def test_fifty_megabytes(tmp_path: Path, refusal: Refusal) -> None:
    file = tmp_path / "case.toml"
    with file.open("wb") as sparse:
        sparse.truncate(50_000_000)
    assert "is too large, 50,000,000 bytes" in refusal(file)


def test_folder(tmp_path: Path, refusal: Refusal) -> None:
    assert f"is a folder, not a case file; did you mean '{tmp_path}/case.toml'?" in refusal(
        tmp_path
    )


def test_no_file(tmp_path: Path, refusal: Refusal) -> None:
    assert "no such file" in refusal(tmp_path / "case.toml")
    assert "no such file" in refusal(tmp_path / "neither" / "case.toml")


def test_not_a_regular_file(refusal: Refusal) -> None:
    assert "is not a regular file" in refusal(Path("/dev/zero"))


@pytest.mark.parametrize("height", ["1e308", "1e150"])
def test_numbers_that_nothing_can_be_computed_with(
    height: str, tmp_path: Path, refusal: Refusal
) -> None:
    file = tmp_path / "case.toml"
    file.write_text(SDNL32.read_text().replace("height = 0.014", f"height = {height}"))
    assert "too large or too small to compute with" in refusal(file)


@pytest.mark.parametrize("depth", [100, 200, 300, 400])
@pytest.mark.parametrize(("start", "end"), [("[", "]"), ("{a=", "}")])
def test_nesting(depth: int, start: str, end: str, tmp_path: Path, refusal: Refusal) -> None:
    file = tmp_path / "case.toml"
    deep = f"{start * depth}1{end * depth}"
    file.write_text(f"{SDNL32.read_text()}\n[variants.deep]\nx = {deep}\n")
    line = refusal(file)
    assert "is nested too deeply" in line or 'variants.deep."x' in line


def test_several_mistakes_are_counted(tmp_path: Path, refusal: Refusal) -> None:
    file = tmp_path / "case.toml"
    text = SDNL32.read_text().replace("stiffness = 18e3 ", "stifness = 18e3 ")
    file.write_text(text.replace("modes = 10", "modes = -10").replace("67e9", "'67 kg'"))
    line = refusal(file)
    assert "stops.spring.stifness" in line
    assert line.endswith("did you mean 'stiffness'? (and 2 more mistakes)\n")


@pytest.mark.parametrize("value", [-18e3, "18 kN/m2"])
def test_as_a_process_of_its_own(value: float | str, tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    text = SDNL32.read_text().replace("stiffness = 18e3 ", f"stiffness = {toml_value(value)} ")
    file.write_text(text)
    command = [sys.executable, "-m", "bumpstop", "run", str(file), "--out", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith(f"error: {file}: stops.spring.stiffness: ")
    assert f"(got {value!r})" in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()
