"""Whether two responses are equal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bumpstop.errors import InputError
from bumpstop.post.energy import ledger

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from bumpstop.response import Response

__all__ = ["equal_responses"]

_ACCOUNT = (
    "method",
    "steps",
    "certified_steps",
    "missed_penetration",
    "motion_error",
    "event_count",
    "energy_residual",
    "options",
)


def equal_responses(one: Response, other: Response) -> bool:
    """Return whether two responses tell the same, to the bit; see `Response.equals`."""
    if not isinstance(other, type(one)):
        raise InputError("must be a response", key="other", value=other)
    if any(getattr(one, name) != getattr(other, name) for name in _ACCOUNT):
        return False
    if not np.array_equal(one.times, other.times) or not _same_problem(one, other):
        return False
    if not _same_kept(one, other):
        return False
    columns = zip(_columns(one), _columns(other), strict=True)
    return all(_same(mine, yours) for mine, yours in columns)


def _same_problem(one: Response, other: Response) -> bool:
    from bumpstop.io.statement import packed

    return one.problem is other.problem or packed(one.problem) == packed(other.problem)


def _same_kept(one: Response, other: Response) -> bool:
    if one.kept is None or other.kept is None:
        return one.kept is other.kept
    return np.array_equal(one.kept, other.kept)


def _columns(response: Response) -> Iterator[NDArray[np.generic]]:
    for derivative in range(3):
        yield response.motion(derivative)
    for number, law in enumerate(response.problem.laws):
        yield from response.history.law_motion(number, response.times)
        yield response.history.contact_forces(number, response.times)
        yield response.history.law_forces(number, response.times)
        if getattr(law, "internal_variables", ()):
            yield response.history.internal_variables(number, response.times)
        yield response.sample("state", law.name)
    found = ledger(response, response.times)
    yield from found.terms.values()
    yield from found.stops.values()
    for table in (response.impact_table(), response.event_table()):
        yield from (np.array(column) for column in table.values())


def _same(mine: NDArray[np.generic], yours: NDArray[np.generic]) -> bool:
    numbers = mine.dtype.kind == "f"
    return np.array_equal(mine, yours, equal_nan=numbers)
