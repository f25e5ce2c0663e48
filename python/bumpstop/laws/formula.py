"""Formulas of a position and a velocity, read without running them as Python."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from bumpstop.arguments import did_you_mean, name
from bumpstop.errors import InputError

__all__ = ["FUNCTIONS", "VARIABLES", "program"]

FUNCTIONS = {
    **dict.fromkeys(("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh"), 1),
    **dict.fromkeys(("exp", "log", "sqrt", "abs", "sign", "step"), 1),
    **dict.fromkeys(("min", "max", "atan2"), 2),
}
"""How many arguments each function takes."""
VARIABLES = ("x", "v")
"""Position and velocity."""
CONSTANTS = {"pi": 3.141592653589793, "e": 2.718281828459045}
_BINARY: dict[type, str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Pow: "**",
}
_LONGEST = 2000


def program(formula: str) -> list[float | str]:
    """Return the words of a formula in the order in which a machine with a stack takes them.

    Parameters
    ----------
    formula
        Numbers, ``x``, ``v``, ``pi``, ``e``, ``+ - * / **``, brackets and the `FUNCTIONS`.

    Raises
    ------
    InputError
        If the formula is none, or has something else in it.

    Examples
    --------
    >>> program("-2 * x + abs(v)")
    [2.0, 'negate', 'x', '*', 'v', 'abs', '+']
    """
    if len(name("force", formula)) > _LONGEST:
        what = f"must be shorter than {_LONGEST} characters"
        raise InputError(what, key="force", value=formula)
    try:
        return list(_words(ast.parse(formula.strip(), mode="eval").body))
    except InputError as error:
        found = error.value or formula
        raise InputError(error.what, key="force", value=found, hint=error.hint) from error
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        what, hint = "is no formula", "write it as in Python: '-2e4 * x - 30 * v * abs(v)'"
        raise InputError(what, key="force", value=formula, hint=hint) from error


def _words(node: ast.expr) -> Iterator[float | str]:
    """Yield the words of a branch of the parsed formula; nothing but what is listed above."""
    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            yield float(number)
        case ast.Name(id=word) if word in VARIABLES:
            yield word
        case ast.Name(id=word) if word in CONSTANTS:
            yield CONSTANTS[word]
        case ast.Name(id=word):
            hint = did_you_mean(word, [*VARIABLES, *CONSTANTS])
            raise InputError("unknown name", value=word, hint=hint)
        case ast.BinOp(op=kind) if type(kind) in _BINARY:
            yield from _words(node.left)
            yield from _words(node.right)
            yield _BINARY[type(kind)]
        case ast.UnaryOp(op=ast.UAdd()):
            yield from _words(node.operand)
        case ast.UnaryOp(op=ast.USub()):
            yield from _words(node.operand)
            yield "negate"
        case ast.Call(func=ast.Name(id=word), keywords=[]):
            _check_call(word, len(node.args))
            for argument in node.args:
                yield from _words(argument)
            yield word
        case _:
            hint = "numbers, x, v, pi, e, + - * / ** and functions such as abs and exp may"
            raise InputError("must not have this in it", value=ast.unparse(node), hint=hint)


def _check_call(word: str, count: int) -> None:
    if word not in FUNCTIONS:
        raise InputError("unknown function", value=word, hint=did_you_mean(word, FUNCTIONS))
    if count != FUNCTIONS[word]:
        wanted = "one argument" if FUNCTIONS[word] == 1 else f"{FUNCTIONS[word]} arguments"
        raise InputError(f"{word} takes {wanted}, not {count}")
