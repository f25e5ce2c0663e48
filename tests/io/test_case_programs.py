"""Laws of Python files and of other programs, in case files."""

import sys
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs

MASS = """
[nodes]
P = [0, 0, 0]
[masses.p]
node = "P"
mass = 1
[[supports]]
nodes = ["P"]
fixed = ["dz", "drx", "dry", "drz"]
[basis]
modes = 2
rigid_modes = 2
[initial.nodal]
velocity = { P = { dx = 1.0 } }
[run]
duration = 0.5
"""
PYTHON = '[laws.own]\ntype = "python"\nnode = "P"\ndirection = [1, 0, 0]\nfile = "own.py"\n'
ANSWER = """
import sys
for line in sys.stdin:
    step, qx, qy, vx, vy = line.split()
    print(-9.0 * float(qx), -4.0 * float(vy), flush=True)
"""


def case(folder: Path, text: str) -> bs.Problem:
    (folder / "case.toml").write_text(MASS + text)
    return bs.load_case(folder / "case.toml").problems["base"]


def program(folder: Path, code: str) -> str:
    (folder / "answer.py").write_text(code)
    command = [sys.executable, "answer.py"]
    return (
        '[laws.own]\ntype = "program"\nnode = "P"\ndirection = [1, 0, 0]\n'
        f"further_directions = [[0, 1, 0]]\ncommand = {command!r}\n"
    )


def test_a_file_defines_force_and_memory(tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text(
        "def force(q, v, t, z):\n    return -z\n\n\ndef memory_rate(q, v, t, z):\n    return 2.0\n"
    )
    problem = case(tmp_path, f"{PYTHON}memory = 3.0\n")
    speed = bs.simulate(problem, rtol=1e-10).sample("velocity", "P", "dx", times=[0.5])[0]
    assert speed == pytest.approx(1.0 - 3.0 * 0.5 - 0.25, rel=1e-9)


def test_a_program_answers_in_two_directions(tmp_path: Path) -> None:
    problem = case(tmp_path, program(tmp_path, ANSWER))
    response = bs.simulate(problem, "symplectic_euler", dt=1e-3)
    times = np.array([0.1, 0.3, 0.5])
    found = response.sample("displacement", "P", "dx", times=times)
    np.testing.assert_allclose(found, np.sin(3.0 * times) / 3.0, rtol=0, atol=2e-3)
    assert not response.sample("displacement", "P", "dy", times=times).any()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, r"laws\.own\.file: no such file \(got 'own\.py'\)"),
        ("x = 1", r"laws\.own\.file: defines no force .*; define force\(q, v, t\)"),
        ("import nothing_at_all", r"laws\.own\.file: cannot be run: ModuleNotFoundError: "),
        ("force = 3", r"laws\.own\.force: must be a function"),
    ],
)
def test_files_that_are_no_laws(tmp_path: Path, content: str | None, message: str) -> None:
    if content is not None:
        (tmp_path / "own.py").write_text(content)
    with pytest.raises(bs.InputError, match=message) as caught:
        case(tmp_path, PYTHON)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("pass", "has ended without an answer"),
        ("input(); print('five')", "answers step 0 with 'five', which is no list of numbers"),
        ("input(); print(1.0)", r"the program of law 'own' is array\(\[1\.\]\) at step 0"),
        ("input(); print('nan nan')", "the program of law 'own' is .*nan.* at step 0"),
    ],
)
def test_programs_that_do_not_answer(tmp_path: Path, code: str, message: str) -> None:
    problem = case(tmp_path, program(tmp_path, code))
    with pytest.raises(bs.ComputationError, match=message) as caught:
        bs.simulate(problem, "symplectic_euler", dt=1e-3)
    assert "\n" not in str(caught.value)


def test_programs_that_are_not_there(tmp_path: Path) -> None:
    text = program(tmp_path, "").replace(sys.executable, "no-such-program")
    with pytest.raises(bs.ComputationError, match="cannot be started: No such file"):
        bs.simulate(case(tmp_path, text), "symplectic_euler", dt=1e-3)
    for wrong in ("[]", "[3]", '"relay"'):
        text = program(tmp_path, "")
        text = text[: text.index("command")] + f"command = {wrong}\n"
        with pytest.raises(bs.InputError, match=r"laws\.own\.command"):
            case(tmp_path, text)
    with pytest.raises(bs.InputError, match="command: must be a list of texts"):
        bs.PipedProgram("relay")
