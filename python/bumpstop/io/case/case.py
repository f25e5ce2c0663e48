"""Case: what a case file says, made of objects."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypedDict

from bumpstop.modal.basis import ModalBasis
from bumpstop.post.references import Reference
from bumpstop.problem import Problem

if TYPE_CHECKING:
    from bumpstop.post.results.reading import Result

__all__ = ["Case", "Method", "MethodOptions"]


class MethodOptions(TypedDict, total=False):
    """Options of the methods: step in s, whether it may be unstable, parameters; tolerances."""

    dt: float
    beyond_stability_limit: bool
    beta: float
    gamma: float
    alpha: float
    spectral_radius: float
    theta: float
    points_per_period: float
    rtol: float
    atol: float
    exact_flights: bool


class Method(NamedTuple):
    """How time is integrated; each method has use for some of the options only."""

    name: str
    options: MethodOptions


@dataclass(frozen=True, eq=False, kw_only=True)
class Case:
    """A problem written in a file, with its variants and what is known of them.

    Parameters
    ----------
    name
        Name of the folder that holds the file.
    title
        What the case is, in one line.
    description
        More about it.
    path
        The file.
    bases
        The modes of each variant; a case without variants has one, named ``base``.
    problems
        The problem of each variant that has one: a modal case, without ``[run]``, has none.
    references
        The known values of each variant.
    methods
        How the time of each problem is integrated.
    method, method_options
        The same for the case without its variants.
    exports
        Formats in which the responses of each variant are written beside NetCDF.
    results
        What else each variant is asked for, in its report.
    documents
        What the file says of each variant, as TOML has it: what finer models are made of.
    """

    name: str
    title: str
    description: str
    path: Path
    bases: dict[str, ModalBasis]
    problems: dict[str, Problem]
    references: dict[str, list[Reference]]
    methods: dict[str, Method]
    method: str
    method_options: MethodOptions
    exports: Mapping[str, Sequence[str]] = field(default_factory=dict)
    results: Mapping[str, Sequence[Result]] = field(default_factory=dict)
    documents: Mapping[str, dict[str, Any]] = field(default_factory=dict, repr=False)
