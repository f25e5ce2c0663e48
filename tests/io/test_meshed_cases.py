"""Cases whose nodes and lines come from a mesh."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from bumpstop import InputError, load_case

MESH = """\
COOR_3D
N0 0 0 0  N1 250 0 0  N2 500 0 0  N3 1000 0 0  N4 1000 0 500
FINSF
SEG2
M0 N0 N1  M1 N1 N2  M2 N2 N3  M3 N3 N4
FINSF
GROUP_MA NOM=TUBES
M0 M1 M2
FINSF
GROUP_MA NOM=POST
M3
FINSF
GROUP_MA NOM=ALL
M0 M1 M2 M3
FINSF
GROUP_NO NOM=BASE
N0
FINSF
GROUP_NO NOM=MIDDLE
N1 N2
FINSF
GROUP_NO NOM=TIP
N3
FINSF
FIN
"""
PARTS = """
[materials.steel]
young_modulus = 210e9
poisson_ratio = 0.3
density = 7800.0
[sections.bar]
shape = "rectangle"
height = 0.06
width = 0.025
[[supports]]
nodes = ["BASE"]
fixed = ["dx", "dy", "dz", "drx", "dry", "drz"]
[[supports]]
nodes = ["MIDDLE", "TIP"]
fixed = ["dx", "drx"]
[masses.lump]
node = "TIP"
mass = 2.0
[basis]
modes = 4
[stops.guide]
node = "TIP"
normal = [0, 1, 0]
stiffness = 1e5
[run]
duration = 0.01
"""
CASE = (
    """
[mesh]
file = "frame.mail"
unit = "1 mm"
[mesh.beams.TUBES]
elements = 2
material = "steel"
section = "bar"
"""
    + PARTS
)
BY_HAND = (
    "".join(
        f'[beams.M{i}]\nnodes = ["{a}", "{b}"]\nelements = 2\nmaterial = "steel"\nsection = "bar"\n'
        for i, (a, b) in enumerate([("BASE", "N1"), ("N1", "N2"), ("N2", "TIP")])
    )
    + "[nodes]\nBASE = [0, 0, 0]\nN1 = [0.25, 0, 0]\nN2 = [0.5, 0, 0]\nTIP = [1.0, 0, 0]\n"
    + PARTS.replace('"MIDDLE"', '"N1", "N2"')
)


@pytest.fixture
def case(tmp_path: Path) -> Path:
    (tmp_path / "frame.mail").write_text(MESH)
    return tmp_path / "case.toml"


def test_lines_become_beams(case: Path) -> None:
    case.write_text(CASE)
    meshed = load_case(case).problems["base"].basis
    case.write_text(BY_HAND)
    by_hand = load_case(case).problems["base"].basis
    np.testing.assert_array_equal(meshed.omega2, by_hand.omega2)
    np.testing.assert_array_equal(meshed.row("TIP", "dy"), by_hand.row("TIP", "dy"))
    np.testing.assert_array_equal(meshed.row("M2@0.1", "dy"), by_hand.row("M2@0.1", "dy"))


MISTAKES = {
    CASE.replace("frame.mail", "other.mail"): r"other\.mail: no such file",
    CASE.replace("beams.TUBES", "beams.TUBE"): (
        r"case\.toml: mesh\.beams\.TUBE: unknown group of lines .got 'TUBE'.; did you mean 'TUBES'"
    ),
    CASE.replace('material = "steel"', 'material = "steal"'): (
        r"case\.toml: mesh\.beams\.TUBES\.material: unknown material .got 'steal'."
    ),
    CASE.replace("elements = 2", "elemnts = 2"): r"mesh\.beams\.TUBES\.elemnts: unknown key",
    CASE.replace('["BASE"]', '["BASIS"]'): (
        r"supports\.0\.nodes: unknown node or group .got 'BASIS'.; did you mean 'BASE'"
    ),
    CASE + '[mesh.beams.ALL]\nmaterial = "steel"\nsection = "bar"\n': (
        r"mesh\.beams\.ALL: line M0 is in group 'TUBES' too"
    ),
    CASE + "[nodes]\nA = [0, 0, 0]\n": r"mesh: \[nodes\] and \[mesh\] exclude each other",
    CASE.replace('node = "TIP"\nnormal', 'node = "N4"\nnormal'): r"stops\.guide\.node: unk",
    CASE.replace('unit = "1 mm"', 'unit = "1 kg"'): r"mesh\.unit: ",
}


@pytest.mark.parametrize(("text", "message"), MISTAKES.items(), ids=list(MISTAKES.values()))
def test_mistakes_are_one_line_that_says_where(case: Path, text: str, message: str) -> None:
    case.write_text(text)
    with pytest.raises(InputError, match=message) as refused:
        load_case(case)
    assert "\n" not in str(refused.value)
