"""``[basis]`` of a case file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.modal.damping import RayleighDamping, StructuralDamping

SDNL32 = (Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml").read_text()
ASKED = "modes = 10\ndamping = 0.01              # of critical, in each mode\n"


def load(tmp_path: Path, basis: str) -> bs.Case:
    assert ASKED in SDNL32
    file = tmp_path / "case.toml"
    file.write_text(SDNL32.replace(ASKED, basis))
    return bs.load_case(file)


def basis(tmp_path: Path, text: str) -> bs.ModalBasis:
    problems = load(tmp_path, text).problems
    assert problems["soft"].basis is problems["stiff"].basis
    return problems["soft"].basis


def test_a_static_shape_for_each_stop(tmp_path: Path) -> None:
    found = basis(tmp_path, 'modes = 5\nstatic_shapes = "stops"\ndamping = 0.01\n')
    assert found.labels[5:] == ("static shape of B.dy",)
    named = basis(tmp_path, 'modes = 5\nstatic_shapes = [["B", "dy"]]\ndamping = 0.01\n')
    np.testing.assert_array_equal(found.shapes, named.shapes)
    along = basis(tmp_path, 'modes = 5\nstatic_shapes = [["B", [0, 2, 0]]]\n')
    np.testing.assert_array_equal(found.shapes, along.shapes)


def test_other_companions_and_all_modes(tmp_path: Path) -> None:
    held = 'constraint_shapes = [["AB.5", "dy"], ["B", "dy"]]\n'
    found = basis(tmp_path, f'modes = 4\n{held}base_shapes = ["dy"]\nstatic_damping = 1\n')
    # Both places moving in proportion are the rigid mode: one of the two shapes is enough.
    assert len(found.dropped) == 1
    assert found.labels[4:] == ("constraint shape of AB.5.dy", "base acceleration along dy")
    assert found.damping_ratio.tolist() == [0.0] * 4 + [1.0] * 2
    assert len(basis(tmp_path, 'modes = "all"\n').omega2) == 21


@pytest.mark.parametrize(
    ("modes", "meant"),
    [
        ("{ band = [0, 500] }", bs.ModesInBand(0.0, 500.0)),
        ("{ band = ['80 Hz', '2 kHz'] }", bs.ModesInBand(80.0, 2000.0)),
        ("{ around = '0.4 kHz', count = 3 }", bs.ModesAround(400.0, 3)),
    ],
)
def test_modes_of_a_band_and_around_a_frequency(modes: str, meant: Any, tmp_path: Path) -> None:
    # From rest: a band may hold no mode that turns about the hinge.
    swing = 'rotation = { about = "A", rate = [0.0, 0.0, -3.8] }'
    document = SDNL32.replace(ASKED, f"modes = {modes}\n").replace(swing, "modal = {}")
    file = tmp_path / "case.toml"
    file.write_text(document)
    found = bs.load_case(file).problems["soft"].basis
    structure = found.structure
    assert structure is not None
    asked = bs.ModalBasis.from_structure(structure, modes=meant)
    np.testing.assert_array_equal(found.shapes, asked.shapes)
    assert found.sturm == asked.sturm
    assert 0 < len(found.omega2) < 21


def test_a_variant_changes_the_band(tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    banded = SDNL32.replace(ASKED, "modes = { band = [0, 500] }\n")
    changes = '"basis.modes.band.1" = "1 kHz"\n"stops.spring.stiffness" = '
    file.write_text(banded.replace('"stops.spring.stiffness" = ', changes, 1))
    soft, stiff = (problem.basis for problem in bs.load_case(file).problems.values())
    assert sorted([len(soft.omega2), len(stiff.omega2)]) == [3, 5]


@pytest.mark.parametrize(
    ("damping", "rule"),
    [
        ("{ rayleigh = { alpha = 2.0, beta = '20 us' } }", RayleighDamping(alpha=2.0, beta=2e-5)),
        ("{ rayleigh = { beta = 1e-5 } }", RayleighDamping(beta=1e-5)),
        (
            "{ rayleigh = { frequencies = [80, '400 Hz'], ratios = [0.01, 0.02] } }",
            RayleighDamping.from_ratios(frequencies=[80, 400], ratios=[0.01, 0.02]),
        ),
        ("{ structural = 0.02 }", StructuralDamping(0.02)),
    ],
)
def test_rules_of_damping(damping: str, rule: Any, tmp_path: Path) -> None:
    found = basis(tmp_path, f"modes = 5\ndamping = {damping}\n")
    np.testing.assert_array_equal(found.damping, rule.modal(found.omega2))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('modes = "many"', r'basis.modes: must be a whole number, or "all" \(got .many'),
        ("modes = 0", "basis.modes: must be 1 or more"),
        ("modes = {}", r"basis.modes.around: is missing; give { band ="),
        ("modes = { around = 120 }", "basis.modes.count: is missing"),
        ("modes = { around = 120, count = 0 }", r"basis.modes.count: must be 1 or more \(got 0"),
        ("modes = { around = 120, count = 99 }", r"basis.modes: more modes than free .* \(got 99"),
        ("modes = { around = '5 m', count = 2 }", "basis.modes.around: .*'5 m'"),
        ("modes = { bandd = [0, 5] }", "basis.modes.bandd: unknown key .*'band'"),
        ("modes = { band = [0, 5], count = 3 }", r"basis.modes.count: excludes band \(got 3\)"),
        ("modes = { band = 500 }", r"basis.modes.band: must be a list of 2 frequencies \(got 500"),
        ("modes = { band = [-1, 500] }", r"basis.modes.band.0: must not be negative \(got -1"),
        ("modes = { band = [5, 5] }", r"basis.modes.band: must end above its start \(got \[5, 5"),
        ("modes = { band = [1, 2] }", "basis.modes: there is no mode from 1 Hz to 2 Hz"),
        ("modes = 5\ndamping = -0.01", "basis.damping: must not be negative"),
        ("modes = 5\ndamping = [0.1, -0.1]", "basis.damping.1: must not be negative"),
        ("modes = 5\ndamping = {}", "basis.damping: must have one key"),
        ("modes = 5\ndamping = { raleigh = 1 }", "basis.damping.raleigh: unknown key .*'rayleigh'"),
        ("modes = 5\ndamping = { structural = 'x' }", "basis.damping.structural: "),
        ("modes = 5\ndamping = { rayleigh = 1 }", "basis.damping.rayleigh: must be a table"),
        (
            "modes = 5\ndamping = { rayleigh = { alpha = -1 } }",
            "basis.damping.rayleigh.alpha: must not be negative",
        ),
        (
            "modes = 5\ndamping = { rayleigh = { gamma = 1 } }",
            "basis.damping.rayleigh.gamma: unknown key",
        ),
        (
            "modes = 5\ndamping = { rayleigh = { ratios = [0.1, 0.1] } }",
            "basis.damping.rayleigh.frequencies: is missing",
        ),
        (
            "modes = 5\ndamping = { rayleigh = { frequencies = [1, 2], ratios = [0.01, 0.1] } }",
            "basis.damping.rayleigh.ratios: would make alpha negative",
        ),
        (
            "modes = 5\ndamping = { rayleigh = { frequencies = [1, 2], ratios = [0.1] } }",
            "basis.damping.rayleigh.ratios: must be a list of 2 numbers",
        ),
        ('modes = 5\nstatic_shapes = "all"', "basis.static_shapes: must be a list of places"),
        ('modes = 5\nstatic_shapes = [["B"]]', "basis.static_shapes.0: must be a node and a dof"),
        ('modes = 5\nstatic_shapes = [["B", "y"]]', "basis.static_shapes.0: is not one of"),
        ('modes = 5\nstatic_shapes = [["C", "dy"]]', r"basis.static_shapes.0: unknown node"),
        ('modes = 5\nstatic_shapes = [["A", "dy"]]', "basis.static_shapes.0: nothing can move"),
        ('modes = 5\nbase_shapes = ["y"]', "basis.base_shapes.0: is not one of"),
        ("modes = 5\nstatic_damping = -1", "basis.static_damping: must not be negative"),
        ('modes = 5\ndamping_coupling = "none"', "basis.damping_coupling: is not one of"),
        ("modes = 5\ndamping = [0.1]", "basis.damping: must be one number"),
    ],
)
def test_mistakes(text: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(bs.InputError, match=says):
        load(tmp_path, text + "\n")
