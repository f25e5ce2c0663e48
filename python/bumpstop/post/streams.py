"""Streams: signals of a response that are sampled block by block, for runs of any length."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, SupportsIndex

import numpy as np

from bumpstop.arguments import FloatArray, finite, not_negative, one_of, positive
from bumpstop.errors import InputError
from bumpstop.post.blows import refuse_blows
from bumpstop.post.of_run import check_run
from bumpstop.quantities import QUANTITIES, dof_units
from bumpstop.sampling import MOTIONS

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.response import Response

__all__ = ["SignalStatistics", "Stream", "signal_statistics"]

BLOCK = 131_072
"""Samples in a block."""
ROUNDING = 1e-9
"""How far beyond the end of the time looked at a sample may lie, in steps."""


class Stream:
    """A signal of a response, sampled evenly as it is needed: it takes the memory of a block.

    `power_spectral_density` and `signal_statistics` read it, of 10^8 samples too.

    Parameters
    ----------
    response
        The run.
    quantity, target
        What to sample, as `Response.sample` takes it: ``"displacement", "B", "dy"``.
    step
        Interval of the samples in s.
    start, end
        The time looked at, in s; all of the run where left out.

    Raises
    ------
    InputError
        If there is no such signal, a number cannot be used, or it is the force of a rigid stop,
        which lacks its blows.

    Examples
    --------
    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    >>> thrown = bs.ModalState(velocity=[2 * np.pi])
    >>> swing = bs.simulate(bs.Problem(basis, initial=thrown, duration=4.0))
    >>> wave = bs.Stream(swing, "displacement", "P", "dx", step=1e-3)
    >>> len(wave), round(bs.signal_statistics(wave).maximum, 6)
    (4001, 1.0)
    """

    def __init__(
        self,
        response: Response,
        quantity: str,
        *target: str | SupportsIndex,
        step: float,
        start: float = 0.0,
        end: float | None = None,
    ) -> None:
        check_run(response)
        duration = response.problem.duration
        last = duration if end is None else finite("end", end)
        first = not_negative("start", start)
        if not first < last <= duration:
            what = f"must lie after the start, {first:g} s, and within the run of {duration:g} s"
            raise InputError(what, key="end", value=last)
        self.response = response
        self.quantity = one_of("quantity", quantity, tuple(QUANTITIES))
        self.target = target
        refuse_blows(response.problem, quantity, *target)
        self.step = positive("step", step)
        self.start, self.end = first, last
        if self.sample(0, 1).ndim != 1:
            raise InputError("must be that of one mode", key="target", value=target)

    def __len__(self) -> int:
        return math.floor((self.end - self.start) / self.step + ROUNDING) + 1

    @property
    def units(self) -> str:
        """Unit of the values."""
        if self.quantity in MOTIONS:
            return dof_units(self.quantity, str(self.target[1]))
        return QUANTITIES[self.quantity].units

    @property
    def words(self) -> str:
        """What it is, in words."""
        return f"{self.quantity.replace('_', ' ')} of {' '.join(map(str, self.target))}"

    def instants(self, first: int, end: int) -> FloatArray:
        """Return the instants of some samples in s, shape (end - first,)."""
        last = min(end, len(self))
        times: FloatArray = self.start + self.step * np.arange(first, last, dtype=np.float64)
        return np.minimum(times, self.response.problem.duration)

    def sample(self, first: int, end: int) -> FloatArray:
        """Return some samples by their numbers, shape (end - first,)."""
        times = self.instants(first, end)
        values: FloatArray = self.response.sample(self.quantity, *self.target, times=times)
        return values

    def blocks(self, size: int = BLOCK) -> Iterator[tuple[int, FloatArray]]:
        """Yield the number of the first sample of each block, and its values."""
        for first in range(0, len(self), size):
            yield first, self.sample(first, first + size)


class _Tabulated:
    """A signal that is there as an array, read as a stream is."""

    def __init__(self, signal: xr.DataArray) -> None:
        if getattr(signal, "dims", None) != ("time",) or not len(signal):
            what = "must be an array over time, or a Stream"
            raise InputError(what, key="signal", value=type(signal).__name__)
        self.values = np.asarray(signal.values, dtype=np.float64)
        self.times = np.asarray(signal["time"].values, dtype=np.float64)
        self.units = str(signal.attrs.get("units", "1"))

    def instants(self, first: int, end: int) -> FloatArray:
        """Return the instants of some samples in s."""
        return self.times[first:end]

    def blocks(self) -> Iterator[tuple[int, FloatArray]]:
        """Yield all of it at once."""
        yield 0, self.values


@dataclass(frozen=True)
class SignalStatistics:
    """What `signal_statistics` found, in the unit of the signal.

    Attributes
    ----------
    count
        Number of samples.
    mean, standard_deviation, rms
        Of all samples, the deviation about their mean.
    minimum, maximum
        The smallest and the largest sample; the motion between samples is not looked at.
    time_of_minimum, time_of_maximum
        Their instants in s, the first ones.
    units
        Unit of the signal.
    """

    count: int
    mean: float
    standard_deviation: float
    rms: float
    minimum: float
    maximum: float
    time_of_minimum: float
    time_of_maximum: float
    units: str


def signal_statistics(signal: xr.DataArray | Stream) -> SignalStatistics:
    """Return mean, scatter and extremes of a signal: of an array, or sampled as it is read.

    Means and squared deviations of blocks are joined by the pairwise formula of T. F. Chan,
    G. H. Golub and R. J. LeVeque (The American Statistician 37 (1983) 242-247), so that no digits
    are lost to a mean far from zero.

    Parameters
    ----------
    signal
        Over ``time``; or a `Stream`, which takes the memory of a block.

    Raises
    ------
    InputError
        If it is neither, or an instant is outside the simulated time.
    """
    stream = signal if isinstance(signal, Stream) else _Tabulated(signal)
    count, mean, deviations = 0, 0.0, 0.0
    low, high = (math.inf, 0), (-math.inf, 0)
    for first, values in stream.blocks():
        own = float(values.mean())
        apart = own - mean
        total = count + len(values)
        mean += apart * len(values) / total
        deviations += float(np.square(values - own).sum()) + apart**2 * count * len(values) / total
        count = total
        least, most = int(values.argmin()), int(values.argmax())
        low = min(low, (float(values[least]), first + least))
        high = max(high, (float(values[most]), first + most), key=lambda found: found[0])
    variance = deviations / count
    low_time, high_time = (float(stream.instants(at, at + 1)[0]) for _, at in (low, high))
    return SignalStatistics(
        count=count,
        mean=mean,
        standard_deviation=math.sqrt(variance),
        rms=math.hypot(mean, math.sqrt(variance)),
        minimum=low[0],
        maximum=high[0],
        time_of_minimum=low_time,
        time_of_maximum=high_time,
        units=stream.units,
    )
