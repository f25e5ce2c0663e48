"""A relay with hysteresis: it reads step, displacement and velocity, and writes a force."""

import sys

FORCE, SIDE = 2.0, 10e-3
"""In N, and in m."""


def main() -> None:
    """Answer each line with one, until there are no more."""
    push = -FORCE
    for line in sys.stdin:
        _, place, _ = line.split()
        if float(place) > SIDE:
            push = -FORCE
        elif float(place) < -SIDE:
            push = FORCE
        print(push, flush=True)


if __name__ == "__main__":
    main()
