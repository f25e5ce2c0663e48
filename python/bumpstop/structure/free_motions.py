"""What the motions are that strain nothing: in words, of which piece, and whether a mechanism.

Each connected piece of a model may move as a whole: that is a rigid motion, named by its
direction or axis, and by its nodes where it is not the only piece. What else strains nothing
moves parts of a piece against each other: a mechanism, named by what turns about what, or by
the dofs that move most.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray, Vector
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.echelon import independent_rows, null_space
from bumpstop.structure.frame import rigid_motions
from bumpstop.structure.graph import components
from bumpstop.structure.model import LinearModel
from bumpstop.structure.rigid_words import direction_words, names_words, rigid_words
from bumpstop.structure.sparse import IndexArray

__all__ = ["FreeMotion", "free_motions"]

_MANY = 60
"""Most free motions of a piece among which those of the whole are looked for."""

_SAME = 1e-7
"""Motions that differ by less, relative to their size, are the same."""


_JOINING = ("stiffness", "mass", "damping", "gyroscopic", "circulatory")
"""Matrices by which one part is felt by another."""


@dataclass(frozen=True)
class FreeMotion:
    """A motion that strains nothing.

    Parameters
    ----------
    how
        The motion in words: ``"rotation about z through A"``.
    is_mechanism
        Whether it moves parts of a connected piece against each other.
    piece
        The nodes of the piece that moves, where others can move beside it and nothing joins
        them; else nothing.
    """

    how: str
    is_mechanism: bool
    piece: str = ""

    @property
    def text(self) -> str:
        """What moves and how: ``"translation along x of C, D"``."""
        return f"{self.how} of {self.piece}" if self.piece and not self.is_mechanism else self.how


def free_motions(model: LinearModel) -> list[FreeMotion]:
    """Return the motions of a model that strain nothing, rigid motions of whole pieces first.

    A piece with a node of unknown position is known to be rigid in translations alone.
    Amplitudes of shapes are not looked at; what moves them alone counts as a mechanism.

    Examples
    --------
    >>> from bumpstop import Beam, Material, Rectangle, Structure, Support
    >>> steel = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    >>> beam = Beam("AB", nodes=("A", "B"), elements=4, material=steel,
    ...     section=Rectangle(height=0.02, width=0.02))
    >>> hinged = Structure(nodes={"A": (0, 0, 0), "B": (1, 0, 0)}, beams=[beam],
    ...     supports=[Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry"))])
    >>> free_motions(hinged)
    [FreeMotion(how='rotation about z through A', is_mechanism=False, piece='')]
    """
    fields = model.expansion @ model.rigid_shapes()
    if fields.shape[1] == 0:
        return []
    ground = _Ground.of(model)
    several = len(ground.pieces(model, *_JOINING)) > 1
    found = [
        motion
        for rows in ground.pieces(model, "stiffness")
        for motion in _of_piece(ground, rows, fields[rows], named=several)
    ]
    amplitudes = fields[:, ~fields[ground.dof >= 0].any(axis=0)]
    found += [FreeMotion(_led_by(model.dofs, field), is_mechanism=True) for field in amplitudes.T]
    return sorted(found, key=lambda motion: motion.is_mechanism)


@dataclass(frozen=True, eq=False)
class _Ground:
    """Where the dofs of a model are.

    Parameters
    ----------
    names
        Names of the nodes.
    positions
        Where they are in m, (nodes, 3); NaN where that is not known.
    node, dof
        Of each row, the numbers of its node and of its place in ``DOFS``; -1 for another dof.
    """

    names: tuple[str, ...]
    positions: FloatArray
    node: IndexArray
    dof: IndexArray

    @classmethod
    def of(cls, model: LinearModel) -> _Ground:
        """Return where the dofs of a model are."""
        names = tuple(dict.fromkeys(node for node, _ in model.dofs))
        numbers = {name: number for number, name in enumerate(names)}
        return cls(
            names,
            positions=np.array([_position(model, name) for name in names]),
            node=np.array([numbers[node] for node, _ in model.dofs]),
            dof=np.array([DOFS.index(dof) if dof in DOFS else -1 for _, dof in model.dofs]),
        )

    @cached_property
    def size(self) -> float:
        """A length in m that is typical of the model."""
        known = self.positions[~np.isnan(self.positions[:, 0])]
        return float(np.ptp(known, axis=0).max()) or 1.0 if len(known) else 1.0

    def pieces(self, model: LinearModel, *matrices: str) -> list[IndexArray]:
        """Return the rows that can move of each piece that some matrices hold together."""
        expansion = model.expansion
        same = np.flatnonzero(np.diff(expansion.columns) == 0)
        given = [getattr(model, matrix) for matrix in matrices]
        of_node = components(
            len(self.names),
            self.node[np.concatenate([expansion.rows[same], *(matrix.rows for matrix in given)])],
            self.node[
                np.concatenate([expansion.rows[same + 1], *(matrix.columns for matrix in given)])
            ],
        )
        piece = np.zeros(len(self.names), dtype=np.intp)
        for number, nodes in enumerate(of_node):
            piece[nodes] = number
        moving = np.zeros(len(self.node), dtype=bool)
        moving[expansion.rows] = True
        rows = np.flatnonzero(moving & (self.dof >= 0))
        rows = rows[np.argsort(piece[self.node[rows]], kind="stable")]
        ends = np.flatnonzero(np.diff(piece[self.node[rows]])) + 1
        return np.split(rows, ends) if len(rows) else []

    def scaled(self, rows: IndexArray, fields: FloatArray) -> FloatArray:
        """Return fields with rotations as the displacements that they make at a distance."""
        scale = np.where(self.dof[rows] < 3, 1.0, self.size)
        return fields * scale[:, np.newaxis]

    def rigid(self, rows: IndexArray) -> FloatArray:
        """Return the six rigid motions of some rows, scaled; about the origin, (rows, 6).

        Rotations are left out, as zeros, where a position is not known.
        """
        positions = self.positions[self.node[rows]]
        motions = rigid_motions(np.nan_to_num(positions) / self.size, np.zeros(3))
        own: FloatArray = motions[6 * np.arange(len(rows)) + self.dof[rows]]
        if np.isnan(positions).any():
            own[:, 3:] = 0.0
        return own

    def words(self, motion: FloatArray) -> str:
        """Return what one of these, (6,), is in words."""
        known = np.flatnonzero(~np.isnan(self.positions[:, 0]))
        names = [self.names[node] for node in known]
        return rigid_words(motion[:3], motion[3:] / self.size, names, self.positions[known])


def _position(model: LinearModel, node: str) -> Vector:
    try:
        return model.position(node)
    except InputError:
        return (np.nan, np.nan, np.nan)


def _of_piece(
    ground: _Ground, rows: IndexArray, fields: FloatArray, *, named: bool
) -> list[FreeMotion]:
    """Return the motions of one piece, given on its rows."""
    fields = ground.scaled(rows, fields)
    fields = fields[:, np.abs(fields).max(axis=0) > 0.0]
    if fields.shape[1] == 0:
        return []
    rigid = ground.rigid(rows)
    # With so many, the piece does not hang together; its few rigid motions are among them.
    whole = _common(rigid, fields) if fields.shape[1] <= _MANY else np.zeros((6, 0))
    piece = _names(ground, rows) if named else ""
    words = [_whole_words(ground, motion, whole) for motion in whole.T]
    others = _others(fields, rigid @ whole)
    mechanisms = [_mechanism_words(ground, rows, field) for field in others.T]
    return [
        *(FreeMotion(how, is_mechanism=False, piece=piece) for how in words),
        *(FreeMotion(how, is_mechanism=True, piece=piece) for how in mechanisms),
    ]


def _common(rigid: FloatArray, fields: FloatArray) -> FloatArray:
    """Return independent combinations of rigid motions that are among the fields, (6, n)."""
    directions = _directions(fields)
    common = null_space(rigid - directions @ (directions.T @ rigid))
    moving = np.flatnonzero(np.abs(rigid @ common).max(axis=0) > _SAME)
    chosen = independent_rows((rigid @ common[:, moving]).T)
    return common[:, moving[chosen]]


def _others(fields: FloatArray, known: FloatArray) -> FloatArray:
    """Return fields that are no combination of the known ones; those that move least first."""
    moved = np.abs(fields) > _SAME * np.abs(fields).max(axis=0)
    fields = fields[:, np.argsort(moved.sum(axis=0), kind="stable")]
    if known.shape[1] == 0:
        return fields
    directions = np.zeros((len(fields), fields.shape[1]))
    count = known.shape[1]
    directions[:, :count] = _directions(known)
    others = []
    for field in fields.T:
        left = field / np.linalg.norm(field)
        for _ in range(2):  # once more removes what rounding left
            left = left - directions[:, :count] @ (directions[:, :count].T @ left)
        size = np.linalg.norm(left)
        if size > _SAME and count < fields.shape[1]:
            directions[:, count] = left / size
            count += 1
            others.append(field)
    return np.array(others).reshape(-1, len(fields)).T


def _whole_words(ground: _Ground, motion: FloatArray, whole: FloatArray) -> str:
    """Return what a motion of a whole piece is; its axis has no place if all shifts are free."""
    turn = motion[3:]
    if turn.any():
        shifts = whole[:3, ~whole[3:].any(axis=0)]
        across = shifts - np.outer(turn, turn @ shifts) / (turn @ turn)
        if np.linalg.matrix_rank(across, tol=_SAME) == 2:
            return f"rotation about {direction_words(turn)}"
    return ground.words(motion)


def _mechanism_words(ground: _Ground, rows: IndexArray, field: FloatArray) -> str:
    """Return what a mechanism is: a rigid motion of some nodes, or where it moves most."""
    moved = np.unique(ground.node[rows[np.abs(field) > _SAME * np.abs(field).max()]])
    inside = np.isin(ground.node[rows], moved)
    rigid = ground.rigid(rows[inside])
    for free in (3, 6):  # a translation, if that says it
        motion = np.zeros(6)
        motion[:free] = np.linalg.lstsq(rigid[:, :free], field[inside], rcond=_SAME)[0]
        if np.abs(rigid @ motion - field[inside]).max() <= _SAME * np.abs(field).max():
            motion[np.abs(motion) <= _SAME * np.abs(motion).max()] = 0.0
            return f"{ground.words(motion)} of {_names(ground, rows[inside])}"
    dofs = [(ground.names[ground.node[row]], DOFS[ground.dof[row]]) for row in rows]
    return _led_by(dofs, field)


def _led_by(dofs: Sequence[Dof], field: FloatArray) -> str:
    """Return which dofs move most."""
    sizes = np.round(np.abs(field) / np.abs(field).max(), 7)  # so that rounding orders nothing
    largest = np.argsort(-sizes, kind="stable")[:3]
    leading = [".".join(dofs[row]) for row in largest if sizes[row] > 0.0]
    more = np.count_nonzero(sizes) - len(leading)
    return f"motion of {', '.join(leading)}" + (f" and {more} more" if more else "")


def _names(ground: _Ground, rows: IndexArray) -> str:
    return names_words([ground.names[node] for node in np.unique(ground.node[rows])])


def _directions(fields: FloatArray) -> FloatArray:
    """Return orthonormal vectors that span independent fields."""
    return np.array(np.linalg.qr(fields / np.linalg.norm(fields, axis=0))[0])
