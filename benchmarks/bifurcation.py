"""The bifurcation diagram of the impact oscillator: 10^3 forcings, 10^4 periods each, up and down.

``x'' + 2 a x' + x = b cos(w t)`` below an elastic stop at x = 1 (Shaw and Holmes, Journal of
Sound and Vibration 90, 1983). The closing speeds of period-one motions are held against their
closed form, and the first forcing with impacts on the way up against that of grazing.
"""

import argparse
import sys
from pathlib import Path
from time import perf_counter, process_time

import numpy as np
import xarray as xr

sys.path.insert(0, str(Path(__file__).parents[1]))  # the closed forms live among the tests

import bumpstop as bs
from tests.reference.impact_oscillator import Oscillator, elastic_orbit, grazing_forcing

FREQUENCY, DAMPING, SPRING = 0.8, 0.05, 100.0
FORCING = (0.15, 3.0)
MINUTE = 60.0
LATEST = 100
"""Impacts kept of each run."""
SETTLED = 1e-9


def problem(periods: int) -> bs.Problem:
    """Return the oscillator under a unit forcing."""
    unit = 1.0 / (2.0 * np.pi)
    shapes = {("P", "dx"): [1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[unit], damping=DAMPING, shapes=shapes)
    wall = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=1.0, stiffness=SPRING)
    time = bs.Harmonic(FREQUENCY * unit, cosine=1.0)
    load = bs.NodalForce("load", node="P", force=(1.0, 0, 0), time=time)
    return bs.Problem(basis, laws=[wall], loads=[load], duration=periods * 2 * np.pi / FREQUENCY)


def main() -> int:
    """Measure, print and judge; return 1 if a target was missed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--parameters", type=int, default=1000)
    parser.add_argument("--periods", type=int, default=10_000)
    given = parser.parse_args()
    forcing = np.linspace(*FORCING, given.parameters)
    kept = {
        "speed": bs.Output(quantity="closing_speed", stop="wall", latest=LATEST),
        "start": bs.Output(quantity="impact_start", stop="wall", latest=3),
        "contact": bs.Output(quantity="impact_duration", stop="wall", latest=2),
        "impacts": bs.Output(quantity="impacts"),
    }
    start, cpu = perf_counter(), process_time()
    found = bs.follow(problem(given.periods), {"loads": forcing}, kept)
    seconds, cpu = perf_counter() - start, process_time() - cpu
    impacts = int(found.impacts.sum())
    print(f"{given.parameters} forcings up and down, {impacts} impacts: {seconds:.1f} s")
    print(f"processor time {cpu:.1f} s, {1e6 * cpu / impacts:.2f} us an impact")
    up = found.sel(way="up")
    speed, start = up.speed.values, up.start.values
    period = 2 * np.pi / FREQUENCY
    settled = np.ptp(speed, axis=1) < SETTLED
    once = np.abs(np.diff(start, axis=1) - period).max(axis=1) < SETTLED * period
    ones = np.flatnonzero(settled & once)
    errors = []
    for number in ones[:: max(1, len(ones) // 20)]:
        hit = speed[number, -1]
        guess = (start[number, 0] % period, hit, up.contact.values[number, 0], hit)
        oscillator = Oscillator(DAMPING, float(forcing[number]), FREQUENCY, spring=SPRING)
        known = elastic_orbit(oscillator, guess, periods=1)
        assert known.is_possible()
        errors.append(abs(hit / float(known.speed) - 1.0))
    print(f"period one at {len(ones)} forcings; {len(errors)} held against the closed form")
    grazing = grazing_forcing(Oscillator(DAMPING, 1.0, FREQUENCY))
    first = forcing[np.isfinite(speed[:, -1])][0]
    return judge(found, seconds, max(errors), abs(first - grazing), forcing[1] - forcing[0])


def judge(found: xr.Dataset, seconds: float, error: float, off: float, step: float) -> int:
    """Print each target with what was reached; return 1 if one was missed."""
    checks = [
        ("seconds for one way", 0.5 * seconds, MINUTE),
        ("largest error of a period-one closing speed", error, 1e-9),
        ("first forcing with impacts from that of grazing, in steps", off / step, 2.0),
        ("runs that failed", float(found.failed.sum()), 0.5),
    ]
    for name, reached, most in checks:
        print(f"{'PASS' if reached <= most else 'MISS'}  {name}: {reached:.3g} (at most {most:g})")
    return 0 if all(reached <= most for _, reached, most in checks) else 1


if __name__ == "__main__":
    sys.exit(main())
