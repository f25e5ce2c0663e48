"""WAV: hear how a structure rattles."""

from __future__ import annotations

import wave
from collections.abc import Iterator
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import count, one_of, positive
from bumpstop.errors import InputError
from bumpstop.files import written_whole
from bumpstop.io.signals import BLOCK, signals
from bumpstop.post.blows import refuse_blows
from bumpstop.quantities import QUANTITIES

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.response import Response

__all__ = ["write_wav"]

FASTEST = 1_000_000
"""Samples a second at most: more than any player takes."""
LOUDEST = 0.99 * 32767
"""The largest sample, of sixteen bits."""
MOST = 2**31 - 256
"""Bytes of sound that the format can hold."""


def write_wav(
    response: Response,
    path: str | PathLike[str],
    quantity: str | None = None,
    *target: str,
    rate: int = 44_100,
    slowed: float = 1.0,
) -> None:
    """Write one quantity over the whole run as sound: mono, sixteen bits.

    The response is read at the instants of the sound's own samples, so that nothing is
    interpolated; its mean is taken away, and its largest deviation is nearly full scale.

    Parameters
    ----------
    response
        What to listen to.
    path
        The file; one of that name is replaced once the new one is complete.
    quantity, target
        As `Response.sample` takes them: ``"velocity", "B", "dy"`` or ``"stop_force", "guide"``;
        the velocity of the first output, or at the first stop, where left out.
    rate
        Samples a second of sound.
    slowed
        Seconds of sound for each second of the run: 100 makes 2 kHz a hum of 20 Hz.

    Raises
    ------
    InputError
        If the quantity or what it is of are unknown, a number is out of range, the sound would be
        longer than the format holds, it is the force of a rigid stop, which lacks the blows, or the
        file cannot be written there.
    """
    if quantity is None:
        chosen = next(each for each in signals(response) if each.quantity == "velocity")
        quantity, target = chosen.quantity, chosen.target
    one_of("quantity", quantity, tuple(QUANTITIES))
    if quantity.startswith("modal_") and not target:
        raise InputError("must be one mode, counted from 1", key="target", value=quantity)
    refuse_blows(response.problem, quantity, *target)
    pace = count("rate", rate, most=FASTEST) * positive("slowed", slowed)
    samples = int(response.problem.duration * pace) + 1
    if 2 * samples > MOST:
        what = f"would make {samples:,} samples, more than a WAV file holds"
        raise InputError(what, key="rate", value=rate, hint="take a lower one, or less slowed")

    def blocks() -> Iterator[FloatArray]:
        for start in range(0, samples, BLOCK):
            times = np.arange(start, min(start + BLOCK, samples)) / pace
            yield response.sample(quantity, *target, times=times)

    # Twice through: how loud it is must be known before it is written.
    mean = sum(float(block.sum()) for block in blocks()) / samples
    largest = max(float(np.abs(block - mean).max()) for block in blocks())
    scale = LOUDEST / largest if largest > 0.0 else 0.0
    with written_whole(path) as part, wave.open(str(part), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(rate)
        for block in blocks():
            file.writeframes(np.rint((block - mean) * scale).astype("<i2").tobytes())
