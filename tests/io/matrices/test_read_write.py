from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp

from bumpstop import Beam, InputError, Material, Matrices, Rectangle, Structure, Support
from bumpstop.io import read_matrices, write_matrices
from bumpstop.io.matrices.read import read_matrix

SPRING = np.array([[2.0, -2.0], [-2.0, 2.0]])


@pytest.fixture
def frame() -> Structure:
    steel = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    bar = Rectangle(height=0.06, width=0.025)
    return Structure(
        nodes={"A": (0, 0, 0), "B": (0.5, 0.1, 0.7)},
        beams=[Beam("AB", nodes=("A", "B"), elements=3, material=steel, section=bar)],
        supports=[Support(nodes="A", fixed=("dx", "dy", "dz"))],
    )


@pytest.mark.parametrize("form", ["npz", "mtx"])
def test_what_is_written_is_read_to_the_last_bit(
    tmp_path: Path, frame: Structure, form: str
) -> None:
    files: dict[str, Any] = dict(write_matrices(tmp_path / "deep" / "model", frame, form=form))
    model = read_matrices(**files)
    assert model.dofs == frame.dofs
    assert model.free.tolist() == frame.free.tolist()
    assert model.position("AB.2") == frame.position("AB.2")
    for key in ("stiffness", "mass"):
        ours, theirs = getattr(model, key).to_dense(), getattr(frame, key).to_dense()
        np.testing.assert_array_equal(ours, 0.5 * (theirs + theirs.T))


@pytest.mark.parametrize("form", ["npz", "mtx"])
def test_all_five_matrices(tmp_path: Path, form: str) -> None:
    turn = np.array([[0.0, 0.3], [-0.3, 0.0]])
    model = Matrices(
        stiffness=SPRING,
        mass=np.eye(2),
        damping=0.1 * SPRING,
        gyroscopic=turn,
        circulatory=-2.0 * turn,
        dofs=[("P", "dy"), ("P", "dz")],
    )
    files: dict[str, Any] = dict(write_matrices(tmp_path, model, form=form))
    again = read_matrices(**files)
    for key in ("stiffness", "mass", "damping", "gyroscopic", "circulatory"):
        np.testing.assert_array_equal(
            getattr(again, key).to_dense(), getattr(model, key).to_dense()
        )


def write_pair(folder: Path) -> dict[str, Any]:
    files = {"stiffness": folder / "K.npz", "mass": folder / "M.mtx", "dofs": folder / "dofs.csv"}
    sp.save_npz(files["stiffness"], sp.csc_array(SPRING))
    scipy.io.mmwrite(files["mass"], np.eye(2))
    files["dofs"].write_text("node,dof\nP,dx\nQ,dx\n")
    return files


def test_formats_may_be_mixed(tmp_path: Path) -> None:
    model = read_matrices(**write_pair(tmp_path), fixed=[("P", "dx")])
    assert model.free.tolist() == [1]
    np.testing.assert_array_equal(model.stiffness.to_dense(), SPRING)


def test_labels_are_put_in_the_order_of_the_dof_map(tmp_path: Path) -> None:
    files = write_pair(tmp_path)
    (tmp_path / "K.mtx").write_text("20,1,20,1,5.\n20,1,3,1,-1.\n3,1,3,1,7.\n")
    (tmp_path / "M.mtx").write_text("3,1,3,1,1.\n20,1,20,1,2.\n")
    without_map = read_matrices(stiffness=tmp_path / "K.mtx", mass=tmp_path / "M.mtx")
    assert without_map.dofs == (("3", "dx"), ("20", "dx"))
    assert without_map.stiffness.to_dense().tolist() == [[7.0, -1.0], [-1.0, 5.0]]
    files["dofs"].write_text("node,dof\n20,dx\n3,dx\n")
    ordered = read_matrices(
        stiffness=tmp_path / "K.mtx", mass=tmp_path / "M.mtx", dofs=files["dofs"]
    )
    assert ordered.stiffness.to_dense().tolist() == [[5.0, -1.0], [-1.0, 7.0]]
    files["dofs"].write_text("node,dof\n20,dx\n")
    with pytest.raises(InputError, match=r"K\.mtx: has a dof that the dof map has not .got '3"):
        read_matrices(stiffness=tmp_path / "K.mtx", mass=tmp_path / "M.mtx", dofs=files["dofs"])


def test_one_of_several_matrices(tmp_path: Path) -> None:
    file = tmp_path / "model.pch"
    file.write_text(
        "DMIG,KAAX,0,6,1,0\nDMIG,KAAX,1,1,,1,1,2.\nDMIG,MAAX,0,6,1,0\nDMIG,MAAX,1,1,,1,1,3.\n"
    )
    model = read_matrices(stiffness=f"{file}#KAAX", mass=f"{file}#MAAX")
    assert (model.stiffness.values.tolist(), model.mass.values.tolist()) == ([2.0], [3.0])
    with pytest.raises(InputError, match=r"holds 2 matrices; say which after '#': KAAX, MAAX"):
        read_matrix(file)
    with pytest.raises(InputError, match=r"has no such matrix .got 'KAX'.; did you mean 'KAAX'"):
        read_matrix(f"{file}#KAX")


def test_mistakes_name_the_file(tmp_path: Path) -> None:
    files = write_pair(tmp_path)
    with pytest.raises(InputError, match=r"K\.npz: does not say what its rows are; give a dof map"):
        read_matrices(stiffness=files["stiffness"], mass=files["mass"])
    with pytest.raises(InputError, match=r"K\.txt: is of no known kind of matrix"):
        read_matrices(**files | {"stiffness": tmp_path / "K.txt"})
    with pytest.raises(InputError, match=r"C\.npz: no such file"):
        read_matrices(**files, damping=tmp_path / "C.npz")
    with pytest.raises(InputError, match=r"K\.npz: has only one matrix"):
        read_matrix(f"{files['stiffness']}#KAA")
    sp.save_npz(files["stiffness"], sp.csc_array([[2.0, -2.0], [-1.0, 2.0]]))
    with pytest.raises(InputError, match=r"K\.npz: stiffness: must be symmetric"):
        read_matrices(**files)
    sp.save_npz(files["stiffness"], sp.eye_array(3))
    with pytest.raises(InputError, match=r"K\.npz: is 3 x 3, but there are 2 dofs"):
        read_matrices(**files)


def test_only_known_forms_are_written(tmp_path: Path, frame: Structure) -> None:
    with pytest.raises(InputError, match="unknown form"):
        write_matrices(tmp_path, frame, form="mat")
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="cannot be made"):
        write_matrices(tmp_path / "file" / "model", frame)
