"""Hold the core against the judge on many random problems of several stops.

``python -m tests.reference.campaign FIRST LAST [--family F] [--jobs N] [--precise]`` goes through
a range of seeds. It prints each problem that fails, a line of progress now and then that names
the seed to go on from, and what it all came to. Exit status 1 if anything failed. The judge is
the scan by matrix exponentials or, with ``--precise``, the one in fifty digits, over fifty events.
"""

import argparse
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial
from multiprocessing import Pool
from time import monotonic

from .several.coupled import random_coupled
from .several.forced import random_forced
from .several.grazing import random_grazing
from .several.multilinear import random_multilinear
from .several.precise import PreciseSeveral
from .several.random_problems import random_several
from .several.rigid import random_rigid
from .several.rubbing import random_rubbing
from .several.verdict import LARGEST_GROWTH, Verdict, compare

SECONDS_BETWEEN_LINES = 20.0
PRECISE_EVENTS = 50
LARGEST_RESIDUAL = 1e-9
FAMILIES = {
    "constant": random_several,
    "coupled": random_coupled,
    "forced": random_forced,
    "friction": random_rubbing,
    "grazing": random_grazing,
    "rigid": random_rigid,
    "springs": random_multilinear,
}


@dataclass(frozen=True)
class Outcome:
    """What one seed came to."""

    seed: int
    verdict: Verdict | None
    refusal: str = ""
    failure: str = ""


def outcome(seed: int, family: str, precise: bool) -> Outcome:
    """Solve one problem with both and compare."""
    from bumpstop._core import CoreError

    problem = FAMILIES[family](seed)
    try:
        problem.solve()  # what is refused is not judged
        judge = PreciseSeveral(problem, PRECISE_EVENTS, LARGEST_GROWTH) if precise else None
        verdict = compare(problem, judge)
    except CoreError as error:
        return Outcome(seed, None, refusal=kind(str(error)))
    except Exception as error:  # the campaign goes on, and tells
        return Outcome(seed, None, failure=repr(error))
    return Outcome(seed, verdict)


def kind(message: str) -> str:
    """Return a refusal without the numbers in it, so that alike ones are counted together."""
    words = (word for word in message.split() if not any(letter.isdigit() for letter in word))
    return " ".join(words)[:100]


@dataclass
class Summary:
    """What the seeds so far came to."""

    problems: int = 0
    events: int = 0
    missed: int = 0
    false: int = 0
    undecidable: int = 0
    inexact: int = 0
    unbalanced: int = 0
    broken: int = 0
    worst_error: float = 0.0
    worst_excess: float = 0.0
    worst_energy: float = 0.0
    refusals: Counter[str] = field(default_factory=Counter)

    def add(self, one: Outcome) -> str | None:
        """Count one; return what to say of it, if anything is wrong."""
        self.problems += 1
        if one.verdict is None:
            self.broken += bool(one.failure)
            self.refusals.update([one.refusal] if one.refusal else [])
            return one.failure or f"refused: {one.refusal}"
        verdict, difference = one.verdict, one.verdict.difference
        self.events += verdict.events
        self.worst_error = max(self.worst_error, verdict.error)
        self.worst_excess = max(self.worst_excess, verdict.excess)
        self.worst_energy = max(self.worst_energy, verdict.energy)
        if verdict.undecidable:
            self.undecidable += 1
        elif difference is not None:
            self.missed += difference.missed
            self.false += not difference.missed
            word = "missed" if difference.missed else "false"
            return f"{word} event of stop {difference.stop} at {difference.time:.17g} s"
        if verdict.excess > 1:
            self.inexact += 1
            return (
                f"error {verdict.error:.1e} is {verdict.excess:.1f} times what is allowed, "
                f"growth {verdict.growth:.1e}, {verdict.events} events"
            )
        if verdict.energy > LARGEST_RESIDUAL:
            self.unbalanced += 1
            return f"energy residual {verdict.energy:.1e}"
        return None

    @property
    def passed(self) -> bool:
        """Whether nothing failed."""
        return not (self.missed or self.false or self.inexact or self.unbalanced or self.broken)

    def lines(self) -> Iterator[str]:
        """Yield the summary."""
        yield (
            f"{self.problems} problems, {self.events} events: {self.missed} missed, "
            f"{self.false} false, {self.undecidable} decided by rounding, "
            f"{self.inexact} inexact, {self.unbalanced} unbalanced, {self.broken} not judged, "
            f"{self.refusals.total()} refused"
        )
        yield (
            f"worst error {self.worst_error:.1e}, {self.worst_excess:.2g} of what is allowed; "
            f"worst energy residual {self.worst_energy:.1e}"
        )
        for message, count in self.refusals.most_common():
            yield f"{count} refused: {message}"


def main() -> int:
    """Run the seeds asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--family", choices=FAMILIES, default="constant")
    parser.add_argument("--precise", action="store_true")
    arguments = parser.parse_args()
    judged = partial(outcome, family=arguments.family, precise=arguments.precise)
    seeds = range(arguments.first, arguments.last)
    summary, began, said = Summary(), monotonic(), monotonic()
    with Pool(arguments.jobs) as pool:
        for one in pool.imap(judged, seeds, chunksize=1 if arguments.precise else 16):
            wrong = summary.add(one)
            if wrong:
                print(f"{one.seed}: {wrong}", flush=True)
            if monotonic() - said > SECONDS_BETWEEN_LINES:
                said = monotonic()
                rate = summary.problems / (said - began)
                print(f"-- next {one.seed + 1}, {rate:.0f} a second", flush=True)
    print(*summary.lines(), sep="\n")
    return 0 if summary.passed else 1


if __name__ == "__main__":
    sys.exit(main())
