"""The modal basis: what the rest of the program knows of a structure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray, count, did_you_mean, not_negative, one_of, series
from bumpstop.errors import InputError
from bumpstop.modal.damping import damping_ratios
from bumpstop.modal.eigen import structure_modes
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.gauge import Gauge
from bumpstop.structure.structure import Structure

__all__ = ["ModalBasis"]


@dataclass(frozen=True, eq=False)
class ModalBasis:
    """Modes of unit modal mass, with their frequencies, damping and shapes.

    Make one with ``from_structure`` or ``from_modes``. N is the number of modes.

    Parameters
    ----------
    omega2
        Squared angular frequencies in rad2/s2, (N,); exactly zero for rigid modes.
    damping_ratio
        Ratios of critical damping, (N,).
    dofs
        Node and dof of each row of ``shapes``.
    shapes
        Mode shapes, (rows, N), in 1/sqrt(kg) and rad/(m sqrt(kg)).
    mass_rows
        Shapes times the mass matrix, (N, rows); None where there is no mass matrix.
    structure
        The structure that the modes were computed from; None for modes from elsewhere.
    """

    omega2: FloatArray
    damping_ratio: FloatArray
    dofs: tuple[Dof, ...] = field(repr=False)
    shapes: FloatArray = field(repr=False)
    mass_rows: FloatArray | None = field(default=None, repr=False)
    structure: Structure | None = field(default=None, repr=False)

    @classmethod
    def from_structure(
        cls, structure: Structure, *, modes: int, damping: float | Sequence[float] = 0.0
    ) -> ModalBasis:
        """Compute the lowest modes of a structure.

        Parameters
        ----------
        structure
            The structure, with its supports.
        modes
            Number of modes.
        damping
            Ratio of critical damping: one for all modes, or one for each.

        Raises
        ------
        InputError
            If a value cannot be used, or the structure has fewer free dofs than modes.
        """
        number = count("modes", modes)
        ratios = damping_ratios(damping, number)
        omega2, shapes = structure_modes(structure, number)
        return cls(
            omega2=omega2,
            damping_ratio=ratios,
            dofs=structure.dofs,
            shapes=shapes,
            mass_rows=np.ascontiguousarray((structure.mass @ shapes).T),
            structure=structure,
        )

    @classmethod
    def from_modes(
        cls,
        *,
        frequency: Sequence[float],
        damping: float | Sequence[float] = 0.0,
        shapes: Mapping[Dof, Sequence[float]],
    ) -> ModalBasis:
        """Take modes from elsewhere: a measurement, another program, a formula.

        Parameters
        ----------
        frequency
            Natural frequencies in Hz.
        damping
            Ratio of critical damping: one for all modes, or one for each.
        shapes
            Components of the modes, scaled to unit modal mass, by (node, dof).

        Raises
        ------
        InputError
            If a value is not finite or negative, a dof is unknown, or numbers of modes differ.

        Examples
        --------
        >>> basis = ModalBasis.from_modes(
        ...     frequency=[3.0, 7.5], damping=[0.01, 0.01], shapes={("P", "dx"): [1.0, 0.4]}
        ... )
        >>> basis.row("P", "dx")
        array([1. , 0.4])
        """
        hertz = [not_negative("frequency", value) for value in series("frequency", frequency)]
        rows = [_components(key, values, len(hertz)) for key, values in _items(shapes)]
        return cls(
            omega2=(2.0 * np.pi * np.array(hertz)) ** 2,
            damping_ratio=damping_ratios(damping, len(hertz)),
            dofs=tuple((str(node), str(dof)) for node, dof in shapes),
            shapes=np.array(rows),
        )

    @property
    def frequencies(self) -> FloatArray:
        """Natural frequencies in Hz, (N,)."""
        frequencies: FloatArray = np.sqrt(self.omega2) / (2.0 * np.pi)
        return frequencies

    @property
    def damping(self) -> FloatArray:
        """Damping of each modal equation, 2 xi omega, in rad/s, (N,)."""
        return 2.0 * self.damping_ratio * np.sqrt(self.omega2)

    def row(self, node: str, dof: str) -> FloatArray:
        """Return how much each mode moves a dof, (N,): u = row . q.

        Parameters
        ----------
        node
            Name of a node, of a mesh node (``"AB.3"``), or of a point along a beam
            (``"AB@0.462"``), which moves as its element's shape functions say.
        dof
            One of ``dx dy dz drx dry drz``.

        Raises
        ------
        InputError
            If the node or dof is unknown, or the basis has no shape for it.
        """
        if self.structure is not None:
            return self.structure.displacement_form(node, dof).of(self.shapes)
        number = self._rows.get((node, one_of("dof", dof, DOFS)))
        if number is not None:
            own: FloatArray = self.shapes[number].copy()
            return own
        nodes = dict.fromkeys(known for known, _ in self.dofs)
        if node not in nodes:
            hint = did_you_mean(node, nodes)
            raise InputError("no mode shape at this node", key="node", value=node, hint=hint)
        hint = f"known at {node!r}: " + ", ".join(d for known, d in self.dofs if known == node)
        raise InputError("no mode shape for this dof", key="dof", value=dof, hint=hint)

    def gauge_row(self, gauge: Gauge) -> FloatArray:
        """Return how much each mode strains a gauge, (N,): strain = gauge_row . q.

        Raises
        ------
        InputError
            If the gauge is not on a beam of the structure, or the basis has no structure.
        """
        if self.structure is None:
            raise InputError("a gauge needs a basis computed from a structure", value=gauge.name)
        return self.structure.strain_form(gauge).of(self.shapes)

    def project_field(self, field: FloatArray) -> FloatArray:
        """Return the modal coordinates nearest to a field in the norm of the mass matrix.

        Parameters
        ----------
        field
            One value for each of ``dofs``, (rows,).

        Raises
        ------
        InputError
            If the basis has no mass matrix.
        """
        if self.mass_rows is None:
            raise InputError(
                "this basis has no mass matrix to project a field with",
                hint="give the initial state mode by mode, as a ModalState",
            )
        coordinates: FloatArray = self.mass_rows @ field
        return coordinates

    @cached_property
    def _rows(self) -> dict[Dof, int]:
        return {dof: number for number, dof in enumerate(self.dofs)}


def _items(shapes: object) -> list[tuple[object, object]]:
    if not isinstance(shapes, Mapping) or not shapes:
        what = 'must map (node, dof) to components, such as {("P", "dx"): [1.0, 0.4]}'
        raise InputError(what, key="shapes", value=shapes)
    return list(shapes.items())


def _components(key: object, values: object, modes: int) -> tuple[float, ...]:
    """Return the components of one dof, one a mode."""
    if not isinstance(key, tuple) or len(key) != 2 or not isinstance(key[0], str):
        raise InputError("must be a node and a dof", key="shapes", value=key)
    one_of("dof", key[1], DOFS)
    components = series(f"shapes.{key[0]}.{key[1]}", values)
    if len(components) != modes:
        what = f"must have one component for each of the {modes} modes"
        raise InputError(what, key=f"shapes.{key[0]}.{key[1]}", value=values)
    return components
