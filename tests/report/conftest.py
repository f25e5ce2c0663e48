"""Cases that the report is tried on: the two of the house, and small ones made here."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import pytest

import bumpstop as bs
from bumpstop.post.references import Check, Reference, check_references
from bumpstop.report import write_modes, write_report

CASES = Path(__file__).parents[2] / "cases"


@dataclass(frozen=True)
class Run:
    """A case with what came out of it, and its report once written."""

    case: bs.Case
    responses: dict[str, bs.Response]
    checks: dict[str, list[Check]]

    def write(self, path: Path) -> Path:
        write_report(self.case, self.responses, self.checks, path)
        return path


def run(case: bs.Case, variants: list[str] | None = None, method: str = "exact") -> Run:
    responses = {
        name: bs.simulate(case.problems[name], method=method) for name in variants or case.problems
    }
    checks = {
        name: check_references(response, case.references.get(name, []))
        for name, response in responses.items()
    }
    return Run(case, responses, checks)


def made_case(
    problems: dict[str, bs.Problem],
    references: dict[str, list[Reference]] | None = None,
    title: str = "A case made for a test",
) -> bs.Case:
    return bs.Case(
        name="made",
        title=title,
        description="",
        path=Path("made/case.toml"),
        bases={name: problem.basis for name, problem in problems.items()},
        problems=problems,
        references=references or {},
        methods={},
        method="exact",
        method_options={},
    )


@pytest.fixture(scope="session")
def sdnl32() -> Run:
    return run(bs.load_case(CASES / "sdnl32" / "case.toml"))


@pytest.fixture(scope="session")
def ball() -> Run:
    return run(bs.load_case(CASES / "ball-on-spring" / "case.toml"))


@pytest.fixture(scope="session")
def soft(sdnl32: Run) -> bs.Response:
    return sdnl32.responses["soft"]


@pytest.fixture(scope="session")
def sdnl32_page(sdnl32: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return sdnl32.write(tmp_path_factory.mktemp("sdnl32") / "report.html")


@pytest.fixture(scope="session")
def ball_page(ball: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return ball.write(tmp_path_factory.mktemp("ball") / "report.html")


@pytest.fixture(scope="session")
def portal() -> bs.ModalBasis:
    """A portal frame in space, clamped at its four feet, with a mass on one corner."""
    corners = [(0, 0), (4, 0), (4, 3), (0, 3)]
    steel = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    bar = bs.Tube(outer_radius=0.06, thickness=0.005)
    pairs = [(f"foot{i}", f"top{i}") for i in range(4)]
    pairs += [(f"top{i}", f"top{(i + 1) % 4}") for i in range(4)]
    structure = bs.Structure(
        nodes={f"foot{i}": (x, y, 0) for i, (x, y) in enumerate(corners)}
        | {f"top{i}": (x, y, 3) for i, (x, y) in enumerate(corners)},
        beams=[
            bs.Beam(f"{a}-{b}", nodes=(a, b), elements=4, material=steel, section=bar)
            for a, b in pairs
        ],
        masses=[bs.PointMass("crane", node="top2", mass=300.0)],
        supports=[
            bs.Support(
                nodes=[f"foot{i}" for i in range(4)],
                fixed=("dx", "dy", "dz", "drx", "dry", "drz"),
            )
        ],
    )
    return bs.ModalBasis.from_structure(structure, modes=6)


@pytest.fixture(scope="session")
def portal_page(portal: bs.ModalBasis, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of its modes."""
    path = tmp_path_factory.mktemp("portal") / "modes.html"
    case = replace(made_case({}, title="A portal frame in space"), bases={"base": portal})
    write_modes(case, {}, path)
    return path


@pytest.fixture(scope="session")
def pendulum() -> bs.Problem:
    """Two nodes of a basis without geometry, one of them with a stop that has a damper."""
    basis = bs.ModalBasis.from_modes(
        frequency=[5.0, 13.0],
        damping=0.02,
        shapes={("P", "dx"): [1.0, 0.4], ("Q", "dx"): [0.5, -0.9]},
    )
    stop = bs.Stop("left", node="P", normal=(1, 0, 0), gap=1e-3, stiffness=1e5, damping=20.0)
    start = bs.ModalState(velocity=[0.3, 0.0])
    return bs.Problem(basis, laws=[stop], initial=start, duration=0.5)


@pytest.fixture(scope="session")
def bouncing() -> bs.Response:
    """A ball that bounces some hundred times, tabulated finely."""
    basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("P", "dy"): [1.0]})
    floor = bs.Stop("floor", node="P", normal=(0, 1, 0), gap=1e-3, stiffness=1e6)
    weight = bs.NodalForce("weight", node="P", force=(0, -9.81, 0))
    problem = bs.Problem(basis, laws=[floor], loads=[weight], duration=3.0, sample=1e-4)
    return bs.simulate(problem, method="exact")


@pytest.fixture(scope="session")
def tube() -> Run:
    """A tube that whirls in its hole."""
    case = bs.load_case(CASES / "tube-in-hole" / "case.toml")
    return run(case, ["whirling"], method="dop853")


@pytest.fixture(scope="session")
def tube_page(tube: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tube.write(tmp_path_factory.mktemp("tube") / "report.html")
