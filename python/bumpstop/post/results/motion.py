"""Results about the kind of a motion: periodic or chaotic."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import count
from bumpstop.post.results.reading import Drawn, Fact, Reading, check_period, check_span
from bumpstop.quantities import Quantity

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = ["Chaos", "Section"]


@dataclass(frozen=True)
class Section:
    """A Poincaré section by the clock of the load; see `stroboscopic_section`."""

    name: str
    _: KW_ONLY
    node: str
    dof: str
    period: float
    phase: float = 0.0
    start: float = 0.0

    def check(self, problem: Problem) -> None:
        """Raise where there is no such node, or the time is not within the run."""
        problem.basis.row(self.node, self.dof)
        check_span(self.start, None, problem)
        check_period(self.period, self.start, problem)

    def read(self, response: Response) -> Reading:
        """Read velocities over displacements, and after how many periods the motion repeats."""
        from bumpstop.post.poincare import periodicity

        repeats = periodicity(response, self.period, start=self.start)
        what = Quantity("1", "periods after which the motion repeats itself")
        multiple = float(repeats.multiple) if repeats.multiple is not None else math.nan
        return Reading([Fact(what, multiple)], [Drawn(self.plane(response))])

    def plane(self, response: Response) -> xr.DataArray:
        """Return the velocities of the section over its displacements, in ascending order."""
        import xarray as xr

        from bumpstop.post.poincare import stroboscopic_section

        found = stroboscopic_section(
            response, self.node, self.dof, self.period, phase=self.phase, start=self.start
        )
        order = np.argsort(found["displacement"].values, kind="stable")
        places = ("displacement", found["displacement"].values[order], found["displacement"].attrs)
        title = f"Poincaré section of {self.node} {self.dof}"
        return xr.DataArray(
            found["velocity"].values[order],
            dims="displacement",
            coords={"displacement": places},
            name="velocity",
            attrs=found["velocity"].attrs | {"title": title},
        )


@dataclass(frozen=True)
class Chaos:
    """Lyapunov exponents; see `lyapunov_exponents`."""

    name: str
    _: KW_ONLY
    exponents: int = 1
    start: float = 0.0

    def check(self, problem: Problem) -> None:
        """Raise where the time is not within the run, or there are not so many exponents."""
        check_span(self.start, None, problem)
        most = 2 * len(problem.basis.omega2)
        count("exponents", self.exponents, most=most)

    def read(self, response: Response) -> Reading:
        """Read the exponents, and how the largest one converges."""
        from bumpstop.post.lyapunov import lyapunov_exponents

        found = lyapunov_exponents(response, exponents=self.exponents, start=self.start)
        facts = [
            Fact(Quantity("1/s", f"Lyapunov exponent {number}"), float(value))
            for number, value in enumerate(found.values, start=1)
        ]
        return Reading(facts, [Drawn(found.convergence.sel(exponent=1))])
