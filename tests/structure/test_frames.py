"""Portals and trusses against the method of forces, and in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from bumpstop import (
    Beam,
    Gauge,
    InputError,
    Material,
    ModalBasis,
    Rectangle,
    Structure,
    Support,
    Tube,
)
from bumpstop.structure.dofs import DOFS

Array = NDArray[np.float64]
STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = Rectangle(height=0.02, width=0.03)
PLANE = ("dx", "dz", "dry")


def loaded(
    structure: Structure, forces: dict[tuple[str, str], float]
) -> dict[tuple[str, str], float]:
    """Static displacements by node and dof."""
    load = np.zeros(len(structure.dofs))
    for dof, force in forces.items():
        load[structure.dofs.index(dof)] = force
    stiffness = structure.reduced(structure.stiffness).to_dense()
    reduced = structure.expansion.to_dense().T @ load
    moved = np.array(np.linalg.solve(stiffness, reduced), dtype=np.float64)
    motion = structure.expansion @ moved
    return dict(zip(structure.dofs, motion.tolist(), strict=True))


class Portal:
    """A clamped portal A-B-C-D in the plane X-Z, solved by the method of forces.

    Without the clamp at D it is statically determinate; the clamp's force and moment close
    the gap there. Products of linear functions are integrated by Simpson's rule, exactly.
    """

    points = (np.array([0, 0]), np.array([0, 1.0]), np.array([1.4, 1.2]), np.array([1.4, 0]))

    def _cuts(self) -> list[tuple[Array, float, Array]]:
        """Places along the members, their weights in Simpson's rule, and directions."""
        cuts = []
        for start, end in zip(self.points, self.points[1:], strict=False):
            length = float(np.linalg.norm(end - start))
            for part, weight in ((0.0, 1 / 6), (0.5, 4 / 6), (1.0, 1 / 6)):
                cuts.append((start + part * (end - start), weight * length, (end - start) / length))
        return cuts

    def _inner(self, at: int, force: tuple[float, float], moment: float) -> list[Array]:
        """Normal force, shear force and moment by a force and moment at one of the points."""
        rows = []
        for number, (place, _, along) in enumerate(self._cuts()):
            if number // 3 >= at:  # beyond the point nothing is loaded
                rows.append(np.zeros(3))
                continue
            arm = self.points[at] - place
            bending = moment + arm[1] * force[0] - arm[0] * force[1]  # about Y
            across = np.array([-along[1], along[0]])
            rows.append(np.array([along @ force, across @ force, bending]))
        return rows

    def sway(self, push: float) -> float:
        """Displacement of B along X by a force there."""
        factor = BAR.shear_factors[1] * STEEL.shear_modulus * BAR.area
        stiff = np.array(
            [STEEL.young_modulus * BAR.area, factor, STEEL.young_modulus * BAR.inertia_y]
        )
        cases = [
            self._inner(1, (1.0, 0.0), 0.0),
            self._inner(3, (1.0, 0.0), 0.0),
            self._inner(3, (0.0, 1.0), 0.0),
            self._inner(3, (0.0, 0.0), 1.0),
        ]
        weights = [weight for _, weight, _ in self._cuts()]
        flexibility = np.array(
            [
                [
                    sum(w * a @ (b / stiff) for w, a, b in zip(weights, one, two, strict=True))
                    for one in cases
                ]
                for two in cases
            ]
        )
        clamp = np.linalg.solve(flexibility[1:, 1:], -flexibility[1:, 0] * push)
        return float(flexibility[0, 0] * push + flexibility[0, 1:] @ clamp)


@pytest.mark.parametrize("elements", [1, 3])
def test_a_portal_sways_as_by_the_method_of_forces(elements: int) -> None:
    nodes = {
        name: (float(x), 0.0, float(z)) for name, (x, z) in zip("ABCD", Portal.points, strict=True)
    }
    beams = [
        Beam(name, nodes=tuple(name), elements=elements, material=STEEL, section=BAR)
        for name in ("AB", "BC", "CD")
    ]
    frame = Structure(
        nodes=nodes,
        beams=beams,
        supports=[
            Support(nodes=("A", "D"), fixed=PLANE),
            Support(nodes="all", fixed=("dy", "drx", "drz")),
        ],
    )
    # Local z of an upright column is -X: bending in the plane is about local y everywhere.
    sway = loaded(frame, {("B", "dx"): 500.0})["B", "dx"]
    assert sway == pytest.approx(Portal().sway(500.0), rel=1e-11)


