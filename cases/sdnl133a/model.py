"""The files of this case, from the figures of its source: run it to write them anew.

Beams of Euler and Bernoulli in one plane stand for both planes of the shaft. Six vectors reduce
each to three, and physical dofs take the place of the vectors' amplitudes: the bend of the crack,
the rotation and the displacement of the tip. That changes the coordinates alone.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.io import mmwrite
from scipy.linalg import block_diag, eigh

HERE = Path(__file__).parent
LENGTH, ELEMENTS, CRACK = 0.2, 20, 10
YOUNG, DENSITY, RADIUS = 210e9, 7800.0, 0.4
AREA, INERTIA = np.pi * RADIUS**2, np.pi * RADIUS**4 / 4
UNIT = YOUNG * INERTIA / 3.2
"""Stiffness in N m/rad that the table of the crack is a multiple of."""
CLOSED = 1e4 * UNIT
RATIO = 0.5

KAPPA = [
    *(200, 199.045, 195.538, 189.592, 181.399, 171.22, 159.372, 146.215, 132.129, 117.501),
    *(103.077, 88.8041, 75.0151, 62.1243, 50.5064, 40.4464, 31.7338, 24.5256, 18.8326, 14.3367),
    *(10.9729, 8.42381, 6.53998, 5.1247, 4.05177, 3.23606, 2.5991, 2.10423, 1.71247, 1.40057),
    *(1.1525, 0.954617, 0.797885, 0.677311, 0.59006, 0.536436, 0.518364),
]
"""Every 5 degrees from 90 to 270 degrees; symmetric about both."""
SLOPE = [
    *(0, -27.8315, -54.9511, -80.5817, -104.009, -124.616, -142.278, -155.456, -165.093),
    *(-169.202, -165.691, -160.767, -153.905, -141.175, -124.746, -107.509, -91.7217, -73.5051),
    *(-58.4082, -44.5887, -33.6506, -24.8546, -18.7978, -13.9022, -10.7342, -8.2513, -6.37881),
    *(-5.05771, -3.96831, -3.18942, -2.54823, -2.00204, -1.57338, -1.1866, -0.805458, -0.41216, 0),
]
"""Its derivative in 1/rad, at the same directions; antisymmetric."""


def assembled(bend: float) -> tuple[np.ndarray, np.ndarray]:
    """Return mass and stiffness in one plane, with a stiffness against the bend of the crack."""
    n, h = 2 * (ELEMENTS + 2), LENGTH
    mass, stiffness = np.zeros((n, n)), np.zeros((n, n))
    m = [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h]]
    m += [[54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]
    k = [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]]
    k += [[-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
    for element in range(ELEMENTS):
        node = element + (element >= CRACK)
        at = np.ix_(*2 * [np.arange(2 * node, 2 * node + 4)])
        mass[at] += DENSITY * AREA * h / 420 * np.array(m)
        stiffness[at] += YOUNG * INERTIA / h**3 * np.array(k)
    for dof, spring in ((0, CLOSED), (1, bend)):
        left, right = 2 * CRACK + dof, 2 * CRACK + 2 + dof
        at = np.ix_([left, right], [left, right])
        stiffness[at] += spring * np.array([[1, -1], [-1, 1]])
    return mass[2:, 2:], stiffness[2:, 2:]


def reduced() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return mass, damping and stiffness of (bend, rotation and displacement of the tip)."""
    mass, hinged = assembled(0.0)
    _, closed = assembled(CLOSED)
    places = LENGTH * np.arange(ELEMENTS + 1)
    places = np.insert(places, CRACK, places[CRACK])[1:]
    right = np.arange(len(places)) >= CRACK
    hinge = np.zeros(len(mass))
    hinge[0::2] = np.where(right, places - LENGTH * CRACK, 0.0)
    hinge[1::2] = right
    omega2, modes = eigh(closed, mass)
    below = np.sqrt(omega2) < 2 * np.pi * 250.0
    vectors = np.column_stack([hinge, modes[:, below]])
    assert vectors.shape[1] == 3
    m, k = (vectors.T @ matrix @ vectors for matrix in (mass, hinged))
    k[0], k[:, 0] = 0.0, 0.0
    rates = np.sqrt(np.diag(k) / np.diag(m))
    damping = np.diag(2 * RATIO * rates) @ m
    # The bend is the rotation of the left node less that of the right one.
    left, tip = 2 * CRACK - 1, len(mass) - 1
    coordinates = np.stack([vectors[left] - vectors[left + 2], vectors[tip], vectors[tip - 1]])
    back = np.linalg.inv(coordinates)
    return back.T @ m @ back, back.T @ damping @ back, back.T @ k @ back


def both_planes(matrix: np.ndarray) -> np.ndarray:
    """Return a matrix of (bend, slope, deflection) in the planes xz and xy; dry = -dw/dx."""
    signs = np.diag([-1.0, -1.0, 1.0])
    return block_diag(signs @ matrix @ signs, matrix)


def crack() -> np.ndarray:
    """Return direction in rad, stiffness and its derivative every degree, by the splines."""
    degrees = np.arange(90.0, 451.0, 5.0)
    kappa = np.array([*KAPPA, *KAPPA[-2::-1]])
    slope = np.array([*SLOPE, *(-value for value in SLOPE[-2::-1])])
    logarithm = CubicSpline(np.radians(degrees), np.log(kappa), bc_type="periodic")
    derivative = CubicSpline(np.radians(degrees), slope, bc_type="periodic")
    fine = np.radians(np.arange(90.0, 450.0))
    return np.stack([fine, UNIT * np.exp(logarithm(fine)), UNIT * derivative(fine)], axis=1)


def main() -> None:
    """Write all files."""
    mass, damping, stiffness = map(both_planes, reduced())
    mass, stiffness = (0.5 * (matrix + matrix.T) for matrix in (mass, stiffness))
    halves = (0.5 * (damping + damping.T), 0.5 * (damping - damping.T))
    files = {"mass": mass, "stiffness": stiffness, "damping": halves[0], "skew": halves[1]}
    for name, matrix in files.items():
        kind = "skew-symmetric" if name == "skew" else "symmetric"
        mmwrite(HERE / f"{name}.mtx", matrix, precision=17, symmetry=kind)
    rows = ["node,dof,x,y,z,fixed"]
    rows += ["C,dry,2,0,0,0\ntip,dry,4,0,0,0\ntip,dz,4,0,0,0"]
    rows += ["C,drz,2,0,0,0\ntip,drz,4,0,0,0\ntip,dy,4,0,0,0"]
    (HERE / "dofs.csv").write_text("\n".join(rows) + "\n")
    header = "direction in rad, stiffness in N m/rad, its derivative in N m/rad2"
    np.savetxt(HERE / "crack.csv", crack(), fmt="%.17g", delimiter=", ", header=header)


if __name__ == "__main__":
    main()
