"""``[results.NAME]``: what a case asks for is read and shown in its report."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import bumpstop as bs
from bumpstop.cli import main
from bumpstop.report import write_report

CASE = """
[nodes]
A = [0.0, 0.0, 0.0]
B = [1.2, 0.0, 0.0]
[materials.steel]
young_modulus = "210 GPa"
poisson_ratio = 0.3
density = 7800.0
[sections.bar]
shape = "rectangle"
height = "12 mm"
width = "12 mm"
[beams.AB]
nodes = ["A", "B"]
elements = 6
material = "steel"
section = "bar"
[[supports]]
nodes = "all"
fixed = ["dx", "dz", "drx", "dry"]
[[supports]]
nodes = ["A"]
fixed = ["dy", "drz"]
[basis]
modes = 3
damping = 0.02
[stops.wall]
node = "B"
normal = [0.6, -0.8, 0]
gap = "0.4 mm"
stiffness = "80 kN/m"
[loads.shaker]
type = "force"
node = "B"
force = [0, 30, 0]
harmonics = [{ frequency = 7.0, sine = 1.0 }]
[gauges.root]
beam = "AB"
at = 0.0
fibre = [0.006, 0.0]
[run]
duration = 2.0
method = "exact"
"""

RESULTS = {
    "counts": 'type = "contact_statistics"\nstop = "wall"\nthreshold = 1.0\nstart = 0.2\n'
    "blocks = 6",
    "spectrum": 'type = "spectrum"\nquantity = "gauge"\ngauge = "root"\nsample = "1 ms"',
    "lines": 'type = "spectrum"\nof = "amplitude"\nquantity = "velocity"\nnode = "B"\ndof = "dy"\n'
    'sample = "1 ms"',
    "waterfall": 'type = "spectrum"\nof = "spectrogram"\nquantity = "stop_force"\nstop = "wall"\n'
    'sample = "1 ms"\nsegment = "0.2 s"',
    "shape": 'type = "spectrum"\nof = "envelope"\nquantity = "gap"\nstop = "wall"\nsample = "2 ms"',
    "floor": 'type = "response_spectrum"\nnode = "B"\ndof = "dy"\nlowest = 1.0\n'
    'highest = "0.2 kHz"\npoints = 12\nsample = "0.5 ms"\ndamping = [0.02, 0.05]',
    "root": 'type = "section_forces"\nbeam = "AB"\nat = 0.0',
    "fibre": 'type = "stress"\nbeam = "AB"\nat = "0.1 m"\nfibre = ["6 mm", 0.0]',
    "clamp": 'type = "reactions"\nnode = "A"',
    "points": 'type = "poincare"\nnode = "B"\ndof = "dy"\nperiod = 0.142857142857\nstart = 0.5',
    "order": 'type = "lyapunov"\nexponents = 2\nstart = 0.3',
    "sides": 'type = "work_by_sector"\nstops = "wall"\nsectors = 4\naxes = ["dx", "dy"]',
    "scar": 'type = "wear"\nstop = "wall"\nlaw = "archard"\ncoefficient = 2e-18\n'
    'service = ["1 year", "2 year"]\nradius = "9 mm"\nlength = "10 mm"',
}


def case_with(tmp_path: Path, *names: str, **more: str) -> bs.Case:
    tables = {name: RESULTS[name] for name in names} | more
    text = CASE + "".join(f"[results.{name}]\n{table}\n" for name, table in tables.items())
    file = tmp_path / "case.toml"
    file.write_text(text)
    return bs.load_case(file)


def test_every_type_is_shown_in_the_report(tmp_path: Path) -> None:
    case = case_with(tmp_path, *RESULTS)
    responses = {name: bs.simulate(problem) for name, problem in case.problems.items()}
    for result in case.results["base"]:
        reading = result.read(responses["base"])
        assert reading.facts or reading.figures, result.name
    page = tmp_path / "report.html"
    write_report(case, responses, {}, page)
    text = page.read_text()
    assert "Work rate at wall" in text
    assert '"type":"bar"' in text
    assert '"type":"heatmap"' in text
    assert "Lyapunov exponent 2" in text
    assert "Standard error" in text
    assert "Poincaré section of B dy" in text
    assert "Largest bending moment about local z in AB" in text


def test_they_read_what_the_functions_read(tmp_path: Path) -> None:
    case = case_with(tmp_path, "counts", "floor", "root", "scar")
    run = bs.simulate(case.problems["base"])
    counts, floor, root, scar = (result.read(run) for result in case.results["base"])
    expected = bs.contact_statistics(run, "wall", threshold=1.0, start=0.2, blocks=6)
    told = {fact.what.long_name: fact for fact in counts.facts}
    assert told["rms force over all the time"].value == expected["rms_force"]
    error = expected.uncertainty["rms_force"]
    assert told["rms force over all the time"].uncertainty == error
    times = np.arange(0.0, 2.0 + 1e-9, 5e-4)
    motion = run.at(times.clip(0.0, 2.0)).acceleration("B", "dy")
    spectrum = bs.response_spectrum(motion, np.geomspace(1.0, 200.0, 12), 0.05)
    np.testing.assert_allclose(floor.figures[1].array, spectrum, rtol=1e-9)
    assert floor.figures[1].log == "xy"
    moment = bs.recovery(run).section_forces("AB", 0.0)["Mz"]
    assert [str(drawn.array.name) for drawn in root.figures] == ["Vy", "Mz"]
    np.testing.assert_array_equal(root.figures[1].array, moment)
    flat = bs.FlatScar(radius=9e-3, length=10e-3)
    law = bs.ArchardWear(2e-18)
    year = 365.25 * 86400.0
    expected_wear = bs.wear(run, "wall", law, [year, 2.0 * year], scar=flat)
    assert scar.facts[-1].value > 0.0
    assert scar.facts[-1].value == pytest.approx(float(expected_wear["depth"][-1]), rel=1e-3)


def test_floor_spectra_are_of_the_absolute_acceleration(tmp_path: Path) -> None:
    """Whether results are told from the ground or from the supports that shake."""
    shaking = (
        "\n[base_motion]\nacceleration = [0, 3.0, 0]\n"
        'harmonics = [{{ frequency = 3.0, sine = 1.0 }}]\nframe = "{frame}"\n'
    )
    found = []
    for frame in ("relative", "absolute"):
        file = tmp_path / f"{frame}.toml"
        table = f"[results.floor]\n{RESULTS['floor']}\n"
        file.write_text(CASE + shaking.format(frame=frame) + table)
        case = bs.load_case(file)
        (floor,) = case.results["base"]
        (first, _) = floor.read(bs.simulate(case.problems["base"])).figures
        found.append(np.asarray(first.array))
    np.testing.assert_allclose(found[0], found[1], rtol=1e-9)
    # A stiff oscillator on the floor feels no less than the ground does.
    assert found[0][-1] > 2.9


@pytest.mark.parametrize(
    ("table", "key", "what"),
    [
        ('type = "contact_statistics"\nstop = "wal"', "results.bad.stop", "did you mean 'wall'"),
        (RESULTS["counts"] + "\nend = 3.0", "results.bad.end", "within the run of 2 s"),
        (RESULTS["root"].replace("AB", "AX"), "results.bad.beam", "unknown beam"),
        (RESULTS["clamp"].replace('"A"', '"Z"'), "results.bad.node", "unknown node"),
        (RESULTS["spectrum"] + '\nnode = "B"', "results.bad.node", "does not belong to gauge"),
        (RESULTS["lines"].replace('dof = "dy"\n', ""), "results.bad.dof", "is needed"),
        (RESULTS["waterfall"].replace('segment = "0.2 s"', ""), "results.bad.segment", "is needed"),
        (RESULTS["floor"].replace('"0.2 kHz"', "0.5"), "results.bad.highest", "above the lowest"),
        (RESULTS["scar"].replace('length = "10 mm"', ""), "results.bad.length", "is needed"),
        (RESULTS["clamp"].replace('"A"', '"AB@0.1"'), "results.bad.node", "unknown node"),
        (
            RESULTS["lines"].replace('"1 ms"', '"3 s"'),
            "results.bad.sample",
            "must be below the 2 s",
        ),
        (
            RESULTS["waterfall"].replace('"0.2 s"', '"20 s"'),
            "results.bad.segment",
            "between two steps and the signal's",
        ),
        (RESULTS["spectrum"] + '\nwindow = "foo"', "results.bad.window", "no window of SciPy"),
        (RESULTS["floor"].replace("0.05", "1.5"), "results.bad.damping.1", "below 1"),
        ('type = "lyapunov"\nexponents = 300', "results.bad.exponents", "at most 6"),
        (
            'type = "poincare"\nnode = "B"\ndof = "dy"\nperiod = "3 s"',
            "results.bad.period",
            "does not fit twice",
        ),
        (
            'type = "contact_statistics"\nstop = "wall"\nblocks = 1000000000000',
            "results.bad.blocks",
            "at most 10,000",
        ),
        (
            RESULTS["root"].replace("section_forces", "section_force"),
            "results.bad.type",
            "section_forces",
        ),
    ],
)
def test_refuses(tmp_path: Path, table: str, key: str, what: str) -> None:
    with pytest.raises(bs.InputError, match=what) as caught:
        case_with(tmp_path, bad=table)
    assert caught.value.key == key


def test_a_modal_case_has_none(tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    modal = CASE.partition("[stops.wall]")[0]
    file.write_text(f"{modal}[results.bad]\n{RESULTS['clamp']}\n")
    with pytest.raises(bs.InputError, match="there are results"):
        bs.load_case(file)


def test_a_result_that_cannot_be_read_leaves_the_others(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The rate of wear would rise: that is known once the run is made."""
    wear = 'type = "wear"\nstop = "wall"\nlaw = "edf"\ncoefficient = 1e-30\nservice = ["10 years"]'
    file = tmp_path / "case.toml"
    tables = {"rising": wear, "counts": RESULTS["counts"]}
    told = "".join(f"[results.{name}]\n{table}\n" for name, table in tables.items())
    file.write_text(f"{CASE}{told}")
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 1
    error = capsys.readouterr().err
    assert f"{file}: results.rising: " in error
    assert "above the rate of wear at first" in error
    page = (tmp_path / "out" / "report.html").read_text()
    assert "Could not be read: results.rising: " in page
    assert "Number of impacts" in page
    assert bs.read_netcdf(next((tmp_path / "out").glob("*/response.nc"))).event_count > 0


