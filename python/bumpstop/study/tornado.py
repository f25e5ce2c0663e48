"""Each parameter alone from its low to its high value: what a tornado chart shows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from bumpstop.errors import InputError
from bumpstop.study.outputs import Output
from bumpstop.study.sampling import Sampling
from bumpstop.study.study import Study

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.io.case import Case

__all__ = ["one_at_a_time"]


def one_at_a_time(
    case: Case,
    parameters: Mapping[str, Any],
    outputs: Mapping[str, Output],
    *,
    share: float = 0.05,
    variant: str | None = None,
    workers: int | None = None,
) -> xr.Dataset:
    """Return results where one parameter is low or high, and the others are in their middle.

    The runs are those of a study whose `Sampling` is ``"one_at_a_time"``, which may have a store
    or a scheduler.

    Parameters
    ----------
    case, parameters, outputs, variant
        See `Study`. Parameters are ranges, distributions or lists, of which the middle is the
        median; outputs are single numbers.
    share
        Low is the value below which this share of the parameter lies, high the one above which
        as much lies: 0.05 and 0.95 of a distribution, near the ends of a range.
    workers
        How many processes.

    Returns
    -------
    xarray.Dataset
        The outputs over ``parameter`` and ``side`` (low, middle, high), whether the run
        ``failed``, and the ``value`` of the parameter; a failed run is NaN.

    Raises
    ------
    InputError
        If something is not as it must be; see `Study`.

    Examples
    --------
    >>> import bumpstop as bs
    >>> found = bs.one_at_a_time(
    ...     bs.load_case("cases/sdnl32/case.toml"),
    ...     {"stops.spring.gap": bs.Range(0.0, 1e-3), "stops.spring.stiffness": bs.Range(1e4, 2e4)},
    ...     {"force": bs.Output(quantity="largest_force", stop="spring")},
    ...     variant="soft",
    ... )
    >>> found.force.dims, bool((found.force.sel(side="low") < found.force.sel(side="high"))[1])
    (('parameter', 'side'), True)
    """
    for name, output in outputs.items():
        if output.shape:
            raise InputError("must be a single number", key=f"outputs.{name}.times")
    sampling = Sampling("one_at_a_time", share=share)
    study = Study(case, parameters, outputs, sampling=sampling, variant=variant)
    return study.run(workers=workers)
