"""The bifurcation diagram of the impact oscillator: 10^3 forcings, 10^4 periods each, up and down.

``x'' + 2 a x' + x = b cos(w t)`` below an elastic stop at x = 1 (Shaw and Holmes, Journal of
Sound and Vibration 90, 1983). The closing speeds of period-one motions are held against their
closed form, and the first forcing with impacts on the way up against that of grazing.
"""

import argparse
import sys
from pathlib import Path
from time import perf_counter, process_time
from typing import NamedTuple

import numpy as np
import xarray as xr

sys.path.insert(0, str(Path(__file__).parents[1]))  # the closed forms live among the tests

import bumpstop as bs
from tests.reference.impact_oscillator import Oscillator, elastic_orbit, grazing_forcing

FREQUENCY, DAMPING, SPRING = 0.8, 0.05, 100.0
FORCING = (0.15, 3.0)
MINUTE = 60.0
SETTLED, SETTLED_IMPACTS = 1e-9, 100
"""Speeds of as many last impacts differ by less where a motion has settled."""


def problem(periods: int) -> bs.Problem:
    """Return the oscillator under a unit forcing."""
    unit = 1.0 / (2.0 * np.pi)
    shapes = {("P", "dx"): [1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[unit], damping=DAMPING, shapes=shapes)
    wall = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=1.0, stiffness=SPRING)
    time = bs.Harmonic(FREQUENCY * unit, cosine=1.0)
    load = bs.NodalForce("load", node="P", force=(1.0, 0, 0), time=time)
    return bs.Problem(basis, laws=[wall], loads=[load], duration=periods * 2 * np.pi / FREQUENCY)


class Branch(NamedTuple):
    """Motions with one impact a period that were reached on the way up."""

    forcing: list[float]
    speed: list[float]
    """In closed form."""
    error: float
    """Largest difference of what was computed, relative."""


def main() -> int:
    """Measure, print and judge; return 1 if a target was missed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--parameters", type=int, default=1000)
    parser.add_argument("--periods", type=int, default=10_000)
    parser.add_argument("--latest", type=int, default=1000, help="impacts kept of each run")
    parser.add_argument("--picture", type=Path, help="page with the diagram, such as diagram.html")
    given = parser.parse_args()
    forcing = np.linspace(*FORCING, given.parameters)
    kept = {
        "speed": bs.Output(quantity="closing_speed", stop="wall", latest=given.latest),
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
    branch = period_one(found.sel(way="up"))
    print(f"period one in closed form at {len(branch.forcing)} forcings")
    grazing = grazing_forcing(Oscillator(DAMPING, 1.0, FREQUENCY))
    if given.picture is not None:
        draw(found, branch, grazing, given.picture)
    first = forcing[np.isfinite(found.speed.sel(way="up").values[:, -1])][0]
    return judge(found, seconds, branch.error, abs(first - grazing) / (forcing[1] - forcing[0]))


def period_one(up: xr.Dataset) -> Branch:
    """Hold the settled motions with one impact a period against their closed form."""
    speed, start, contact = (up[key].values for key in ("speed", "start", "contact"))
    period = 2 * np.pi / FREQUENCY
    settled = np.ptp(speed[:, -SETTLED_IMPACTS:], axis=1) < SETTLED
    once = np.abs(np.diff(start, axis=1) - period).max(axis=1) < SETTLED * period
    branch = Branch([], [], 0.0)
    for number in np.flatnonzero(settled & once):
        forcing, hit = float(up.loads[number]), speed[number, -1]
        guess = (start[number, 0] % period, hit, contact[number, 0], hit)
        oscillator = Oscillator(DAMPING, forcing, FREQUENCY, spring=SPRING)
        known = elastic_orbit(oscillator, guess, periods=1)
        assert known.is_possible()
        branch.forcing.append(forcing)
        branch.speed.append(float(known.speed))
        branch = branch._replace(error=max(branch.error, abs(hit / float(known.speed) - 1.0)))
    return branch


def draw(found: xr.Dataset, branch: Branch, grazing: float, path: Path) -> None:
    """Write the diagram with the branch in closed form and the grazing forcing on it."""
    start = perf_counter()
    figure = bs.bifurcation_diagram(found, "speed")
    line = {"color": "#1c2126", "width": 1}
    figure.add_scatter(x=branch.forcing, y=branch.speed, name="period one", line=line)
    figure.add_vline(x=grazing, annotation_text="grazing", line={**line, "dash": "dot"})
    figure.write_html(path)
    print(f"{found.speed.size} points drawn in {perf_counter() - start:.1f} s: {path}")


def judge(found: xr.Dataset, seconds: float, error: float, off: float) -> int:
    """Print each target with what was reached; return 1 if one was missed."""
    checks = [
        ("seconds for both ways, side by side", seconds, MINUTE),
        ("largest error of a period-one closing speed", error, 1e-9),
        ("first forcing with impacts from that of grazing, in steps", off, 2.0),
        ("runs that failed", float(found.failed.sum()), 0.5),
    ]
    for name, reached, most in checks:
        print(f"{'PASS' if reached <= most else 'MISS'}  {name}: {reached:.3g} (at most {most:g})")
    return 0 if all(reached <= most for _, reached, most in checks) else 1


if __name__ == "__main__":
    sys.exit(main())
