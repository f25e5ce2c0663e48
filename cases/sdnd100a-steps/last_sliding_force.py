"""Coulomb friction that sticks from the last sliding force on, as the published steps have it."""

import sys
from math import copysign, sqrt

HOLDS = 1.0
"""mu N, in N."""
STIFFNESS = 4e5
"""Of the stick, in N/m."""
DAMPING = 2.0 * sqrt(2.0 * (2e4 + STIFFNESS))
"""Of the stick, in N s/m, with the modal mass of 2 kg and the modal stiffness of 2e4 N/m."""
STILL = 1e-6
"""Speed in m/s up to which nothing slides."""


class Floor:
    """What the floor remembers from step to step."""

    def __init__(self) -> None:
        self.place: float | None = None
        """Where it slid last, in m."""
        self.force = 0.0
        """The force then, in N."""
        self.speed = 0.0
        """That of the step before, in m/s."""
        self.sticks = False

    def answer(self, place: float, speed: float) -> float:
        """Return the force on the mass over a step, in N."""
        if self.place is None:
            self.place = place
        slides_on = not self.sticks and speed * self.speed >= 0.0 and abs(speed) > STILL
        self.speed = speed
        if not slides_on:
            force = self.force - STIFFNESS * (place - self.place) - DAMPING * speed
            if abs(force) <= HOLDS:
                self.sticks = True
                return force
        self.sticks = False
        self.place, self.force = place, -copysign(HOLDS, speed)
        return self.force


def main() -> None:
    """Answer each line with one, until there are no more."""
    floor = Floor()
    for line in sys.stdin:
        _, place, speed = (float(part) for part in line.split())
        print(repr(floor.answer(place, speed)), flush=True)


if __name__ == "__main__":
    main()
