"""``method = "auto"`` on the command line: what it takes, and that it says why."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from bumpstop.cli import main

Output = Callable[..., tuple[int, str, str]]


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Output:
    """Run a command and return its status, output and error output."""

    def run(*arguments: str) -> tuple[int, str, str]:
        status = main(arguments)
        return status, *capsys.readouterr()

    return run


FULL = """
[nodes]
P = [0, 0, 0]
[masses.p]
node = "P"
mass = 1
[[supports]]
nodes = ["P"]
fixed = ["dy", "dz", "drx", "dry", "drz"]
[basis]
model = "full"
[stops.wall]
node = "P"
normal = [-1, 0, 0]
gap = "1 mm"
stiffness = "10 kN/m"
[initial.nodal]
velocity = { P = { dx = 0.1 } }
[run]
duration = 0.1
"""


def test_a_full_model_is_stepped_where_the_method_is_left_open(
    call: Output, tmp_path: Path
) -> None:
    file = tmp_path / "case.toml"
    file.write_text(f'{FULL}dt = "0.1 ms"\n')
    for more in (
        [],
        ["--method", "auto"],
        ["--method", "auto", "--dt", "0.2 ms"],
        ["--dt", "0.2 ms"],
    ):
        status, out, _ = call("run", str(file), *more)
        assert status == 0
        assert "method newmark, " in out
        assert "auto took this method: a full model is stepped through time" in out
    assert "method newmark, 500 steps" in out
    status, out, _ = call("run", str(file), "--json")
    (variant,) = json.loads(out)["variants"]
    assert variant["method_reason"] == "a full model is stepped through time"
    file.write_text(FULL)
    status, _, err = call("run", str(file))
    assert status == 2
    assert "run.dt: the newmark method, which auto took (a full model is" in err
