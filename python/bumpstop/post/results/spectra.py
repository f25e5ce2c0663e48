"""Results about signals: spectra, envelopes and response spectra."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, one_of
from bumpstop.carried import base_acceleration
from bumpstop.errors import InputError
from bumpstop.post.blows import refuse_blows
from bumpstop.post.results.reading import Drawn, Reading, check_span, check_step

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = ["SPECTRA", "FloorSpectrum", "Spectrum"]

SPECTRA = ("amplitude", "density", "spectrogram", "envelope")


@dataclass(frozen=True)
class Spectrum:
    """A spectrum or envelope of a signal, sampled for it; see `power_spectral_density` and others.

    ``target`` is a quantity and what it is that of, as `Response.sample` takes them.
    """

    name: str
    _: KW_ONLY
    target: tuple[str, *tuple[str, ...]]
    kind: str
    step: float
    segment: float | None = None
    window: str = "hann"
    start: float = 0.0
    end: float | None = None

    def check(self, problem: Problem) -> None:
        """Raise where there is no such signal, or the time is not within the run."""
        one_of("of", self.kind, SPECTRA)
        if self.kind == "spectrogram" and self.segment is None:
            raise InputError("is needed for a spectrogram", key="segment")
        check_span(self.start, self.end, problem)
        check_step(self.step, self.start, self.end, problem)
        _check_target(self.target, problem)
        refuse_blows(problem, *self.target)
        self._check_window(problem)

    def _check_window(self, problem: Problem) -> None:
        """Raise where there is no such window, or no such segment fits into the samples."""
        from bumpstop.post.signals import segment_samples, window_weights

        last = problem.duration if self.end is None else self.end
        count = math.floor((last - self.start) / self.step + 1e-9) + 1
        segmented = self.kind in ("density", "spectrogram")
        length = segment_samples(self.segment, count, self.step) if segmented else 2
        window_weights(self.window, min(length, count))

    def read(self, response: Response) -> Reading:
        """Read the spectrum."""
        from bumpstop.post import signals

        if self.kind == "density":
            return Reading(figures=[Drawn(self._density(response), "y")])
        sampled = response.at(_grid(response, self.start, self.end, self.step))
        signal = _signal(sampled, self.target)
        match self.kind:
            case "amplitude":
                array, log = signals.amplitude_spectrum(signal, window=self.window), "y"
            case "spectrogram":
                length = self.segment or 0.0
                array, log = signals.spectrogram(signal, segment=length, window=self.window), "z"
            case _:
                array, log = signals.envelope(signal), ""
        return Reading(figures=[Drawn(array, log)])

    def _density(self, response: Response) -> xr.DataArray:
        """Return the density of a signal that is never held as a whole."""
        from bumpstop.post.signals import power_spectral_density
        from bumpstop.post.streams import Stream

        stream = Stream(response, *self.target, step=self.step, start=self.start, end=self.end)
        return power_spectral_density(stream, segment=self.segment, window=self.window)


@dataclass(frozen=True)
class FloorSpectrum:
    """Response spectra of the absolute acceleration of a node; see `response_spectrum`."""

    name: str
    _: KW_ONLY
    node: str
    dof: str
    frequencies: Sequence[float]
    damping: Sequence[float]
    step: float
    quantity: str = "pseudo_acceleration"
    start: float = 0.0
    end: float | None = None

    def check(self, problem: Problem) -> None:
        """Raise where there is no such node, or the time is not within the run."""
        problem.basis.row(self.node, self.dof)
        check_span(self.start, self.end, problem)
        check_step(self.step, self.start, self.end, problem)
        for number, damping in enumerate(self.damping):
            if not 0.0 <= damping < 1.0:
                what = "must be from 0 to below 1"
                raise InputError(what, key=f"damping.{number}", value=damping)

    def read(self, response: Response) -> Reading:
        """Read a spectrum for each damping."""
        from bumpstop.post.response_spectrum import response_spectrum

        sampled = response.at(_grid(response, self.start, self.end, self.step))
        own = sampled.acceleration(self.node, self.dof)
        motion = own + base_acceleration(response.problem, self.node, self.dof, sampled.times)
        found = []
        for damping in self.damping:
            spectrum = response_spectrum(motion, self.frequencies, damping, quantity=self.quantity)
            words = f"{self.quantity.replace('_', ' ')} spectrum of {self.node} {self.dof}"
            titled = spectrum.assign_attrs(title=f"{words}, damping {damping:.2g}")
            found.append(Drawn(titled, "xy"))
        return Reading(figures=found)


def _grid(response: Response, start: float, end: float | None, step: float) -> FloatArray:
    last = response.problem.duration if end is None else end
    count = math.floor((last - start) / step + 1e-9) + 1
    times: FloatArray = start + step * np.arange(count, dtype=np.float64)
    return times


def _signal(response: Response, target: tuple[str, ...]) -> xr.DataArray:
    quantity, *of = target
    signal: xr.DataArray = getattr(response, quantity)(*of)
    return signal


def _check_target(target: tuple[str, ...], problem: Problem) -> None:
    quantity, *of = target
    if quantity == "gauge":
        one_of("gauge", of[0], [gauge.name for gauge in problem.gauges])
    elif len(of) == 1:
        one_of("stop", of[0], [law.name for law in problem.laws])
    else:
        problem.basis.row(of[0], of[1])
