"""Published values, and how far a response or its modes are from them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, count, not_negative, one_of, series
from bumpstop.errors import InputError
from bumpstop.post.impacts import impacts_of
from bumpstop.quantities import (
    ENERGIES,
    FREQUENCY,
    IMPACTS,
    QUANTITIES,
    STATISTICS,
    dof_units,
)

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = [
    "REFERENCE_QUANTITIES",
    "Check",
    "Reference",
    "check_frequencies",
    "check_references",
    "computed",
]

TARGETS = ("node", "dof", "mode", "modes", "stop", "gauge", "term", "impact")

IMPACT_COLUMNS = {
    "impact_start": "start",
    "impact_end": "end",
    "impact_duration": "duration",
    "closing_speed": "closing_speed",
    "opening_speed": "opening_speed",
    "peak_force": "peak_force",
    "peak_time": "peak_time",
    "impulse": "impulse",
    "energy_returned": "energy_returned",
}
"""Quantities of an impact, and the column of the impact table that each is."""

UNSAMPLED = ("opening_speed", "energy_returned")
"""Quantities of an impact that samples of the force do not have."""

REFERENCE_QUANTITIES: dict[str, tuple[str, ...]] = {
    **{quantity: what.target for quantity, what in QUANTITIES.items()},
    "energy": ("term",),
    "frequency": ("modes",),
    **dict.fromkeys(IMPACT_COLUMNS, ("stop", "impact")),
    **{quantity: what.target for quantity, what in STATISTICS.items()},
}
"""Each quantity that can be compared, and what says of which part it is."""


@dataclass(frozen=True, kw_only=True)
class Reference:
    """Values that somebody published, closed forms among them.

    Parameters
    ----------
    quantity
        What they are values of: a quantity of time (``displacement``, ``velocity``,
        ``acceleration`` of a ``node`` and ``dof``, ``modal_displacement`` of a ``mode``
        counted from 1, ``stop_force`` and ``gap`` of a ``stop``, ``gauge`` of a ``gauge``,
        ``energy`` of a ``term`` of the ledger), one of an ``impact`` of a ``stop``, counted
        from 1 (``impact_start``, ``impact_end``, ``impact_duration``, ``closing_speed``,
        ``opening_speed``, ``peak_force``, ``peak_time``, ``impulse``, ``energy_returned``),
        one of the contact statistics of a ``stop`` over the run (``impact_count``,
        ``mean_force``, ``largest_force`` and the others of `contact_statistics`), or the natural
        ``frequency`` of some ``modes``, without damping and spin, in Hz.
    times
        Instants in s, one a value; none for a quantity of an impact, a statistic and for
        frequencies.
    values
        The published values in SI units; one for a quantity of an impact and a statistic, one
        a mode for frequencies.
    tolerance
        Largest deviation relative to the size of the value.
    absolute_tolerance
        Largest deviation in the quantity's own unit; give this or `tolerance`.
    node, dof, mode, modes, stop, gauge, term, impact
        What it is the quantity of. Modes count from 1; for a frequency `mode` may stand
        instead of `modes`.
    sampled
        True where a quantity of an impact is that of the samples at the response's times, as
        `sampled_impacts` counts them, instead of that of the solution between them.
    source
        Where the values come from.
    of_model
        True where the values were computed with this very model, its modes and its mesh: they do
        not tell it from a finer one.

    Raises
    ------
    InputError
        If the quantity is unknown, what it needs is missing, or there are not as many times
        or modes as values.
    """

    quantity: str
    values: Sequence[float] | FloatArray
    times: Sequence[float] | FloatArray = ()
    tolerance: float | None = None
    absolute_tolerance: float | None = None
    node: str | None = None
    dof: str | None = None
    mode: int | None = None
    modes: Sequence[int] | None = None
    stop: str | None = None
    gauge: str | None = None
    term: str | None = None
    impact: int | None = None
    sampled: bool = False
    source: str = ""
    of_model: bool = False

    def __post_init__(self) -> None:
        one_of("quantity", self.quantity, tuple(REFERENCE_QUANTITIES))
        object.__setattr__(self, "values", series("values", self.values))
        object.__setattr__(self, "times", series("times", self.times) if len(self.times) else ())
        if self.quantity == "frequency":
            self._take_modes()
        self._check_target()
        self._check_lengths()
        self._check_tolerances()

    @property
    def target(self) -> tuple[str, *tuple[str | int, ...]]:
        """The quantity and what it is that of, as `Response.sample` takes them."""
        if self.quantity == "frequency":
            return (self.quantity,)
        parts = (getattr(self, key) for key in REFERENCE_QUANTITIES[self.quantity])
        return (self.quantity, *parts)

    @property
    def units(self) -> str:
        """Unit of the values."""
        if self.dof is not None:
            return dof_units(self.quantity, self.dof)
        if self.quantity == "energy":
            return ENERGIES[str(self.term)].units
        if self.quantity == "frequency":
            return FREQUENCY.units
        if self.impact is not None:
            return IMPACTS[IMPACT_COLUMNS[self.quantity]].units
        if self.quantity in STATISTICS:
            return STATISTICS[self.quantity].units
        return QUANTITIES[self.quantity].units

    def check_target(self, problem: Problem) -> None:
        """Check that a problem has what this is of, for long enough.

        Raises
        ------
        InputError
            If it has no such mode, node, stop or gauge, or ends before the last instant.
        """
        self.check_modes(problem.basis)
        if len(self.times) and self.times[-1] > problem.duration:
            raise InputError(
                "is after the end of the run",
                key=f"times.{len(self.times) - 1}",
                value=self.times[-1],
                hint=f"run.duration is {problem.duration:g} s",
            )
        if self.node is not None:
            problem.basis.row(self.node, str(self.dof))
        if self.stop is not None:
            laws = [law.name for law in problem.laws]
            one_of("stop", self.stop, laws if self.quantity in QUANTITIES else problem.stop_names)
        if self.gauge is not None:
            one_of("gauge", self.gauge, [gauge.name for gauge in problem.gauges])

    def check_modes(self, basis: ModalBasis) -> None:
        """Raise an InputError where a basis has no such mode."""
        for number, mode in enumerate(self.modes or ()):
            if mode > len(basis.omega2):
                key = f"modes.{number}"
                raise InputError(f"must be at most {len(basis.omega2)}", key=key, value=mode)
        modes = len(basis.labels)
        if self.mode is not None and self.mode > modes:
            raise InputError(f"must be at most {modes}", key="mode", value=self.mode)

    def _take_modes(self) -> None:
        """Take a single mode as a list of one."""
        if self.mode is not None:
            if self.modes is not None:
                raise InputError("give either mode or modes", key="modes", value=self.modes)
            object.__setattr__(self, "modes", [self.mode])
            object.__setattr__(self, "mode", None)
        if self.modes is not None:
            object.__setattr__(self, "modes", tuple(count("modes", mode) for mode in self.modes))

    def _check_target(self) -> None:
        wanted = REFERENCE_QUANTITIES[self.quantity]
        for key in TARGETS:
            given = getattr(self, key)
            if key in wanted and given is None:
                raise InputError(f"is needed for {self.quantity}", key=key)
            if key not in wanted and given is not None:
                what = f"does not belong to {self.quantity}"
                hint = f"it is that of a {' and a '.join(wanted)}"
                raise InputError(what, key=key, value=given, hint=hint)
        for key in ("mode", "impact"):
            if key in wanted:
                count(key, getattr(self, key))
        if self.sampled and (self.impact is None or self.quantity in UNSAMPLED):
            what = f"{self.quantity} has no definition by samples"
            raise InputError(what, key="sampled", value=self.sampled)
        if self.term is not None:
            one_of("term", self.term, tuple(ENERGIES))

    def _check_lengths(self) -> None:
        if self.impact is not None or self.quantity in STATISTICS:
            if self.times or len(self.values) != 1:
                of = "of one impact" if self.impact is not None else "of the whole run"
                what = f"{self.quantity} is one value {of}, without times"
                raise InputError(what, key="values", value=self.values)
        elif self.modes is not None:
            self._check_modes(self.modes)
        elif len(self.times) != len(self.values):
            what = f"must be as many as there are values, {len(self.values)}"
            raise InputError(what, key="times", value=self.times)

    def _check_modes(self, modes: Sequence[int]) -> None:
        if len(self.times):
            raise InputError("frequencies have no times", key="times", value=self.times)
        if len(modes) != len(self.values):
            what = f"must be as many as there are values, {len(self.values)}"
            raise InputError(what, key="modes", value=modes)

    def _check_tolerances(self) -> None:
        both = ("tolerance", "absolute_tolerance")
        given = [key for key in both if getattr(self, key) is not None]
        if len(given) != 1:
            raise InputError("give either tolerance or absolute_tolerance", key="tolerance")
        object.__setattr__(self, given[0], not_negative(given[0], getattr(self, given[0])))
        if self.tolerance is not None and 0.0 in self.values:
            hint = "give absolute_tolerance"
            raise InputError("nothing is relative to a value of 0", key="tolerance", hint=hint)


@dataclass(frozen=True, kw_only=True)
class Check:
    """One published value beside the computed one.

    ``deviation`` is the size of the difference, relative to that of the reference, or in the
    quantity's unit where the tolerance is ``absolute``. ``time`` is in s; for a quantity of an
    impact it is the instant of closing, for a statistic the end of the run. Where there is no
    such impact, ``value``, ``deviation`` and ``time`` are NaN; where it has not ended yet,
    ``value`` and ``deviation`` may be. A NaN never passes. A frequency has the ``mode`` that it
    is the frequency of, counted from 1, and no time: that is NaN.
    """

    quantity: str
    target: tuple[str, *tuple[str | int, ...]]
    units: str
    time: float
    value: float
    reference: float
    deviation: float
    tolerance: float
    absolute: bool
    passed: bool
    source: str
    of_model: bool
    mode: int | None = None

    @property
    def missing(self) -> str:
        """Why there is no computed value; empty where there is one."""
        if not math.isnan(self.value):
            return ""
        return "no such impact" if math.isnan(self.time) else "still closed"

    @property
    def tolerance_used(self) -> float:
        """The deviation as a fraction of the tolerance, infinite where nothing can meet it."""
        if math.isnan(self.deviation):
            return math.inf
        if self.tolerance == 0.0:
            return 0.0 if self.deviation == 0.0 else math.inf
        return self.deviation / self.tolerance


def check_references(response: Response, references: Iterable[Reference]) -> list[Check]:
    """Compare a response with published values, one check a value.

    Raises
    ------
    InputError
        If the problem has no such node, stop, gauge or mode, or an instant is outside the
        simulated time.
    """
    checks = []
    for reference in references:
        if reference.modes is not None:
            checks += check_frequencies(response.problem.basis, [reference])
            continue
        times, values = computed(response, reference)
        for time, value, published in zip(times, values, reference.values, strict=True):
            checks.append(_check(reference, float(time), float(value), published))
    return checks


def check_frequencies(basis: ModalBasis, references: Iterable[Reference]) -> list[Check]:
    """Compare the natural frequencies of a basis with published ones, one check a value.

    Modes are compared in their order: of a multiple frequency each counts.

    Raises
    ------
    InputError
        If a reference is not of frequencies, or the basis has no such mode.
    """
    frequencies = basis.frequencies.tolist()
    checks = []
    for reference in references:
        if reference.modes is None:
            what = "is not a frequency"
            raise InputError(what, key="quantity", value=reference.quantity)
        for mode, published in zip(reference.modes, reference.values, strict=True):
            if mode > len(frequencies):
                raise InputError(f"must be at most {len(frequencies)}", key="modes", value=mode)
            check = _check(reference, math.nan, frequencies[mode - 1], published)
            checks.append(replace(check, mode=mode))
    return checks


def computed(response: Response, reference: Reference) -> tuple[FloatArray, FloatArray]:
    """Return instants in s and the values of a response there, each (n,); not for frequencies.

    NaN stand for an impact that there was not.
    """
    times = np.array(reference.times)
    if reference.impact is not None:
        return _of_impact(response, reference)
    if reference.quantity == "energy":
        return times, response.energy_terms(times)[str(reference.term)]
    if reference.quantity in STATISTICS:
        return _of_run(response, reference)
    return times, response.sample(*reference.target, times=times)


def _of_run(response: Response, reference: Reference) -> tuple[FloatArray, FloatArray]:
    from bumpstop.post.statistics import contact_statistics

    found = contact_statistics(response, str(reference.stop), blocks=1)
    return np.array([response.problem.duration]), np.array([found[reference.quantity]])


def _of_impact(response: Response, reference: Reference) -> tuple[FloatArray, FloatArray]:
    law = response.stop_index(str(reference.stop))
    if reference.sampled:
        from bumpstop.post.sampled import samples_of

        table = samples_of(response, law)
    else:
        table = impacts_of(response, law)
    number = reference.impact
    if number is None or number > len(table["start"]):
        return np.array([math.nan]), np.array([math.nan])
    column = table[IMPACT_COLUMNS[reference.quantity]]
    return table["start"][number - 1 : number], column[number - 1 : number]


def _check(reference: Reference, time: float, value: float, published: float) -> Check:
    deviation = abs(value - published)
    if reference.absolute_tolerance is not None:
        tolerance = reference.absolute_tolerance
    else:
        deviation /= abs(published)
        tolerance = reference.tolerance or 0.0
    return Check(
        quantity=reference.quantity,
        target=reference.target,
        units=reference.units,
        time=time,
        value=value,
        reference=published,
        deviation=deviation,
        tolerance=tolerance,
        absolute=reference.absolute_tolerance is not None,
        passed=deviation <= tolerance,
        source=reference.source,
        of_model=reference.of_model,
    )
