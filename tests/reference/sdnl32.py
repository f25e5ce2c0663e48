"""Modal data and card values of SDNL32, made from the card alone, in 40-digit arithmetic.

The element is integrated here from its shape functions (cubic deflection, quadratic rotation,
constant shear), so nothing is shared with the elements of the package.
"""

from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from mpmath import mp

from .problem import Array, StopProblem

LENGTH, SIDE, YOUNG, DENSITY, SHEAR_FACTOR = "0.783", "0.014", "6.7e10", "2400", (5, 6)
ELEMENTS, MODES, RATE = 10, 10, -3.8
RATIO, DURATION = 0.01, 0.02
TIMES: Array = np.arange(1, 13, dtype=np.float64) * 1e-3

EXACT = {
    18e3: (
        -0.0026630074754697424,
        -0.004335434178442924,
        -0.004952964893569209,
        -0.004782798954063054,
        -0.00382512588955237,
        -0.0028753903293462202,
        -0.0027099607167028715,
        -0.0030877305847437316,
        -0.0034066092932065954,
        -0.003364211840662438,
        -0.0026433186577396912,
        -0.0007442702007923218,
    ),
    45e3: (
        -0.0022501408478655996,
        -0.002657796120160796,
        -0.0019651832717182847,
        -0.0011570312221391701,
        -0.00012291384262992373,
        -0.00036273951615495623,
        -0.002007473268830859,
        -0.002740656054817856,
        -0.0018950775201947362,
        -0.0003538920573262055,
        0.001700341352540431,
        0.00498249244645018,
    ),
}
LOST_CONTACT = {18e3: 0.012302783633707, 45e3: 0.010222552119430}


def timoshenko(length: Any, bending: Any, shear: Any, mass: Any, rotary: Any) -> tuple[Any, Any]:
    """Return stiffness and mass of (v1, r1, v2, r2) by exact integration of shape functions.

    With x in [0, 1] and the ratio a = 12 EI / (GA L^2), the deflection is the cubic and the
    rotation the quadratic that solve the static beam for given ends.
    """
    a = 12 * bending / (shear * length**2)
    b = 1 + a

    def deflection(x: Any) -> list[Any]:
        return [
            (1 - 3 * x**2 + 2 * x**3 + a * (1 - x)) / b,
            length * (x - 2 * x**2 + x**3 + a * (x - x**2) / 2) / b,
            (3 * x**2 - 2 * x**3 + a * x) / b,
            length * (-(x**2) + x**3 - a * (x - x**2) / 2) / b,
        ]

    def rotation(x: Any) -> list[Any]:
        return [
            6 * (x**2 - x) / (b * length),
            (1 - 4 * x + 3 * x**2 + a * (1 - x)) / b,
            6 * (x - x**2) / (b * length),
            (3 * x**2 - 2 * x + a * x) / b,
        ]

    def slope(function: Any, row: int, x: Any) -> Any:
        return mp.diff(lambda y: function(y)[row], x) / length

    points = [(mp.mpf(x) + 1) / 2 for x in gauss_points()]
    stiffness, inertia = mp.zeros(4), mp.zeros(4)
    for x, weight in zip(points, gauss_weights(), strict=True):
        v, r = deflection(x), rotation(x)
        curvature = [slope(rotation, i, x) for i in range(4)]
        angle = [slope(deflection, i, x) - r[i] for i in range(4)]
        for i in range(4):
            for j in range(4):
                stiffness[i, j] += weight * (
                    bending * curvature[i] * curvature[j] + shear * angle[i] * angle[j]
                )
                inertia[i, j] += weight * (mass * v[i] * v[j] + rotary * r[i] * r[j])
    return stiffness * length / 2, inertia * length / 2


@cache
def gauss_points() -> list[Any]:
    """Return the five Gauss-Legendre points on [-1, 1], exact to degree nine."""
    inner, outer = (mp.sqrt(5 + sign * 2 * mp.sqrt(mp.mpf(10) / 7)) / 3 for sign in (-1, 1))
    return [-outer, -inner, mp.mpf(0), inner, outer]


def gauss_weights() -> list[Any]:
    """Return the weights of those points."""
    inner, outer = ((322 + sign * 13 * mp.sqrt(70)) / 900 for sign in (1, -1))
    return [outer, inner, mp.mpf(128) / 225, inner, outer]


def matrices(nodes: tuple[Any, ...]) -> tuple[Any, Any]:
    """Return K and M of the hinged beam over its node abscissae; dofs (r0, v1, r1, v2, ...)."""
    h = mp.mpf(SIDE)
    young, density, area = mp.mpf(YOUNG), mp.mpf(DENSITY), h**2
    inertia, shear = h**4 / 12, young / 2 * area * SHEAR_FACTOR[0] / SHEAR_FACTOR[1]
    size = 2 * len(nodes)
    stiffness, mass = mp.zeros(size), mp.zeros(size)
    for e, (left, right) in enumerate(pairwise(nodes)):
        element = timoshenko(
            right - left, young * inertia, shear, density * area, density * inertia
        )
        for i in range(4):
            for j in range(4):
                stiffness[2 * e + i, 2 * e + j] += element[0][i, j]
                mass[2 * e + i, 2 * e + j] += element[1][i, j]
    return stiffness[1:, 1:], mass[1:, 1:]


def shapes_of(stiffness: Any, mass: Any) -> tuple[Any, Any]:
    """Return ascending omega2 and the shapes of unit modal mass."""
    inverse = mp.inverse(mp.cholesky(mass))
    values, vectors = mp.eigsy(inverse * stiffness * inverse.T)
    return values, inverse.T * vectors


@cache
def modes() -> tuple[Array, Array, Array]:
    """Return omega2 (N,), tip row (N,) and modal velocities (N,) of the clean model, rounded."""
    with mp.workdps(40):
        nodes = tuple(mp.mpf(LENGTH) * i / ELEMENTS for i in range(ELEMENTS + 1))
        stiffness, mass = matrices(nodes)
        values, shapes = shapes_of(stiffness, mass)
        field = mp.matrix([1] + [a for x in nodes[1:] for a in (x, 1)]) * mp.mpf(str(RATE))
        modal = shapes.T * (mass * field)
        tip = shapes.rows - 2
        signs = [1 if shapes[tip, i] > 0 else -1 for i in range(MODES)]
        omega2 = np.array([0.0] + [float(values[i]) for i in range(1, MODES)])
        row = np.array([float(signs[i] * shapes[tip, i]) for i in range(MODES)])
        return omega2, row, np.array([float(signs[i] * modal[i]) for i in range(MODES)])


def clean(stiffness: float = 18e3, ratio: float = RATIO, rate: float = RATE) -> StopProblem:
    """Return the clean model: uniform mesh, ten transverse modes, rigid rotation."""
    omega2, row, velocity = modes()
    return StopProblem(
        omega2=omega2,
        damping=2 * ratio * np.sqrt(omega2),
        row=row,
        stiffness=stiffness,
        duration=DURATION,
        velocity=velocity * (rate / RATE),
    )
