"""Loads that change in time, in case files."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs

MAST = """
[nodes]
A = [0, 0, 0]
B = [1, 0, 0]
[masses.b]
node = "B"
mass = 2.0
[springs.ab]
node = "B"
other = "A"
stiffness = 800.0
[[supports]]
nodes = ["A"]
fixed = ["dx", "dy", "dz"]
[[supports]]
nodes = ["B"]
fixed = ["dy", "dz"]
[basis]
modes = 1
[run]
duration = 2.0
"""


def case(folder: Path, text: str) -> bs.Problem:
    (folder / "case.toml").write_text(MAST + text)
    return bs.load_case(folder / "case.toml").problems["base"]


def test_terms_of_a_load_add_up(tmp_path: Path) -> None:
    problem = case(
        tmp_path,
        '[loads.push]\ntype = "force"\nnode = "B"\nforce = ["2 N", 0, 0]\n'
        'harmonics = [{ frequency = "3 Hz", cosine = 0.5 }, { frequency = 1, sine = 2 }]\n'
        "polynomial = [1.0, -0.5]\n"
        'table = { times = [0, "500 ms"], values = [1, 3], scale = 2, beyond = "hold" }\n',
    )
    (push,) = problem.loads
    assert isinstance(push, bs.NodalForce)
    times = np.array([0.25, 1.0])
    total = sum(function.at(times) for function in push.functions)
    turn = 2.0 * np.pi * times
    expected = 0.5 * np.cos(3 * turn) + 2 * np.sin(turn) + 1 - 0.5 * times + np.array([4.0, 6.0])
    np.testing.assert_allclose(total, expected, rtol=1e-14)
    assert bs.simulate(problem).history.event_count == 0


def test_the_supports_move_by_a_file(tmp_path: Path) -> None:
    times = np.linspace(0.0, 1.5, 16)
    values = np.sin(7.0 * times)
    lines = [f"{t},{a}" for t, a in zip(times.tolist(), values.tolist(), strict=True)]
    (tmp_path / "quake.csv").write_text("\n".join(["t,a", *lines]))
    problem = case(
        tmp_path,
        '[base_motion]\nacceleration = ["9.81 m/s^2", 0, 0]\n'
        'table = { file = "quake.csv", columns = ["t", "a"], beyond = "zero" }\n',
    )
    table = bs.TimeTable(times, values, beyond="zero")
    shake = bs.BaseMotion(acceleration=(9.81, 0, 0), time=table)
    again = bs.Problem(problem.basis, loads=[shake], duration=2.0)
    found, expected = (
        bs.simulate(each).displacement("B", "dx").to_numpy() for each in (problem, again)
    )
    np.testing.assert_array_equal(found, expected)
    assert abs(found).max() > 0.0


STOP = '[stops.wall]\nnode = "B"\nnormal = [-1, 0, 0]\ngap = 0.1\nstiffness = 1e4\n'


def test_an_obstacle_moves(tmp_path: Path) -> None:
    problem = case(
        tmp_path,
        STOP + 'motion = { travel = "20 cm", polynomial = [0, 1], '
        'harmonics = [{ frequency = "3 Hz", sine = 0.5 }], '
        "table = { times = [0, 2], values = [1, 3] } }\n",
    )
    (wall,) = problem.laws
    assert isinstance(wall, bs.Stop)
    times = np.array([0.1, 1.7])
    moved = sum(function.at(times) for function in wall.functions)
    expected = 0.2 * (times + 0.5 * np.sin(6.0 * np.pi * times) + 1.0 + times)
    np.testing.assert_allclose(moved, expected, rtol=1e-14)
    response = bs.simulate(problem)
    at_rest = 0.1 - 0.2 + 0.0 * times
    gap = response.at(np.array([0.0])).gap("wall")
    np.testing.assert_allclose(gap, at_rest[:1], rtol=0, atol=1e-15)


LOAD = '[loads.push]\ntype = "force"\nnode = "B"\nforce = [1, 0, 0]\n'


@pytest.mark.parametrize(
    ("text", "key", "what"),
    [
        (LOAD + "polynomial = [1, 1, 1, 1, 1, 1, 1]\n", "loads.push.polynomial", "degree 5"),
        (
            LOAD + "harmonics = [{ frequency = 0 }]\n",
            "loads.push.harmonics.0.frequency",
            "positive",
        ),
        (
            LOAD + "harmonics = [{ frequency = 1, cosin = 1 }]\n",
            "loads.push.harmonics.0.cosin",
            "unk",
        ),
        (LOAD + "table = {}\n", "loads.push.table", "needs a file, or times and values"),
        (
            LOAD + "table = { times = [0, 1], values = [1] }\n",
            "loads.push.table.values",
            "one value",
        ),
        (
            LOAD + "table = { times = [0, 2, 1], values = [0, 0, 0] }\n",
            "loads.push.table.times",
            "must not go backwards",
        ),
        (
            LOAD + "table = { times = [0, 1], values = [0, 0] }\n",
            "loads.push.table",
            "does not cover the run",
        ),
        (
            LOAD + 'table = { file = "a.csv", times = [0, 1] }\n',
            "loads.push.table.times",
            "is in the file",
        ),
        (LOAD + "table = { step = 1, times = [0] }\n", "loads.push.table.step", "is for a file"),
        (STOP + "motion = {}\n", "stops.wall.motion", "needs harmonics, a polynomial or a table"),
        (
            STOP + "motion = { table = { times = [0, 1], values = [0, 0] } }\n",
            "stops.wall.motion",
            "does not cover the run",
        ),
        (
            STOP + 'motion = { table = { times = [0, 1], values = [0, 1], beyond = "zero" } }\n',
            "stops.wall.motion",
            "must not jump",
        ),
        (
            STOP.replace("stiffness = 1e4", "restitution = 0.5")
            + "motion = { polynomial = [1] }\n",
            "stops.wall.motion",
            "is of no use to a rigid stop",
        ),
        (
            "[base_motion]\nacceleration = [1, 0, 0]\ntable = { times = [0], values = [1] }\n",
            "base_motion.table",
            "does not cover the run",
        ),
    ],
)
def test_mistakes_are_named(tmp_path: Path, text: str, key: str, what: str) -> None:
    with pytest.raises(bs.InputError, match=what) as caught:
        case(tmp_path, text)
    assert caught.value.key == key
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(bs.InputError, match=r"nowhere\.csv: no such file"):
        case(tmp_path, LOAD + 'table = { file = "nowhere.csv" }\n')


def test_a_load_may_sweep_and_follow_formulas_and_products(tmp_path: Path) -> None:
    problem = case(
        tmp_path,
        '[loads.push]\ntype = "force"\nnode = "B"\nforce = [2, 0, 0]\n'
        'sweeps = [{ frequencies = ["3 Hz", 8], duration = "1 s", phase = "90 deg" }]\n'
        'expression = "exp(-t)"\n'
        "product = [{ harmonics = [{ frequency = 4, sine = 1 }] }, "
        '{ table = { times = [0, 2], values = [0, 1] }, expression = "t" }]\n'
        "line_tolerance = 1e-3\n",
    )
    (push,) = problem.loads
    assert isinstance(push, bs.NodalForce)
    sweep, formula, product = push.functions
    assert sweep == bs.Sweep((3.0, 8.0), duration=1.0, phase=np.pi / 2, tolerance=1e-3)
    assert formula == bs.Expression("exp(-t)", tolerance=1e-3)
    times = np.array([0.3, 1.1])
    np.testing.assert_allclose(
        product.at(times), np.sin(8 * np.pi * times) * 1.5 * times, rtol=1e-12
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('expression = "sin(x)"', r"loads\.push\.expression: unknown name .*'x'"),
        ('expression = "1/t"', r"loads\.push\.expression: has no finite value"),
        ('expression = "exp(1e5*t)"', r"loads\.push\.expression: has no finite value"),
        ('expression = "1/(t - 0.1234)"', r"loads\.push\.expression: grows without limit"),
        (
            'expression = "sin(1e9*t)"\nline_tolerance = 1e-6',
            r"loads\.push\.line_tolerance: needs more than 2,000,000",
        ),
        (
            'product = [{ expression = "1/t" }, { expression = "t" }]',
            r"loads\.push\.product: has no finite value",
        ),
        ("product = []", r"loads\.push\.product: must be two functions"),
        ("product = [{ polynomial = [1] }]", r"loads\.push\.product: must be two functions"),
        ("product = [{}, {}]", r"loads\.push\.product\.0: has no function of time"),
        (
            "sweeps = [{ frequencies = [0, 1], duration = 1, spacing = 'logarithmic' }]",
            r"loads\.push\.sweeps\.0\.frequencies: must be positive",
        ),
        ('table = { file = "a.csv", units = ["ms"] }', r"push\.table\.units: must be two units"),
        ('table = { file = "a.csv", units = ["mm", "N"] }', r"table\.units: .*a length, expected"),
        ('table = { file = "a.csv", units = ["s", "Nn"] }', r"table\.units: unknown unit .*'Nn'"),
        ('table = { times = [0], values = [0], units = ["s", "N"] }', r"units: is for a file"),
    ],
)
def test_mistakes_of_functions_are_one_line(tmp_path: Path, text: str, message: str) -> None:
    head = '[loads.push]\ntype = "force"\nnode = "B"\nforce = [2, 0, 0]\n'
    with pytest.raises(bs.InputError, match=message) as caught:
        case(tmp_path, f"{head}{text}\n")
    assert "\n" not in str(caught.value)


BEAM = """
[nodes]
A = [0, 0, 0]
B = ["1.2 m", 0, 0]
[materials.steel]
young_modulus = "210 GPa"
poisson_ratio = 0.25
density = 7800
[sections.bar]
shape = "rectangle"
height = "30 mm"
width = "20 mm"
[beams.AB]
nodes = ["A", "B"]
elements = 3
material = "steel"
section = "bar"
[[supports]]
nodes = ["A"]
fixed = ["dx", "dy", "dz", "drx", "dry", "drz"]
[run]
duration = "10 ms"
"""


def test_loads_along_beams_and_their_static_shapes(tmp_path: Path) -> None:
    text = (
        '[basis]\nmodes = 2\nload_shapes = ["wind"]\n'
        '[loads.wind]\ntype = "line_force"\nbeam = "AB"\nforce = [0, "0.1 kN/m", 0]\n'
        'end_force = [0, 30, 0]\nstart = "20 cm"\nend = 1\naxes = "local"\n'
        "harmonics = [{ frequency = 30, sine = 1 }]\n"
        '[loads.weight]\ntype = "gravity"\nacceleration = [0, 0, -9.81]\n'
    )
    (tmp_path / "case.toml").write_text(BEAM + text)
    problem = bs.load_case(tmp_path / "case.toml").problems["base"]
    wind = bs.LineForce(
        "wind",
        beam="AB",
        force=(0, 100.0, 0),
        end_force=(0, 30.0, 0),
        start=0.2,
        end=1.0,
        axes="local",
        time=[bs.Harmonic(30.0, sine=1.0)],
    )
    assert problem.loads[0] == wind
    assert problem.basis.labels == ("mode 1", "mode 2", "static shape of load wind")
    (tmp_path / "case.toml").write_text(BEAM + text.replace('["wind"]', '["wand"]'))
    with pytest.raises(bs.InputError, match=r"basis\.load_shapes: unknown .*mean 'wind'"):
        bs.load_case(tmp_path / "case.toml")
    (tmp_path / "case.toml").write_text(BEAM + text.replace('["wind"]', '"all"'))
    problem = bs.load_case(tmp_path / "case.toml").problems["base"]
    assert len(problem.basis.labels) == 4


def test_random_loads(tmp_path: Path) -> None:
    (tmp_path / "psd.csv").write_text("f,S\n1,4\n50,4\n")
    text = (
        "[basis]\nmodes = 2\n"
        '[loads.flow]\ntype = "turbulence"\nbeam = "AB"\ndirection = [0, 1, 0]\n'
        'psd = { file = "psd.csv" }\ncorrelation_length = "30 cm"\nseed = 3\nperiod = "1 s"\n'
        '[loads.noise]\ntype = "force"\nnode = "B"\nforce = [0, 2, 0]\n'
        "product = [{ random = { psd = { frequencies = [1, 50], values = [1, 1] }, seed = 1, "
        "period = 1 } }, { table = { times = [0, 1], values = [0, 1] } }]\n"
        "[base_motion]\nacceleration = [0, 1, 0]\n"
        "[base_motion.accelerogram]\ndamping = 0.05\nduration = 3\nseed = 1\n"
        "spectrum = { frequencies = [2, 20], values = [3, 3] }\n"
    )
    (tmp_path / "case.toml").write_text(BEAM + text)
    problem = bs.load_case(tmp_path / "case.toml").problems["base"]
    flow, noise, quake = problem.loads
    assert isinstance(flow, bs.Turbulence)
    assert flow.density.rms == pytest.approx(14.0)
    assert isinstance(noise, bs.NodalForce)
    assert isinstance(quake, bs.BaseMotion)
    assert isinstance(quake.functions[0], bs.Accelerogram)
    assert bs.simulate(problem).sample("displacement", "B", "dy").any()
    for wrong, message in (
        (text.replace("psd.csv", "none.csv"), r"none\.csv: no such file"),
        (text.replace("values = [1, 1] }, seed", "values = [1] }, seed"), r"random\.psd\.values: "),
        (
            text.replace("duration = 3\n", "duration = 0.1\n"),
            r"accelerogram\.duration",
        ),
        (text.replace("values = [3, 3]", "values = [3]"), r"accelerogram\.spectrum\.values"),
        (text.replace('"30 cm"', "0"), r"loads\.flow\.correlation_length: must be positive"),
    ):
        (tmp_path / "case.toml").write_text(BEAM + wrong)
        with pytest.raises(bs.InputError, match=message):
            bs.load_case(tmp_path / "case.toml")


def test_supports_move_in_either_frame(tmp_path: Path) -> None:
    wave = 'harmonics = [{ frequency = "2 Hz", sine = 1 }]\n'
    base = f'[base_motion]\ndisplacement = ["3 mm", 0, 0]\n{wave}frame = "absolute"\n'
    problem = case(tmp_path, f'{base}{STOP}frame = "absolute"\n')
    moved = bs.BaseMotion(
        displacement=(3e-3, 0, 0), time=[bs.Harmonic(2.0, sine=1.0)], frame="absolute"
    )
    assert problem.loads == (moved,)
    (wall,) = problem.laws
    assert isinstance(wall, bs.Stop)
    assert wall.frame == "absolute"
    text = f'[loads.foot]\ntype = "support_motion"\nnodes = ["A"]\nacceleration = [1, 0, 0]\n{wave}'
    (foot,) = case(tmp_path, text).loads
    assert isinstance(foot, bs.SupportMotion)
    assert foot.acceleration == (1.0, 0.0, 0.0)
    for wrong, message in (
        (text.replace('"A"', '"B"'), r"loads\.foot\.nodes: no support holds its dx"),
        (text + "displacement = [1, 0, 0]\n", r"loads\.foot\.acceleration: .* not both"),
        (base.replace("absolute", "moving"), r"base_motion\.frame: is not one of"),
        (
            f'{base}{STOP.replace("stiffness = 1e4", "restitution = 0.5")}frame = "absolute"\n',
            r"stops\.wall\.frame: is of no use to a rigid stop",
        ),
    ):
        with pytest.raises(bs.InputError, match=message):
            case(tmp_path, wrong)


def test_obstacles_of_a_shape_move_along_axes(tmp_path: Path) -> None:
    wave = '{ travel = "2 mm", harmonics = [{ frequency = "2 Hz", sine = 1 }] }'
    hole = (
        '[stops.hole]\nnode = "B"\nobstacle = "circle"\naxis = [0, 0, 1]\nradius = "1 mm"\n'
        f"stiffness = 1e4\nmotion.dx = {wave}\n"
    )
    (stop,) = case(tmp_path, f'{hole}frame = "absolute"\n').laws
    assert isinstance(stop, bs.CircleStop)
    assert stop.motion == {"dx": (bs.Harmonic(2.0, sine=2e-3),)}
    assert stop.frame == "absolute"
    floor = (
        '[stops.floor]\nnode = "B"\nnormal = [1, 0, 0]\nstiffness = 1e4\nsliding = "plane"\n'
        f"friction = 0.3\ntangential_stiffness = 1e4\nmotion.dx = {wave}\n"
    )
    (rubs,) = case(tmp_path, floor).laws
    assert isinstance(rubs, bs.PlaneStop)
    assert rubs.motions[0] == (bs.Harmonic(2.0, sine=2e-3),)
    for wrong, message in (
        (
            hole.replace("motion.dx", "motion"),
            r"stops\.hole\.motion\.harmonics: must say along which",
        ),
        (hole.replace("motion.dx", "motion.rx"), r"stops\.hole\.motion\.rx: .*unknown"),
        (hole.replace(wave, "{}"), r"stops\.hole\.motion\.dx: needs harmonics"),
        (
            STOP + f"motion.dx = {wave}\n",
            r"stops\.wall\.motion\.dx: a plane moves along its normal",
        ),
    ):
        with pytest.raises(bs.InputError, match=message):
            case(tmp_path, wrong)


def test_a_beam_is_pushed_onto_its_stop_and_let_go(tmp_path: Path) -> None:
    text = (
        "[basis]\nmodes = 3\n"
        '[loads.push]\ntype = "force"\nnode = "B"\nforce = [0, -500, 0]\n'
        '[loads.weight]\ntype = "gravity"\nacceleration = [0, -9.81, 0]\n'
        '[stops.wall]\nnode = "B"\nnormal = [0, 1, 0]\ngap = "2 mm"\nstiffness = 2e5\n'
        '[initial.static]\nrelease = ["push"]\n'
    )
    (tmp_path / "case.toml").write_text(BEAM + text)
    problem = bs.load_case(tmp_path / "case.toml").problems["base"]
    assert [load.name for load in problem.loads] == ["weight"]
    assert isinstance(problem.initial, bs.StaticState)
    assert [load.name for load in problem.initial.loads] == ["push", "weight"]  # type: ignore[attr-defined]  # as they were given
    assert bs.simulate(problem).sample("stop_force", "wall", times=[0.0])[0] > 0.0
    for wrong, message in (
        (text.replace('["push"]', '["pull"]'), r"initial\.static\.release: unknown release"),
        (text.replace("release =", "loads ="), None),
        (text + 'loads = ["pull"]\n', r"initial\.static\.loads: unknown loads"),
        (text + "[initial.modal]\n", r"initial: static and modal exclude each other"),
    ):
        (tmp_path / "case.toml").write_text(BEAM + wrong)
        if message is None:
            assert len(bs.load_case(tmp_path / "case.toml").problems["base"].loads) == 2
            continue
        with pytest.raises(bs.InputError, match=message):
            bs.load_case(tmp_path / "case.toml")


def test_nodes_start_with_displacements_and_velocities(tmp_path: Path) -> None:
    text = (
        "[basis]\nmodes = 18\n[initial.nodal]\n"
        'displacement = { B = { dy = "1 mm" } }\nvelocity = { "AB.1" = { dz = 0.2 } }\n'
    )
    (tmp_path / "case.toml").write_text(BEAM + text)
    problem = bs.load_case(tmp_path / "case.toml").problems["base"]
    found = bs.simulate(problem)
    assert found.sample("displacement", "B", "dy", times=[0.0])[0] == pytest.approx(1e-3)
    assert found.sample("velocity", "AB.1", "dz", times=[0.0])[0] == pytest.approx(0.2)
    (tmp_path / "case.toml").write_text(BEAM + text.replace("{ B =", "{ C ="))
    with pytest.raises(bs.InputError, match=r"initial\.nodal\.displacement: unknown node"):
        bs.load_case(tmp_path / "case.toml")


def test_a_force_travels_along_a_beam(tmp_path: Path) -> None:
    text = (
        "[basis]\nmodes = 2\n"
        '[loads.axle]\ntype = "moving_force"\nbeam = "AB"\nforce = [0, 0, "-5 N"]\n'
        'speed = "360 km/hour"\nenters = "1 ms"\n'
    )
    (tmp_path / "case.toml").write_text(BEAM + text)
    (axle,) = bs.load_case(tmp_path / "case.toml").problems["base"].loads
    assert isinstance(axle, bs.MovingForce)
    assert (axle.speed, axle.enters, axle.force) == (100.0, 1e-3, (0.0, 0.0, -5.0))
    (tmp_path / "case.toml").write_text(BEAM + text.replace('"360 km/hour"', "0"))
    with pytest.raises(bs.InputError, match=r"loads\.axle\.speed: must not be zero"):
        bs.load_case(tmp_path / "case.toml")


def test_a_stop_of_any_power_may_stand_still(tmp_path: Path) -> None:
    base = "[base_motion]\ndisplacement = [1e-3, 0, 0]\nharmonics = [{ frequency = 2, sine = 1 }]\n"
    text = f'{base}frame = "absolute"\n{STOP}exponent = 1.5\nframe = "absolute"\n'
    problem = case(tmp_path, text)
    (wall,) = problem.laws
    assert isinstance(wall, bs.HertzStop)
    response = bs.simulate(problem)
    gap = response.sample("gap", "wall") + response.sample("displacement", "B", "dx")
    np.testing.assert_allclose(gap, 0.1, rtol=1e-12)
