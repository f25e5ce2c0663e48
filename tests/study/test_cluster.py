"""Studies on a dask scheduler: the same bits, whoever is killed."""

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import dask
import pytest
from distributed import Client, Future, LocalCluster

import bumpstop as bs
from bumpstop.cli import main
from bumpstop.study import cluster
from bumpstop.study.execution import Progress
from tests.study.bouncing import CASE, IN_PYTHON, written

SLOW = CASE.replace("duration = 2.0", "duration = 2.0\nsample = 1e-5")
"""The energy ledger takes a few milliseconds."""
LONG = IN_PYTHON.replace("count = 5", "count = 60").replace("chunk = 3", "chunk = 2")
"""60 chunks of two runs."""
GAP = "stops.spring.gap"


@pytest.fixture(scope="module")
def local() -> Iterator[LocalCluster]:
    """Two workers, each a process that is started again where it dies."""
    # A task that two workers died of is given up: starting processes takes time.
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 1}),
        LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
        ) as started,
    ):
        yield started


@contextmanager
def scheduler_alone(folder: Path) -> Iterator[tuple[Path, subprocess.Popen[bytes]]]:
    """A scheduler and a worker as processes of their own, and the scheduler's file."""
    file = folder / "scheduler.json"
    quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    words = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0"]
    words += ["--no-dashboard", "--scheduler-file", str(file)]
    with subprocess.Popen(words, **quiet) as scheduler:
        words = [sys.executable, "-m", "distributed.cli.dask_worker", "--no-nanny"]
        words += ["--no-dashboard", "--nthreads", "1", "--scheduler-file", str(file)]
        with subprocess.Popen(words, **quiet) as worker:
            try:
                deadline = time.monotonic() + 60
                while not file.exists() and time.monotonic() < deadline:
                    time.sleep(0.02)
                yield file, scheduler
            finally:
                worker.kill()
                scheduler.kill()


def files(store: Path) -> dict[str, bytes]:
    found = (path for path in store.rglob("*") if path.is_file())
    return {str(path.relative_to(store)): path.read_bytes() for path in found}


def living_process(local: LocalCluster, killed: list[int]) -> int:
    """Return the process of a worker that has not been killed, waiting for one to be started."""
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        # Whoever starts workers again may not have seen yet that one is dead.
        processes: set[int | None] = {nanny.pid for nanny in local.workers.values()}
        for process in processes.difference(killed):
            if process is not None:
                return process
        time.sleep(0.02)
    raise TimeoutError("no worker has been started again")


def test_workers_are_killed_and_no_byte_differs(local: LocalCluster, tmp_path: Path) -> None:
    study = bs.load_study(written(tmp_path, LONG, SLOW))
    study.run(tmp_path / "here.zarr", workers=1)
    told: list[Progress] = []
    killed: list[int] = []

    def kill_one(progress: Progress) -> None:
        told.append(progress)
        if len(told) in (5, 20, 40):
            killed.append(living_process(local, killed))
            os.kill(killed[-1], signal.SIGKILL)

    found = study.run(tmp_path / "there.zarr", scheduler=local, progress=kill_one)
    assert len(set(killed)) == 3
    assert [each.made for each in told] == list(range(2, 121, 2))  # each chunk once
    assert not found.failed.any()
    assert files(tmp_path / "there.zarr") == files(tmp_path / "here.zarr")


def test_a_client_stays_open_and_forgets_the_study(local: LocalCluster, tmp_path: Path) -> None:
    study = bs.load_study(written(tmp_path))
    with Client(local, set_as_default=False) as client:
        assert study.run(scheduler=client).identical(study.run(workers=1))
        assert client.status == "running"
        plugins = client.run(lambda dask_worker: list(dask_worker.plugins))
        assert not any("bumpstop" in name for names in plugins.values() for name in names)


def test_modes_that_vary_are_the_same_bits(local: LocalCluster) -> None:
    case = bs.load_case(Path(__file__).parents[2] / "cases" / "sdnl32" / "case.toml")
    study = bs.Study(
        case,
        {"beams.AB.elements": [6, 10], "basis.modes": [4, 9], "stops.spring.stiffness": [1e4, -1]},
        {"tip": bs.Output(quantity="displacement", node="B", dof="dy", times=[0.01])},
        variant="stiff",
        chunk=2,
    )
    found = study.run(scheduler=local)
    assert found.failed.sum() == 4  # recorded as they are here
    assert found.identical(study.run(workers=1))


