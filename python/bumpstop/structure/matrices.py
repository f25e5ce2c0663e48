"""Matrices: a structure whose matrices come from elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray, Vector, did_you_mean, listed, one_of, positive, vector
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.frame import rigid_motions
from bumpstop.structure.given import GivenMatrix, skew_matrix, symmetric_matrix
from bumpstop.structure.graph import components
from bumpstop.structure.null_motions import LARGEST_DENSE, null_motions
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["Matrices"]

ACCURACY = 1e-13
"""How well numbers in double precision keep what was assembled from them."""


class Matrices:
    """A linear structure given by its matrices, from any finite-element code.

    Parameters
    ----------
    stiffness, mass
        Symmetric matrices (dofs, dofs): sparse matrices of SciPy, dense arrays or
        SparseMatrix; N/m, N and N m, and kg, kg m and kg m2.
    damping
        The same for viscous damping; none where left out.
    gyroscopic, circulatory
        Skew-symmetric matrices: forces G u' and N u; none where left out.
    dofs
        Node and dof of each row, such as ``("P", "dx")``.
    positions
        Coordinates (x, y, z) of nodes in m. Rigid motions are then known from geometry.
    fixed
        Node and dof of what is held at zero.
    accuracy
        How exact the entries are, relative to those on the diagonal. Asymmetries and the
        resistance to rigid motions are taken for rounding up to this; say 1e-9 where the
        matrices went through a file with ten digits.

    Raises
    ------
    InputError
        If a matrix is not finite, not symmetric or of another size than the dofs; if a dof
        appears twice or is not known; if a dof that can move has no mass, or mass is negative.

    Examples
    --------
    Two masses joined by a spring, free in space: the motion of both together strains nothing.

    >>> import numpy as np
    >>> from bumpstop import Matrices
    >>> pair = Matrices(
    ...     stiffness=[[1e4, -1e4], [-1e4, 1e4]],
    ...     mass=[[2.0, 0.0], [0.0, 3.0]],
    ...     dofs=[("P", "dx"), ("Q", "dx")],
    ... )
    >>> pair.rigid_shapes()
    array([[1.],
           [1.]])
    """

    stiffness: SparseMatrix
    mass: SparseMatrix
    damping: SparseMatrix
    gyroscopic: SparseMatrix
    circulatory: SparseMatrix
    dofs: tuple[Dof, ...]
    positions: Mapping[str, Vector]
    fixed: tuple[Dof, ...]
    accuracy: float

    def __init__(
        self,
        *,
        stiffness: GivenMatrix,
        mass: GivenMatrix,
        damping: GivenMatrix | None = None,
        gyroscopic: GivenMatrix | None = None,
        circulatory: GivenMatrix | None = None,
        dofs: Sequence[Dof],
        positions: Mapping[str, Sequence[float]] | None = None,
        fixed: Sequence[Dof] = (),
        accuracy: float = ACCURACY,
    ) -> None:
        self.dofs = _dofs("dofs", dofs)
        self.accuracy = positive("accuracy", accuracy)
        self.stiffness = symmetric_matrix("stiffness", stiffness, self.dofs, self.accuracy)
        self.mass = symmetric_matrix("mass", mass, self.dofs, self.accuracy)
        self.damping = self._symmetric_or_none("damping", damping)
        self.gyroscopic = self._skew_or_none("gyroscopic", gyroscopic)
        self.circulatory = self._skew_or_none("circulatory", circulatory)
        self.positions = _positions(positions)
        self.fixed = _dofs("fixed", fixed) if len(fixed) else ()
        for number, (node, dof) in enumerate(self.fixed):
            self._number(node, dof, f"fixed[{number}]", f"fixed[{number}]")
        self._refuse_negative_mass()
        self._refuse_massless_dofs()
        self._refuse_indefinite_mass()

    @cached_property
    def free(self) -> IndexArray:
        """Numbers of the dofs that are not fixed, ascending."""
        held = set(self.fixed)
        return np.array([i for i, dof in enumerate(self.dofs) if dof not in held], dtype=np.intp)

    @cached_property
    def expansion(self) -> SparseMatrix:
        """All dofs from the free ones, (dofs, free): a selection."""
        return SparseMatrix.selection(len(self.dofs), self.free)

    def reduced(self, matrix: SparseMatrix) -> SparseMatrix:
        """Return the part of a matrix on all dofs that belongs to the free ones."""
        return matrix.restricted(self.free)

    def displacement_form(self, node: str, dof: str) -> LinearForm:
        """Return one dof of a node as a form of all dofs.

        Raises
        ------
        InputError
            If the matrices have no such node or dof.
        """
        number = self._number(node, one_of("dof", dof, DOFS), "node", "dof")
        return LinearForm(np.array([number]), np.ones(1))

    def position(self, node: str) -> Vector:
        """Return where a node is at rest, in m.

        Raises
        ------
        InputError
            If the position of the node was not given.
        """
        if node not in self.positions:
            hint = did_you_mean(node, self.positions) if self.positions else "give positions"
            raise InputError("the position of this node is not known", value=node, hint=hint)
        return self.positions[node]

    def rigid_field(
        self,
        *,
        translation: Vector = (0.0, 0.0, 0.0),
        rotation: Vector = (0.0, 0.0, 0.0),
        about: Vector = (0.0, 0.0, 0.0),
    ) -> FloatArray:
        """Return a small rigid motion of the whole structure, one value a dof.

        Parameters
        ----------
        translation
            Along the global axes, in m; or in m/s for a velocity, m/s2 for gravity.
        rotation
            About the global axes, in rad (rad/s, rad/s2).
        about
            Where the axes of rotation meet, in m.

        Raises
        ------
        InputError
            If the structure turns and the position of a node is not known.
        """
        if any(rotation):
            for node, dof in self.dofs:
                if dof in DOFS[:3]:
                    self.position(node)
        motions = self._motions(np.array(about, dtype=float))
        field: FloatArray = motions @ np.array([*translation, *rotation], dtype=float)
        return field

    def rigid_shapes(self) -> FloatArray:
        """Return all motions of the free dofs that strain nothing, (free, motions).

        Where positions are known these are the rigid motions of geometry, as far as the
        stiffness matrix lets them pass; what remains, mechanisms for example, is found from
        the matrix itself.
        """
        about = self._centre()
        motions = self._motions(about) if self.positions else self._translations()
        stiffness = self.reduced(self.stiffness)
        return null_motions(stiffness, motions[self.free], self.accuracy)

    def _symmetric_or_none(self, key: str, given: GivenMatrix | None) -> SparseMatrix:
        if given is None:
            return self._nothing()
        return symmetric_matrix(key, given, self.dofs, self.accuracy)

    def _skew_or_none(self, key: str, given: GivenMatrix | None) -> SparseMatrix:
        if given is None:
            return self._nothing()
        return skew_matrix(key, given, self.dofs, self.accuracy)

    def _nothing(self) -> SparseMatrix:
        size, none = len(self.dofs), np.zeros(0, dtype=np.intp)
        return SparseMatrix.from_triplets((size, size), none, none, np.zeros(0))

    def _number(self, node: str, dof: str, node_key: str, dof_key: str) -> int:
        number = self._numbers.get((node, dof))
        if number is not None:
            return number
        own = [known for name, known in self.dofs if name == node]
        if not own:
            hint = did_you_mean(node, dict.fromkeys(name for name, _ in self.dofs))
            raise InputError("unknown node", key=node_key, value=node, hint=hint)
        hint = f"known at {node!r}: {', '.join(own)}"
        raise InputError("the matrices have no such dof", key=dof_key, value=dof, hint=hint)

    @cached_property
    def _numbers(self) -> dict[Dof, int]:
        return {dof: number for number, dof in enumerate(self.dofs)}

    def _motions(self, about: FloatArray) -> FloatArray:
        """Return the six rigid motions (dofs, 6); a node of unknown position stays in place."""
        names = list(dict.fromkeys(node for node, _ in self.dofs))
        numbers = {node: number for number, node in enumerate(names)}
        known = np.array([node in self.positions or not self.positions for node in names])
        places = np.array([self.positions.get(node, tuple(about)) for node in names])
        motions = rigid_motions(places, about).reshape(len(names), 6, 6) * known[:, None, None]
        return np.array([motions[numbers[node], DOFS.index(dof)] for node, dof in self.dofs])

    def _translations(self) -> FloatArray:
        """Return the translations alone, (dofs, 3), which ask for no positions."""
        return np.array([[float(dof == axis) for axis in DOFS[:3]] for _, dof in self.dofs])

    def _centre(self) -> FloatArray:
        """Return a point about which rotations are simple: a held node, or any other."""
        held = [node for node, dof in self.fixed if dof in DOFS[:3] and node in self.positions]
        node = next(iter([*held, *self.positions]), None)
        return np.array(self.positions[node]) if node is not None else np.zeros(3)

    def _refuse_negative_mass(self) -> None:
        diagonal = self.mass.diagonal()
        worst = int(diagonal.argmin())
        if diagonal[worst] < 0.0:
            place = ".".join(self.dofs[worst])
            raise InputError(
                f"must not be negative at {place}", key="mass", value=float(diagonal[worst])
            )

    def _refuse_massless_dofs(self) -> None:
        """Raise where a dof can move that has no inertia: its acceleration has no meaning."""
        massless = self.free[self.mass.diagonal()[self.free] == 0.0]
        if len(massless):
            node = self.dofs[massless[0]][0]
            dofs = ", ".join(
                dof for known, dof in (self.dofs[i] for i in massless) if known == node
            )
            what = f"{dofs} of node {node!r} can move but have no mass"
            raise InputError(what, key="mass", hint="fix or condense them")

    def _refuse_indefinite_mass(self) -> None:
        """Raise where some motion would have negative kinetic energy, or none."""
        mass = self.reduced(self.mass)
        for dofs in components(mass.shape[0], mass.rows, mass.columns):
            group = np.array(dofs)
            if 1 < len(group) <= LARGEST_DENSE and not _is_positive(mass.restricted(group)):
                place = ".".join(self.dofs[self.free[group[0]]])
                what = f"is not positive definite: some motion with {place} has no inertia"
                raise InputError(what, key="mass")


def _is_positive(matrix: SparseMatrix) -> bool:
    dense = matrix.to_dense()
    scale = 1.0 / np.sqrt(dense.diagonal())
    try:
        np.linalg.cholesky(dense * np.outer(scale, scale))
    except np.linalg.LinAlgError:
        return False
    return True


def _dofs(key: str, given: object) -> tuple[Dof, ...]:
    """Return pairs of a node and a dof, each once."""
    pairs = [_dof(f"{key}[{number}]", pair) for number, pair in enumerate(listed(key, given))]
    if not pairs:
        raise InputError("must name at least one dof", key=key)
    seen: dict[Dof, int] = {}
    for number, pair in enumerate(pairs):
        if pair in seen:
            what = f"the same as {key}[{seen[pair]}]"
            raise InputError(what, key=f"{key}[{number}]", value=pair)
        seen[pair] = number
    return tuple(pairs)


def _dof(key: str, pair: object) -> Dof:
    if not isinstance(pair, list | tuple) or len(pair) != 2 or not isinstance(pair[0], str):
        raise InputError("must be a node's name and a dof", key=key, value=pair)
    node, dof = pair
    if dof not in DOFS:
        raise InputError("unknown dof", key=key, value=dof, hint=did_you_mean(dof, DOFS))
    return node, dof


def _positions(given: Mapping[str, Sequence[float]] | None) -> dict[str, Vector]:
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise InputError("must map names of nodes to coordinates", key="positions", value=given)
    return {node: vector(f"positions.{node}", place) for node, place in given.items()}
