"""Runs a second of a study of SDNL32: processes beside threads."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import bumpstop as bs
from bumpstop.study.evaluation import Evaluator
from bumpstop.study.pool import Task, evaluated, usable_cores

CASE = Path(__file__).parents[1] / "cases" / "sdnl32" / "case.toml"
RUNS = 1500


def by_processes(study: bs.Study, tasks: list[Task], workers: int) -> None:
    """Make the runs as studies do."""
    for _ in evaluated(study.recipe, range(len(tasks)), tasks.__getitem__, workers):
        pass


def by_threads(study: bs.Study, tasks: list[Task], workers: int) -> None:
    """Make the runs by threads of this process."""
    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(lambda task: Evaluator(study.recipe).kept(task.columns), tasks))


def main() -> None:
    """Print what was measured."""
    warnings.simplefilter("ignore", bs.ModellingWarning)  # threads do not keep them quiet
    study = bs.Study(
        bs.load_case(CASE),
        {"stops.spring.stiffness": bs.Range(1e4, 1e7, RUNS, spacing="log")},
        {
            "force": bs.Output(quantity="peak_force", stop="spring", statistic="maximum"),
            "tip": bs.Output(quantity="displacement", node="B", dof="dy", times=[0.001, 0.01]),
            "residual": bs.Output(quantity="energy_residual"),
        },
        variant="stiff",
        chunk=50,
    )
    tasks = [study.task(chunk) for chunk in range(study.layout.chunks)]
    cores = usable_cores()
    ways: list[tuple[str, Callable[[bs.Study, list[Task], int], None], int]] = [
        ("1 process", by_processes, 1),
        (f"{cores} processes", by_processes, cores),
        (f"{cores} threads", by_threads, cores),
    ]
    for name, make, workers in ways:
        started = time.perf_counter()
        make(study, tasks, workers)
        print(f"{name:>12}: {RUNS / (time.perf_counter() - started):8.0f} runs a second")


if __name__ == "__main__":
    main()
