"""Kill studies a hundred times at random instants, and compare their stores with unbroken ones.

A quarter of the kills meet a study whose runs the core makes, a quarter one whose runs processes
make, a quarter one whose runs follow one another, and a quarter a search for a worst case.
``python benchmarks/killed_studies.py [KILLS]``; the exit status is 1 where a byte differs.
"""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

STUDY = """
case = {case!r}
variant = "stiff"
[parameters]
"stops.spring.stiffness" = {{ from = 1e4, to = 1e7, count = 60, spacing = "log" }}
"stops.spring.gap" = {{ from = -1e-3, to = 1e-3, count = 40 }}
[outputs.force]
quantity = "largest_force"
stop = "spring"
[outputs.tip]
quantity = "displacement"
node = "B"
dof = "dy"
times = [0.001, 0.002, 0.01]
[execution]
chunk = 5
"""
MEAN = """
[outputs.mean]
quantity = "displacement"
node = "B"
dof = "dy"
statistic = "mean"
"""
"""An output that the core does not read: processes make the runs."""
FOLLOWED = (
    STUDY.replace(', count = 60, spacing = "log"', ", count = 600")
    .replace("count = 40", "count = 600")
    .replace("[outputs.tip]", '[sampling]\nmethod = "continuation"\n[outputs.tip]')
)
"""The same numbers side by side, up and then down: each run starts where the last one ended."""
SEARCHED = (STUDY + MEAN).replace(
    "[execution]\nchunk = 5", '[sampling]\nmethod = "worst_case"\nof = "mean"\ncount = 1600'
)
"""A search: generations wait for those before them, and processes make their runs."""
CASE = Path(__file__).parents[1] / "cases" / "sdnl32" / "case.toml"


def content(store: Path) -> dict[str, bytes]:
    """Return the content of every file of a store."""
    found = (path for path in store.rglob("*") if path.is_file())
    return {str(path.relative_to(store)): path.read_bytes() for path in found}


def sweep(study: Path, store: Path) -> list[str]:
    """Return the command that makes or resumes a study."""
    command = [sys.executable, "-m", "bumpstop", "sweep", str(study), "--store", str(store)]
    return [*command, "--workers", "2", *(["--resume"] if store.exists() else [])]


def killed_once(study: Path, store: Path, chance: random.Random) -> bool:
    """Start a study, kill it some time later, and tell whether it was still running."""
    with subprocess.Popen(sweep(study, store), stdout=subprocess.DEVNULL) as process:
        deadline = time.monotonic() + chance.uniform(0.0, 6.0)
        while process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.002)
        process.send_signal(signal.SIGKILL)
        return process.wait() == -signal.SIGKILL


def survives(text: str, wanted: int, chance: random.Random) -> bool:
    """Kill a study so many times, resume it, and tell whether every store has the same bytes."""
    kills = studies = 0
    with TemporaryDirectory() as folder:
        study = Path(folder) / "study.toml"
        study.write_text(text.format(case=str(CASE)), encoding="utf-8")
        whole = Path(folder) / "whole.zarr"
        subprocess.run(sweep(study, whole), check=True)
        expected = content(whole)
        while kills < wanted:
            studies += 1
            store = Path(folder) / f"{studies}.zarr"
            while kills < wanted and killed_once(study, store, chance):
                kills += 1
            subprocess.run(sweep(study, store), check=True, stdout=subprocess.DEVNULL)
            if content(store) != expected:
                print(f"MISS  study {studies} differs after {kills} kills")
                return False
    print(f"PASS  {kills} kills in {studies} studies: all stores have the bytes of an unbroken one")
    return True


def main() -> int:
    """Kill, resume, compare; return the exit status."""
    wanted = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    chance = random.Random(1)
    quarter = wanted // 4
    kinds = dict.fromkeys([STUDY, STUDY + MEAN, FOLLOWED], quarter)
    kinds[SEARCHED] = wanted - 3 * quarter
    survived = [survives(text, kills, chance) for text, kills in kinds.items()]
    return 0 if all(survived) else 1


if __name__ == "__main__":
    sys.exit(main())
