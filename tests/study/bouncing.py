"""A ball without weight, thrown at a spring: all is known in closed form."""

from pathlib import Path

CASE = """
title = "A ball thrown at a spring"
[nodes]
P = [0.0, 0.0, 0.0]
[masses.ball]
node = "P"
mass = 2.0
[[supports]]
nodes = ["P"]
fixed = ["dx", "dy", "drx", "dry", "drz"]
[basis]
modes = 1
[stops.spring]
node = "P"
normal = [0, 0, 1]
gap = 0.5
stiffness = 200.0
[initial.translation]
velocity = [0.0, 0.0, -3.0]
[run]
duration = 2.0
"""

STUDY = """
case = "case.toml"
[parameters]
"stops.spring.stiffness" = { from = "50 N/m", to = 800, count = 5, spacing = "log" }
"stops.spring.gap" = [0.25, "50 cm"]
[outputs.force]
quantity = "largest_force"
stop = "spring"
[outputs.start]
quantity = "impact_start"
stop = "spring"
impact = 1
[outputs.place]
quantity = "displacement"
node = "P"
dof = "dz"
times = [0.05, 1.9]
[execution]
chunk = 3
"""

IN_PYTHON = STUDY.replace(
    "[execution]",
    """[outputs.mean]
quantity = "displacement"
node = "P"
dof = "dz"
statistic = "mean"
[execution]""",
)
"""The same with an output that the core does not read, so that processes make the runs."""


def written(folder: Path, study: str = STUDY, case: str = CASE) -> Path:
    """Write case and study into a folder, and return the study's path."""
    (folder / "case.toml").write_text(case)
    path = folder / "study.toml"
    path.write_text(study)
    return path
