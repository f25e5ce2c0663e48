"""What the keys of a case take, as the checks of case files tell it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from bumpstop.errors import InputError
from bumpstop.io.case.load import checked_tables
from bumpstop.io.case.overrides import overridden
from bumpstop.io.units import WRONG_UNIT, asked_unit

if TYPE_CHECKING:
    from bumpstop.study.parameters import Parameter

__all__ = ["CaseKeys"]

_BESIDE = 2.0**-10
"""So far from a whole number are those that tell whether a key takes others, too."""
_NO_KEY = ("unknown key", "leads nowhere", "cannot be changed by a variant")
"""What is said of a name that is no key of the case."""

_TABLE = "must be a table"
"""What is said of a number where the case has a table."""


class CaseKeys:
    """The keys of a case by dotted name.

    Parameters
    ----------
    document
        What the case file says of the variant.
    """

    def __init__(self, document: dict[str, Any]) -> None:
        self._document = document

    def check(self, key: str, parameter: Parameter) -> None:
        """Raise where there is no such key, it is a table, or a word is not of its kind.

        Numbers are judged run by run.

        Raises
        ------
        InputError
            That says so.
        """
        first, *others = parameter.written or (1.0,)
        for written in (first, *(other for other in others if isinstance(other, str | bool))):
            self._check_value(key, written)
        for written in parameter.spread:
            # A difference may be below what values may be; its unit is theirs.
            error = self._objection(key, written)
            if error is not None and error.what.startswith(WRONG_UNIT):
                _refuse(key, error)

    def takes_whole(self, key: str, parameter: Parameter) -> bool:
        """Return whether a key takes a whole number, and none just beside it."""
        if parameter.whole() is parameter:
            return False
        near = round(float(parameter.quantiles(np.array([0.5]))[0]))
        beside = [near - _BESIDE, near + _BESIDE]
        return self._objection(key, near) is None and all(
            self._objection(key, value) is not None for value in beside
        )

    def unit(self, key: str) -> str | None:
        """Return the SI unit of a key's numbers; None where they have none."""
        error = self._objection(key, "1")
        return None if error is None else asked_unit(error)

    def _check_value(self, key: str, written: object) -> None:
        error = self._objection(key, written)
        if error is None:
            return
        if error.what in _NO_KEY:
            what, place = f"the case has no such key: {error.key}", f'parameters."{key}"'
            raise InputError(what, key=place, hint=error.hint) from error
        if isinstance(written, str | bool) or error.what.startswith(_TABLE):
            _refuse(key, error)

    def _objection(self, key: str, value: object) -> InputError | None:
        """Return what the checks of a case file say against a value of a key."""
        try:
            checked_tables(overridden(self._document, {key: value}))
        except InputError as error:
            return error
        return None


def _refuse(key: str, error: InputError) -> NoReturn:
    place = f'parameters."{key}"'
    raise InputError(error.what, key=place, value=error.value, hint=error.hint) from error
