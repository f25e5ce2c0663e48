"""Wear: the work of sliding contacts, and the volume that wear laws make of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray, finite, not_negative, positive, series
from bumpstop.errors import InputError
from bumpstop.post.contacts import integrals_of, loaded_spans
from bumpstop.post.impacts import impacts_of
from bumpstop.post.of_run import of_run
from bumpstop.post.sliding import sliding_speed
from bumpstop.post.spans import Spans, spans_within, state_spans

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.post.scars import Scar
    from bumpstop.response import Response

__all__ = [
    "ArchardWear",
    "EdfWear",
    "KwuEpriWear",
    "WearLaw",
    "WearWork",
    "check_wear",
    "sliding_spans",
    "time_window",
    "wear",
    "wear_work",
]

SMOOTH = 1e-10
"""Tolerance of integrals of speeds, which have kinks where the sliding turns."""
LOOKS = 400
"""Samples of each contact, of which classes of force and speed are made."""


@dataclass(frozen=True, eq=False)
class WearWork:
    """What the contacts of a stop do to the surfaces; see `wear_work`.

    Attributes
    ----------
    work
        Integral of the normal force times the sliding speed, in J.
    distance
        Integral of the sliding speed over the time loaded, in m.
    time
        Time looked at, in s.
    force, speed
        Samples of both while loaded, in N and m/s, (n,).
    weight
        Part of the time loaded that each sample stands for, (n,).
    """

    work: float
    distance: float
    time: float
    force: FloatArray
    speed: FloatArray
    weight: FloatArray

    @property
    def rate(self) -> float:
        """Work rate in W, the mean over all the time looked at."""
        return self.work / self.time


@of_run
def wear_work(
    response: Response, stop: str, *, start: float = 0.0, end: float | None = None
) -> WearWork:
    """Return the work of sliding in the contacts of a stop.

    The work rate, the mean of normal force times sliding speed, is what wear is told by (P. L. Ko
    and H. Basista, Journal of Pressure Vessel Technology 106 (1984) 338-344; N. J. Fisher, A. B.
    Chow and M. K. Weckwerth, same journal 117 (1995) 312-320). The sliding speed is that of the
    node along the obstacle as seen from there: against the other node where there is one, and
    with the motion of supports that carry the structure past an obstacle which stands still;
    while friction holds it, there is none.

    Parameters
    ----------
    response
        The run.
    stop
        Name of the stop.
    start, end
        The time looked at, in s; all of the run where left out.

    Raises
    ------
    InputError
        If there is no such stop, it is a rigid one, or no sliding direction is known.

    Examples
    --------
    A mass of 2 kg that slides to rest under its weight has lost its kinetic energy by friction.

    >>> import bumpstop as bs
    >>> shapes = {("P", "dx"): [0.5**0.5, 0.0], ("P", "dz"): [0.0, 0.5**0.5]}
    >>> basis = bs.ModalBasis.from_modes(frequency=[0.0, 0.0], shapes=shapes)
    >>> floor = bs.Stop("floor", node="P", normal=(0, 0, 1), gap=-2e-4, stiffness=1e5,
    ...                 friction=0.5, sliding=(1, 0, 0), tangential_stiffness=1e6)
    >>> weight = bs.NodalForce("weight", node="P", force=(0, 0, -20.0))
    >>> thrown = bs.ModalState(velocity=[3.0 * 2**0.5, 0.0])
    >>> run = bs.simulate(bs.Problem(basis, laws=[floor], loads=[weight], initial=thrown,
    ...                              duration=0.6))
    >>> print(f"{0.5 * bs.wear_work(run, 'floor').work:.3f} J")
    9.000 J
    """
    first, last = time_window(response, start, end)
    law = response.stop_index(stop)
    spans = spans_within(sliding_spans(response, stop), first, last)
    speed = sliding_speed(response, law)

    def powers(times: FloatArray) -> FloatArray:
        sliding = speed(times)
        return np.stack([_force(response, law, times) * sliding, sliding], axis=1)

    work, distance = integrals_of(response, spans, powers, SMOOTH).sum(axis=0).tolist()
    loaded = spans_within(loaded_spans(response, stop, 0.0), first, last)
    times, weight = _looks(loaded)
    sliding = speed(times) * _within(times, spans)
    force = _force(response, law, times)
    return WearWork(work, distance, last - first, force, sliding, weight)


class WearLaw(Protocol):
    """What makes a worn volume of the work of contacts."""

    def volume(self, work: WearWork, times: FloatArray) -> FloatArray:
        """Return the volume in m3 after some service times in s."""


@dataclass(frozen=True)
class ArchardWear:
    """V = K W t, with the work rate W.

    J. F. Archard, Journal of Applied Physics 24 (1953) 981-988.

    Parameters
    ----------
    coefficient
        Wear coefficient K in m3/J = 1/Pa.
    """

    coefficient: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "coefficient", not_negative("coefficient", self.coefficient))

    def volume(self, work: WearWork, times: FloatArray) -> FloatArray:
        """Return the volume in m3 after some service times in s."""
        return self.coefficient * work.rate * times


@dataclass(frozen=True)
class EdfWear:
    """A rate of wear that falls from A W^b to S as the scar becomes smooth.

    V = S t + (A W^b - S) (1 - exp(-n t)) / n, with the work rate W in W: the law EDF_MZ of
    code_aster's POST_USURE, with its default values.

    Parameters
    ----------
    coefficient
        A, in m3/s at a work rate of 1 W.
    exponent
        b.
    threshold
        S, in m3/s, the rate at last.
    slowing
        n, in 1/s.
    """

    _: KW_ONLY
    coefficient: float = 1e-13
    exponent: float = 1.2
    threshold: float = 1.14e-16
    slowing: float = 2.44e-8

    def __post_init__(self) -> None:
        for key in ("coefficient", "exponent", "threshold"):
            object.__setattr__(self, key, not_negative(key, getattr(self, key)))
        object.__setattr__(self, "slowing", positive("slowing", self.slowing))

    def volume(self, work: WearWork, times: FloatArray) -> FloatArray:
        """Return the volume in m3 after some service times in s.

        Raises
        ------
        InputError
            If the rate would rise: the work rate is too low for the law.
        """
        first: float = self.coefficient * work.rate**self.exponent
        if first < self.threshold:
            what = f"is above the rate of wear at first, {first:.3g} m3/s"
            raise InputError(what, key="threshold", value=self.threshold)
        slowed: FloatArray = -np.expm1(-self.slowing * times) / self.slowing
        return self.threshold * times + (first - self.threshold) * slowed


@dataclass(frozen=True)
class KwuEpriWear:
    """Archard's law times a factor for how impacts and sliding share the contacts.

    Normal force F in N and sliding speed v in m/s of the time loaded are sorted into five classes
    each, up to their largest values; f is a class's part of the time loaded, F and v are those of
    its middle. Impacts, the classes of the lowest speed, harden the surface, the others wear it:
    p = sum f k_n K (F / C)^3, s = sum f k_t F v^2, and V = K_w s^2 / (s + p) W t. The class that is
    lowest in both is in both sums. This is the law KWU_EPRI of code_aster's POST_USURE, whose
    classes of force are as wide as a whole number of N; here they are a fifth of the largest force.

    Parameters
    ----------
    coefficient
        Wear coefficient K_w, in m3/J where the factor is one.
    impact, sliding
        Coefficients k_n and k_t.
    hardening
        Constant K.
    reference_force
        Constant C in N.
    """

    coefficient: float
    _: KW_ONLY
    impact: float
    sliding: float
    hardening: float = 5.0
    reference_force: float = 10.0

    def __post_init__(self) -> None:
        for key in ("coefficient", "impact", "sliding", "hardening"):
            object.__setattr__(self, key, not_negative(key, getattr(self, key)))
        reference = positive("reference_force", self.reference_force)
        object.__setattr__(self, "reference_force", reference)

    def factor(self, work: WearWork) -> float:
        """Return s^2 / (s + p)."""
        force, speed = (float(values.max(initial=0.0)) for values in (work.force, work.speed))
        if not force or not speed:
            return 0.0
        edges = [np.linspace(0.0, force, 6), np.linspace(0.0, speed, 6)]
        part, _, _ = np.histogram2d(work.force, work.speed, bins=edges, weights=work.weight)
        f, v = (0.5 * (edge[1:] + edge[:-1]) for edge in edges)
        impacts = self.impact * self.hardening * (f / self.reference_force) ** 3
        rubs = self.sliding * np.outer(f, v**2)
        rubs[1:, 0] = 0.0
        struck, rubbed = float(part[:, 0] @ impacts), float((part * rubs).sum())
        return rubbed**2 / (rubbed + struck) if rubbed else 0.0

    def volume(self, work: WearWork, times: FloatArray) -> FloatArray:
        """Return the volume in m3 after some service times in s."""
        return self.coefficient * self.factor(work) * work.rate * times


@of_run
def wear(
    response: Response,
    stop: str,
    law: WearLaw,
    times: Sequence[float] | FloatArray,
    *,
    scar: Scar | None = None,
    start: float = 0.0,
    end: float | None = None,
) -> xr.Dataset:
    """Return the wear at a stop after times of service that a run stands for.

    Parameters
    ----------
    response
        The run.
    stop
        Name of the stop.
    law
        ``ArchardWear``, ``EdfWear`` or ``KwuEpriWear``.
    times
        Times of service in s.
    scar
        Shape of the scar, for its depth: ``FlatScar``, ``HoleScar``, ``PadScar``.
    start, end
        The part of the run that the service is like, in s; all of it where left out.

    Returns
    -------
    xarray.Dataset
        ``volume`` in m3 and, with a scar, ``depth`` in m over ``service`` time in s; the work rate
        in W as the attribute ``work_rate``.

    Raises
    ------
    InputError
        As `wear_work` does, or if a time is negative.
    """
    import xarray as xr

    check_wear(law, scar)
    service = np.array([not_negative("times", time) for time in series("times", times)])
    work = wear_work(response, stop, start=start, end=end)
    volume = law.volume(work, service)
    found = {"volume": ("service", volume, {"units": "m^3", "long_name": "worn volume"})}
    if scar is not None:
        depth = np.array([scar.depth(float(each)) for each in volume])
        found["depth"] = ("service", depth, {"units": "m", "long_name": "depth of the scar"})
    where = {"service": ("service", service, {"units": "s", "long_name": "time of service"})}
    return xr.Dataset(found, coords=where, attrs={"stop": stop, "work_rate": work.rate})


def check_wear(law: object, scar: object) -> None:
    """Raise where something is no wear law, or no scar."""
    if not callable(getattr(law, "volume", None)):
        hint = "such as ArchardWear(1e-15)"
        raise InputError("must be a wear law", key="law", value=law, hint=hint)
    if scar is not None and not callable(getattr(scar, "depth", None)):
        hint = "FlatScar, HoleScar and PadScar are"
        raise InputError("is no scar", key="scar", value=scar, hint=hint)


def sliding_spans(response: Response, stop: str) -> Spans:
    """Return when a stop is loaded and friction does not hold it."""
    law = response.stop_index(stop)
    loaded = loaded_spans(response, stop, 0.0)
    if np.isinf(impacts_of(response, law)["peak_force"]).any():
        what = "is rigid: no work is known of its impacts, which take no time"
        raise InputError(what, key="stop", value=stop, hint="give it a stiffness")
    if getattr(response.problem.laws[law], "friction", None) is None:
        return loaded
    return state_spans(response, law, lambda state: state.startswith("slip"))


def time_window(response: Response, start: float, end: float | None) -> tuple[float, float]:
    """Return the two ends of a stretch of time, checked."""
    duration = response.problem.duration
    first = not_negative("start", start)
    last = duration if end is None else finite("end", end)
    if not first < last <= duration:
        what = f"must lie after the start, {first:g} s, and within the run of {duration:g} s"
        raise InputError(what, key="end", value=last)
    return first, last


def _looks(spans: Spans) -> tuple[FloatArray, FloatArray]:
    """Return evenly spread instants of each interval, and the part of them all each stands for."""
    part = (np.arange(LOOKS) + 0.5) / LOOKS
    width = spans.ends - spans.starts
    times = (spans.starts[:, np.newaxis] + width[:, np.newaxis] * part).ravel()
    weight = np.repeat(width / LOOKS, LOOKS)
    return times, weight / max(float(weight.sum()), np.finfo(float).tiny)


def _within(times: FloatArray, spans: Spans) -> NDArray[np.bool_]:
    number = np.searchsorted(spans.starts, times, side="right") - 1
    ends = np.append(spans.ends, -np.inf)
    return (number >= 0) & (times < ends[number])


def _force(response: Response, law: int, times: FloatArray) -> FloatArray:
    return response.history.law_motion(law, times)[2]
