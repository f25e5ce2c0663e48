"""The README's Python runs as printed, and states the same problem as the case file."""

from __future__ import annotations

import re
from pathlib import Path

import bumpstop as bs

ROOT = Path(__file__).parents[1]


def test_python_and_case_file_give_the_same_bits() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    code = re.search(r"```python\n(.*?)```", readme, re.DOTALL)
    assert code
    names: dict[str, bs.Response] = {}
    exec(code[1], names)
    written = names["response"]
    read = bs.simulate(bs.load_case(ROOT / "cases/sdnl32/case.toml").problems["soft"], "exact")
    assert (written.times == read.times).all()
    for derivative in range(3):
        assert (written.motion(derivative) == read.motion(derivative)).all()
