"""Expression: a function of time as a formula, read without running it as Python."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from functools import cached_property, lru_cache
from typing import Any, TypeAlias

import numpy as np

from bumpstop.arguments import FloatArray, did_you_mean, name
from bumpstop.errors import InputError
from bumpstop.loads.sampling import TOLERANCE, checked_tolerance, sampled
from bumpstop.loads.time import TimeTable

__all__ = ["CONSTANTS", "FUNCTIONS", "Expression", "formula_in"]

_Formula: TypeAlias = Callable[[FloatArray], Any]

FUNCTIONS: dict[str, tuple[int, Callable[..., Any]]] = {
    **{
        word: (1, getattr(np, word))
        for word in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log", "sqrt", "abs")
    },
    "asin": (1, np.arcsin),
    "acos": (1, np.arccos),
    "atan": (1, np.arctan),
    "atan2": (2, np.arctan2),
    "min": (2, np.minimum),
    "max": (2, np.maximum),
    "step": (1, lambda x: np.where(np.asarray(x) >= 0.0, 1.0, 0.0)),
}
"""How many arguments each function takes, and what it does."""
CONSTANTS = {"pi": np.pi, "e": np.e}
_BINARY: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
_UNARY: dict[type, Callable[[Any], Any]] = {ast.UAdd: operator.pos, ast.USub: operator.neg}
_LONGEST = 2000
_INTERVALS = 2048
"""Between which the search for straight lines starts."""


@dataclass(frozen=True)
class Expression:
    """A formula in the time t in s from the start of the run, such as ``"exp(-3*t) * sin(20*t)"``.

    It may have numbers, ``+ - * / **``, brackets, ``pi``, ``e`` and the functions ``sin cos tan
    asin acos atan atan2 sinh cosh tanh exp log sqrt abs min max step``, where ``step(x)`` is 1
    from x = 0 on and 0 before. Angles are in radians. The exact method follows straight lines
    through it, refined until they are as close as the tolerance says; oscillations should not be
    quicker than some thousand periods a run.

    Parameters
    ----------
    formula
        The formula.
    tolerance
        Largest deviation of the straight lines, relative to the largest value in the run.

    Raises
    ------
    InputError
        If the formula is none, or has something else in it.

    Examples
    --------
    >>> Expression("2 * sin(pi * t / 6) ** 2").at(np.array([0.0, 1.0])).round(12).tolist()
    [0.0, 0.5]
    """

    formula: str
    _: KW_ONLY
    tolerance: float = TOLERANCE

    def __post_init__(self) -> None:
        name("formula", self.formula)
        object.__setattr__(self, "tolerance", checked_tolerance(self.tolerance))
        self._read  # noqa: B018  # says what is wrong now

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s."""
        wanted = np.asarray(times, dtype=np.float64)
        with np.errstate(all="ignore"):
            return np.broadcast_to(self._read(wanted), wanted.shape).astype(np.float64)

    @lru_cache(maxsize=16)  # noqa: B019  # asked for when a problem is made, and when it is run
    def terms(self, duration: float) -> tuple[TimeTable, ...]:
        """Return its straight lines over a run.

        Raises
        ------
        InputError
            If it has no finite value somewhere, or takes more than two million lines.
        """
        grid = np.linspace(0.0, duration, _INTERVALS + 1)
        return (sampled(self.at, grid, self.tolerance, "time.formula"),)

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        return self.formula

    @cached_property
    def _read(self) -> _Formula:
        return formula_in("t", self.formula)


def formula_in(variable: str, formula: str, key: str = "formula") -> _Formula:
    """Return a function of arrays that a formula in one variable means.

    Parameters
    ----------
    variable
        The name that stands for the argument.
    formula
        The formula, of what an `Expression` may have.
    key
        The argument that is blamed.

    Raises
    ------
    InputError
        If the formula is none, or has something else in it.

    Examples
    --------
    >>> float(formula_in("x", "2 * x + 1")(np.array(3.0)))
    7.0
    """
    if len(formula) > _LONGEST:
        raise InputError(f"must be shorter than {_LONGEST} characters", key=key, value=formula)
    try:
        return _formula(ast.parse(formula.strip(), mode="eval").body, variable)
    except InputError as error:
        found = error.value or formula
        raise InputError(error.what, key=key, value=found, hint=error.hint) from error
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        what, hint = "is no formula", f"write it as in Python: '2 * sin(3 * {variable}) ** 2'"
        raise InputError(what, key=key, value=formula, hint=hint) from error


def _formula(node: ast.expr, variable: str) -> _Formula:
    """Return what a branch of the parsed formula computes; nothing but what is listed above."""
    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            return _constant(float(number))
        case ast.Name(id=word) if word == variable:
            return lambda times: times
        case ast.Name(id=word) if word in CONSTANTS:
            return _constant(CONSTANTS[word])
        case ast.Name(id=word):
            hint = did_you_mean(word, [variable, *CONSTANTS])
            raise InputError("unknown name", value=word, hint=hint)
        case ast.BinOp(op=kind) if type(kind) in _BINARY:
            left, right = (_formula(side, variable) for side in (node.left, node.right))
            both = _BINARY[type(kind)]
            return lambda times: both(left(times), right(times))
        case ast.UnaryOp(op=kind) if type(kind) in _UNARY:
            inner, change = _formula(node.operand, variable), _UNARY[type(kind)]
            return lambda times: change(inner(times))
        case ast.Call(func=ast.Name(id=word), keywords=[]):
            return _call(word, node.args, variable)
    hint = f"numbers, {variable}, pi, e, + - * / ** and functions such as sin and exp may"
    raise InputError("must not have this in it", value=ast.unparse(node), hint=hint)


def _constant(number: float) -> _Formula:
    # numpy's numbers overflow to infinity, where Python's would stop.
    value = np.float64(number)
    return lambda _: value


def _call(word: str, arguments: list[ast.expr], variable: str) -> _Formula:
    if word not in FUNCTIONS:
        hint = did_you_mean(word, FUNCTIONS)
        raise InputError("unknown function", value=word, hint=hint)
    count, function = FUNCTIONS[word]
    if len(arguments) != count:
        wanted = "one argument" if count == 1 else f"{count} arguments"
        raise InputError(f"{word} takes {wanted}, not {len(arguments)}")
    inner = [_formula(argument, variable) for argument in arguments]
    return lambda times: function(*(each(times) for each in inner))
