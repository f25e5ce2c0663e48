"""Matrices: a structure whose matrices come from elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray, Vector, did_you_mean, listed, one_of, positive, vector
from bumpstop.errors import InputError
from bumpstop.structure.assembly import KINDS
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.elimination import Freedom
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.frame import rigid_field, rigid_motions
from bumpstop.structure.given import GivenMatrix, skew_matrix, symmetric_matrix
from bumpstop.structure.graph import components
from bumpstop.structure.mobility import Mobility, mobility
from bumpstop.structure.null_motions import LARGEST_DENSE, is_definite, null_motions
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["Matrices"]

ROUNDING = 1e-9
"""A mass matrix of unit diagonal is definite if its eigenvalues are above this."""

ACCURACY = 1e-13
"""How well numbers in double precision keep what was assembled from them."""


# Its parts are fields, by which files keep it; what it is made of is checked by hand.
@dataclass(init=False, eq=False, repr=False)
class Matrices:
    """A linear structure given by its matrices, from any finite-element code.

    Dofs without mass follow the others in equilibrium; those that nothing resists either are left
    out.

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
        appears twice or is not known; if mass is zero everywhere or negative for some motion, or
        a motion without mass is damped or has negative stiffness.

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
        if len(self.mass.values) == 0:
            what, hint = "is zero everywhere: nothing has inertia", "is it the right matrix?"
            raise InputError(what, key="mass", hint=hint)
        self._refuse_negative_mass()
        self._refuse_indefinite_mass()
        self._mobility  # noqa: B018  # says what is wrong now, not when modes are asked for

    @property
    def free(self) -> IndexArray:
        """Numbers of the dofs that move by themselves, ascending: not fixed, not massless."""
        return self._mobility.freedom.free

    @property
    def expansion(self) -> SparseMatrix:
        """All dofs from the free ones, (dofs, free); massless ones follow in equilibrium."""
        return self._mobility.freedom.expansion

    def reduced(self, matrix: SparseMatrix) -> SparseMatrix:
        """Return a matrix of all dofs as one of the free dofs, expansion' @ matrix @ expansion."""
        return self._mobility.freedom.reduced(matrix)

    def has_inertia(self, form: LinearForm) -> bool:
        """Tell whether a force along a form accelerates masses alone."""
        return self._mobility.has_inertia(form)

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
        places = np.array([self.positions.get(node, about) for node in self._nodes])
        field = rigid_field(places, translation=translation, rotation=rotation, about=about)
        return field[self._rows]

    def rigid_shapes(self) -> FloatArray:
        """Return all motions of the free dofs that strain nothing, (free, motions).

        Where positions are known these are the rigid motions of geometry, as far as the
        stiffness matrix lets them pass; what remains, mechanisms for example, is found from
        the matrix itself, unless more than 3000 dofs of known position hang together.
        """
        return self._rigid_shapes

    @cached_property
    def _rigid_shapes(self) -> FloatArray:
        motions = self._motions(self._centre()) if self.positions else self._translations()
        return null_motions(
            self.reduced(self.stiffness),
            motions[self.free],
            self.accuracy,
            search_large=not self.positions,
        )

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
        known = np.array([node in self.positions or not self.positions for node in self._nodes])
        places = np.array([self.positions.get(node, tuple(about)) for node in self._nodes])
        motions: FloatArray = rigid_motions(places, about) * np.repeat(known, 6)[:, np.newaxis]
        return motions[self._rows]

    @cached_property
    def _nodes(self) -> list[str]:
        return list(dict.fromkeys(node for node, _ in self.dofs))

    @cached_property
    def _rows(self) -> IndexArray:
        """Which of the six dofs of each node the dofs are, (dofs,)."""
        numbers = {node: number for number, node in enumerate(self._nodes)}
        return np.array([6 * numbers[node] + DOFS.index(dof) for node, dof in self.dofs])

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

    def _refuse_indefinite_mass(self) -> None:
        """Raise where some motion would have negative kinetic energy."""
        for group, matrix in self._mass_groups:
            if not is_definite(matrix, -ROUNDING):
                place = ".".join(self.dofs[group[0]])
                what = f"must not be negative, but is for some motion with {place}"
                raise InputError(what, key="mass")

    @cached_property
    def _mobility(self) -> Mobility:
        held = np.zeros(len(self.dofs), dtype=bool)
        held[[self._numbers[dof] for dof in self.fixed]] = True
        kept = np.flatnonzero(~held)
        told = Freedom(kept, SparseMatrix.selection(len(held), kept))
        matrices = {kind: getattr(self, kind) for kind in KINDS}
        return mobility(self.dofs, told, self._scale, self._massive, matrices)

    @cached_property
    def _massive(self) -> NDArray[np.bool_]:
        """Which dofs have inertia in whatever way they move, (dofs,)."""
        massive = self.mass.diagonal() > 0.0
        for group, matrix in self._mass_groups:
            massive[group] = is_definite(matrix, ROUNDING)
        return massive

    @cached_property
    def _mass_groups(self) -> list[tuple[IndexArray, FloatArray]]:
        """Dofs that the mass matrix couples, with their mass, where they are not too many."""
        groups = (
            np.array(group)
            for group in components(len(self.dofs), self.mass.rows, self.mass.columns)
            if 1 < len(group) <= LARGEST_DENSE
        )
        return [(group, self.mass.restricted(group).to_dense()) for group in groups]

    @property
    def _scale(self) -> FloatArray:
        """Size of a typical motion of each dof: it moves something by about 1 m."""
        places = np.array([*self.positions.values()] or [(0.0, 0.0, 0.0)])
        size = float(np.ptp(places, axis=0).max()) or 1.0
        return np.array([1.0 / size if dof.startswith("dr") else 1.0 for _, dof in self.dofs])


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