def test_their_numbers_stand_in_the_file(tmp_path: Path) -> None:
    text = "".join(f"[results.{name}]\n{table}\n" for name, table in RESULTS.items())
    file = tmp_path / "case.toml"
    file.write_text(f"{CASE}{text}")
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 0
    found = bs.read_results(tmp_path / "out" / "base" / "response.nc")
    case = bs.load_case(file)
    response = bs.simulate(case.problems["base"], method="exact")
    facts = [
        (each.name, fact.what.long_name, fact.what.units, fact.value, fact.uncertainty)
        for each in case.results["base"]
        for fact in each.read(response).facts
    ]
    assert len(facts) > 10
    expected = pd.DataFrame(facts, columns=["name", "quantity", "units", "value", "uncertainty"])
    pd.testing.assert_frame_equal(found, expected, check_exact=True)


def test_a_file_without_results_has_none(tmp_path: Path) -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    bs.simulate(bs.Problem(basis, duration=1.0)).to_netcdf(tmp_path / "free.nc")
    assert len(bs.read_results(tmp_path / "free.nc")) == 0
    (tmp_path / "text.nc").write_text("no file of numbers")
    with pytest.raises(bs.InputError, match="no response that bumpstop wrote"):
        bs.read_results(tmp_path / "text.nc")
    with pytest.raises(bs.InputError, match="no such file"):
        bs.read_results(tmp_path / "missing.nc")


