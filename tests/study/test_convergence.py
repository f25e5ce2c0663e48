"""converge: errors of time, basis and mesh, against closed forms and against each other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.report.convergence import position_told
from bumpstop.study.convergence.finer import finer_mesh

CASES = Path(__file__).parents[2] / "cases"
SDNL32 = CASES / "sdnl32" / "case.toml"

OSCILLATOR = """
[nodes]
P = [0, 0, 0]
[masses.m]
node = "P"
mass = 2.0
[springs.k]
node = "P"
stiffness = [0, 200.0, 0, 0, 0, 0]
[[supports]]
nodes = "all"
fixed = ["dx", "dz", "drx", "dry", "drz"]
[basis]
modes = 1
damping = 0.1
[initial]
translation = { velocity = [0, 1.0, 0] }
[run]
duration = 1.0
method = "central_difference"
dt = 0.02
[[references]]
quantity = "displacement"
node = "P"
dof = "dy"
times = [0.2, 0.5, 0.6]
values = [0.09, 0.08, -0.03]
tolerance = 0.1
"""

BAR = """
[nodes]
A = [0, 0, 0]
B = [2.0, 0, 0]
[materials.steel]
young_modulus = 200e9
poisson_ratio = 0.3
density = 8000.0
[sections.bar]
shape = "rectangle"
height = 0.1
width = 0.1
[beams.AB]
nodes = ["A", "B"]
elements = 4
theory = "bar"
material = "steel"
section = "bar"
[[supports]]
nodes = "all"
fixed = ["dy", "dz", "drx", "dry", "drz"]
[[supports]]
nodes = ["A"]
fixed = ["dx"]
[basis]
modes = 3
"""


def written(folder: Path, text: str) -> bs.Case:
    file = folder / "case.toml"
    file.write_text(text)
    return bs.load_case(file)


@pytest.fixture(scope="module")
def sdnl32() -> bs.Convergence:
    return bs.converge(bs.load_case(SDNL32))


def test_published_values_of_sdnl32_are_those_of_ten_modes(sdnl32: bs.Convergence) -> None:
    for name, variant in sdnl32.variants.items():
        assert variant.vectors == 10
        assert variant.largest == "basis"
        assert variant.position is not None
        assert variant.position.verdict == "computed"
        assert variant.position.is_firm is (name == "stiff")
    stiff = sdnl32.variants["stiff"]
    # The case passes its published tolerance of 1.2 %; what it converges to does not.
    assert np.max(np.abs(stiff.computed / stiff.published - 1.0)) < 0.009
    assert np.max(np.abs(stiff.converged / stiff.published - 1.0)) > 0.0135


def test_errors_of_sdnl32_add_up_to_those_of_a_much_finer_model(
    sdnl32: bs.Convergence, tmp_path: Path
) -> None:
    text = SDNL32.read_text().replace("elements = 10", "elements = 128")
    fine = written(tmp_path, text.replace("modes = 10\n", 'modes = "all"\n'))
    for name, variant in sdnl32.variants.items():
        response = bs.simulate(fine.problems[name])
        times = [check.time for check in variant.checks]
        finest = response.sample("displacement", "B", "dy", times=times)
        parts = sum(ladder.error for ladder in variant.ladders)
        np.testing.assert_allclose(variant.computed - variant.converged, parts, atol=1e-18)
        assert np.all(np.abs(variant.converged - finest) < 2.0 * variant.uncertainty + 2e-8)
        assert variant.relative(variant.converged - finest) < 1e-2 * variant.relative(variant.error)


def test_static_shapes_take_most_of_the_error_of_the_basis(sdnl32: bs.Convergence) -> None:
    for variant in sdnl32.variants.values():
        assert variant.remedy is not None
        left = variant.relative(variant.remedy.error)
        assert left < 0.01 * variant.relative(variant.basis.error)


@pytest.mark.parametrize(("method", "order"), [("symplectic_euler", 1), ("central_difference", 2)])
def test_errors_of_time_are_those_of_the_closed_form(
    tmp_path: Path, method: str, order: int
) -> None:
    text = OSCILLATOR.replace('"central_difference"', f'"{method}"').replace("0.02", "0.005")
    found = bs.converge(written(tmp_path, text)).variants["base"]
    times, rate = np.array([0.2, 0.5, 0.6]), 10.0 * np.sqrt(0.99)
    true = np.exp(-times) * np.sin(rate * times) / rate
    np.testing.assert_allclose(found.time.error, found.computed - true, rtol=1e-9)
    np.testing.assert_allclose(found.converged, true, rtol=1e-9)
    np.testing.assert_allclose(found.time.order, order, atol=0.15)
    assert found.basis.told == "none: the basis has all modes"
    assert found.mesh.told == "not refined: the case has no beams of its own"
    assert np.isnan(found.mesh.error).all()


def test_errors_of_tolerance_are_those_of_the_closed_form(tmp_path: Path) -> None:
    text = OSCILLATOR.replace('"central_difference"', '"rk32"').replace("dt = 0.02", "rtol = 1e-4")
    found = bs.converge(written(tmp_path, text)).variants["base"]
    times, rate = np.array([0.2, 0.5, 0.6]), 10.0 * np.sqrt(0.99)
    true = np.exp(-times) * np.sin(rate * times) / rate
    np.testing.assert_allclose(found.time.error, found.computed - true, rtol=1e-9)
    assert [rung.label for rung in found.time.rungs] == ["0.0001", "1e-05", "1e-06", "1e-07"]
    assert "tolerances of 0.0001, 1e-05, 1e-06, 1e-07, and the exact method" in found.time.told
    left = [np.abs(rung.values - true).max() for rung in found.time.rungs]
    assert left == sorted(left, reverse=True)


def test_frequencies_converge_to_those_of_a_bar(tmp_path: Path) -> None:
    true = (2.0 * np.arange(1, 4) - 1.0) * 5000.0 / 8.0  # (2 n - 1) c / 4 L, c = 5 km/s
    reference = f"""
