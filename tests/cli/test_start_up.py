"""Starting up: what a run loads, and how long it takes beside its bare dependencies."""

import os
import resource
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from statistics import median

SDNL32 = Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml"

LATE = ("pydantic", "pandas", "xarray", "pint", "plotly", "scipy", "rich", "jinja2", "matplotlib")
"""Packages that a run on plain numbers, without a report and without a terminal, can do without."""

UNUSED = (
    "io.case.tables.bearings",
    "io.case.tables.components",
    "io.case.tables.joints",
    "io.case.tables.links",
    "io.case.tables.loads",
    "io.case.tables.masses",
    "io.case.tables.matrices",
    "io.case.tables.mesh",
    "io.case.tables.modes",
    "io.case.tables.outputs",
    "io.case.tables.parts",
    "io.case.tables.relations",
    "io.case.tables.springs",
    "io.matrices",
    "io.meshes",
    "io.modes",
    "loads.force",
    "loads.gravity",
    "modal.companions",
    "modal.oscillation",
    "modal.rotor",
    "modal.substructure",
    "report.html",
    "structure.bearing",
    "structure.elements.varying",
    "structure.link",
    "structure.mass",
    "structure.relation",
    "structure.sections.circle",
    "structure.spring",
)
"""Modules of ours for what SDNL32 does not have."""

MOST_OWN = 145
"""Modules of ours that a run of SDNL32 may load. Each takes about 0.2 ms, a dataclass 0.3 more:
before raising this, see whether the new ones could wait until a case needs them."""


def loaded_by(*arguments: str) -> set[str]:
    """Return the modules that a command loads in a process of its own."""
    script = (
        "import sys; from bumpstop.cli import main; status = main(sys.argv[1:]); "
        "print(*sys.modules, sep=' ', file=sys.stderr); sys.exit(status)"
    )
    command = [sys.executable, "-c", script, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return set(done.stderr.split())


def test_a_run_loads_nothing_that_it_does_not_use(tmp_path: Path) -> None:
    loaded = loaded_by("run", str(SDNL32), "--out", str(tmp_path / "out"), "--no-report")
    assert (tmp_path / "out" / "stiff" / "response.nc").exists()
    assert "numpy" in loaded
    assert loaded.isdisjoint(LATE)
    own = {name for name in loaded if name.startswith("bumpstop.")}
    assert own.isdisjoint(f"bumpstop.{name}" for name in UNUSED)
    assert len(own) <= MOST_OWN


def test_what_it_should_not_load_is_there() -> None:
    assert all(find_spec(f"bumpstop.{name}") for name in UNUSED)


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
    # They take turns, so that a busy spell of the machine strikes all alike, and a spell within
    # a round is outvoted by the others.
    ratios = []
    for _ in range(9):
        yardstick, *runs = (
            cpu_seconds(*command, environment=environment)
            for command in (dependencies, run, writing)
        )
        ratios.append([seconds / yardstick for seconds in runs])
    running, running_and_writing = map(median, zip(*ratios, strict=True))
    assert running < 2.0
    assert running_and_writing < 2.0
