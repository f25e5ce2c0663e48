"""How long it takes, and how much memory, to write a long run to disk and to read it back.

A body hammers on a stop; its response is tabulated at 10^8 instants and written block by block,
as Parquet (motion, force and gap) or as NetCDF (everything: modes, states and the energy ledger
too), then read back block by block and held against the response itself at some of its instants.
The file is removed at the end.

``python benchmarks/long_run.py [--samples N] [--form parquet|netcdf] [--folder DIR]``.
"""

import argparse
import resource
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter, process_time

import numpy as np

import bumpstop as bs
from bumpstop.arguments import FloatArray

MOST_MEMORY = 2 * 2**30
"""Bytes that the whole of it may take."""
BLOCK = 1_000_000
"""Instants that are read back at a time."""
DURATION = 1000.0


def hammering(samples: int) -> bs.Response:
    """Return a run of so many instants: a body that a force drives against a stop."""
    basis = bs.ModalBasis.from_modes(frequency=[2.0], damping=0.02, shapes={("P", "dx"): [1.0]})
    stop = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=4e4, damping=20.0)
    shaker = bs.NodalForce("shaker", node="P", force=(30.0, 0, 0), time=bs.Harmonic(3.1, sine=1.0))
    step = DURATION / (samples - 1)
    return bs.simulate(
        bs.Problem(basis, laws=[stop], loads=[shaker], duration=DURATION, sample=step)
    )


def read_parquet(path: Path) -> Iterator[FloatArray]:
    """Yield the forces of a file, block by block."""
    from pyarrow import parquet

    for batch in parquet.ParquetFile(path).iter_batches(BLOCK, columns=["stop_force_wall"]):
        yield batch.column(0).to_numpy()


def read_netcdf(path: Path) -> Iterator[FloatArray]:
    """Yield the forces of a file, block by block."""
    for _, block in bs.read_netcdf(path).blocks(BLOCK):
        yield block.sample("stop_force", "wall")


READERS = {"parquet": read_parquet, "netcdf": read_netcdf}


def compared(response: bs.Response, blocks: Iterator[FloatArray]) -> int:
    """Return how many forces were read; each block begins with the response's own."""
    count = 0
    for forces in blocks:
        own = response.at(response.instants[count : count + 1000]).sample("stop_force", "wall")
        np.testing.assert_array_equal(forces[:1000], own)
        count += len(forces)
    return count


def peak_memory() -> int:
    """Return the most memory that this process has had, in bytes."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak


def main() -> int:
    """Print times and memory; return 1 if there was more of it than 2 GiB."""
    parser = argparse.ArgumentParser(description="Time the writing of a long run.")
    parser.add_argument("--samples", type=int, default=100_000_000)
    parser.add_argument("--form", choices=sorted(READERS), default="parquet")
    parser.add_argument("--folder", type=Path)
    arguments = parser.parse_args()
    response = hammering(arguments.samples)
    with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
        path = Path(folder) / f"run.{arguments.form}"
        start, busy = perf_counter(), process_time()
        response.export(path, arguments.form)
        wall, cpu = perf_counter() - start, process_time() - busy
        size = path.stat().st_size / 1e9
        told = f"written to {size:.2f} GB in {wall:.0f} s ({cpu:.0f} s of processor time)"
        print(f"{len(response.instants):,} instants {told}", flush=True)
        start = perf_counter()
        count = compared(response, READERS[arguments.form](path))
        print(f"{count:,} forces read back in {perf_counter() - start:.0f} s")
    peak = peak_memory()
    print(f"most memory {peak / 2**30:.2f} GiB")
    return int(peak > MOST_MEMORY or count != len(response.instants))


if __name__ == "__main__":
    sys.exit(main())
