"""Fifty modes of a frame of 100,000 dofs, beside SciPy's ARPACK with SuperLU.

Each solver runs in a process of its own, on the same matrices. Measured are its processor
time, so that other work on the machine does not count, and its peak memory.
``python benchmarks/eigen.py [--dofs N] [--modes N]``.
"""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from time import process_time

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from benchmarks.lattice import lattice
from bumpstop.structure.sparse import SparseMatrix

LARGEST_RATIO = 1.0 / 3.0
AGREEMENT = 1e-8
SOLVERS = ("bumpstop", "scipy")


def save_matrices(dofs: int, folder: Path) -> None:
    """Write K and M of the frame on its free dofs."""
    start = process_time()
    structure = lattice(dofs)
    stiffness, mass = structure.stiffness, structure.mass
    built = process_time()
    np.savez(folder / "k.npz", *structure.reduced(stiffness).arrays)
    np.savez(folder / "m.npz", *structure.reduced(mass).arrays)
    free, entries = len(structure.free), len(stiffness.values)
    print(f"{free} free dofs, {entries} entries in the stiffness matrix")
    print(f"made, checked and assembled in {built - start:.1f} s")


def load(folder: Path) -> list[SparseMatrix]:
    """Read K and M."""
    found = []
    for name in ("k.npz", "m.npz"):
        with np.load(folder / name) as file:
            starts, rows, values = (file[f"arr_{i}"] for i in range(3))
        size = len(starts) - 1
        found.append(SparseMatrix((size, size), starts, rows, values))
    return found


def solve(solver: str, folder: Path, modes: int) -> None:
    """Time one solver in this process, and write what it found."""
    stiffness, mass = load(folder)
    if solver == "bumpstop":
        from bumpstop.modal.coupled import coupled_modes
        from bumpstop.modal.selection import LowestModes

        rigid = np.zeros((mass.shape[0], 0))
        start = process_time()
        omega2 = coupled_modes(stiffness, mass, rigid, LowestModes(modes)).omega2[:modes]
    else:
        from scipy.sparse.linalg import eigsh

        matrices = stiffness.to_scipy(), mass.to_scipy()
        start = process_time()
        omega2 = np.sort(eigsh(matrices[0], modes, matrices[1], sigma=0.0)[0])
    seconds = process_time() - start
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    np.savez(folder / f"{solver}.npz", omega2=omega2, seconds=seconds, memory=memory)


def measure(solver: str, folder: Path, modes: int) -> tuple[np.ndarray, float, float]:
    """Return eigenvalues, seconds and peak memory in GiB of a process with one solver."""
    script = [sys.executable, __file__, "--solve", solver, "--folder", str(folder)]
    alone = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    subprocess.run([*script, "--modes", str(modes)], check=True, env=alone)
    with np.load(folder / f"{solver}.npz") as file:
        return file["omega2"], float(file["seconds"]), float(file["memory"])


def compare(dofs: int, modes: int, solvers: list[str]) -> int:
    """Print the table; return 1 if a target was missed."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        save_matrices(dofs, folder)
        print(f"{'':12}{'time s':>10}{'memory GiB':>12}")
        found = {}
        for solver in solvers:
            found[solver] = measure(solver, folder, modes)
            print(f"{solver:12}{found[solver][1]:10.2f}{found[solver][2]:12.2f}", flush=True)
    if len(found) < len(SOLVERS):
        return 0
    (ours, time, memory), (theirs, their_time, their_memory) = found.values()
    apart = float(np.abs(ours / theirs - 1.0).max())
    checks = {
        f"time ratio {time / their_time:.3f}, at most {LARGEST_RATIO:.3f}": time
        <= LARGEST_RATIO * their_time,
        f"memory ratio {memory / their_memory:.3f}, below 1": memory < their_memory,
        f"eigenvalues agree to {apart:.1e}, at most {AGREEMENT:.0e}": apart <= AGREEMENT,
    }
    for line, good in checks.items():
        print(f"{'PASS' if good else 'MISS'}  {line}")
    return int(not all(checks.values()))


def main() -> int:
    """Read the command line."""
    parser = argparse.ArgumentParser(description="Time the modes of a large frame.")
    parser.add_argument("--dofs", type=int, default=100_000)
    parser.add_argument("--modes", type=int, default=50)
    parser.add_argument("--only", choices=SOLVERS, help="measure one solver alone")
    parser.add_argument("--solve", choices=SOLVERS, help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.solve:
        solve(arguments.solve, arguments.folder, arguments.modes)
        return 0
    solvers = [arguments.only] if arguments.only else list(SOLVERS)
    return compare(arguments.dofs, arguments.modes, solvers)


if __name__ == "__main__":
    sys.exit(main())
