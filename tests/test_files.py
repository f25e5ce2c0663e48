from pathlib import Path
from typing import Any

import pytest

from bumpstop.errors import InputError
from bumpstop.files import written_whole


def test_the_name_appears_at_the_end(tmp_path: Path) -> None:
    with written_whole(tmp_path / "a.txt") as part:
        part.write_text("new")
        assert not (tmp_path / "a.txt").exists()
    assert (tmp_path / "a.txt").read_text() == "new"
    assert len(list(tmp_path.iterdir())) == 1


def test_two_at_once_do_not_meet(tmp_path: Path) -> None:
    with written_whole(tmp_path / "a.txt") as one, written_whole(tmp_path / "a.txt") as two:
        one.write_text("one")
        two.write_text("two")
    assert (tmp_path / "a.txt").read_text() == "one"


@pytest.mark.parametrize("stop", [RuntimeError, KeyboardInterrupt])
def test_what_goes_wrong_leaves_nothing(tmp_path: Path, stop: Any) -> None:
    with pytest.raises(stop), written_whole(tmp_path / "a.txt") as part:  # noqa: PT012  # both lines are the write
        part.write_text("half")
        raise stop
    assert list(tmp_path.iterdir()) == []


def test_a_folder_cannot_be_a_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is a folder"), written_whole(tmp_path):
        pass


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    place = tmp_path / "no" / "a.txt"
    with pytest.raises(InputError, match="No such file or directory") as caught:
        written_whole(place).__enter__()
    assert caught.value.file == str(place)