def test_a_run_that_kills_its_workers_has_failed(
    monkeypatch: pytest.MonkeyPatch, local: LocalCluster, tmp_path: Path
) -> None:
    monkeypatch.setattr(cluster, "_made", deadly)
    beside = watch_single_runs(monkeypatch)
    given = bs.load_study(written(tmp_path))
    gaps = [0.25, 0.3, 0.35, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75]
    found = bs.Study(given.case, {GAP: gaps}, given.outputs, chunk=3).run(scheduler=local)
    assert [gap for gap, failed in zip(gaps, found.failed, strict=True) if failed] == [0.5]
    assert "it was killed, or found no memory" in str(found.message.values[3])
    # dask blames all tasks that were at a worker: only what is alone there can be guilty.
    assert len(beside) >= 3
    assert set(beside) == {0}


def watch_single_runs(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return a list that gets, for each run sent alone, how many tasks were out beside it."""
    beside: list[int] = []
    out = [0]
    submitted, result = cluster.Cluster._submitted, cluster._result

    def watched(self: cluster.Cluster, maker: Any, columns: cluster.Columns) -> Future[Any]:
        if len(columns[GAP]) == 1:
            beside.append(out[0])
        out[0] += 1
        return submitted(self, maker, columns)

    def taken(future: Future[Any]) -> Any:
        kept = result(future)
        out[0] -= 1
        return kept

    monkeypatch.setattr(cluster.Cluster, "_submitted", watched)
    monkeypatch.setattr(cluster, "_result", taken)
    return beside


made_by_workers = cluster._made


def deadly(name: str, columns: cluster.Columns) -> Any:
    """Make runs, unless one of them ends the process."""
    if 0.5 in columns[GAP]:
        os._exit(1)
    return made_by_workers(name, columns)


def test_a_scheduler_that_dies_loses_nothing(tmp_path: Path) -> None:
    path = written(tmp_path, LONG, SLOW)
    study, store = bs.load_study(path), tmp_path / "study.zarr"
    study.run(tmp_path / "whole.zarr", workers=1)
    with scheduler_alone(tmp_path) as (file, process):

        def kill(progress: Progress) -> None:
            if progress.made == 20:
                process.kill()

        with pytest.raises(bs.ComputationError, match="is gone; the runs made before are kept"):
            study.run(store, scheduler=file, progress=kill)
    made = int((~bs.open_study(store).force.isnull()).sum())
    assert 20 <= made < 120
    study.run(store, workers=1, resume=True)
    assert files(store) == files(tmp_path / "whole.zarr")


def test_a_dead_scheduler(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "PATIENCE", 0.5)
    study = str(written(tmp_path))
    for address, told in [
        ("tcp://127.0.0.1:1", "scheduler: does not answer (got 'tcp://127.0.0.1:1')"),
        ("nonsense://x", "scheduler: does not answer (got 'nonsense://x')"),
        (str(tmp_path / "none.json"), "no such scheduler file"),
    ]:
        assert main(["sweep", study, "--scheduler", address]) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert told in line
        assert not (tmp_path / "study.zarr").exists()


def test_something_else_at_the_address(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "PATIENCE", 5.0)
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer() -> None:
            with server.accept()[0] as connection:
                # A scheduler would take these for the lengths of what follows: 3 EiB.
                connection.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")
                connection.recv(1)

        other = threading.Thread(target=answer)
        other.start()
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        with pytest.raises(bs.InputError, match="scheduler: does not answer"):
            cluster.Cluster(address)
        other.join()


def test_workers_that_would_make_other_runs(local: LocalCluster, tmp_path: Path) -> None:
    table = tmp_path / "push.csv"
    table.write_text("0, 0\n1, 1\n2, 0\n")
    push = '\n[loads.push]\ntype = "force"\nnode = "P"\nforce = [0, 0, 1]\n[loads.push.table]\n'
    case = CASE + push + 'file = "push.csv"\n'
    study = bs.load_study(written(tmp_path, case=case))
    assert list(study.files) == ["push.csv"]
    table.write_text("0, 0\n1, 2\n2, 0\n")
    with pytest.raises(bs.InputError, match="a worker does not see this file as it is here"):
        study.run(scheduler=local)


def test_from_the_command_line(
    local: LocalCluster, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = str(written(tmp_path))
    words = ["sweep", study, "--scheduler", local.scheduler_address, "--json"]
    assert main(words) == 0
    record = json.loads(capsys.readouterr().out)
    assert (record["made"], record["failed"], record["workers"]) == (10, 0, 2)
    assert main([*words, "--resume"]) == 0
    assert json.loads(capsys.readouterr().out)["made"] == 0
