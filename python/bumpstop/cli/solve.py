"""Simulating the variants of a case, where they run, and checking them."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import NamedTuple, TypeAlias

import numpy as np

from bumpstop.arguments import did_you_mean, positive
from bumpstop.errors import ComputationError, InputError, ModellingWarning
from bumpstop.io.case import Case
from bumpstop.methods import (
    FIXED_STEP_METHODS,
    METHODS,
    TOLERANCE_METHODS,
    choose,
    usable_options,
)
from bumpstop.post.references import Check, check_frequencies, check_references
from bumpstop.response import Response
from bumpstop.simulate import simulate

__all__ = [
    "CaseResult",
    "Progress",
    "Stepping",
    "VariantResult",
    "frequency_checks",
    "solve_case",
]

Progress: TypeAlias = Callable[[str], AbstractContextManager[Callable[[float], None] | None]]
"""Opens a progress display under a name and gives what to call with the fraction done."""


class VariantResult(NamedTuple):
    """One variant, simulated and checked; a modal case has no response."""

    name: str
    response: Response | None
    checks: list[Check]

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)


class CaseResult(NamedTuple):
    """All variants of a case, checked."""

    case: Case
    variants: list[VariantResult]

    @property
    def passed(self) -> bool:
        """Whether every check of every variant passed."""
        return all(variant.passed for variant in self.variants)

    @property
    def responses(self) -> dict[str, Response]:
        """The response of each variant that ran."""
        return {name: response for name, response, _ in self.variants if response is not None}


class Stepping(NamedTuple):
    """How to integrate time instead of as a case says; None leaves it to the case."""

    method: str | None = None
    dt: float | None = None
    rtol: float | None = None

    def check(self) -> None:
        """Raise an error where there is no such method, step or tolerance."""
        if self.method is not None and self.method not in METHODS:
            hint = did_you_mean(self.method, METHODS)
            raise InputError("unknown method", key="--method", value=self.method, hint=hint)
        for key, value in (("--dt", self.dt), ("--rtol", self.rtol)):
            if value is not None:
                positive(key, value)

    def check_for(self, case: Case) -> None:
        """Raise an error where the method that a variant takes has no such step or tolerance."""
        for name, problem in case.problems.items():
            method, _ = choose(self.method or case.methods[name].name, problem)
            if self.rtol is not None and method not in TOLERANCE_METHODS:
                what = "only methods that follow a tolerance take it"
                raise InputError(what, key="--rtol", hint=self._those(TOLERANCE_METHODS))
            if self.dt is not None and method not in FIXED_STEP_METHODS:
                what = "only methods with fixed steps take it"
                raise InputError(what, key="--dt", hint=self._those(FIXED_STEP_METHODS))

    def _those(self, methods: Iterable[str]) -> str:
        lead = "give --method, too" if self.method is None else "take another --method"
        return f"{lead}: {' or '.join(methods)}"


def solve_case(case: Case, stepping: Stepping, progress: Progress) -> CaseResult:
    """Simulate every variant that runs, and compare all with their references.

    Parameters
    ----------
    case
        The case.
    stepping
        How to integrate time instead of as the case says.
    progress
        Shows how far a variant is.

    Raises
    ------
    InputError
        If the method is unknown, has no such step, or refuses the case.
    ComputationError
        If a variant could not be finished.
    """
    stepping.check()
    stepping.check_for(case)
    return CaseResult(case, [_solved(case, name, stepping, progress) for name in case.bases])


def _solved(case: Case, name: str, stepping: Stepping, progress: Progress) -> VariantResult:
    if name not in case.problems:
        return VariantResult(name, None, frequency_checks(case, name))
    own_method, options = case.methods[name]
    chosen = stepping.method or own_method
    used = usable_options(chosen, options, case.problems[name])
    if stepping.dt is not None:
        used["dt"] = stepping.dt
    if stepping.rtol is not None:
        used["rtol"] = stepping.rtol
    with _located(case, name), progress(f"{case.name}, {name}") as tell:
        with warnings.catch_warnings():
            # They are among the remarks, which are printed.
            warnings.simplefilter("ignore", ModellingWarning)
            response = simulate(case.problems[name], chosen, progress=tell, **used)
        checks = check_references(response, case.references[name])
    return VariantResult(name, response, checks)


def frequency_checks(case: Case, variant: str) -> list[Check]:
    """Compare the natural frequencies of a variant with those among its references."""
    known = [each for each in case.references[variant] if each.modes is not None]
    return check_frequencies(case.bases[variant], known)


@contextmanager
def _located(case: Case, variant: str) -> Iterator[None]:
    """Say in which file and variant something was wrong or could not be finished."""
    try:
        with np.errstate(over="raise", invalid="raise", divide="raise"):
            yield
    except InputError as error:
        raise InputError(
            error.what,
            file=str(case.path),
            key=_key(error.key),
            value=error.value,
            hint=error.hint,
        ) from error
    except ComputationError as error:
        raise ComputationError(f"{case.path}: variant {variant}: {error}") from error
    except FloatingPointError as error:
        what = "numbers grew too large or too small to compute with"
        raise ComputationError(f"{case.path}: variant {variant}: {what}") from error


def _key(argument: str | None) -> str:
    """Return where in the file an argument of `simulate` stands; a whole path stays."""
    if argument in ("initial", "basis") or (argument and "." in argument):
        return argument
    return f"run.{argument}" if argument else "run"
