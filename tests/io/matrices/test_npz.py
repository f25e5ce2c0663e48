from __future__ import annotations

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp
from numpy.lib import format as npy

from bumpstop import InputError
from bumpstop.io.matrices.npz import read_npy, read_npz, write_npz
from bumpstop.structure.given import given_matrix

DENSE = np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])


@pytest.mark.parametrize("form", ["csr", "csc", "coo", "bsr", "dia"])
def test_every_format_of_scipy_is_read(tmp_path: Path, form: str) -> None:
    sp.save_npz(tmp_path / "K.npz", sp.coo_array(DENSE).asformat(form))
    np.testing.assert_array_equal(read_npz(tmp_path / "K.npz").to_dense(), DENSE)


def test_scipy_reads_what_is_written(tmp_path: Path) -> None:
    write_npz(tmp_path / "K.npz", given_matrix("K", DENSE))
    np.testing.assert_array_equal(sp.load_npz(tmp_path / "K.npz").toarray(), DENSE)


def test_dense_arrays_are_read(tmp_path: Path) -> None:
    np.save(tmp_path / "K.npy", DENSE)
    np.testing.assert_array_equal(read_npy(tmp_path / "K.npy").to_dense(), DENSE)


def test_every_truncation_is_noticed(tmp_path: Path) -> None:
    file = tmp_path / "K.npz"
    sp.save_npz(file, sp.csc_array(DENSE))
    whole = file.read_bytes()
    for end in range(0, len(whole), 37):
        file.write_bytes(whole[:end])
        with pytest.raises(InputError, match=r"K\.npz: is (empty|not a sparse matrix)"):
            read_npz(file)
    np.save(tmp_path / "K.npy", DENSE)
    cut = (tmp_path / "K.npy").read_bytes()[:-8]
    (tmp_path / "K.npy").write_bytes(cut)
    with pytest.raises(InputError, match=r"K\.npy: is no array of NumPy, or is truncated"):
        read_npy(tmp_path / "K.npy")


def test_damage_is_noticed(tmp_path: Path) -> None:
    file = tmp_path / "K.npz"
    sp.save_npz(file, sp.csc_array(DENSE), compressed=False)
    damaged = file.read_bytes().replace(np.float64(2.0).tobytes(), np.float64(3.0).tobytes())
    file.write_bytes(damaged)
    with pytest.raises(InputError, match=r"is not a sparse matrix of SciPy, or is truncated"):
        read_npz(file)


def test_no_room_is_made_for_what_is_only_announced(tmp_path: Path) -> None:
    header = io.BytesIO()
    npy.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (10**15,)})
    with zipfile.ZipFile(tmp_path / "K.npz", "w") as archive:
        archive.writestr("data.npy", header.getvalue())
    with pytest.raises(InputError, match=r"announces 8,000,000,000,000,000 bytes"):
        read_npz(tmp_path / "K.npz")
    (tmp_path / "K.npy").write_bytes(header.getvalue())
    with pytest.raises(InputError, match=r"K\.npy: "):
        read_npy(tmp_path / "K.npy")


def test_other_archives_are_refused(tmp_path: Path) -> None:
    np.savez(tmp_path / "K.npz", stiffness=DENSE)
    with pytest.raises(InputError, match="is no sparse matrix of SciPy"):
        read_npz(tmp_path / "K.npz")
    with zipfile.ZipFile(tmp_path / "notes.npz", "w") as archive:
        archive.writestr("notes.txt", "nothing here")
    with pytest.raises(InputError, match=r"member 'notes\.txt' is no array"):
        read_npz(tmp_path / "notes.npz")
    np.savez(tmp_path / "object.npz", data=np.array([{"a": 1}], dtype=object))
    with pytest.raises(InputError, match="holds pickled objects"):
        read_npz(tmp_path / "object.npz")
    (tmp_path / "trash.npz").write_bytes(np.random.default_rng(1).bytes(500))
    with pytest.raises(InputError, match="is not a sparse matrix of SciPy"):
        read_npz(tmp_path / "trash.npz")


def test_indices_outside_of_the_matrix_are_refused(tmp_path: Path) -> None:
    np.savez(
        tmp_path / "K.npz",
        format=np.array(b"csc"),
        shape=np.array([2, 2]),
        data=np.array([1.0]),
        indices=np.array([7]),
        indptr=np.array([0, 1, 1]),
    )
    with pytest.raises(InputError, match="is damaged"):
        read_npz(tmp_path / "K.npz")
