"""Cases whose structure comes from files: SDNL32 again, from matrices and from modes."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

import bumpstop as bs
from bumpstop import InputError, ModalBasis, Problem, Response, Structure, load_case
from bumpstop.io import read_matrices, write_matrices

SDNL32 = Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml"
CLOSE = 1e-12
RUN = """
[basis]
modes = 10
damping = 0.01
[stops.spring]
node = "B"
normal = [0, 1, 0]
stiffness = 18e3
[initial]
{initial}
[run]
duration = 0.02
sample = 1e-4
"""
ROTATION = 'rotation = { about = "A", rate = [0.0, 0.0, -3.8] }'


@pytest.fixture(scope="module")
def original() -> Problem:
    return load_case(SDNL32).problems["soft"]


@pytest.fixture(scope="module")
def structure(original: Problem) -> Structure:
    assert original.basis.structure is not None
    return original.basis.structure


@pytest.fixture(scope="module")
def response(original: Problem) -> Response:
    return bs.simulate(original)


def assert_same(response: Response, imported: Problem) -> None:
    other = bs.simulate(imported)
    times = np.linspace(0.0, 0.02, 201)
    for name, ours, theirs in (
        ("displacement", response.displacement("B", "dy"), other.displacement("B", "dy")),
        ("velocity", response.velocity("B", "dy"), other.velocity("B", "dy")),
        ("force", response.stop_force("spring"), other.stop_force("spring")),
    ):
        ours, theirs = ours.interp(time=times), theirs.interp(time=times)
        error = float(np.abs(ours - theirs).max() / np.abs(ours).max())
        assert error <= CLOSE, name
    for column in ("start", "end", "peak_force", "impulse"):
        np.testing.assert_allclose(
            other.impacts[column], response.impacts[column], rtol=CLOSE, atol=0.0
        )


def test_matrices_made_by_scipy_give_the_results_of_the_case(
    original: Problem, structure: Structure, response: Response
) -> None:
    held = np.setdiff1d(np.arange(len(structure.dofs)), structure.free)
    mesh = structure.mesh
    model = bs.Matrices(
        stiffness=sp.csr_array(structure.stiffness.to_scipy()),
        mass=sp.csr_array(structure.mass.to_scipy()),
        dofs=structure.dofs,
        positions=dict(zip(mesh.names, mesh.positions, strict=True)),
        fixed=[structure.dofs[number] for number in held],
    )
    basis = ModalBasis.from_structure(model, modes=10, damping=0.01)
    assert basis.omega2[0] == 0.0
    imported = Problem(
        basis, laws=original.laws, initial=original.initial, duration=0.02, sample=1e-4
    )
    assert_same(response, imported)


@pytest.mark.parametrize("form", ["npz", "mtx"])
def test_a_case_file_with_matrices_gives_the_results_of_the_case(
    tmp_path: Path, structure: Structure, response: Response, form: str
) -> None:
    write_matrices(tmp_path / "model", structure, form=form)
    case = tmp_path / "case.toml"
    case.write_text(
        "[matrices]\n"
        f'stiffness = "model/stiffness.{form}"\n'
        f'mass = "model/mass.{form}"\n'
        'dofs = "model/dofs.csv"\n' + RUN.format(initial=ROTATION)
    )
    assert_same(response, load_case(case).problems["base"])


def test_supports_of_the_case_file_hold_dofs_of_the_matrices(
    tmp_path: Path, structure: Structure, response: Response
) -> None:
    free = Structure(nodes=structure.nodes, beams=structure.beams)
    write_matrices(tmp_path, free)
    supports = tomllib.loads(SDNL32.read_text())["supports"]
    case = tmp_path / "case.toml"
    case.write_text(
        '[matrices]\nstiffness = "stiffness.npz"\nmass = "mass.npz"\ndofs = "dofs.csv"\n'
        + "".join(
            f"[[supports]]\nnodes = {support['nodes']!r}\nfixed = {support['fixed']!r}\n"
            for support in supports
        )
        + RUN.format(initial=ROTATION)
    )
    assert_same(response, load_case(case).problems["base"])


def test_files_in_millimetres_newtons_and_tonnes(
    tmp_path: Path, structure: Structure, response: Response
) -> None:
    turns = np.array([1e3 if dof.startswith("dr") else 1.0 for _, dof in structure.dofs])
    scale = sp.diags_array(turns)
    for key in ("stiffness", "mass"):
        matrix = scale @ getattr(structure, key).to_scipy() @ scale * 1e-3
        sp.save_npz(tmp_path / f"{key}.npz", sp.csc_array(matrix))
    lines = ["node,dof,x,y,z,fixed"]
    for number, (node, dof) in enumerate(structure.dofs):
        x, y, z = (1e3 * place for place in structure.position(node))
        lines.append(f"{node},{dof},{x!r},{y!r},{z!r},{int(number not in structure.free)}")
    (tmp_path / "dofs.csv").write_text("\n".join(lines) + "\n")
    case = tmp_path / "case.toml"
    case.write_text(
        '[matrices]\nstiffness = "stiffness.npz"\nmass = "mass.npz"\ndofs = "dofs.csv"\n'
        'length = "1 mm"\n' + RUN.format(initial=ROTATION)
    )
    other = bs.simulate(load_case(case).problems["base"])
    np.testing.assert_allclose(
        other.impacts[["end", "peak_force", "impulse"]],
        response.impacts[["end", "peak_force", "impulse"]],
        rtol=1e-9,
    )
    case.write_text(case.read_text().replace('length = "1 mm"', "force = -1.0"))
    with pytest.raises(InputError, match=r"matrices\.force: must be positive"):
        load_case(case)


def write_modes(basis: ModalBasis, folder: Path, *, mass: float = 1.0) -> None:
    columns = ["frequency", "modal_mass", "B.dy"]
    rows = zip(
        basis.frequencies,
        np.full(10, mass),
        np.sqrt(mass) * basis.row("B", "dy"),
        strict=True,
    )
    lines = [",".join(columns), *(",".join(repr(float(number)) for number in row) for row in rows)]
    (folder / "modes.csv").write_text("\n".join(lines) + "\n")


@pytest.mark.parametrize("mass", [1.0, 0.37])
def test_a_case_file_with_modes_gives_the_results_of_the_case(
    tmp_path: Path, original: Problem, response: Response, mass: float
) -> None:
    assert original.initial is not None
    write_modes(original.basis, tmp_path, mass=mass)
    velocity = original.initial.modal_state(original.basis)[1] / np.sqrt(mass)
    case = tmp_path / "case.toml"
    initial = f"modal = {{ velocity = {velocity.tolist()} }}"
    case.write_text('[modes]\nfile = "modes.csv"\n' + RUN.format(initial=initial))
    assert_same(response, load_case(case).problems["base"])


def test_the_free_structure_has_six_rigid_modes(tmp_path: Path, structure: Structure) -> None:
    free = Structure(nodes=structure.nodes, beams=structure.beams)
    files: dict[str, Any] = dict(write_matrices(tmp_path, free))
    basis = ModalBasis.from_structure(read_matrices(**files), modes=12)
    assert np.count_nonzero(basis.omega2) == 6
    expected = ModalBasis.from_structure(free, modes=12)
    np.testing.assert_allclose(basis.frequencies, expected.frequencies, rtol=1e-9)


Edit = Callable[[str], str]
GOOD = '[matrices]\nstiffness = "K.npz"\nmass = "M.npz"\ndofs = "dofs.csv"\n' + RUN.format(
    initial="modal = { velocity = [0.1] }"
).replace("modes = 10", "modes = 1").replace('node = "B"', 'node = "P"').replace("[0, 1", "[1, 0")


def small(folder: Path) -> Path:
    sp.save_npz(folder / "K.npz", sp.csc_array([[2.0]]))
    sp.save_npz(folder / "M.npz", sp.csc_array([[1.0]]))
    (folder / "dofs.csv").write_text("node,dof\nP,dx\n")
    (folder / "modes.csv").write_text("frequency,P.dx\n3.0,1.0\n")
    return folder / "case.toml"


MODES = '[modes]\nfile = "modes.csv"\n' + GOOD[GOOD.index("[basis]") :]
MISTAKES: list[tuple[str, str]] = [
    (GOOD.replace("K.npz", "L.npz"), r"L\.npz: no such file"),
    (GOOD.replace("K.npz", "dofs.csv"), r"dofs\.csv: is of no known kind of matrix"),
    (GOOD.replace('dofs = "dofs.csv"\n', ""), r"K\.npz: does not say what its rows are"),
    (GOOD.replace('stiffness = "K.npz"\n', ""), r"case\.toml: matrices\.stiffness: is missing"),
    (GOOD + "[nodes]\nA = [0, 0, 0]\n", r"matrices: \[nodes\] and \[matrices\] exclude each other"),
    (GOOD + '[modes]\nfile = "modes.csv"\n', r"modes: \[matrices\] and \[modes\] exclude each"),
    (GOOD + '[masses.m]\nnode = "P"\nmass = 1.0\n', r"masses: does not go with \[matrices\]"),
    (GOOD[GOOD.index("[basis]") :], r"case\.toml: nodes: is missing; .*\[matrices\] or \[modes\]"),
    (GOOD.replace('node = "P"', 'node = "Q"'), r"stops\.spring\.node: unknown node .got 'Q'."),
    (GOOD.replace("[1, 0, 0]", "[0, 1, 0]"), r"stops\.spring.*: the matrices have no such dof"),
    (
        GOOD + '[[supports]]\nnodes = ["Q"]\nfixed = ["dx"]\n',
        r"supports\.0\.nodes: unknown node .got 'Q'.",
    ),
    (
        GOOD + '[[supports]]\nnodes = ["P"]\nfixed = ["dy"]\n',
        r"supports\.0\.fixed: the matrices have no such dof at node 'P' .got 'dy'.",
    ),
    (GOOD.replace("modes = 1", "modes = 2"), r"basis\.modes: more modes than free dofs .got 2."),
    (MODES.replace("modes.csv", "shapes.csv"), r"shapes\.csv: no such file"),
    (MODES.replace("modes = 1", "modes = 2"), r"basis\.modes: more modes than the file has"),
    (
        MODES.replace("modes = 1", "modes.band = [4, 9]"),
        r"basis\.modes: there is no mode",
    ),
    (MODES.replace('node = "P"', 'node = "Q"'), r"stops\.spring\.node: no mode shape at this node"),
    (MODES.replace("[1, 0, 0]", "[0, 1, 0]"), r"stops\.spring.*: no mode shape for this dof"),
    (
        MODES.replace("damping = 0.01", 'static_shapes = "stops"'),
        r"basis\.static_shapes: needs a structure",
    ),
    (
        MODES.replace('"modes.csv"\n', '"modes.csv"\nmodal_mass = [1.0, 2.0]\n'),
        r"modes\.modal_mass: must be one number, or one for each of the 1 modes",
    ),
    (
        MODES + '[[supports]]\nnodes = ["P"]\nfixed = ["dx"]\n',
        r"supports: does not go with \[modes\]",
    ),
]


@pytest.mark.parametrize(("text", "message"), MISTAKES, ids=[line for _, line in MISTAKES])
def test_mistakes_are_one_line_that_names_the_file(tmp_path: Path, text: str, message: str) -> None:
    case = small(tmp_path)
    case.write_text(GOOD)
    load_case(case)
    case.write_text(text)
    with pytest.raises(InputError, match=message) as refused:
        load_case(case)
    assert "\n" not in str(refused.value)
    assert str(tmp_path) in str(refused.value)


def test_a_variant_may_take_another_file(tmp_path: Path) -> None:
    case = small(tmp_path)
    sp.save_npz(tmp_path / "K2.npz", sp.csc_array([[8.0]]))
    case.write_text(GOOD + '[variants.stiff]\n"matrices.stiffness" = "K2.npz"\n')
    assert load_case(case).problems["stiff"].basis.omega2.tolist() == [8.0]
    case.write_text(GOOD + '[variants.stiff]\n"matrices.stiffness" = "K3.npz"\n')
    with pytest.raises(InputError, match=r"K3\.npz: no such file"):
        load_case(case)
