"""What a study costs on a dask scheduler: scaling, and the work of scheduler, client and store.

``python benchmarks/cluster.py [RUNS]``; runs of SDNL32 whose duration varies, too, so that each is
made by way of Python, as most are on a cluster. Costs are processor time, which a busy machine
does not change; the last lines say what they are for 1,000 cores.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from distributed import LocalCluster

import bumpstop as bs
from bumpstop.study.evaluation import Evaluator
from bumpstop.study.pool import usable_cores

CASE = Path(__file__).parents[1] / "cases" / "sdnl32" / "case.toml"
CORES = 1000
SCALING = 0.75
"""Of all cores of this machine: scheduler, client and store work on them, too."""
BUSY = 0.95


def study(runs: int, chunk: int) -> bs.Study:
    """Return a study of so many runs, 12 numbers of each."""
    draws = np.random.default_rng(1)
    return bs.Study(
        bs.load_case(CASE),
        {
            "stops.spring.stiffness": draws.uniform(1e4, 1e6, runs).tolist(),
            "run.duration": draws.uniform(0.019, 0.02, runs).tolist(),
        },
        {
            "tip": bs.Output(
                quantity="displacement",
                node="B",
                dof="dy",
                times=(np.arange(1, 12) * 1e-3).tolist(),
            ),
            "force": bs.Output(quantity="largest_force", stop="spring"),
        },
        sampling=bs.Sampling("list"),
        variant="stiff",
        chunk=chunk,
    )


def rate(many: bs.Study, scheduler: LocalCluster | None) -> float:
    """Return runs a second by the clock."""
    started = time.perf_counter()
    many.run(scheduler=scheduler, workers=1)
    return many.runs.count / (time.perf_counter() - started)


def cost_of_a_run(many: bs.Study) -> float:
    """Return the processor time of a run in seconds."""
    evaluator, task = Evaluator(many.recipe), many.task(0)
    evaluator.kept(task.columns)
    started = time.process_time()
    evaluator.kept(task.columns)
    return (time.process_time() - started) / many.layout.chunk


def cost_of_a_task(scheduler: LocalCluster) -> float:
    """Return the processor time of client and scheduler, which live here, for a task."""
    small = study(1000, 1)
    started = time.process_time()
    small.run(scheduler=scheduler)
    return (time.process_time() - started) / small.layout.chunks


def cost_of_a_write(chunk: int) -> float:
    """Return the processor time that the store takes for a chunk."""
    many = study(20 * chunk, chunk)
    columns = many.layout.columns(many.task(0).columns)
    # The same numbers everywhere: writing does not ask what they are.
    kept = Evaluator(many.recipe).kept(many.task(0).columns)
    with TemporaryDirectory() as folder:
        store = many.opened(Path(folder) / "s.zarr", resume=False)
        started = time.process_time()
        for number in range(many.layout.chunks):
            store.write(number, columns, kept)
        return (time.process_time() - started) / many.layout.chunks


def scaled(many: bs.Study) -> tuple[dict[int, float], float]:
    """Return runs a second by the number of workers here, and the cost of a task in seconds."""
    rates = {}
    for workers in sorted({1, usable_cores()}):
        with LocalCluster(
            n_workers=workers, threads_per_worker=1, dashboard_address=None
        ) as scheduler:
            rate(study(64, 8), scheduler)  # lets workers import what they need
            rates[workers] = rate(many, scheduler)
            print(f"dask, workers: {workers}      {rates[workers]:6.0f} runs a second")
            task = cost_of_a_task(scheduler)
    print(f"a task               {1e3 * task:6.2f} ms of client and scheduler")
    return rates, task


def busy_at(chunk: int, run: float, task: float) -> float:
    """Print what many cores would do with chunks of a size; return how busy they are."""
    write = cost_of_a_write(chunk)
    print(f"a chunk of {chunk:<10}{1e3 * write:6.2f} ms to write")
    period = max(task + write, run * chunk / CORES)
    busy = run * chunk / CORES / period
    print(f"  {CORES:,} cores: {chunk / period:,.0f} runs a second, {busy:.0%} of them busy")
    return busy


def main() -> int:
    """Measure, say what it comes to, and judge; return 1 if a target was missed."""
    many = study(int(sys.argv[1]) if len(sys.argv) > 1 else 2000, 50)
    run = cost_of_a_run(many)
    print(f"a run                {1e3 * run:6.2f} ms of a core")
    rate(study(64, 8), None)
    print(f"here, one process    {rate(many, None):6.0f} runs a second")
    rates, task = scaled(many)
    busy = [busy_at(chunk, run, task) for chunk in (50, 5000)]
    most = max(rates)
    checks = [
        (f"{most} workers over one, for each worker", rates[most] / rates[1] / most, SCALING),
        (f"part of {CORES:,} cores that is busy with chunks of 5000", busy[-1], BUSY),
    ]
    print()
    for name, reached, least in checks:
        print(f"{'PASS' if reached >= least else 'MISS'}  {name}: {reached:.2f} (at least {least})")
    return 0 if all(reached >= least for _, reached, least in checks) else 1


if __name__ == "__main__":
    sys.exit(main())
