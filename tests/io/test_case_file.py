"""Case files become problems: tables, units, variants, references."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs

SDNL32 = Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml"

BALL = """
[nodes]
P = [0, 0, 0]
[masses.ball]
node = "P"
mass = 2.0
[[supports]]
nodes = "all"
fixed = ["dx", "dy", "drx", "dry", "drz"]
[basis]
modes = 1
[stops.floor]
node = "P"
normal = [0, 0, 2]
stiffness = 1e4
[run]
duration = 1.0
"""

Load = Callable[[str], bs.Case]


def _stop(problem: bs.Problem) -> bs.Stop:
    stop = problem.laws[0]
    assert isinstance(stop, bs.Stop)
    return stop


def test_defaults(load: Load, tmp_path: Path) -> None:
    case = load(BALL)
    (problem,) = case.problems.values()
    (stop,) = problem.laws
    assert isinstance(stop, bs.Stop)
    assert list(case.problems) == ["base"]
    assert case.name == case.title == tmp_path.name
    assert case.path == tmp_path / "case.toml"
    assert (case.method, dict(case.method_options)) == ("auto", {"beyond_stability_limit": False})
    assert (stop.gap, stop.damping, stop.obstacle) == (0.0, 0.0, "plane")
    assert stop.normal == (0.0, 0.0, 1.0)
    assert problem.initial is None
    assert problem.basis.damping_ratio.tolist() == [0.0]
    assert case.references == {"base": []}


def test_everything_that_can_be_written(load: Load) -> None:
    case = load(
        'title = "Ball"\ndescription = """\nTwo\nlines"""\n'
        + BALL
        + 'dt = "1 ms"\nsample = "2 ms"\n'
        'method = "symplectic_euler"\nbeyond_stability_limit = true\n'
        '[loads.weight]\ntype = "gravity"\nacceleration = [0, 0, "-1 g_0"]\n'
        '[loads.push]\ntype = "force"\nnode = "P"\nforce = [0, 0, "2 N"]\n'
        'moment = ["1 N m", 0, 0]\n'
        "[initial]\nmodal = { displacement = [0.5], velocity = [-1] }\n"
        '[[outputs]]\nnode = "P"\ndof = "dz"\n'
        '[[references]]\nquantity = "velocity"\nnode = "P"\ndof = "dz"\ntimes = [0, "100 ms"]\n'
        'values = [-1, "-36 km/h"]\nabsolute_tolerance = "1 mm/s"\nsource = "nowhere"\n'
    )
    problem = case.problems["base"]
    assert (case.title, case.description) == ("Ball", "Two\nlines")
    assert case.method == "symplectic_euler"
    assert dict(case.method_options) == {"dt": 1e-3, "beyond_stability_limit": True}
    assert problem.sample == 2e-3
    assert problem.outputs == (("P", "dz"),)
    assert problem.initial == bs.ModalState(displacement=[0.5], velocity=[-1.0])
    assert problem.loads == (
        bs.Gravity("weight", acceleration=(0, 0, -9.80665)),
        bs.NodalForce("push", node="P", force=(0, 0, 2), moment=(1, 0, 0)),
    )
    (reference,) = case.references["base"]
    assert reference.times == (0.0, 0.1)
    assert reference.values == (-1.0, -10.0)
    assert (reference.tolerance, reference.absolute_tolerance) == (None, 1e-3)
    assert reference.source == "nowhere"


@pytest.mark.parametrize(("written", "flies"), [("", None), ("false", False), ("true", True)])
def test_a_case_says_whether_methods_fly(written: str, flies: bool | None, load: Load) -> None:
    key = f"exact_flights = {written}\n" if written else ""
    assert load(f'{BALL}method = "dop853"\n{key}').method_options.get("exact_flights") is flies


def test_other_words_for_flights_are_refused(refused: Callable[[str], str]) -> None:
    assert "run.exact_flights" in refused(f'{BALL}exact_flights = "no"\n')


@pytest.mark.parametrize("key", ["tolerance", "relative_tolerance"])
def test_a_relative_tolerance_has_a_short_and_a_full_name(key: str, load: Load) -> None:
    case = load(BALL + REFERENCE + f"times = [0.5]\nvalues = [1]\n{key} = 0.008")
    (reference,) = case.references["base"]
    assert (reference.tolerance, reference.absolute_tolerance) == (0.008, None)


def test_units_and_si_numbers_give_the_same_bits(load: Load) -> None:
    text = SDNL32.read_text()
    for si, unit in [
        ("0.783, 0.0", '"783 mm", 0'),
        ("67e9 ", '"67 GPa"'),
        ("2400.0", '"2.4 g/cm^3"'),
        ("height = 0.014", 'height = "14 mm"'),
        ("0.01 ", '"1 %"'),
        ("= 18e3 ", '= "18 kN/m"'),
        ("= 45e3 ", '= "45 N/mm"'),
        ("0.462", '"46.2 cm"'),
        ("0.02 ", '"20 ms"'),
        ("sample = 1e-5", 'sample = "10 us"'),
    ]:
        assert si in text
        text = text.replace(si, unit)
    written, with_units = bs.load_case(SDNL32), load(text)
    assert with_units.problems.keys() == written.problems.keys()
    for name, problem in written.problems.items():
        other = with_units.problems[name]
        np.testing.assert_array_equal(other.basis.omega2, problem.basis.omega2)
        np.testing.assert_array_equal(other.basis.shapes, problem.basis.shapes)
        np.testing.assert_array_equal(other.basis.damping, problem.basis.damping)
        assert other.laws == problem.laws
        assert other.gauges == problem.gauges
        assert (other.duration, other.sample) == (problem.duration, problem.sample)
        assert with_units.references[name] == written.references[name]


def test_variants_share_the_modes_that_they_do_not_change(load: Load) -> None:
    case = load(
        BALL + '[variants]\nsoft = { "stops.floor.stiffness" = 1e3 }\nsame = {}\n'
        'heavy = { "masses.ball.mass" = "8 kg" }\n'
    )
    soft, same, heavy = (case.problems[name] for name in ("soft", "same", "heavy"))
    assert [_stop(problem).stiffness for problem in (soft, same, heavy)] == [1e3, 1e4, 1e4]
    assert soft.basis is same.basis
    assert soft.basis.row("P", "dz").item() == pytest.approx(math.sqrt(1 / 2))
    assert heavy.basis.row("P", "dz").item() == pytest.approx(math.sqrt(1 / 8))


@pytest.mark.parametrize(
    "change",
    [
        '"stops.floor.gap" = 0.5',
        'stops.floor.gap = "50 cm"',
        "stops.floor = { gap = 0.5 }",
        '"stops.floor" = { gap = 0.5 }',
        'stops = { "floor.gap" = 0.5 }',
    ],
)
def test_ways_to_write_an_override(change: str, load: Load) -> None:
    case = load(f"{BALL}[variants.far]\n{change}\n")
    assert _stop(case.problems["far"]).gap == 0.5


def test_overrides_reach_into_lists_and_add_tables(load: Load) -> None:
    case = load(
        BALL + '[variants.all]\n"stops.floor.normal.0" = 1\n'
        '"stops.ceiling" = { node = "P", normal = [0, 0, -1], gap = 1, stiffness = 1 }\n'
        '"supports.0.fixed" = ["dy", "drx", "dry", "drz"]\n"basis.modes" = 2\n'
        '"run.method" = "exact"\n'
    )
    floor, ceiling = case.problems["all"].laws
    assert floor.coordinate.direction == pytest.approx((1 / math.sqrt(5), 0, 2 / math.sqrt(5)))
    assert ceiling.name == "ceiling"
    assert len(case.problems["all"].basis.omega2) == 2
    assert (case.methods["all"].name, case.method) == ("exact", "auto")


@pytest.mark.parametrize(
    ("addition", "message"),
    [
        (
            '[variants.x]\n"stops.flor.gap" = 1',
            "the case has no 'flor' there; did you mean 'floor'?",
        ),
        ('[variants.x]\n"basis.modes.first" = 1', "there is no table that could hold 'first'"),
        ('[variants.x]\n"supports.1.fixed" = ["dx"]', "the list there has items 0 to 0"),
        ('[variants.x]\n"supports.-1.fixed" = ["dx"]', "the list there has items 0 to 0"),
        ('[variants.x]\n"title" = "Mine"', "cannot be changed by a variant"),
        ('[variants.x]\n"description" = "Mine"', "cannot be changed by a variant"),
        ('[variants.x]\n"variants.x" = 1', "cannot be changed by a variant"),
        ('[variants.x]\n"references.0.times" = [1]', "cannot be changed by a variant"),
        ('[variants.x]\n"stops.floor.gpa" = 1', "unknown key (got 1); did you mean 'gap'?"),
        ('[variants.x]\n"masses.ball.mass" = -1', "must not be negative (got -1)"),
    ],
)
def test_overrides_that_lead_nowhere(
    addition: str, message: str, refused: Callable[[str], str]
) -> None:
    path = addition.split("\n")[1].split(" = ")[0]
    assert refused(BALL + addition).startswith(f"variants.x.{path}: ")
    assert message in refused(BALL + addition)


def test_a_variant_is_not_blamed_for_the_case(refused: Callable[[str], str]) -> None:
    wrong = BALL.replace('[stops.floor]\nnode = "P"', '[stops.floor]\nnode = "Q"')
    message = refused(wrong + '[variants.x]\n"stops.floor.gap" = 1')
    assert message.startswith("stops.floor.node: unknown node (got 'Q')")


REFERENCE = '[[references]]\nquantity = "displacement"\nnode = "P"\ndof = "dz"\n'


@pytest.mark.parametrize(
    ("reference", "message"),
    [
        (
            REFERENCE + "times = [0.5]\nvalues = [1, 2]\ntolerance = 1",
            "references.0.times: must be as many as there are values, 2",
        ),
        (
            REFERENCE + "times = [0.5, 0.5]\nvalues = [1, 2]\ntolerance = 1",
            "references.0.times.1: times must ascend (got 0.5)",
        ),
        (
            REFERENCE + 'times = [0.5, "2 s"]\nvalues = [1, 2]\ntolerance = 1',
            "references.0.times.1: is after the end of the run (got 2.0); run.duration is 1 s",
        ),
        (
            REFERENCE + 'times = [0.5]\nvalues = ["1 s"]\ntolerance = 1',
            "references.0.values.0: wrong unit: 's' is a time, expected a displacement like 'm'",
        ),
        (
            REFERENCE + 'times = [0.5]\nvalues = [1]\nabsolute_tolerance = "1 s"',
            "references.0.absolute_tolerance: wrong unit: 's' is a time",
        ),
        (
            REFERENCE + "times = [0.5]\nvalues = [1]\nabsolute_tolerance = 0",
            "references.0.absolute_tolerance: must be positive (got 0.0)",
        ),
        (
            REFERENCE + "times = [0.5]\nvalues = [1]",
            "references.0.tolerance: give either tolerance or absolute_tolerance",
        ),
        (
            REFERENCE + "times = [0.5]\nvalues = [1]\ntolerance = 1\nrelative_tolerance = 2",
            "references.0.relative_tolerance: is the same as tolerance (got 2.0); give one",
        ),
        (
            REFERENCE + "times = [0.5]\nvalues = [0]\ntolerance = 1",
            "references.0.tolerance: nothing is relative to a value of 0",
        ),
        (
            REFERENCE.replace('"P"', '"Q"') + "times = [0.5]\nvalues = [1]\ntolerance = 1",
            "references.0.node: unknown node (got 'Q')",
        ),
        (
            '[[references]]\nquantity = "gap"\nstop = "flor"\ntimes = [0.5]\nvalues = [1]\n'
            "tolerance = 1",
            "references.0.stop: unknown stop (got 'flor'); did you mean 'floor'?",
        ),
        (
            '[[references]]\nquantity = "gauge"\ngauge = "g"\ntimes = [0.5]\nvalues = [1]\n'
            "tolerance = 1",
            "references.0.gauge: unknown gauge (got 'g'); none are defined",
        ),
        (
            '[[references]]\nquantity = "modal_displacement"\nmode = 2\ntimes = [0.5]\n'
            "values = [1]\ntolerance = 1",
            "references.0.mode: must be at most 1 (got 2)",
        ),
        (
            REFERENCE + 'variant = "soft"\ntimes = [0.5]\nvalues = [1]\ntolerance = 1',
            "references.0.variant: unknown variant (got 'soft')",
        ),
        (
            REFERENCE.replace('"dz"', '"dq"') + "times = [0.5]\nvalues = [1]\ntolerance = 1",
            "references.0.dof: is not one of the known words (got 'dq'); known: dx, dy",
        ),
    ],
)
def test_references_that_do_not_fit(
    reference: str, message: str, refused: Callable[[str], str]
) -> None:
    assert refused(BALL + reference).startswith(message)


def test_a_reference_without_a_variant_is_for_all(load: Load) -> None:
    reference = f"{REFERENCE}times = [0.5]\nvalues = [1]\ntolerance = 1\n"
    case = load(f"{BALL}{reference}[variants]\na = {{}}\nb = {{}}\n")
    assert case.references["a"] == case.references["b"]
    assert len(case.references["a"]) == 1


@pytest.mark.parametrize(
    ("addition", "message"),
    [
        (
            '[initial]\nrotation = { about = "P", rate = [0, 0, 1] }\nmodal = {}',
            "initial: rotation and modal exclude each other",
        ),
        ("[initial]", "initial: is empty"),
        (
            "[initial]\nmodal = { velocity = [1, 2] }",
            "initial.modal.velocity: must have one number for each of the 1 modes",
        ),
        ('[gauges.g]\nbeam = "AB"\nat = 1\nfibre = [0, 0]', "gauges.g.beam: unknown beam"),
        ('[[outputs]]\nnode = "Q"\ndof = "dx"', "outputs.0.node: unknown node (got 'Q')"),
        (
            '[loads.push]\ntype = "force"\nnode = "Q"\nforce = [1, 0, 0]',
            "loads.push.node: unknown node (got 'Q')",
        ),
        ('[loads.push]\nnode = "P"', "loads.push.type: is missing; known: force, "),
        ('[masses.b]\nnode = "Q"\nmass = 1', "masses.b.node: unknown node (got 'Q')"),
        ("[nodes.all]", "nodes.all"),
    ],
)
def test_parts_that_do_not_fit(addition: str, message: str, refused: Callable[[str], str]) -> None:
    assert refused(BALL + addition).startswith(message)


@pytest.mark.parametrize("method", ["exact", "symplectic_euler", "central_difference"])
def test_ten_lines_of_python_give_the_same_bits_as_the_file(method: str) -> None:
    alloy = bs.Material(young_modulus=67e9, poisson_ratio=0.0, density=2400.0)
    bar = bs.Rectangle(height=0.014, width=0.014)
    beam = bs.Beam("AB", nodes=("A", "B"), elements=10, material=alloy, section=bar)
    bending = bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))
    hinge = bs.Support(nodes=("A",), fixed=("dy",))
    nodes = {"A": (0, 0, 0), "B": (0.783, 0, 0)}
    structure = bs.Structure(nodes=nodes, beams=[beam], supports=[bending, hinge])
    basis = bs.ModalBasis.from_structure(structure, modes=10, damping=0.01)
    stop = bs.Stop("spring", node="B", normal=(0, 1, 0), gap=0.0, stiffness=45e3)
    swing = bs.RigidRotation(about="A", rate=(0, 0, -3.8))
    problem = bs.Problem(basis, laws=[stop], initial=swing, duration=0.02, sample=1e-5)
    dt = None if method == "exact" else 1e-5
    by_hand = bs.simulate(problem, method, dt=dt)
    from_file = bs.simulate(bs.load_case(SDNL32).problems["stiff"], method, dt=dt)
    for quantity in ("displacement", "velocity", "acceleration"):
        np.testing.assert_array_equal(
            from_file.sample(quantity, "B", "dy"), by_hand.sample(quantity, "B", "dy")
        )
    assert from_file.impact_table() == by_hand.impact_table()
