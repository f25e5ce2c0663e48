"""How long a whole process takes, against one that only imports numpy, h5py and pydantic.

The commands take turns; medians are printed. ``python benchmarks/startup.py [--runs N]``.
"""

import argparse
import compileall
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from time import perf_counter

ROOT = Path(__file__).parents[1]
CASE = ROOT / "cases" / "sdnl32" / "case.toml"
PYTHON = sys.executable
PROGRAM = str(Path(PYTHON).with_name("bumpstop"))
LARGEST_RATIO = 2.0
LARGEST_WITH_REPORT = 1.2  # s


def commands(folder: str) -> dict[str, list[str]]:
    """Return what is timed, the yardstick first."""
    run = [PROGRAM, "run", str(CASE)]
    return {
        "import numpy, h5py, pydantic": [PYTHON, "-c", "import numpy, h5py, pydantic"],
        "import bumpstop": [PYTHON, "-c", "import bumpstop"],
        "bumpstop run": run,
        "bumpstop run --out, no report": [*run, "--out", folder, "--no-report"],
        "bumpstop run --out, with report": [*run, "--out", folder],
    }


def wall_time(command: Sequence[str]) -> float:
    """Return the seconds from start to end of a process that must succeed."""
    start = perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - start


def measure(runs: int) -> dict[str, float]:
    """Return median times by name; a first round warms the caches and is thrown away."""
    with tempfile.TemporaryDirectory() as folder:
        rounds = [
            {name: wall_time(command) for name, command in commands(folder).items()}
            for _ in range(runs + 1)
        ][1:]
    return {name: median(times[name] for times in rounds) for name in rounds[0]}


def main() -> int:
    """Print the table; return 1 if a target was missed."""
    parser = argparse.ArgumentParser(description="Time the start of bumpstop.")
    parser.add_argument("--runs", type=int, default=15)
    arguments = parser.parse_args()
    # As pip does with what it installs, so that Python's own habit makes no difference.
    compileall.compile_dir(ROOT / "python", quiet=1)
    seconds = measure(arguments.runs)
    yardstick, *_, with_report = seconds
    missed = False
    print(f"{'':36}{'time ms':>10}{'ratio':>8}")
    for name, time in seconds.items():
        ratio = time / seconds[yardstick]
        good = time <= LARGEST_WITH_REPORT if name == with_report else ratio <= LARGEST_RATIO
        missed = missed or not good
        print(f"{name:36}{1e3 * time:10.1f}{ratio:8.2f}  {'PASS' if good else 'MISS'}")
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
