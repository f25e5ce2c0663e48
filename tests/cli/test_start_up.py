"""Starting up: what a run loads, and how long it takes beside its bare dependencies."""

import os
import resource
import subprocess
import sys
from pathlib import Path

SDNL32 = Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml"

LATE = ("pandas", "xarray", "pint", "plotly", "scipy", "rich", "jinja2", "matplotlib")
"""Packages that a run on plain numbers, without a report and without a terminal, can do without."""


def loaded_by(*arguments: str) -> set[str]:
    """Return the top-level modules that a command loads in a process of its own."""
    script = (
        "import sys; from bumpstop.cli import main; status = main(sys.argv[1:]); "
        "print(*sys.modules, sep=' ', file=sys.stderr); sys.exit(status)"
    )
    command = [sys.executable, "-c", script, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return {name.partition(".")[0] for name in done.stderr.split()}


def test_a_run_loads_nothing_that_it_does_not_use(tmp_path: Path) -> None:
    loaded = loaded_by("run", str(SDNL32), "--out", str(tmp_path / "out"), "--no-report")
    assert (tmp_path / "out" / "stiff" / "response.nc").exists()
    assert "numpy" in loaded
    assert loaded.isdisjoint(LATE)


def test_neither_does_json() -> None:
    assert loaded_by("run", str(SDNL32), "--json").isdisjoint({*LATE, "h5py", "h5netcdf"})


def test_units_load_pint(tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_text(SDNL32.read_text().replace("gap = 0.0 ", 'gap = "0 mm"'))
    assert "pint" in loaded_by("modes", str(file))


def cpu_seconds(*arguments: str, environment: dict[str, str]) -> float:
    """Return the CPU time of a Python process."""

    def spent() -> float:
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    before = spent()
    command = [sys.executable, *arguments]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=environment)
    return spent() - before


def test_a_run_takes_less_than_twice_the_import_of_its_dependencies(tmp_path: Path) -> None:
    # numpy starts a thread a core, which spin: one thread makes CPU time comparable. Byte code
    # is cached, as it is after an installation.
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "PYTHONPYCACHEPREFIX": str(tmp_path)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    dependencies = ("-c", "import numpy, h5py, pydantic")
    run = ("-m", "bumpstop", "run", str(SDNL32))
    writing = (*run, "--out", str(tmp_path / "out"), "--no-report")
    cpu_seconds(*writing, environment=environment)
    # They take turns, so that a busy spell of the machine strikes all alike.
    rounds = [
        [cpu_seconds(*command, environment=environment) for command in (dependencies, run, writing)]
        for _ in range(8)
    ]
    yardstick, running, running_and_writing = map(min, zip(*rounds, strict=True))
    assert running < 2.0 * yardstick
    assert running_and_writing < 2.0 * yardstick
