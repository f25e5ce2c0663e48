"""Functions of time in text files."""

from pathlib import Path

import numpy as np
import pytest

from bumpstop import InputError
from bumpstop.io.time_table import read_time_table


def written(folder: Path, text: str) -> Path:
    path = folder / "a.csv"
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    "text",
    [
        "0.0,1.0\n0.5,2.0\n",
        "# a remark\n\n0.0; 1.0\n0.5; 2.0\n",
        "0.0\t1.0\n0.5  2.0\n% end\n",
        "time, value, other\n0.0, 1.0, 7\n0.5, 2.0, 8\n",
        "Zeit;Kraft\n0,0;1,0\n0,5;2,0;\n",
        "0,0\t1,0\n0,5\t2,0\n",
    ],
)
def test_columns_are_found(tmp_path: Path, text: str) -> None:
    times, values = read_time_table(written(tmp_path, text))
    assert times.tolist() == [0.0, 0.5]
    assert values.tolist() == [1.0, 2.0]


def test_columns_are_chosen_by_name_or_number(tmp_path: Path) -> None:
    path = written(tmp_path, "n,t,a\n1,0.0,3.0\n2,0.5,4.0\n")
    chosen: list[list[float | str]] = [["t", "a"], [2, 3], ["t", 3]]
    for columns in chosen:
        times, values = read_time_table(path, columns=columns)
        assert (times.tolist(), values.tolist()) == ([0.0, 0.5], [3.0, 4.0])


def test_a_step_makes_times(tmp_path: Path) -> None:
    times, values = read_time_table(written(tmp_path, "1 2 3\n4 5\n"), step=0.02)
    np.testing.assert_allclose(times, [0.0, 0.02, 0.04, 0.06, 0.08], rtol=1e-15)
    assert values.tolist() == [1.0, 2.0, 3.0, 4.0, 5.0]


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("", {}, "is empty"),
        ("time,a\n", {}, "holds no numbers"),
        ("1.0\n2.0\n", {}, "has 1 column, not times and values"),
        ("0,1\n1\n", {}, "line 2 has 1 column, but 2 are needed"),
        ("0,1\n1,x\n", {}, "line 2 holds no number .*'x'"),
        ("t,a\n0,1\n", {"columns": ["t", "b"]}, "columns: has no such column .*'b'"),
        ("0,1\n", {"columns": [1, 3]}, "columns: has no such column .*numbered 1 to 2"),
        ("0,1\n", {"columns": [1]}, "columns: must be two columns"),
        ("0,1\n", {"columns": [1, 2], "step": 1.0}, "columns: has values alone"),
    ],
)
def test_mistakes_name_the_file(
    tmp_path: Path, text: str, options: dict[str, object], message: str
) -> None:
    path = written(tmp_path, text)
    with pytest.raises(InputError, match=message) as caught:
        read_time_table(path, **options)  # type: ignore[arg-type]
    assert caught.value.file == str(path)
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_said(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        read_time_table(tmp_path / "b.csv")


def test_units_and_lines_passed_over(tmp_path: Path) -> None:
    path = written(tmp_path, "recorded 2019\n1, 2, 3, 4\nt,F\n0,1\n5,2.5\n")
    times, values = read_time_table(path, units=["ms", "kN"], skip=2)
    assert (times.tolist(), values.tolist()) == ([0.0, 0.005], [1000.0, 2500.0])
