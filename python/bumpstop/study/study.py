"""Study: many runs of one case, and `study`, which makes one and runs it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bumpstop.arguments import by_name, count, did_you_mean, name
from bumpstop.errors import InputError
from bumpstop.io.case import Case, load_case
from bumpstop.io.case.build import STRUCTURE
from bumpstop.io.case.keys import keyed
from bumpstop.io.case.load import checked_tables
from bumpstop.io.case.overrides import overridden
from bumpstop.study.basins import Basins
from bumpstop.study.case_keys import CaseKeys
from bumpstop.study.evaluation import Recipe
from bumpstop.study.execution import Progress, execute, hired
from bumpstop.study.indices import PARTS
from bumpstop.study.layout import STATE, Layout
from bumpstop.study.outputs import Output
from bumpstop.study.parameters import Parameter, as_parameter
from bumpstop.study.pool import Task
from bumpstop.study.sampling import CROWD, Runs, Sampling, planned
from bumpstop.study.store import MemoryStore, Store, open_zarr_store, read_store

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.study.cluster import Scheduler

__all__ = ["Study", "open_study", "study"]

_TAKEN = ("run", "message", "status", "failed", "character", "attractor")
"""Names of what every study has."""


@dataclass(frozen=True, eq=False)
class Study:
    """Many runs of a case, in which some of its keys vary.

    Parameters
    ----------
    case
        A case from a file.
    parameters
        What varies: keys of the case by dotted name, such as ``"stops.guide.gap"``, each with
        a list of values, a `Range` or a `Distribution`.
    outputs
        What to keep of each run, by a name of your own.
    sampling
        How values are put together to runs; a grid where left out.
    variant
        Which variant of the case; needed where it has several.
    chunk
        Runs that are made and written together; by the number of runs where left out.
    basins
        Tell which attractor each run ends on; the results get it as ``attractor``.

    Raises
    ------
    InputError
        If the case has no such key, unit, variant, node or stop, or there are no runs to make
        or too many.

    Examples
    --------
    >>> import bumpstop as bs
    >>> many = bs.Study(
    ...     bs.load_case("cases/sdnl32/case.toml"),
    ...     {"stops.spring.stiffness": bs.Range("10 kN/m", "100 kN/m", 4)},
    ...     {"force": bs.Output(quantity="largest_force", stop="spring")},
    ...     variant="soft",
    ... )
    >>> results = many.run()
    >>> results.force.dims, results.force.attrs["units"]
    (('stops.spring.stiffness',), 'N')
    """

    case: Case
    parameters: Mapping[str, Any]
    outputs: Mapping[str, Output]
    _: KW_ONLY
    sampling: Sampling = Sampling()  # noqa: RUF009  # frozen
    variant: str | None = None
    chunk: int | None = None
    basins: Basins | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.case, Case) or not self.case.documents:
            hint = "load_case gives one"
            raise InputError("must be a case from a file", key="case", hint=hint)
        asked = by_name("parameters", self.parameters).items()
        given = {key: _parameter(key, value) for key, value in asked}
        object.__setattr__(self, "parameters", given)
        object.__setattr__(self, "variant", _variant(self.case, self.variant))
        outputs = by_name("outputs", self.outputs)
        object.__setattr__(self, "outputs", {**outputs, **self._sections()})
        if self.chunk is not None:
            count("chunk", self.chunk)
        self._check_parameters()
        self._check_outputs()
        if self.follows:
            self._check_following()
        if self.searches:
            self._check_sought()
        _ = self.runs

    @cached_property
    def document(self) -> dict[str, Any]:
        """What the case file says of the variant."""
        # Without changes: what belongs to the case and not to its variants is left out.
        return overridden(self.case.documents[str(self.variant)], {})

    @cached_property
    def runs(self) -> Runs:
        """The values of the parameters in each run."""
        slowest = [key for key in self.parameters if key.partition(".")[0] in STRUCTURE]
        return planned(self.varied, self.sampling, slowest)

    @cached_property
    def varied(self) -> dict[str, Parameter]:
        """The parameters as their keys take them: some take whole numbers alone."""
        return {
            key: each.whole() if self._keys.takes_whole(key, each) else each
            for key, each in self.parameters.items()
        }

    @cached_property
    def layout(self) -> Layout:
        """The arrays that its results fill."""
        chunk = CROWD * len(self.parameters) if self.searches else self.chunk
        return Layout(self.runs, self.outputs, chunk, modes=self._modes, units=self.units)

    @cached_property
    def units(self) -> dict[str, str]:
        """The SI units of those parameters that have one."""
        units = {key: self._keys.unit(key) for key in self.parameters}
        return {key: unit for key, unit in units.items() if unit}

    @cached_property
    def _keys(self) -> CaseKeys:
        return CaseKeys(self.document)

    @property
    def follows(self) -> bool:
        """Whether each run starts where the one before it ended."""
        return self.sampling.method == "continuation"

    @property
    def searches(self) -> bool:
        """Whether runs are placed where those before them have been worst."""
        return self.sampling.method == "worst_case"

    @property
    def sought(self) -> str:
        """The output that a search makes largest."""
        return self.sampling.of or next(iter(self.outputs))

    @property
    def _modes(self) -> int | None:
        """How many numbers a state has, where runs follow one another."""
        return len(self.case.bases[str(self.variant)].labels) if self.follows else None

    @cached_property
    def recipe(self) -> Recipe:
        """What it takes to make the runs."""
        known = (checked_tables(self.document), self.case.bases[str(self.variant)])
        return Recipe(
            document=self.document,
            folder=self.case.path.parent.absolute(),
            names=self.runs.names,
            outputs=self.outputs,
            known=(known,),
        )

    @cached_property
    def files(self) -> dict[str, str]:
        """The files that the case names, and what tells their content."""
        return dict(_digests(self.document, self.case.path.parent))

    @cached_property
    def definition(self) -> dict[str, Any]:
        """All that the results depend on: two studies with the same one are the same."""
        from bumpstop import __version__

        return {
            "title": self.case.title,
            "bumpstop": __version__,
            "case": self.document,
            "files": self.files,
            "parameters": {key: each.record for key, each in self.varied.items()},
            "sampling": self.sampling.record,
            "slowest_first": list(self.runs.names),
            "outputs": {key: each.record for key, each in self.outputs.items()},
            "chunk": self.layout.chunk,
            **({} if self.basins is None else {"basins": self.basins.record}),
        }

    def task(self, chunk: int) -> Task:
        """Return the runs of a chunk."""
        part = self.layout.part(chunk)
        return Task(chunk, self.runs.columns(part.start, part.stop))

    def run(
        self,
        store: str | PathLike[str] | None = None,
        *,
        workers: int | None = None,
        resume: bool = False,
        scheduler: Scheduler | None = None,
        progress: Callable[[Progress], None] | None = None,
    ) -> xr.Dataset:
        """Make all runs, and return what is kept of them.

        Parameters
        ----------
        store
            Folder of a zarr store that is filled as results come; in memory where left out.
        workers
            How many processes; as many as there are cores where left out. Results do not
            depend on it, to the last bit.
        resume
            Go on with a store that is there.
        scheduler
            A dask scheduler whose workers make the runs, instead of processes here: its
            address, the path of its scheduler file, or a cluster or client of
            ``distributed``. Results do not depend on it either.
        progress
            Called after each chunk.

        Returns
        -------
        xarray.Dataset
            The outputs over the parameters of a grid, or over ``run``; whether a run
            ``failed``, and its ``message``.

        Raises
        ------
        InputError
            If the store cannot be written, is there and shall not be resumed, or is that of
            another study; or the scheduler does not answer.
        ComputationError
            If the scheduler goes away; what was made before is in the store.
        """
        with hired(self, scheduler) as cluster:
            opened = self.opened(store, resume=resume)
            execute(self, opened, workers, progress, cluster)
        return self.labelled(opened)

    def labelled(self, store: Store) -> xr.Dataset:
        """Return what a store holds; see `run`."""
        from bumpstop.study.dataset import labelled

        return labelled(self.definition, self.layout.arrays, store.read)

    def opened(self, store: str | PathLike[str] | None, *, resume: bool) -> Store:
        """Return where results are kept; see `run`."""
        if store is None:
            return MemoryStore(self.layout)
        if not isinstance(store, str | PathLike):
            raise InputError("must be the path of a folder", key="store", value=store)
        return open_zarr_store(Path(store), self.layout, self.definition, resume=resume)

    def _check_parameters(self) -> None:
        if not self.parameters:
            hint = "name what varies and its values"
            raise InputError("there are none", key="parameters", hint=hint)
        for key, parameter in self.parameters.items():
            self._keys.check(key, parameter)

    def _sections(self) -> dict[str, Output]:
        """Return what tells attractors apart, where they are wanted."""
        if self.basins is None:
            return {}
        if not isinstance(self.basins, Basins):
            raise InputError("must be Basins", key="basins", value=self.basins)
        problem = self.case.problems.get(str(self.variant))
        if problem is None:
            raise InputError("is missing: nothing runs", key="run")
        with keyed("basins"):
            return self.basins.outputs(problem.duration)

    def _check_following(self) -> None:
        """Raise where a run cannot start in the state of another."""
        if self.variant not in self.case.problems:
            raise InputError("is missing: nothing runs", key="run")
        if self.basins is not None:
            what = "asks where runs end that start apart, and these follow one another"
            raise InputError(what, key="basins", hint="take a grid")
        for key in self.parameters:
            table = key.partition(".")[0]
            if table in STRUCTURE:
                what = "changes the modes, and the state of others says nothing of these"
                raise InputError(what, key=f'parameters."{key}"')
            if table == "initial":
                raise InputError("is that of the run before", key=f'parameters."{key}"')

    def _check_sought(self) -> None:
        """Raise where a search has nothing, or too much, to make largest."""
        if self.chunk is not None:
            raise InputError("is a generation in a search", key="chunk", hint="leave it out")
        if self.sampling.of is None and len(self.outputs) > 1:
            hint = "name the output that the search makes largest"
            raise InputError("is missing", key="sampling.of", hint=hint)
        output = self.outputs.get(self.sought)
        if output is None:
            hint = did_you_mean(self.sought, self.outputs)
            raise InputError("no such output", key="sampling.of", value=self.sought, hint=hint)
        if output.shape:
            what = "must be a single number, for the worst case to be known"
            raise InputError(what, key=f"outputs.{self.sought}", hint="give a statistic")

    def _told_beside(self) -> Iterator[str]:
        """Yield names that the results get from the way of sampling."""
        if self.follows:
            yield from ("way", "run_number", *STATE)
        if self.sampling.method == "saltelli":
            yield "parameter"
            yield from (f"{key}_{part}" for key in self.outputs for part in PARTS)
        if self.sampling.method == "one_at_a_time":
            yield from ("parameter", "side", "value")

    def _check_outputs(self) -> None:
        if not self.outputs:
            hint = "say what to keep of each run"
            raise InputError("there are none", key="outputs", hint=hint)
        problem = self.case.problems.get(str(self.variant))
        for key, output in self.outputs.items():
            name("outputs", key)
            if key in {*_TAKEN, *self.parameters, *self._told_beside()}:
                raise InputError("this name is taken", key="outputs", value=key)
            if not isinstance(output, Output):
                raise InputError("must be an Output", key=f"outputs.{key}", value=output)
            with keyed(f"outputs.{key}"):
                if problem is None:
                    output.of_modes(self.case.bases[str(self.variant)])
                else:
                    output.check(problem)


def study(
    case: Case | str | PathLike[str],
    parameters: Mapping[str, Any],
    outputs: Mapping[str, Output],
    *,
    sampling: str = "grid",
    count: int | None = None,
    seed: int = 0,
    of: str | None = None,
    variant: str | None = None,
    basins: Basins | None = None,
    store: str | PathLike[str] | None = None,
    workers: int | None = None,
    resume: bool = False,
    scheduler: Scheduler | None = None,
) -> xr.Dataset:
    """Make many runs of a case, and return what is kept of them.

    Parameters
    ----------
    case
        A case from a file, or the path of one.
    parameters
        What varies: keys of the case by dotted name, each with a list of values, a `Range` or
        a `Distribution`.
    outputs
        What to keep of each run, by a name of your own.
    sampling, count, seed, of
        See `Sampling`.
    variant
        Which variant of the case; needed where it has several.
    basins
        Tell which attractor each run ends on; see `Basins`.
    store, workers, resume, scheduler
        See `Study.run`.

    Returns
    -------
    xarray.Dataset
        The outputs over the parameters of a grid, or over ``run``.

    Raises
    ------
    InputError
        If something is not as it must be; see `Study`.

    Examples
    --------
    >>> import bumpstop as bs
    >>> found = bs.study(
    ...     "cases/sdnl32/case.toml",
    ...     {"stops.spring.gap": ["0 mm", "1 mm"], "basis.modes": [4, 10]},
    ...     {"impacts": bs.Output(quantity="impacts")},
    ...     variant="stiff",
    ... )
    >>> found.impacts.dims, found.impacts.shape
    (('stops.spring.gap', 'basis.modes'), (2, 2))
    """
    loaded = load_case(case) if isinstance(case, str | PathLike) else case
    made = Study(
        loaded,
        parameters,
        outputs,
        sampling=Sampling(sampling, count, seed, of=of),
        variant=variant,
        basins=basins,
    )
    return made.run(store, workers=workers, resume=resume, scheduler=scheduler)


def open_study(store: str | PathLike[str]) -> xr.Dataset:
    """Return the results in a store, also of a study that has not ended.

    Parameters
    ----------
    store
        Folder of the zarr store.

    Returns
    -------
    xarray.Dataset
        As `Study.run` gives it; what has not been run yet is NaN.

    Raises
    ------
    InputError
        If there is no store of a study.
    """
    from bumpstop.study.dataset import labelled

    return labelled(*read_store(Path(store)))


def _parameter(key: str, value: object) -> Parameter:
    with keyed(f'parameters."{key}"'):
        return as_parameter(value)


def _variant(case: Case, variant: str | None) -> str:
    known = list(case.documents)
    if variant is None:
        if len(known) > 1:
            hint = f"the case has {', '.join(known)}"
            raise InputError("is missing", key="variant", hint=hint)
        return known[0]
    if variant not in known:
        raise InputError(
            "unknown variant", key="variant", value=variant, hint=did_you_mean(variant, known)
        )
    return variant


def _digests(part: Any, folder: Path) -> Iterator[tuple[str, str]]:
    """Yield the files that a document names, and what tells their content."""
    if isinstance(part, dict):
        for each in part.values():
            yield from _digests(each, folder)
    elif isinstance(part, list):
        for each in part:
            yield from _digests(each, folder)
    elif isinstance(part, str) and 0 < len(part) < 256 and "\0" not in part:
        path = folder / part
        if path.is_file():
            yield part, hashlib.sha256(path.read_bytes()).hexdigest()