[[references]]
quantity = "frequency"
modes = [1, 2, 3]
values = {true.tolist()}
tolerance = 0.1
"""
    found = bs.converge(written(tmp_path, BAR + reference)).variants["base"]
    assert found.response is None
    np.testing.assert_allclose(found.mesh.order, 2.0, atol=0.1)
    errors = found.converged - true
    assert np.all(np.abs(errors) < found.mesh.uncertainty)
    np.testing.assert_allclose(found.converged, true, rtol=2e-4)
    assert found.position is not None
    assert found.position.verdict == "converged"


def test_modes_left_out_of_a_bar_are_the_tail_of_its_series(tmp_path: Path) -> None:
    """A step of force at the free end: u = sum 8 F L / (pi2 EA (2n-1)2) (1 - cos w_n t)."""
    run = """
[loads.pull]
type = "force"
node = "B"
force = [1e6, 0, 0]
[run]
duration = "0.4 ms"
[[references]]
quantity = "displacement"
node = "B"
dof = "dx"
times = [2e-4, 3e-4, 4e-4]
values = [5e-4, 7.5e-4, 1e-3]
tolerance = 0.1
"""
    text = (BAR + run).replace("elements = 4", "elements = 32")
    found = bs.converge(written(tmp_path, text)).variants["base"]
    times = np.array([2e-4, 3e-4, 4e-4])
    true = 1e6 * 5000.0 * times / (200e9 * 0.01)  # F c t / EA until the wave comes back
    assert np.all(np.abs(found.converged - true) < 3e-3 * true)
    odd = 2.0 * np.arange(4, 2000) - 1.0
    size = 8.0 * 1e6 * 2.0 / (np.pi**2 * 200e9 * 0.01)
    tail = size * ((1.0 - np.cos(np.outer(times, odd * np.pi * 5000.0 / 4.0))) / odd**2).sum(axis=1)
    np.testing.assert_allclose(found.basis.error, -tail, rtol=0.02, atol=2e-3 * tail.max())


def test_names_of_mesh_nodes_follow_the_mesh(tmp_path: Path) -> None:
    def moved(place: str) -> bs.Convergence:
        text = SDNL32.read_text().replace('node = "B"', f'node = "{place}"')
        folder = tmp_path / place
        folder.mkdir()
        return bs.converge(written(folder, text), levels=2)

    by_name, by_place = moved("AB.5"), moved("AB@0.3915")
    for one, other in zip(by_name.variants.values(), by_place.variants.values(), strict=True):
        np.testing.assert_allclose(one.mesh.error, other.mesh.error, rtol=1e-6, atol=1e-15)
        np.testing.assert_allclose(one.converged, other.converged, rtol=1e-9)


def test_a_finer_mesh_leaves_the_document_as_it_was() -> None:
    given = bs.load_case(SDNL32).documents["soft"]
    finer = finer_mesh(given, 4, {"AB": 10})
    assert given["beams"]["AB"]["elements"] == 10
    assert finer["beams"]["AB"]["elements"] == 40
    assert {key for key in given if given[key] != finer[key]} == {"beams"}


@pytest.mark.parametrize(
    ("modes", "damping", "vectors"),
    [
        ("{ band = [0, 600] }", "0.01", ["4", "5", "7"]),
        ("{ around = 100, count = 3 }", "0.01", ["3", "6", "12"]),
        ("3", "[0.01, 0.02, 0.03]", ["1", "3", "6", "12"]),
    ],
)
def test_any_selection_of_modes_grows_to_all(
    tmp_path: Path, modes: str, damping: str, vectors: list[str]
) -> None:
    text = SDNL32.read_text().replace("modes = 10\n", f"modes = {modes}\n")
    case = written(tmp_path, text.replace("damping = 0.01 ", f"damping = {damping} "))
    found = bs.converge(case, levels=1)
    sizes = [rung.label for rung in found.variants["soft"].basis.rungs]
    assert sizes[: len(vectors)] == vectors
    assert sizes[-1] == "21"


def test_the_most_modes_are_helped_by_static_shapes(sdnl32: bs.Convergence) -> None:
    found = bs.converge(bs.load_case(SDNL32), most_modes=20, levels=2)
    for name, variant in found.variants.items():
        assert variant.mesh.rungs[-1].label == "4"
        whole = sdnl32.variants[name]
        assert variant.relative(variant.converged - whole.converged) < 0.02 * whole.relative(
            whole.error
        )


def test_missing_modes_are_measured_and_not_warned_of(tmp_path: Path) -> None:
    text = SDNL32.read_text().replace("18e3", "18e6").replace("modes = 10\n", "modes = 3\n")
    case = written(tmp_path, text)
    with pytest.warns(bs.ModellingWarning, match="the modes left out would give way"):
        bs.simulate(case.problems["soft"])
    found = bs.converge(case, levels=1).variants["soft"]  # warnings are errors here
    assert found.largest == "basis"


def test_all_modes_leave_no_error_of_the_basis(tmp_path: Path) -> None:
    case = written(tmp_path, SDNL32.read_text().replace("modes = 10\n", 'modes = "all"\n'))
    found = bs.converge(case, levels=1).variants["stiff"]
    assert found.basis.told == "none: the basis has all modes"
    assert not found.basis.error.any()
    assert found.remedy is None
    assert found.largest == "mesh"


def test_parts_are_refined_with_their_components() -> None:
    case = bs.load_case(CASES / "sdnl105b" / "case.toml")
    found = bs.converge(case, levels=3).variants["published"]
    frequencies = [row for row, check in enumerate(found.checks) if check.mode is not None]
    assert found.mesh.rungs[-1].label == "8"
    # The posts have no mass: the lowest three, in which they bend most, keep fewer digits.
    np.testing.assert_allclose(found.mesh.order[frequencies[3:]], 4.0, atol=0.1)


def test_the_table_has_a_row_for_each_value(sdnl32: bs.Convergence) -> None:
    table = sdnl32.table
    assert len(table) == 24
    total = table.time_error + table.basis_error + table.mesh_error
    np.testing.assert_allclose(table.computed - total, table.converged, rtol=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[[references]]", "[[unread]]", "references: is missing: its values are what is refined"),
        (
            "modes = 10\n",
            "modes = { band = [0, 90] }\n",
            "basis.damping: ratios listed mode by mode tell nothing of modes beyond a band",
        ),
    ],
)
def test_what_cannot_be_refined(tmp_path: Path, old: str, new: str, message: str) -> None:
    text = SDNL32.read_text()
    if new.startswith("[["):
        text = text[: text.index(old)]
    text = text.replace(old, new).replace("damping = 0.01 ", "damping = [0.01, 0.02] ")
    case = written(tmp_path, text.replace("modes = 10\n", "modes = 2\n"))
    with pytest.raises(bs.InputError, match=f"^.*case.toml: {message}"):
        bs.converge(case)


def test_modes_of_a_file_cannot_be_refined(tmp_path: Path) -> None:
    (tmp_path / "modes.csv").write_text("frequency,damping,P.dy\n10,0.01,1\n")
    text = """
