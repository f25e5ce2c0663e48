"""Several stops: what an event costs and how that grows, and which contacts others miss.

Run ``make bench``, or ``python benchmarks/several_stops.py [--quick]``. Times of the exact method
are the core's own, cold: every spectrum is made anew in each run. The other solvers call Python
functions, as their users write them, but for the loop, which numba has compiled.
"""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from statistics import median
from time import perf_counter

sys.path.insert(0, str(Path(__file__).parents[1]))  # the judge lives among the tests

from benchmarks.several.contacts import Contacts, Finder, missed
from benchmarks.several.cvode import Cvode
from benchmarks.several.exact import Effort, Exact
from benchmarks.several.numba_loop import NumbaLoop
from benchmarks.several.problems import FUNDAMENTAL, brief_touch, bundle, line
from benchmarks.several.scipy_events import ScipyEvents
from benchmarks.several.truth import truth_of

MODES = (10, 50, 200)
STOPS = (1, 4, 16)
LASTING_PERIODS = 60.0
TUBES = (1, 4, 16, 64)
TUBE_MODES = 10
WINDOW = 0.01 / FUNDAMENTAL  # s; a contact that is later or earlier by more is another one
DEPTHS = (1e-3, 1e-4)
BRIEF_PROBLEMS = 60
BRIEF_WINDOW = 1e-4  # s
SUITES: tuple[Finder, ...] = (ScipyEvents("DOP853", 1e-9), ScipyEvents("RK45", 1e-6), Cvode(1e-6))


def row(modes: int, stops: int, effort: Effort) -> str:
    """Return one line of the table of growth."""
    return (
        f"{modes:6}{stops:6}{effort.events:8}{effort.cells:8}{effort.sets:6}"
        f"{1e3 * effort.seconds:12.3f}{1e6 * effort.seconds / max(effort.events, 1):12.1f}"
        f"{1e6 * effort.seconds / effort.cells:10.2f}"
    )


def growth(modes: Sequence[int], stops: Sequence[int], runs: int) -> None:
    """Print what an event and a certified cell cost."""
    header = f"{'modes':>6}{'stops':>6}{'events':>8}{'cells':>8}{'sets':>6}"
    header += f"{'time ms':>12}{'us/event':>12}{'us/cell':>10}"
    print(f"A line between stops, three periods of its fundamental, cold\n{header}")
    for n in modes:
        for m in stops:
            problem = line(n, m)
            few = 1 if n * m > 500 else runs
            print(row(n, m, Exact().effort(problem, few)), flush=True)
    print(f"\nThe same without damping, {LASTING_PERIODS:.0f} periods: spectra are used again")
    print(header)
    for n in modes:
        for m in (m for m in stops if m <= 4):
            problem = line(n, m, damping_ratio=0.0, periods=LASTING_PERIODS)
            print(row(n, m, Exact().effort(problem, 1)), flush=True)


def bundles(tubes: Sequence[int], runs: int) -> None:
    """Print what an event costs in structures side by side that know nothing of each other."""
    print(f"\nLines of {TUBE_MODES} modes side by side, a stop each; modes of all together")
    print(f"{'modes':>6}{'stops':>6}{'events':>8}{'cells':>8}{'sets':>6}", end="")
    print(f"{'time ms':>12}{'us/event':>12}{'us/cell':>10}")
    for m in tubes:
        print(row(m * TUBE_MODES, m, Exact().effort(bundle(m, TUBE_MODES), runs)), flush=True)


def solver(name: str, found: Contacts, true: Contacts) -> str:
    """Return one line of the table of solvers."""
    return (
        f"  {name:44}{1e3 * found.seconds:12.3f}{found.seconds / true.seconds:10.1f}"
        f"{found.count:10}{missed(true, found, WINDOW):8}"
    )


def beside_others(modes: Sequence[int], stops: Sequence[int]) -> int:
    """Print times and missed contacts of all solvers; return how many of ours are wrong."""
    others: list[Finder] = [*SUITES, NumbaLoop()]
    NumbaLoop().find(line(10, 1))  # compiles
    wrong = 0
    print(f"\n{'':46}{'time ms':>12}{'ratio':>10}{'contacts':>10}{'missed':>8}")
    for n in modes:
        for m in stops:
            truth = truth_of(line(n, m))
            wrong += truth.wrong + (truth.judged is False)
            print(
                f"{n} modes, {m} stops, {truth.contacts.count} contacts in "
                f"{truth.problem.duration:.3f} s, {truth.wrong} samples of a scan against them"
                f"{', judged by matrix exponentials' if truth.judged else ''}"
            )
            print(solver(Exact.name, truth.contacts, truth.contacts), flush=True)
            for other in others:
                print(solver(other.name, other.find(truth.problem), truth.contacts), flush=True)
    return wrong


def brief_touches(problems: int) -> int:
    """Print which solvers miss a first, brief touch; return how many we missed.

    The others integrate the free motion with the distance as an event, as a program does that
    goes from event to event: the stop's force is none of their step control's business.
    """
    finders: list[Finder] = [Exact(), *SUITES]
    ours = 0
    for depth in DEPTHS:
        lacking = [0] * len(finders)
        seconds: list[list[float]] = [[] for _ in finders]
        for seed in range(problems):
            problem = brief_touch(depth, seed)
            first = truth_of(problem)
            ours += first.wrong + (first.judged is False)
            contacts = replace(first.contacts, closings=[first.contacts.closings[0][:1]])
            free = problem.but(stops=(replace(problem.stops[0], stiffness=0.0),))
            for n, finder in enumerate(finders):
                found = finder.find(problem if n == 0 else free)
                lacking[n] += missed(contacts, found, BRIEF_WINDOW) or not contacts.count
                seconds[n].append(found.seconds)
        print(f"\n{problems} free vibrations that touch a stop by {depth:.0e} of their swing")
        print(f"{'':46}{'time ms':>12}{'missed':>10}")
        for finder, lack, times in zip(finders, lacking, seconds, strict=True):
            print(f"  {finder.name:44}{1e3 * median(times):12.3f}{lack:10}", flush=True)
        ours += lacking[0]
    return ours


def main() -> int:
    """Print all tables; return 1 if we missed a contact or made one up."""
    parser = argparse.ArgumentParser(description="Time several stops, and count missed contacts.")
    parser.add_argument("--quick", action="store_true", help="small structures, few problems")
    quick = parser.parse_args().quick
    start = perf_counter()
    modes, stops = (MODES[:2], STOPS[:2]) if quick else (MODES, STOPS)
    growth(modes, stops, runs=3 if quick else 11)
    bundles(TUBES[:3] if quick else TUBES, runs=3)
    wrong = beside_others(modes, stops)
    wrong += brief_touches(10 if quick else BRIEF_PROBLEMS)
    print(f"\n{'PASS' if wrong == 0 else 'MISS'}  contacts that we missed or made up: {wrong}")
    print(f"in {perf_counter() - start:.0f} s")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
