"""How long a response takes to be sampled, beside one matrix product of the same size.

A response of 100 modes that mostly rests on its stop, where every mode is a sum of all
exponentials, is read at a million instants. The yardstick is NumPy's product of a matrix of a
million rows and 100 columns with one of 100 by 100: what it takes to turn amplitudes that are
there already into as many others. Measured is processor time of all threads, so that other work
on the machine does not count.

``python benchmarks/sampling.py [--instants N]``.
"""

import argparse
import sys
import warnings
from collections.abc import Callable
from time import process_time

import numpy as np

import bumpstop as bs

MODES = 100
LARGEST_RATIO = 2.0
"""Most time of a sampling against that of the product."""
REPEATED = 3


def pressed() -> bs.Response:
    """Return a response of 100 modes that hammers on a soft stop, closed for most of the time."""
    modes = np.arange(1, MODES + 1)
    basis = bs.ModalBasis.from_modes(
        frequency=(10.0 * modes**1.2).tolist(),
        damping=0.01,
        shapes={("P", "dx"): np.cos(1.3 * modes)},
    )
    stop = bs.Stop("bed", node="P", normal=(-1, 0, 0), gap=-0.01, stiffness=1e5)
    thrown = bs.ModalState(velocity=[0.3] * MODES)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", bs.ModellingWarning)  # it starts pressed, on purpose
        return bs.simulate(bs.Problem(basis, laws=[stop], initial=thrown, duration=1.0))


def seconds(work: Callable[[], object]) -> float:
    """Return the least processor time of some runs."""
    least = float("inf")
    for _ in range(REPEATED):
        start = process_time()
        work()
        least = min(least, process_time() - start)
    return least


def main() -> int:
    """Print the table; return 1 if a target was missed."""
    parser = argparse.ArgumentParser(description="Time the sampling of a response.")
    parser.add_argument("--instants", type=int, default=1_000_000)
    instants = parser.parse_args().instants
    response = pressed()
    times = np.linspace(0.0, response.problem.duration, instants)
    amplitudes = np.random.default_rng(1).standard_normal((instants, MODES))
    square = np.random.default_rng(2).standard_normal((MODES, MODES))
    work: dict[str, Callable[[], object]] = {
        "modal displacement": lambda: response.motion(0, times),
        "modal velocity": lambda: response.motion(1, times),
        "displacement of a node": lambda: response.sample("displacement", "P", "dx", times=times),
        "stop force": lambda: response.sample("stop_force", "bed", times=times),
    }
    product = seconds(lambda: amplitudes @ square)
    closed = np.mean(response.sample("gap", "bed", times=times[::1000]) < 0.0)
    print(f"{MODES} modes, {instants:,} instants, in contact for {closed:.0%} of the time")
    print(f"{'NumPy, matrix product':26}{product:8.3f} s")
    missed = False
    for name, sampling in work.items():
        ratio = seconds(sampling) / product
        slow = ratio > LARGEST_RATIO
        missed = missed or slow
        print(f"{name:26}{ratio * product:8.3f} s{ratio:8.2f}{'  MISS' if slow else ''}")
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
