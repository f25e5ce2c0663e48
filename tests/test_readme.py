"""What the README shows is what one gets."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.cli import main

ROOT = Path(__file__).parents[1]
SDNL32 = ROOT / "cases" / "sdnl32" / "case.toml"


def block(language: str) -> str:
    """Return the README's first block of code in a language."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    found = re.search(rf"```{language}\n(.*?)```", readme, re.DOTALL)
    assert found
    return found[1]


def test_python_and_case_file_give_the_same_bits() -> None:
    names: dict[str, bs.Response] = {}
    exec(block("python"), names)
    written = names["response"]
    read = bs.simulate(bs.load_case(SDNL32).problems["soft"], "exact")
    assert (written.times == read.times).all()
    for derivative in range(3):
        assert (written.motion(derivative) == read.motion(derivative)).all()


# What machines differ in: their speed, and the digits of rounding.
SPEED = re.compile(r"[\d.]+ (us|ms|s)$", re.MULTILINE)
ROUNDING = re.compile(r"(?:< )?([\d.]+e-1\d)\b")


def test_the_command_prints_what_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(SDNL32)]) == 0
    shown, printed = (SPEED.sub("SPEED", text) for text in (block("text"), capsys.readouterr().out))
    pattern = re.escape(ROUNDING.sub("ROUNDING", shown))
    rows_left_out = re.escape("     ...\n")
    assert pattern.count(rows_left_out) == 1
    pattern = pattern.replace(rows_left_out, r"(?: +0\.0.* yes\n){8}")
    assert re.search(rf"^{pattern}\n", ROUNDING.sub("ROUNDING", printed), re.MULTILINE)
    roundings = [np.array(ROUNDING.findall(text), dtype=float) for text in (shown, printed)]
    assert len(roundings[0]) == 3
    ratio = roundings[1][:3] / roundings[0]
    assert ((ratio > 0.1) & (ratio < 10.0)).all()
