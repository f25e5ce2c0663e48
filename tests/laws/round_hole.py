"""A mass in a round hole, and an integration of it that shares nothing with the core."""

from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

import bumpstop as bs

AXES = ("dx", "dy", "dz")


def free_mass(omega: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> bs.ModalBasis:
    """A mass of 1 kg on three springs; their angular frequencies in rad/s."""
    shapes = {("P", axis): np.eye(3)[n].tolist() for n, axis in enumerate(AXES)}
    frequency = [w / (2.0 * np.pi) for w in omega]
    return bs.ModalBasis.from_modes(frequency=frequency, damping=[0.0] * 3, shapes=shapes)


class Hole(NamedTuple):
    """A stop about the x axis in numbers, with friction."""

    reach: float
    stiffness: float
    damping: float = 0.0
    static: float = 0.0
    dynamic: float = 0.0
    tangential_stiffness: float = 1.0
    tangential_damping: float = 1.0

    def stop(self, **changes: Any) -> bs.CircleStop:
        """The law."""
        usual: dict[str, Any] = {
            "node": "P",
            "axis": (1, 0, 0),
            "radius": self.reach,
            "stiffness": self.stiffness,
            "damping": self.damping,
        }
        if self.static:
            usual |= {
                "friction": {"static": self.static, "dynamic": self.dynamic},
                "tangential_stiffness": self.tangential_stiffness,
                "tangential_damping": self.tangential_damping,
            }
        return bs.CircleStop("hole", **usual | changes)

    def rates(self, y: Any, state: str, omega: Any, force: Any) -> Any:
        """Rates of place, velocity, stretch around and along the axis, in a state of the stop."""
        place, speed, stretch = y[:3], y[3:6], y[6:]
        total = force - omega**2 * place
        stretching = np.zeros(2)
        if state in ("closed", "stick", "slip"):
            angle = np.arctan2(place[2], place[1])
            inwards = -np.array([0.0, np.cos(angle), np.sin(angle)])
            around = np.array([0.0, np.sin(angle), -np.cos(angle)])
            depth = np.hypot(place[1], place[2]) - self.reach
            push = self.stiffness * depth - self.damping * (inwards @ speed)
            sliding = np.array([around @ speed, speed[0]])
            total = total + push * inwards
            held = self.tangential_stiffness * stretch + self.tangential_damping * sliding
            if state == "stick":
                total = total - held[0] * around - held[1] * np.array([1.0, 0.0, 0.0])
                stretching = sliding
            elif state == "slip":
                limit, size = self.dynamic * push, np.hypot(*held)
                rub = limit * held / size
                total = total - rub[0] * around - rub[1] * np.array([1.0, 0.0, 0.0])
                stretching = (rub - self.tangential_stiffness * stretch) / self.tangential_damping
        return np.concatenate([speed, total, stretching])

    def follow(self, response: bs.Response, start: Any, omega: Any, force: Any) -> list[Any]:
        """Integrate by SciPy from switch to switch of a run; the motions at all of them."""
        table = response.event_table()
        ends = [*table["time"], response.problem.duration]
        first = str(response.sample("state", "hole", times=[0.0])[0])
        states = [first, *table["after"]]
        y, at, found = np.array([*start, 0.0, 0.0]), 0.0, []
        for state, end in zip(states, ends, strict=True):
            run = solve_ivp(
                lambda _, y, state=state: self.rates(y, state, omega, force),
                (at, end),
                y,
                method="DOP853",
                rtol=1e-12,
                atol=1e-15,
            )
            y, at = run.y[:, -1].copy(), end
            if state == "open":
                y[6:] = 0.0
            found.append(y)
        return found
