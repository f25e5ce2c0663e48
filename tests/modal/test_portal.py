"""A portal frame of Euler-Bernoulli beams against its transcendental frequency equation.

The dynamic stiffness of a member is made here from the solutions of its differential equations,
EI v'''' = m w2 v and EA u'' = -m w2 u. Modes of one bay with equal columns are symmetric or sway to
one side, and half the frame tells both. The number of frequencies below a trial value follows from
the signs of the stiffness and from those of the members with clamped ends (W. H. Wittrick,
F. W. Williams, A general algorithm for computing natural frequencies of elastic structures,
Quarterly Journal of Mechanics and Applied Mathematics 24 (1971) 263-284), so that bisection finds
each frequency and misses none.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from bumpstop import Beam, GeneralSection, Material, ModalBasis, Relation, Structure, Support

Array = NDArray[np.float64]
STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
HEIGHT, SPAN = 2.0, 3.0
TUBE = GeneralSection(area=4e-3, inertia_y=5e-6, inertia_z=5e-6, torsion_constant=1e-5)
BENDING = STEEL.young_modulus * TUBE.inertia_z
STRETCH = STEEL.young_modulus * TUBE.area
LINE = STEEL.density * TUBE.area


class Member(NamedTuple):
    """A member at one frequency: motions at its ends are along it, across it, and rotation."""

    length: float
    omega: float
    stretches: bool

    def stiffness(self) -> Array:
        """Forces at the ends by their motions, (6, 6); along it only if it stretches."""
        matrix = np.zeros((6, 6))
        matrix[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = self._bending()
        if self.stretches:
            matrix[np.ix_([0, 3], [0, 3])] = self._stretching()
        return matrix

    @property
    def bends(self) -> float:
        """The wave number of bending times the length."""
        return math.sqrt(self.omega * math.sqrt(LINE / BENDING)) * self.length

    @property
    def runs(self) -> float:
        """The wave number of stretching times the length."""
        return self.omega * math.sqrt(LINE / STRETCH) * self.length

    def _bending(self) -> Array:
        def derivatives(x: float) -> Array:
            """Of the four solutions, the value and three derivatives by x / length."""
            y = self.bends
            c, s, ch, sh = math.cos(y * x), math.sin(y * x), math.cosh(y * x), math.sinh(y * x)
            rows = [[c, s, ch, sh], [-s, c, sh, ch], [-c, -s, ch, sh], [s, -c, sh, ch]]
            return np.array([[y**order * value for value in row] for order, row in enumerate(rows)])

        first, last = derivatives(0.0), derivatives(1.0)
        motions = np.array([first[0], first[1] / self.length, last[0], last[1] / self.length])
        shear, moment = BENDING / self.length**3, BENDING / self.length**2
        forces = [shear * first[3], -moment * first[2], -shear * last[3], moment * last[2]]
        return np.array(np.linalg.solve(motions.T, np.array(forces).T).T)

    def _stretching(self) -> Array:
        z = self.runs
        factor = STRETCH / self.length * z / math.sin(z)
        return factor * np.array([[math.cos(z), -1.0], [-1.0, math.cos(z)]])

    def clamped_frequencies_below(self) -> int:
        """Count its own frequencies with clamped ends below the one at hand."""
        waves = int(self.bends // math.pi)
        sign = math.copysign(1.0, 1.0 - math.cos(self.bends) * math.cosh(self.bends))
        bending = waves - (1 - (-1) ** waves * sign) / 2
        return int(bending) + (int(self.runs // math.pi) if self.stretches else 0)


def count_below(omega: float, *, clamped: bool, sways: bool, stretches: bool) -> int:
    """Count the frequencies of half the frame: foot A, corner B and M, the middle of the beam."""
    column, beam = Member(HEIGHT, omega, stretches), Member(SPAN / 2.0, omega, stretches)
    # Motions dx, dy, rz of A, B and M. Along the column is dy, across it -dx.
    turn = np.kron(np.eye(2), [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    whole = np.zeros((9, 9))
    whole[:6, :6] += turn.T @ column.stiffness() @ turn
    whole[3:, 3:] += beam.stiffness()
    held = {0, 1} | ({2} if clamped else set()) | ({7} if sways else {6, 8})
    if not stretches:
        whole[3, 3] -= LINE * SPAN / 2.0 * omega**2  # the beam goes along with its corner
        held |= {4, 6} | (set() if sways else {3})
    free = [dof for dof in range(9) if dof not in held]
    negative = np.count_nonzero(np.linalg.eigvalsh(whole[np.ix_(free, free)]) < 0.0)
    members = column.clamped_frequencies_below() + beam.clamped_frequencies_below()
    return int(negative) + members


def exact(count: int, **frame: bool) -> list[float]:
    """The lowest frequencies of half the frame, in rad/s."""
    found = []
    for number in range(1, count + 1):
        low, high = 1.0, 2.0
        while count_below(high, **frame) < number:
            high *= 2.0
        while high - low > 1e-13 * high:
            middle = 0.5 * (low + high)
            below = count_below(middle, **frame) >= number
            low, high = (low, middle) if below else (middle, high)
        found.append(high)
    return found


def portal(elements: int, *, clamped: bool, stretches: bool) -> Structure:
    said: dict[str, Any] = {"elements": elements, "theory": "euler_bernoulli"}
    beams = [
        Beam(name, nodes=tuple(name), material=STEEL, section=TUBE, **said)
        for name in ("AB", "BC", "CD")
    ]
    foot = ("dx", "dy", "drz") if clamped else ("dx", "dy")
    supports = [
        Support(nodes="all", fixed=("dz", "drx", "dry")),
        Support(nodes=("A", "D"), fixed=foot),
    ]
    relations = []
    if not stretches:
        inside = range(1, elements)
        columns = ["B", "C", *(f"{column}.{i}" for column in ("AB", "CD") for i in inside)]
        supports.append(Support(nodes=columns, fixed="dy"))
        along = ["C", *(f"BC.{i}" for i in inside)]
        relations = [Relation({(node, "dx"): 1.0, ("B", "dx"): -1.0}) for node in along]
    return Structure(
        nodes={"A": (0, 0, 0), "B": (0, HEIGHT, 0), "C": (SPAN, HEIGHT, 0), "D": (SPAN, 0, 0)},
        beams=beams,
        supports=supports,
        relations=relations,
    )


def computed(elements: int, *, clamped: bool, stretches: bool) -> tuple[Array, list[bool]]:
    """The six lowest frequencies in rad/s, and whether each sways."""
    frame = portal(elements, clamped=clamped, stretches=stretches)
    basis = ModalBasis.from_structure(frame, modes=6)
    turns = zip(basis.row("B", "drz"), basis.row("C", "drz"), strict=True)
    return np.sqrt(basis.omega2), [left * right > 0.0 for left, right in turns]


def in_order(*, clamped: bool, stretches: bool) -> tuple[list[float], list[bool]]:
    """The same from the frequency equation."""
    both = [
        (omega, sways)
        for sways in (True, False)
        for omega in exact(6, clamped=clamped, sways=sways, stretches=stretches)
    ]
    lowest = sorted(both)[:6]
    return [omega for omega, _ in lowest], [sways for _, sways in lowest]


@pytest.mark.parametrize("stretches", [False, True])
@pytest.mark.parametrize("clamped", [True, False])
def test_frequencies_of_a_portal(clamped: bool, stretches: bool) -> None:
    omega, sways = in_order(clamped=clamped, stretches=stretches)
    found, swaying = computed(64, clamped=clamped, stretches=stretches)
    np.testing.assert_allclose(found, omega, rtol=1e-6)
    assert swaying == sways
    assert sways[:2] == [True, False]


@pytest.mark.parametrize("clamped", [True, False])
def test_they_converge_from_above_at_the_order_of_cubic_deflections(clamped: bool) -> None:
    limit = np.array(in_order(clamped=clamped, stretches=False)[0])
    meshes = (4, 8, 16)
    errors = np.array(
        [computed(n, clamped=clamped, stretches=False)[0] / limit - 1.0 for n in meshes]
    )
    assert np.all(errors > 0.0)
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:])[-1], 4.0, atol=0.1)
