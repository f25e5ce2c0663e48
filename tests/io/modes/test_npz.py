from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bumpstop import InputError
from bumpstop.io import ModeSet, read_modes

ARRAYS: dict[str, Any] = {
    "frequency": np.array([3.0, 7.5]),
    "nodes": np.array(["P", "tip"]),
    "dofs": np.array(["dx", "drz"]),
    "shapes": np.array([[1.0, 0.4], [0.5, -1.0]]),
}


def read(tmp_path: Path, **changes: Any) -> ModeSet:
    file = tmp_path / "modes.npz"
    arrays = {key: value for key, value in (ARRAYS | changes).items() if value is not None}
    np.savez(file, **arrays)
    return read_modes(file)


def test_arrays(tmp_path: Path) -> None:
    modes = read(tmp_path, damping=np.array([0.01, 0.02]), modal_mass=np.array([4, 1]))
    basis = modes.basis()
    np.testing.assert_array_equal(basis.row("P", "dx"), [0.5, 0.4])
    np.testing.assert_array_equal(basis.damping_ratio, [0.01, 0.02])


REFUSED: list[tuple[dict[str, Any], str]] = [
    ({"shapes": None}, "has no array 'shapes'; it holds frequency, nodes, dofs"),
    ({"shapes": np.ones((2, 3))}, r"shapes: must have the shape \(2, 2\)"),
    ({"damping": np.ones(3)}, r"damping: must have the shape \(2,\)"),
    ({"modal_mass": np.array([1.0, np.nan])}, "modal_mass: must hold finite numbers"),
    ({"frequency": np.array(["a", "b"])}, "frequency: must hold finite numbers"),
    ({"nodes": np.array([1, 2])}, "nodes: must be a list of texts"),
    ({"dofs": np.array(["dx"])}, "dofs: must be 2 texts"),
]


@pytest.mark.parametrize(("changes", "message"), REFUSED, ids=[line for _, line in REFUSED])
def test_what_is_wrong_is_said_in_one_line(
    tmp_path: Path, changes: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=rf"modes\.npz: {message}"):
        read(tmp_path, **changes)


def test_a_truncated_file(tmp_path: Path) -> None:
    read(tmp_path)
    file = tmp_path / "modes.npz"
    file.write_bytes(file.read_bytes()[:-100])
    with pytest.raises(InputError, match=r"modes\.npz: is not an archive of arrays, or is trunc"):
        read_modes(file)
