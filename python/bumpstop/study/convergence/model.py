"""One variant of a case, built again with more elements or modes."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError, InputError, ModellingWarning
from bumpstop.io.case.build import Builder
from bumpstop.io.case.build.basis import built_model
from bumpstop.io.case.load import checked_tables
from bumpstop.modal.selection import ModeSelection
from bumpstop.post.references import Check, Reference, check_frequencies, check_references
from bumpstop.simulate import simulate
from bumpstop.structure.structure import Structure
from bumpstop.study.convergence.finer import (
    Document,
    Elements,
    beam_elements,
    finer_mesh,
    renamed,
)

if TYPE_CHECKING:
    from bumpstop.io.case import Case
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem
    from bumpstop.response import Response
    from bumpstop.structure.model import LinearModel

__all__ = ["BEST_RTOL", "Model", "Result"]

BEST_RTOL = 1e-11
"""Tolerance of the finer models, where the exact method does not apply."""


class Result:
    """What a model gives: its reference quantities, and how large it was."""

    def __init__(
        self, basis: ModalBasis, response: Response | None, references: Sequence[Reference]
    ) -> None:
        self.vectors = len(basis.omega2)
        self.response = response
        self.checks: list[Check] = (
            check_frequencies(basis, references)
            if response is None
            else check_references(response, references)
        )

    @property
    def values(self) -> FloatArray:
        """The quantities, one a published value, (n,)."""
        return np.array([check.value for check in self.checks])


class Model:
    """A variant of a case with a mesh of its own.

    Parameters
    ----------
    case
        The case.
    variant
        Name of the variant.
    builder
        Builds the problems; it keeps modes, so that variants share them.
    factor
        Elements in the place of one.
    """

    def __init__(self, case: Case, variant: str, builder: Builder, factor: int = 1) -> None:
        self._case = case
        self._variant = variant
        self._builder = builder
        self._given = case.documents[variant]
        self.factor = factor

    def finer(self, factor: int) -> Model:
        """Return the model with so many elements in the place of one of the case's."""
        return Model(self._case, self._variant, self._builder, factor)

    @cached_property
    def document(self) -> Document:
        """What the case file says, with this mesh."""
        if self.factor == 1:
            return self._given
        return finer_mesh(self._given, self.factor, self._elements)

    @cached_property
    def references(self) -> list[Reference]:
        """The published values, of the nodes as they are called in this mesh."""
        given = self._case.references[self._variant]
        if self.factor == 1:
            return given
        return [self._renamed(reference) for reference in given]

    @property
    def selection(self) -> ModeSelection:
        """Which modes the case asks for."""
        selection: ModeSelection | None = checked_tables(self._given).basis.modes
        assert selection is not None  # or the case could not have been built
        return selection

    @cached_property
    def free(self) -> int:
        """How many independent dofs there are to make modes of."""
        with self._located(f"with {self.factor} elements in the place of one"):
            folder = self._case.path.parent
            model: LinearModel = built_model(checked_tables(self.document), folder)
            return len(model.free)

    def solved(self, document: Document, label: str) -> Result:
        """Return what the model gives as a document describes it, by the best method.

        Parameters
        ----------
        document
            The content of a case file with the mesh of this model.
        label
            What to call it in error messages.
        """
        with self._located(label):
            basis, problem = self._builder.variant(checked_tables(document))
            return self._result(basis, problem, "auto", rtol=BEST_RTOL)

    def as_given(self, method: str, **options: Any) -> Result:
        """Return what the case gives as it is, by a method that `bumpstop.simulate` knows."""
        with self._located(f"by the {method} method"):
            problem = self._case.problems.get(self._variant)
            return self._result(self._case.bases[self._variant], problem, method, **options)

    def _result(
        self, basis: ModalBasis, problem: Problem | None, method: str, **options: Any
    ) -> Result:
        if problem is None:
            return Result(basis, None, self.references)
        with warnings.catch_warnings():
            # That modes are missing is what the study measures.
            warnings.simplefilter("ignore", ModellingWarning)
            response = simulate(problem, method, **options)
        return Result(basis, response, self.references)

    @cached_property
    def _elements(self) -> Elements:
        """Elements of the beams whose inner nodes the file may name."""
        model = self._case.bases[self._variant].model
        if isinstance(model, Structure):  # on the lines of a mesh, too
            return {beam.name: beam.elements for beam in model.beams}
        return beam_elements(self._given)

    def _renamed(self, reference: Reference) -> Reference:
        return replace(reference, node=renamed(reference.node, self._elements, self.factor))

    @contextmanager
    def _located(self, label: str) -> Iterator[None]:
        """Say in which file, variant and size something was wrong or could not be finished."""
        place = f"{self._case.path}: variant {self._variant}, {label}"
        try:
            with np.errstate(over="raise", invalid="raise", divide="raise"):
                yield
        except InputError as error:
            raise InputError(
                error.what, file=place, key=error.key, value=error.value, hint=error.hint
            ) from error
        except ComputationError as error:
            raise ComputationError(f"{place}: {error}") from error
        except FloatingPointError as error:
            what = "numbers grew too large or too small to compute with"
            raise ComputationError(f"{place}: {what}") from error
