"""Solutions a second of SDNL32 over stop stiffness, gap and speed, beside numba loops, in one run.

Twelve displacements of the tip are kept of each of 10^5 problems, in memory. Ours is exact; the
peers march by central differences at 1e-5 s, on all cores as well. All take turns, so that a
busy machine slows all alike; the best of the rounds counts. Errors of ours are against fifty-digit
arithmetic, of the peers against ours.
"""

import argparse
import math
import resource
import sys
from collections.abc import Callable
from pathlib import Path
from time import perf_counter

import numpy as np
import xarray as xr

sys.path.insert(0, str(Path(__file__).parents[1]))  # the oracle lives among the tests

import bumpstop as bs
from benchmarks.numba_batch import LANES, eight_lanes, loop
from benchmarks.sdnl32_problems import DURATION, PUBLISHED_RATE, beam, published
from bumpstop.study.pool import usable_cores
from tests.reference.precise import PreciseSolution
from tests.reference.problem import Array, StopProblem

STEP = 1e-5
OUTPUTS = 12
EVERY = np.round(np.arange(1, OUTPUTS + 1) * (DURATION / OUTPUTS) / STEP).astype(np.int64)
TIMES: Array = np.minimum(EVERY * STEP, DURATION)
ROUNDS = 5
REFERENCES = 12
GROWTH = (1_000, 10_000, 100_000, 1_000_000, 10_000_000)
SECONDS = 3.0
"""Time for each size of the growth; the best of its rounds counts."""
ROOM = 20.0
"""MB that may be taken beside what goes in and comes out, whatever the number of runs."""
TIP = bs.Output(quantity="displacement", node="B", dof="dy", times=TIMES.tolist())


def samples(count: int, seed: int = 8) -> tuple[Array, Array, Array]:
    """Return stiffness in N/m, gap in m, and factors of the published speed."""
    rng = np.random.default_rng(seed)
    stiffness = rng.uniform(5e3, 1e5, count)
    gap = np.where(np.arange(count) % 2, rng.uniform(0.0, 1e-3, count), 0.0)
    return stiffness, gap, rng.uniform(-6.0, -1.0, count) / PUBLISHED_RATE


def problem() -> bs.Problem:
    """Return SDNL32."""
    stop = bs.Stop("spring", node="B", normal=(0, 1, 0), stiffness=18e3)
    start = bs.RigidRotation(about="A", rate=(0, 0, PUBLISHED_RATE))
    return bs.Problem(beam(), laws=[stop], initial=start, duration=DURATION)


def solved(model: bs.Problem, drawn: tuple[Array, Array, Array], *, lanes: bool) -> xr.Dataset:
    """Return what is kept of each run."""
    stiffness, gap, scale = drawn
    varied = {
        "stops.spring.stiffness": stiffness,
        "stops.spring.gap": gap,
        "initial.velocity": scale,
    }
    found = bs.batch(model, varied, {"tip": TIP}, lanes=lanes)
    assert not found.failed.any()
    return found


def ours(model: bs.Problem, drawn: tuple[Array, Array, Array], *, lanes: bool) -> Array:
    """Return the tips (run, time)."""
    tips: Array = solved(model, drawn, lanes=lanes).tip.values
    return tips


def peer(march: Callable[..., None], base: StopProblem, drawn: tuple[Array, Array, Array]) -> Array:
    """Return the tips (run, time) of a numba loop."""
    tips = np.zeros((len(drawn[0]), OUTPUTS))
    march(base.omega2, base.damping, base.row, base.velocity, *drawn, STEP, EVERY, tips)
    return tips


def worst_error(tips: Array, drawn: tuple[Array, Array, Array]) -> float:
    """Return the largest error of some runs against fifty digits, over the largest displacement."""
    base, worst = published()[0], 0.0
    for run in range(REFERENCES):
        stiffness, gap, scale = (float(column[run]) for column in drawn)
        exact = base.but(stiffness=stiffness, gap=gap, velocity=base.velocity * scale)
        known = PreciseSolution(exact).motion(TIMES)[0] @ base.row
        worst = max(worst, float(np.abs(tips[run] - known).max() / np.abs(known).max()))
    return worst


