"""Every law once, with numbers that it takes."""

from __future__ import annotations

from typing import Any

import bumpstop as bs

ALONG: dict[str, Any] = {"node": "P", "direction": (1, 0, 0)}
FACING: dict[str, Any] = {"node": "P", "normal": (1, 0, 0)}
SHAFT = bs.ShaftRotation(50.0)
SQUARE = [(0.0, 0.01), (1.5, 0.01), (3.0, 0.01), (4.5, 0.01)]
BREATHING = [(0.0, 1e5), (1.5, 9e4), (3.0, 5e4), (4.5, 8e4)]
RUBBED: dict[str, Any] = {"friction": 0.2, "tangential_stiffness": 1e4, "tangential_damping": 1.0}
SOUND: dict[str, tuple[Any, dict[str, Any]]] = {
    "Stop": (bs.Stop, FACING | RUBBED | {"stiffness": 1e4, "sliding": (0, 1, 0)}),
    "HertzStop": (bs.HertzStop, FACING | {"stiffness": 1e8}),
    "CircleStop": (
        bs.CircleStop,
        {"node": "P", "stiffness": 1e4, "axis": (0, 0, 1), "radius": 1e-3, "centre": (0, 0, 0)}
        | RUBBED,
    ),
    "PlaneStop": (bs.PlaneStop, FACING | RUBBED | {"stiffness": 1e4}),
    "PolarStop": (
        bs.PolarStop,
        {"node": "P", "stiffness": 1e4, "axis": (0, 0, 1), "profile": SQUARE} | RUBBED,
    ),
    "RigidStop": (
        bs.RigidStop, FACING | {"restitution": 0.5, "friction": 0.2, "sliding": (0, 1, 0)}
    ),
    "BucklingStop": (
        bs.BucklingStop,
        FACING
        | {"stiffness": 1e4, "critical_force": 100.0, "post_force": 50.0, "plateau": 1e-3}
        | {"fall": 1e3, "unloading_stiffness": 8e3},
    ),
    "SeismicDevice": (
        bs.SeismicDevice,
        ALONG | {"first_stiffness": 1e5, "second_stiffness": 1e4, "threshold": 10.0},
    ),
    "ZenerDamper": (
        bs.ZenerDamper, ALONG | {"series_stiffness": 1e5, "branch_stiffness": 1e4, "damping": 1e3}
    ),
    "SpringLaw": (bs.SpringLaw, ALONG | {"stiffness": [1e3, 2e3], "breaks": [0.01]}),
    "DamperLaw": (bs.DamperLaw, ALONG | {"damping": [10.0, 20.0], "breaks": [0.1]}),
    "HardeningSpring": (
        bs.HardeningSpring, ALONG | {"curve": [(1e-3, 100.0), (3e-3, 150.0)]}
    ),
    "CrackedRotor": (
        bs.CrackedRotor,
        {"node": "P", "rotation": SHAFT, "stiffness": BREATHING},
    ),
    "UserLaw": (
        bs.UserLaw,
        ALONG | {"force": lambda q, v, _: -100.0 * q - 3.0 * v, "further_directions": [(0, 1, 0)]},
    ),
}  # fmt: skip
