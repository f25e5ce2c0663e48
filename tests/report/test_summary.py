"""What the report says of a model."""

import bumpstop as bs
from bumpstop.report.summary import model_rows


def test_the_model_tells_how_obstacles_move() -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[1.0, 2.0],
        shapes={("P", "dy"): [1.0, 0.0], ("P", "dz"): [0.0, 1.0]},
    )
    wave = bs.Harmonic(5.0, sine=1e-3)
    wall = bs.Stop("wall", node="P", normal=(0, 1, 0), stiffness=1e4, motion=wave)
    ring = bs.CircleStop(
        "ring",
        node="P",
        axis=(1, 0, 0),
        radius=0.01,
        stiffness=1e4,
        motion={"dz": bs.Polynomial([0.0, 0.1])},
        frame="absolute",
    )
    rows = dict(model_rows(bs.Problem(basis, laws=[wall, ring], duration=1.0)))
    assert rows["Stops"][0].endswith("; moves along its normal by 0.001 sin(2π 5 Hz t), in m")
    moves = "; moves along dz by a polynomial of degree 1, in m; stands still on the ground"
    assert rows["Laws"][0].endswith(moves)
