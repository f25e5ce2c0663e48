"""Compare the core with the oracle on many random problems: ``python -m tests.reference.campaign``.

Prints every problem whose events differ and the worst differences.
"""

import argparse

from .comparison import compare
from .random_problems import random_problem


def main() -> None:
    """Run the seeds asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    arguments = parser.parse_args()
    worst_state = worst_event = 0.0
    events = 0
    for seed in range(arguments.first, arguments.last):
        try:
            result = compare(random_problem(seed))
        except Exception as error:
            print(f"{seed}: {error!r}", flush=True)
            continue
        state, event = result.state_error / result.growth, result.event_error / result.growth
        if not result.same_events or max(state, event) > 1e-12:
            print(
                f"{seed}: {len(result.expected)} expected, {len(result.found)} found, "
                f"state {state:.1e}, event {event:.1e}, margin {result.margin:.1e}",
                flush=True,
            )
        if result.same_events:
            worst_state, worst_event = max(worst_state, state), max(worst_event, event)
        events += len(result.expected)
    count = arguments.last - arguments.first
    print(f"{count} problems, {events} events, worst {worst_state:.1e}, {worst_event:.1e}")


if __name__ == "__main__":
    main()