HOLE = """
[stops.hole]
node = "B"
obstacle = "circle"
axis = [1, 0, 0]
radius = "0.5 mm"
stiffness = "80 kN/m"
friction = 0.2
tangential_stiffness = "80 kN/m"
"""


def in_a_hole(tmp_path: Path, table: str) -> bs.Case:
    free = CASE.replace('fixed = ["dx", "dz", "drx", "dry"]', 'fixed = ["dx", "drx"]')
    free = free.replace('fixed = ["dy", "drz"]', 'fixed = ["dy", "dz", "dry", "drz"]')
    free = free.replace("force = [0, 30, 0]", "force = [0, 30, 20]").replace(
        "duration = 2.0", "duration = 0.6"
    )
    wall = free.index("[stops.wall]"), free.index("[loads.shaker]")
    text = free[: wall[0]] + HOLE + free[wall[1] :] + f"[results.sides]\n{table}\n"
    file = tmp_path / "case.toml"
    file.write_text(text.replace('method = "exact"\n', ""))
    return bs.load_case(file)


def test_work_by_sector(tmp_path: Path) -> None:
    case = in_a_hole(tmp_path, 'type = "work_by_sector"\nstops = "hole"\nsectors = 12')
    run = bs.simulate(case.problems["base"])
    (result,) = case.results["base"]
    reading = result.read(run)
    expected = bs.work_by_sector(run, "hole", sectors=12)
    assert float(expected.sum()) > 0.0
    total, largest, angle = reading.facts
    assert total.value == pytest.approx(bs.wear_work(run, "hole").rate, rel=1e-6)
    assert largest.value == float(expected.max())
    assert angle.value == float(expected["angle"][int(np.argmax(expected.values))])
    page = tmp_path / "report.html"
    write_report(case, {"base": run}, {}, page)
    assert '"type":"barpolar"' in page.read_text()
    run.to_netcdf(tmp_path / "run.nc", results=case.results["base"])
    (drawn,) = bs.read_curves(tmp_path / "run.nc")["sides"]
    assert drawn.identical(reading.figures[0].array)


@pytest.mark.parametrize(
    ("table", "line"),
    [
        ('stops = "hold"', "results.sides.stops"),
        ('stops = ["hole", "hole"]', "results.sides.stops"),
        ('stops = "hole"\nsectors = 100_000', "results.sides.sectors"),
        ('stops = "hole"\naxes = ["dy", "dy"]', "results.sides.axes"),
        ('stops = "hole"\naxes = ["dy", "drz"]', "results.sides.axes"),
        ('stops = "hole"\ncentre = [0.0]', "results.sides.centre"),
        ('stops = "hole"\nstart = 0.7', "results.sides.start"),
    ],
)
def test_mistakes_in_sectors_are_one_line(tmp_path: Path, table: str, line: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        in_a_hole(tmp_path, f'type = "work_by_sector"\n{table}')
    assert line in str(caught.value)
    assert "\n" not in str(caught.value)