def main() -> int:
    """Measure, print and judge; return 1 if a target was missed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--runs", type=int, default=100_000)
    parser.add_argument("--largest", type=int, default=GROWTH[-1], help="most runs of the growth")
    given = parser.parse_args()
    count = given.runs - given.runs % LANES
    model, base, drawn = problem(), published()[0], samples(count)
    # First, since the most memory that the others have had would hide what it takes.
    growth, beside = grown(model, given.largest)
    march, march_eight = loop(), eight_lanes()
    solvers: dict[str, Callable[[tuple[Array, Array, Array]], Array]] = {
        "bumpstop, lanes": lambda drawn: ours(model, drawn, lanes=True),
        "bumpstop, single runs": lambda drawn: ours(model, drawn, lanes=False),
        "numba loop": lambda drawn: peer(march, base, drawn),
        "numba, eight lanes": lambda drawn: peer(march_eight, base, drawn),
    }
    for solve in solvers.values():
        solve(samples(8 * LANES))  # compiles what numba compiles
    best = dict.fromkeys(solvers, 0.0)
    tips: dict[str, Array] = {}
    for _ in range(ROUNDS):
        for name, solve in solvers.items():
            start = perf_counter()
            tips[name] = solve(drawn)
            best[name] = max(best[name], count / (perf_counter() - start))
    exact = tips["bumpstop, lanes"]
    size = np.abs(exact).max(axis=1, keepdims=True)
    print(f"\n{count} problems, {OUTPUTS} outputs each, {usable_cores()} cores, best of {ROUNDS}")
    for name, rate in best.items():
        difference = float(np.max(np.abs(tips[name] - exact) / size))
        print(f"{name:24}{rate:12.0f} a second   from ours {difference:.1e}")
    apart = float(np.max(np.abs(tips["bumpstop, single runs"] - exact) / size))
    tips.clear()
    return judge(best, [worst_error(exact, drawn), apart], growth, beside)


def grown(model: bs.Problem, largest: int) -> tuple[dict[int, float], float]:
    """Return solutions a second by the number of runs, and the memory beside numbers in MB.

    The rate is of what more runs take: a call of one filled lane, which builds problem and
    Dataset, is taken off.
    """
    rates, beside = {}, 0.0
    solved(model, samples(LANES), lanes=True)  # loads what results need
    before = most_memory()
    fixed, _ = shortest(model, LANES)
    print(f"a call of {LANES} runs takes {fixed * 1e3:.2f} ms")
    heads = ("runs", "a second", "beside a call", "MB in and out", "MB beside")
    print("".join(f"{head:>15}" for head in heads))
    for count in (runs for runs in GROWTH if runs <= largest):
        seconds, numbers = shortest(model, count)
        rates[count] = (count - LANES) / (seconds - fixed)
        beside = max(beside, most_memory() - before - numbers)
        rest = f"{numbers:15.1f}{beside:15.1f}"
        print(f"{count:15}{count / seconds:15.0f}{rates[count]:15.0f}{rest}")
    return rates, beside


def shortest(model: bs.Problem, count: int) -> tuple[float, float]:
    """Return the shortest time of a call, and MB of what goes in and comes out."""
    drawn, best, left, numbers = samples(count), math.inf, SECONDS, 0.0
    while left > 0.0:
        start = perf_counter()
        found = solved(model, drawn, lanes=True)
        seconds = perf_counter() - start
        best, left = min(best, seconds), left - seconds
        numbers = found.nbytes / 1e6  # with the samples, which are its coordinates
        del found  # two at a time would count as memory beside them
    return best, numbers


def most_memory() -> float:
    """Return the most memory in MB that this process has had."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def judge(
    best: dict[str, float], errors: list[float], growth: dict[int, float], beside: float
) -> int:
    """Print each target with what was reached; return 1 if one was missed."""
    rate = best["bumpstop, lanes"]
    rates = growth.values()
    checks = [
        ("times the numba loop, at least 10", rate / best["numba loop"], 10.0),
        ("times eight lanes of numba, at least 2", rate / best["numba, eight lanes"], 2.0),
        ("1e-11 over the error against fifty digits, at least 1", 1e-11 / errors[0], 1.0),
        ("1e-11 over what lanes differ from single runs, at least 1", 1e-11 / errors[1], 1.0),
        ("slowest over fastest, whatever the runs, at least 0.7", min(rates) / max(rates), 0.7),
        ("room over the memory beside numbers, at least 1", ROOM / max(beside, 1.0), 1.0),
    ]
    print()
    for name, reached, least in checks:
        print(f"{'PASS' if reached >= least else 'MISS'}  {name}: {reached:.3g}")
    print(f"error against fifty digits: {errors[0]:.1e}")
    return 0 if all(reached >= least for _, reached, least in checks) else 1


if __name__ == "__main__":
    sys.exit(main())
