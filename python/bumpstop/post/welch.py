"""Welch's average of periodograms, of samples that come in blocks."""

from __future__ import annotations

from typing import Any

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["Welch"]

MOST_SAMPLES = 1_000_000
"""Samples of the segments that are transformed at once, at least one of them."""


class Welch:
    """The mean of the periodograms of overlapping segments.

    P. D. Welch, IEEE Transactions on Audio and Electroacoustics 15 (1967) 70-73. Segments that
    the samples do not fill are left out, as `scipy.signal.welch` does.

    Parameters
    ----------
    window
        Weights of the samples of a segment, (segment,).
    hop
        Samples from the start of a segment to that of the next one.
    detrend
        ``"constant"``, ``"linear"`` or False: what is taken off each segment.
    """

    def __init__(self, *, window: FloatArray, hop: int, detrend: Any) -> None:
        self._window = window
        self._hop = hop
        self._detrend = detrend
        self._left = np.empty(0)
        self._powers = np.zeros(len(window) // 2 + 1)
        self._segments = 0

    def add(self, samples: FloatArray) -> None:
        """Add the next samples of the signal, (n,)."""
        known: FloatArray = np.concatenate([self._left, samples])
        length = len(self._window)
        count = max((len(known) - length) // self._hop + 1, 0)
        if count:
            views = np.lib.stride_tricks.sliding_window_view(known, length)[:: self._hop][:count]
            size = max(MOST_SAMPLES // length, 1)
            for first in range(0, count, size):
                self._transform(views[first : first + size])
        self._left = known[count * self._hop :].copy()

    def frequencies(self, step: float) -> FloatArray:
        """Return the frequencies in Hz of samples every ``step`` seconds."""
        return np.asarray(np.fft.rfftfreq(len(self._window), step), dtype=np.float64)

    def density(self, step: float) -> FloatArray:
        """Return the one-sided density of samples every ``step`` seconds, per Hz."""
        sides = np.full(len(self._powers), 2.0)
        sides[0] = 1.0
        if len(self._window) % 2 == 0:
            sides[-1] = 1.0
        whole = self._segments * float(self._window @ self._window)
        return sides * self._powers * (step / whole)

    def _transform(self, segments: FloatArray) -> None:
        import scipy.fft
        import scipy.signal

        if self._detrend is not False:
            segments = scipy.signal.detrend(segments, type=self._detrend)
        lines = scipy.fft.rfft(segments * self._window)
        self._powers += np.square(np.abs(lines)).sum(axis=0)
        self._segments += len(segments)