[modes]
file = "modes.csv"
[basis]
modes = 1
[initial]
modal = { velocity = [1.0] }
[run]
duration = 1.0
[[references]]
quantity = "displacement"
node = "P"
dof = "dy"
times = [0.5]
values = [0.1]
tolerance = 1.0
"""
    case = written(tmp_path, text)
    with pytest.raises(bs.InputError, match="modes: modes of a file cannot be refined"):
        bs.converge(case)


@pytest.mark.parametrize(
    ("options", "key"),
    [({"method": "eulr"}, "method"), ({"dt": -1.0}, "dt"), ({"levels": 0}, "levels")],
)
def test_options_that_cannot_be_used(options: dict[str, object], key: str) -> None:
    with pytest.raises(bs.InputError, match=f"^{key}: "):
        bs.converge(bs.load_case(SDNL32), **options)  # type: ignore[arg-type]  # wrong on purpose


def test_values_of_the_very_model_do_not_tell_it_from_a_finer_one(tmp_path: Path) -> None:
    """Another program's run of ten modes is that of ten modes, whatever the beam does."""
    case = tmp_path / "case.toml"
    text = SDNL32.read_text()
    case.write_text(text.replace("source = ", "of_model = true\nsource = "))
    found = bs.converge(bs.load_case(case)).variants
    assert [variant.position for variant in found.values()] == [None, None]
    assert all(check.of_model for check in found["soft"].checks)
    told = position_told(found["soft"])
    assert told == "No value from outside that could tell this model from a finer one"


def test_few_values_from_outside_are_told_by_their_distances(tmp_path: Path) -> None:
    """One frequency of Euler's hinged beam: the regression would have no residual to go by."""
    case = tmp_path / "case.toml"
    lines = SDNL32.read_text().split("[[references]]")[0]
    case.write_text(
        lines + '[[references]]\nquantity = "frequency"\nmodes = [1]\nvalues = [100.0]\n'
        'tolerance = 1.0\nsource = "made up"\n'
    )
    variant = bs.converge(bs.load_case(case)).variants["soft"]
    assert variant.position is None
    off = [abs(float(end[0]) / 100.0 - 1.0) for end in (variant.computed, variant.converged)]
    np.testing.assert_allclose(variant.distances, off, rtol=1e-12)
    told = position_told(variant)
    assert f"one value from outside, {100 * off[0]:.2g} % off the computed" in told
