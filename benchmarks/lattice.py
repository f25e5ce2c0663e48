"""A storeyed frame of beams in space: the large structure of the benchmarks."""

from itertools import product

import bumpstop as bs

SPACING = (3.0, 3.5, 4.0)
"""Distances of columns and storeys along the axes, in m; unequal, so that no modes are alike."""
DOFS = ("dx", "dy", "dz", "drx", "dry", "drz")


def side_of(dofs: int) -> int:
    """Return how many nodes the frame needs along each axis for about so many free dofs."""
    return next(side for side in range(2, 1000) if 6 * side**2 * (side - 1) >= 0.97 * dofs)


def lattice(dofs: int) -> bs.Structure:
    """Return a frame with about so many free dofs, clamped at its foot."""
    side = side_of(dofs)
    steel = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    bar = bs.Rectangle(height=0.2, width=0.2)
    points = list(product(range(side), repeat=3))
    names = {point: "N" + "_".join(map(str, point)) for point in points}
    beams = []
    for x, y, z in points:
        for end in ((x + 1, y, z), (x, y + 1, z), (x, y, z + 1)):
            if end in names:
                ends = names[x, y, z], names[end]
                name = "-".join(ends)
                beams.append(bs.Beam(name, nodes=ends, elements=1, material=steel, section=bar))
    foot = [names[point] for point in points if point[2] == 0]
    return bs.Structure(
        nodes={
            name: tuple(step * number for step, number in zip(SPACING, point, strict=True))
            for point, name in names.items()
        },
        beams=beams,
        supports=[bs.Support(nodes=foot, fixed=DOFS)],
    )
