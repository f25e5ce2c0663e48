"""How long a frame takes from its parts to sparse matrices, beside SciPy's sorting of triplets.

The frame is a lattice of beams along X, Y and Z, of one element each, whose nodes are shifted
at random, so that no two beams are alike. It is built as a user would. Measured is processor
time of this one thread, so that other work on the machine does not count. The yardstick is
``scipy.sparse`` turning the triplets of one matrix, given for free, into compressed columns.

The column Structure is all that ``bumpstop.Structure`` does: checks, both matrices, what can
move. Memory is the most that was taken so far, the yardstick's included.

``python benchmarks/assembly.py [--largest DOFS]``.
"""

import argparse
import resource
import sys
from collections.abc import Callable
from time import process_time
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array

import bumpstop as bs
from bumpstop.structure.assembly import Assembler
from bumpstop.structure.beam_blocks import beam_blocks

SIDES = (7, 12, 18, 26, 38, 55)
"""Nodes along a side of the lattice; 26 make 105,456 dofs, 55 make 998,250."""

TARGET_SIDE = 26
LARGEST_SECONDS = 1.0
"""Most processor time for both matrices of the lattice of 105,456 dofs."""

REPEATED = 5

T = TypeVar("T")


def lattice(side: int) -> tuple[dict[str, list[float]], list[bs.Beam]]:
    """Return nodes and beams of a cubic lattice whose nodes are shifted at random."""
    corners = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    shifts = np.random.default_rng(1).uniform(-0.2, 0.2, corners.shape)
    nodes = {f"n{i}": place for i, place in enumerate((corners + shifts).tolist())}
    steel = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7850.0)
    tube = bs.Tube(outer_radius=0.02, thickness=0.002)
    number = np.arange(side**3).reshape(side, side, side)
    pairs = np.concatenate(
        [
            np.stack([number[:-1], number[1:]], axis=-1).reshape(-1, 2),
            np.stack([number[:, :-1], number[:, 1:]], axis=-1).reshape(-1, 2),
            np.stack([number[:, :, :-1], number[:, :, 1:]], axis=-1).reshape(-1, 2),
        ]
    )
    beams = [
        bs.Beam(f"b{i}", nodes=(f"n{a}", f"n{b}"), elements=1, material=steel, section=tube)
        for i, (a, b) in enumerate(pairs.tolist())
    ]
    return nodes, beams


def seconds(work: Callable[[], T], times: int) -> tuple[float, T]:
    """Return the least processor time of some runs, and what the last one returned."""
    least = float("inf")
    for _ in range(times):
        start = process_time()
        result = work()
        least = min(least, process_time() - start)
    return least, result


def triplets(
    structure: bs.Structure,
) -> tuple[NDArray[np.float64], tuple[NDArray[np.int32], NDArray[np.int32]]]:
    """Return the stiffness matrix element by element, as a program with SciPy would have it."""
    parts = beam_blocks(structure.beams, structure.mesh)
    dofs = np.concatenate([structure.mesh.dofs_of(part.nodes).reshape(-1, 12) for part in parts])
    values = np.concatenate([part.matrix("stiffness").ravel() for part in parts])
    rows, columns = np.repeat(dofs, 12, axis=1), np.tile(dofs, (1, 12))
    return values, (rows.ravel().astype(np.int32), columns.ravel().astype(np.int32))


def matrices(structure: bs.Structure) -> None:
    """Assemble stiffness and mass from the beams, once more."""
    parts = beam_blocks(structure.beams, structure.mesh)
    assembly = Assembler(parts, len(structure.mesh.names))
    assembly.matrix("stiffness")
    assembly.matrix("mass")


def main() -> int:
    """Print the table; return 1 if the target was missed."""
    parser = argparse.ArgumentParser(description="Time the assembly of frames.")
    parser.add_argument("--largest", type=float, default=1e6, help="most dofs")
    largest = parser.parse_args().largest
    print("Processor seconds; the yardstick sorts one matrix, we compute and add up two.")
    print(
        f"{'dofs':>9}{'beams':>9}{'SciPy':>9}{'K and M':>9}{'ratio':>7}{'Structure':>11}{'MB':>7}"
    )
    missed = False
    for side in SIDES:
        if 6 * side**3 > largest:
            break
        nodes, beams = lattice(side)
        runs = REPEATED if side < 40 else 1
        whole, structure = seconds(lambda: bs.Structure(nodes=nodes, beams=beams), runs)  # noqa: B023
        assembling, _ = seconds(lambda: matrices(structure), runs)  # noqa: B023
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        values, places = triplets(structure)
        shape = (6 * side**3, 6 * side**3)
        sorting, _ = seconds(lambda: coo_array((values, places), shape=shape).tocsc(), runs)  # noqa: B023
        slow = side == TARGET_SIDE and assembling > LARGEST_SECONDS
        missed = missed or slow
        print(
            f"{shape[0]:9}{len(beams):9}{sorting:9.3f}{assembling:9.3f}{assembling / sorting:7.2f}"
            f"{whole:11.3f}{memory:7.0f}{'  MISS' if slow else ''}"
        )
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
