"""Case files as texts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import bumpstop as bs
from bumpstop.errors import InputError


@pytest.fixture
def load(tmp_path: Path) -> Callable[[str], bs.Case]:
    """Load a case from its text."""

    def from_text(text: str) -> bs.Case:
        file = tmp_path / "case.toml"
        file.write_text(text)
        return bs.load_case(file)

    return from_text


@pytest.fixture
def refused(load: Callable[[str], bs.Case]) -> Callable[[str], str]:
    """Load a case that must be refused, and return the message without the file's name."""

    def message(text: str) -> str:
        with pytest.raises(InputError) as error:
            load(text)
        assert error.value.file is not None
        return str(error.value).removeprefix(f"{error.value.file}: ")

    return message