def test_two_bars_under_a_load() -> None:
    """Bars at 60 degrees sink by P L / (2 E A sin2)."""
    angle = math.radians(60)
    nodes = {
        "A": (0.0, 0.0, 0.0),
        "B": (2 * math.cos(angle), 0.0, 0.0),
        "C": (math.cos(angle), 0.0, -math.sin(angle)),
    }
    bars = [
        Beam(n, nodes=(n, "C"), elements=1, material=STEEL, section=BAR, theory="bar") for n in "AB"
    ]
    truss = Structure(
        nodes=nodes,
        beams=bars,
        supports=[
            Support(nodes=("A", "B"), fixed=("dx", "dy", "dz")),
            Support(nodes="C", fixed="dy"),
        ],
    )
    assert [truss.dofs[dof] for dof in truss.free] == [("C", "dx"), ("C", "dz")]
    sunk = loaded(truss, {("C", "dz"): -1e4})["C", "dz"]
    expected = 1e4 / (2 * STEEL.young_modulus * BAR.area * math.sin(angle) ** 2)
    assert sunk == pytest.approx(-expected, rel=1e-13)


def test_a_free_truss_has_six_rigid_motions_and_no_rotations_of_nodes() -> None:
    corners = {"A": (0, 0, 0), "B": (1, 0.1, 0), "C": (0.3, 0.9, 0), "D": (0.4, 0.3, 0.8)}
    edges = [a + b for i, a in enumerate(corners) for b in list(corners)[i + 1 :]]
    truss = Structure(
        nodes=corners,
        beams=[
            Beam(edge, nodes=tuple(edge), elements=1, material=STEEL, section=BAR, theory="bar")
            for edge in edges
        ],
    )
    assert len(truss.free) == 12
    basis = ModalBasis.from_structure(truss, modes=12)
    np.testing.assert_array_equal(basis.omega2[:6], 0.0)
    assert basis.omega2[6] > 1e4


def test_a_bar_moves_evenly_between_its_nodes() -> None:
    truss = Structure(
        nodes={"A": (0, 0, 0), "B": (0, 2.0, 0)},
        beams=[Beam("AB", nodes=("A", "B"), elements=1, material=STEEL, section=BAR, theory="bar")],
    )
    field = np.zeros(12)
    field[[1, 7, 6, 8]] = 1e-3, 3e-3, 4e-3, -6e-3
    read = {dof: truss.displacement_form("AB@0.5", dof).of(field) for dof in DOFS}
    assert read == pytest.approx(
        {"dx": 1e-3, "dy": 1.5e-3, "dz": -1.5e-3, "drx": -3e-3, "dry": 0.0, "drz": -2e-3}
    )
    gauge = Gauge("g", beam="AB", at=0.3, fibre=(0.01, 0.0))
    assert truss.strain_form(gauge).of(field) == pytest.approx(1e-3)


def test_a_gauge_sits_on_the_wall_of_a_tube() -> None:
    tube = Beam(
        "AB",
        nodes=("A", "B"),
        elements=1,
        material=STEEL,
        section=Tube(outer_radius=0.02, thickness=0.002),
        theory="euler_bernoulli",
    )
    structure = Structure(nodes={"A": (0, 0, 0), "B": (1, 0, 0)}, beams=[tube])
    structure.strain_form(Gauge("g", beam="AB", at=0.3, fibre=(0.0, 0.02)))
    with pytest.raises(InputError, match="fibre: is outside the section"):
        structure.strain_form(Gauge("g", beam="AB", at=0.3, fibre=(0.0, 0.017)))


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ({"mass": "lump"}, "mass: unknown mass"),
        ({"roll": math.nan}, "roll: must be finite"),
        ({"tension": "1 kN"}, "tension: must be a number"),
        ({"added_mass": -1.0}, "added_mass: must not be negative"),
        ({"spin": 10.0}, "spin: a beam that spins must be as stiff about y as about z"),
        ({"spin": 10.0, "theory": "euler_bernoulli"}, "theory: a beam that spins needs rotary"),
        ({"spin": 10.0, "theory": "bar"}, "theory: a beam that spins needs rotary inertia"),
    ],
)
def test_bad_beams_are_refused(said: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=f"^{message}"):
        Beam("AB", nodes=("A", "B"), elements=1, material=STEEL, section=BAR, **said)  # type: ignore[arg-type]


def test_numbers_too_large_to_compute_with_name_their_beam() -> None:
    beams = [
        Beam(f"b{i}", nodes=("A", node), elements=1, material=STEEL, section=BAR)
        for i, node in enumerate("BC")
    ]
    with pytest.raises(InputError, match=r"beams\.b1: its numbers are too large or too small"):
        Structure(nodes={"A": (0, 0, 0), "B": (1, 0, 0), "C": (1e-120, 0, 0)}, beams=beams)
