"""Every writer where its file cannot be: one line that names the file, and nothing left behind."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import bumpstop as bs
from bumpstop.io import FORMATS
from bumpstop.io.wav import write_wav

from ..hinged_beam import SWING, end_stop, hinged_modes

resource = pytest.importorskip("resource")


@pytest.fixture(scope="module")
def thrown() -> bs.Response:
    """Enough instants for every format to be larger than the room below."""
    problem = bs.Problem(
        hinged_modes(elements=4, modes=3),
        laws=[end_stop(18e3)],
        initial=SWING,
        duration=0.02,
        sample=4e-6,
    )
    return bs.simulate(problem)


@contextmanager
def room(most: int) -> Iterator[None]:
    """Let no file grow beyond so many bytes, as on a disk that is nearly full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)


@pytest.mark.parametrize("form", FORMATS)
def test_no_space_is_left(thrown: bs.Response, tmp_path: Path, form: str) -> None:
    path = tmp_path / f"run{FORMATS[form]}"
    thrown.at([0.0]).export(path)  # imports, which may write files of their own
    path.write_text("older")
    with (
        room(1500),
        pytest.raises(bs.InputError, match=r"run\.[a-z]+: cannot be written: ") as error,
    ):
        thrown.export(path)
    assert "\n" not in str(error.value)
    assert [found.name for found in tmp_path.iterdir()] == [path.name]
    assert path.read_text() == "older"


@pytest.mark.parametrize("form", FORMATS)
def test_a_file_is_no_folder(thrown: bs.Response, tmp_path: Path, form: str) -> None:
    (tmp_path / "file").write_text("older")
    with pytest.raises(bs.InputError, match="cannot be written: Not a directory"):
        thrown.export(tmp_path / "file" / f"run{FORMATS[form]}")
    (tmp_path / f"run{FORMATS[form]}").mkdir()
    with pytest.raises(bs.InputError, match="is a folder"):
        thrown.export(tmp_path / f"run{FORMATS[form]}")
    assert len(list(tmp_path.iterdir())) == 2


def test_what_has_no_sound(thrown: bs.Response, tmp_path: Path) -> None:
    with pytest.raises(bs.InputError, match=r"^target: "):
        write_wav(thrown, tmp_path / "run.wav", "modal_velocity")
    with pytest.raises(bs.InputError, match=r"^rate: "):
        write_wav(thrown, tmp_path / "run.wav", rate=2**32)
    assert list(tmp_path.iterdir()) == []
