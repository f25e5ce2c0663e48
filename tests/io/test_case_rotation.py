"""Shafts that turn, in case files."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs

ROTOR = """
[nodes]
D = [0, 0, 0]
[masses.D]
node = "D"
mass = 2.0
[springs.D]
node = "D"
stiffness = [0, 800, 800, 0, 0, 0]
[[supports]]
nodes = ["D"]
fixed = ["dx", "drx", "dry", "drz"]
[basis]
modes = 2
[run]
duration = 1.0
"""
SHAFT = """
[nodes]
D = [0, 0, 0]
[masses.D]
node = "D"
mass = 2.0
inertia = [0.1, 0.1, 0.1]
[[supports]]
nodes = ["D"]
fixed = ["dx", "dy", "dz", "drx"]
[basis]
modes = 2
rigid_modes = 2
[run]
duration = 1.0
[rotation]
speed = "60 rpm"
"""
CRACK = '[laws.crack]\ntype = "cracked_rotor"\nnode = "D"\n'


def test_a_run_up_with_an_unbalance(load: Callable[[str], bs.Case]) -> None:
    text = "[rotation]\npolynomial = [1.0, 20.0]\ninitial_angle = 0.5\nspin = 2.0\n"
    text += '[loads.u]\ntype = "unbalance"\nnode = "D"\nmass = "2 kg"\neccentricity = "1 mm"\n'
    problem = load(ROTOR + text).problems["base"]
    assert isinstance(problem.rotation, bs.ShaftRotation)
    assert problem.rotation.speed_at([1.0])[0] == 21.0
    assert problem.rotation.spin == 2.0
    (unbalance,) = problem.loads
    assert isinstance(unbalance, bs.Unbalance)
    assert unbalance.moment == pytest.approx(2e-3)
    assert unbalance.rotation.angle_at([0.0])[0] == 0.5
    assert bs.simulate(problem).method == "dop853"


def test_a_table_of_speeds(load: Callable[[str], bs.Case]) -> None:
    text = "[rotation]\ntable = { times = [0, 0.4, 1], values = [0, 8, 8] }\n"
    rotation = load(ROTOR + text).problems["base"].rotation
    assert rotation is not None
    assert rotation.speed_at([0.2, 0.7]) == pytest.approx([4.0, 8.0])


def test_a_crack_by_a_formula_by_points_and_by_a_file(
    load: Callable[[str], bs.Case], tmp_path: Path
) -> None:
    angles = 2.0 * np.pi * np.arange(24) / 24
    rows = np.stack([angles, 20 + np.sin(angles), np.cos(angles)], axis=1)
    np.savetxt(tmp_path / "crack.csv", rows, delimiter=",", header="phi, K, K'")
    points = ", ".join(f"[{phi!r}, {k!r}]" for phi, k in rows[:, :2].tolist())
    texts = [
        'stiffness = "20 + sin(phi)"\n',
        f"points = [{points}]\n",
        'file = "crack.csv"\n',
    ]
    for text in texts:
        problem = load(SHAFT + CRACK + text).problems["base"]
        (law,) = problem.laws
        assert isinstance(law, bs.CrackedRotor)
        assert law.rotation.constant_speed == pytest.approx(2.0 * np.pi)
        assert law.stiffness_at([1.0])[0] == pytest.approx(20 + np.sin(1.0), abs=1e-5)
        assert law.derivative_at([1.0])[0] == pytest.approx(np.cos(1.0), abs=1e-3)
        assert bs.simulate(problem).energy_residual < 1e-6


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[rotation]\n", "one of speed, polynomial and table"),
        ("[rotation]\nspeed = 1.0\npolynomial = [1.0]\n", "speed, polynomial"),
        ("[rotation]\nspeed = 1.0\nspin = 0.0\n", "rotation.spin: must not be zero"),
        ('[rotation]\nspeed = "3 m"\n', "rotation.speed"),
        ("[rotation]\ntable = { times = [0, 0.5], values = [0, 1] }\n", "cover the run"),
        ('[loads.u]\ntype = "unbalance"\nnode = "D"\nmoment = 1\n', "needs the rotation"),
        (
            '[rotation]\nspeed = 1\n[loads.u]\ntype = "unbalance"\nnode = "D"\nmass = 1\n',
            "loads.u.eccentricity: is missing",
        ),
        (CRACK + 'stiffness = "20"\n', "laws.crack: needs the rotation"),
    ],
)
def test_bad_rotations_are_refused(refused: Callable[[str], str], text: str, message: str) -> None:
    assert message in refused(ROTOR + text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "one of stiffness, points and file"),
        ('stiffness = "20 + phi"\n', "laws.crack.stiffness: must be the same after a full turn"),
        ("points = [[0, 1], [1, 2, 3], [2, 1], [3, 1]]\n", "laws.crack.points"),
        ("points = [[0, 1], [1, 2], [2, 1], [3]]\n", "laws.crack.points"),
        ('file = "none.csv"\n', "no such file"),
        ('file = "bad.csv"\n', "line 2"),
    ],
)
def test_bad_cracks_are_refused(
    refused: Callable[[str], str], tmp_path: Path, text: str, message: str
) -> None:
    (tmp_path / "bad.csv").write_text("0, 1\n1, two\n")
    assert message in refused(SHAFT + CRACK + text)
