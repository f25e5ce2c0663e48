"""Recovery: motions, strains, stresses, section forces and reactions of a structure in a run.

With static correction, what the modes left out add to the displacements is taken as static: the
displacement under what of each force on the structure the modes do not take (the mode-acceleration
method, R. R. Craig and A. J. Kurdila, Fundamentals of Structural Dynamics, 2nd edition, Wiley,
2006, section 11.4). Then every node is in equilibrium.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, boolean, finite, name, one_of
from bumpstop.carried import carried_form
from bumpstop.errors import InputError
from bumpstop.instants import checked_times
from bumpstop.labelled import over_time, time_coordinate
from bumpstop.modal.unit_motion import unit_motion
from bumpstop.post.force_field import ForceField
from bumpstop.post.forces import Forces
from bumpstop.post.full_forces import FullForces
from bumpstop.post.of_run import of_run
from bumpstop.projection import along
from bumpstop.quantities import dof_units
from bumpstop.structure.cut import Cut
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.elements.varying import flexibility
from bumpstop.structure.gauge import Gauge
from bumpstop.structure.model import SectionModel
from bumpstop.structure.points import beam_point

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

    from bumpstop.response import Response
    from bumpstop.structure.beam_element import BeamElement
    from bumpstop.structure.forms import LinearForm

__all__ = ["Recovery", "recovery"]

SECTION_FORCES = {
    "N": ("N", "normal force, positive in tension"),
    "Vy": ("N", "shear force along local y"),
    "Vz": ("N", "shear force along local z"),
    "T": ("N m", "torque"),
    "My": ("N m", "bending moment about local y"),
    "Mz": ("N m", "bending moment about local z"),
}
"""Forces of the part beyond a section on the part before it: unit and meaning."""

RESULTANTS = ("inertia", "damping", "load", "law", "elastic", "reaction", "residual")


@of_run
def recovery(response: Response, *, static_correction: bool = True) -> Recovery:
    """Return what reads forces and motions of the structure out of a run.

    Parameters
    ----------
    response
        A run whose basis was made from a structure or from matrices.
    static_correction
        Add what the modes left out do under the forces of the run, taken as static. Of full
        models, what loads and inertia do between the nodes is all that there is to add.

    Raises
    ------
    InputError
        If the basis was not made from a structure, or a full model has kept the motion of a few
        dofs alone.

    Examples
    --------
    The moment at the root of a cantilever of 2 m that a force of 3 N holds down, at rest.

    >>> import bumpstop as bs
    >>> steel = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    >>> bar = bs.Rectangle(height=0.02, width=0.02)
    >>> cantilever = bs.Structure(
    ...     nodes={"A": (0, 0, 0), "B": (2, 0, 0)},
    ...     beams=[bs.Beam("AB", nodes=("A", "B"), elements=4, material=steel, section=bar)],
    ...     supports=[bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))],
    ... )
    >>> basis = bs.ModalBasis.from_structure(cantilever, modes=2, damping=0.7)
    >>> push = bs.NodalForce("push", node="B", force=(0, 0, -3.0))
    >>> run = bs.simulate(bs.Problem(basis, loads=[push], duration=5.0))
    >>> print(f"{bs.recovery(run).section_forces('AB', 0.0).My.values[-1]:.9f}")
    6.000000000
    """
    return Recovery(response, boolean("static_correction", static_correction))


@dataclass(frozen=True, eq=False)
class Recovery:
    """Reads forces and motions of the structure out of a run, at the times of its response.

    Made by `recovery`; displacements under a residual shape are found once for all readings.
    """

    response: Response
    static_correction: bool
    forces: Forces = field(init=False, repr=False)

    def __post_init__(self) -> None:
        kind = FullForces if self.response.problem.basis.unreduced else Forces
        object.__setattr__(self, "forces", kind(self.response))

    def displacement(self, node: str, dof: str) -> xr.DataArray:
        """Return the displacement of a node or of a point along a beam, in m or rad.

        Raises
        ------
        InputError
            If the structure has no such place.
        """
        form = self.forces.model.displacement_form(name("node", node), one_of("dof", dof, DOFS))
        return over_time(
            "displacement",
            self.response.times,
            self.read(form) + self._inside_of(node, dof),
            units=dof_units("displacement", dof),
            long_name=f"displacement of {node} along {dof}",
            node=node,
            dof=dof,
        )

    def strain(self, beam: str, at: float, fibre: tuple[float, float]) -> xr.DataArray:
        """Return the axial strain of a fibre (y, z), ``at`` m along a beam, as a gauge reads it.

        Raises
        ------
        InputError
            If there is no such beam, place or fibre.
        """
        gauge = Gauge("fibre", beam=beam, at=at, fibre=fibre)
        values = self.read(self._sections.strain_form(gauge)) + self._strain_inside(gauge)
        return over_time("gauge", self.response.times, values, beam=beam)

    def stress(self, beam: str, at: float, fibre: tuple[float, float]) -> xr.DataArray:
        """Return the axial stress of a fibre (y, z), ``at`` m along a beam, in Pa.

        It is N / A - y Mz / Iz + z My / Iy: Young's modulus times the strain of the fibre.

        Raises
        ------
        InputError
            If there is no such beam, place or fibre.
        """
        import xarray as xr

        gauge = Gauge("fibre", beam=beam, at=at, fibre=fibre)
        y, z = gauge.fibre
        form = self._sections.stress_form(gauge)
        young = self._sections.beam_element(gauge.beam, gauge.at).slice_at(0.0).young
        return xr.DataArray(
            self.read(form) + young * self._strain_inside(gauge),
            coords={"time": time_coordinate(self.response.times)},
            name="stress",
            attrs={
                "units": "Pa",
                "long_name": f"axial stress in {beam}, {gauge.at:g} m along, at ({y:g}, {z:g}) m",
            },
        )

    def section_forces(self, beam: str, at: float | Sequence[float]) -> xr.Dataset:
        """Return the forces in sections of a beam: N, Vy, Vz, T, My, Mz.

        They are those of the part beyond the section on the part before it, along and about the
        beam's local axes: stiffness of the element times displacements of its nodes and, with
        static correction, what loads, inertia and laws do between the nodes, on an element whose
        ends are held. Without it, normal force, shear and torque are even along an element and
        moments change linearly; they then jump between elements by what their nodes take.

        Parameters
        ----------
        beam
            Name of the beam.
        at
            Distance from its first node in m, or several.

        Returns
        -------
        xarray.Dataset
            Over ``time``, or over ``time`` and ``at`` for several; N and N m.

        Raises
        ------
        InputError
            If there is no such beam, or a section is not on it.
        """
        import xarray as xr

        name("beam", beam)
        if np.size(at) == 0:
            raise InputError("must be a place along the beam, or several", key="at", value=at)
        one = np.ndim(at) == 0
        places = [finite("at", place) for place in np.atleast_1d(np.asarray(at)).tolist()]
        forms = [self._sections.section_forms(beam, place) for place in places]
        inside = np.stack([self._forces_inside(beam, place) for place in places])
        found = {}
        for number, (force, (units, words)) in enumerate(SECTION_FORCES.items()):
            values = np.stack([self.read(each[number]) for each in forms], axis=1)
            values += inside[:, number].T
            attributes = {"units": units, "long_name": f"{words} in {beam}"}
            dims, kept = (("time",), values[:, 0]) if one else (("time", "at"), values)
            found[force] = (dims, kept, attributes)
        along_beam = {"units": "m", "long_name": f"distance along {beam}"}
        where = ("at", places, along_beam) if not one else ((), places[0], along_beam)
        coordinates = {"time": time_coordinate(self.response.times), "at": where}
        return xr.Dataset(found, coords=coordinates, attrs={"beam": beam})

    def reactions(self, node: str) -> xr.Dataset:
        """Return what supports, relations and links do to a node: ``dx`` ... in N, ``drx`` in N m.

        It is what all other forces at the node lack for equilibrium, and so nothing but
        rounding at a node that is free or on springs (`spring_forces` has theirs), if there is
        static correction; of a full model, what
        its step method leaves between two steps.

        Raises
        ------
        InputError
            If there is no such node.
        """
        import xarray as xr

        self._refuse_parts()
        dofs = {own: number for number, own in enumerate(self.forces.model.dofs)}
        rows = [dofs.get((name("node", node), dof)) for dof in DOFS]
        known = [(dof, row) for dof, row in zip(DOFS, rows, strict=True) if row is not None]
        if not known:
            raise InputError("reactions are those of nodes", key="node", value=node)
        lacking = self._in_pieces(lambda times: self.lacking(times)[[row for _, row in known]])
        told = {"force": "N", "moment": "N m"}
        found = {}
        for number, (dof, _) in enumerate(known):
            word = "force" if dof in DOFS[:3] else "moment"
            attributes = {"units": told[word], "long_name": f"reaction {word} {dof} at {node}"}
            found[dof] = ("time", lacking[number], attributes)
        return xr.Dataset(
            found, coords={"time": time_coordinate(self.response.times)}, attrs={"node": node}
        )

    def spring_forces(self, spring: str) -> xr.Dataset:
        """Return what a spring, damper or bearing does to each of its nodes.

        ``dx`` ... in N and ``drx`` ... in N m over ``node`` and ``time``, in global axes: its
        matrices times displacements, with static correction, and velocities, which have none. To
        the ground it does the opposite of what it does to its only node.

        Raises
        ------
        InputError
            If the structure has no such spring or bearing.
        """
        from bumpstop.post.spring_forces import spring_forces

        return spring_forces(self, spring)

    def resultants(self) -> xr.Dataset:
        """Return the sum of the forces of each kind, and their moments about the origin.

        ``inertia``, ``damping``, ``load``, ``law``, ``elastic`` (of springs to the ground; forces
        within the structure cancel) and ``reaction``, each over ``time`` and ``dof``; in N along
        ``dx dy dz`` and N m about ``drx dry drz``. ``residual`` is their sum, which is rounding
        if there is static correction.
        """
        import xarray as xr

        self._refuse_parts()
        parts = self._in_pieces(self._resultants)
        attributes = {"units": "N", "long_name": "sum of forces, and moment about the origin"}
        return xr.Dataset(
            {
                name: (("time", "dof"), values.T, attributes)
                for name, values in zip(RESULTANTS, np.split(parts, len(RESULTANTS)), strict=True)
            },
            coords={"time": time_coordinate(self.response.times), "dof": list(DOFS)},
        )

    def _resultants(self, times: FloatArray) -> FloatArray:
        """Return the sums of forces of all kinds below each other, (6 kinds, time)."""
        forces, model = self.forces, self.forces.model
        bodies = np.stack([unit_motion(model, dof) for dof in DOFS])
        held = np.ones(len(model.dofs), dtype=bool)
        held[model.free] = False
        found = {name: np.zeros((6, len(times))) for name in RESULTANTS}
        found["inertia"] = bodies @ forces.inertia(times)
        found["damping"] = bodies @ forces.modal_damping(times)
        for each in forces.local:
            found[each.kind] += bodies @ each.fields @ each.sizes(times).T
        found["elastic"] = -(bodies @ (model.stiffness @ self.field(times)))
        found["reaction"] = bodies[:, held] @ self.lacking(times)[held]
        found["residual"] = np.sum(list(found.values()), axis=0)
        return np.concatenate(list(found.values()))

    def lacking(self, times: ArrayLike) -> FloatArray:
        """Return the forces that each dof lacks for equilibrium, (dofs, time), in N and N m.

        They are those of supports, and of relations and links. For all else, inertia, damping,
        elastic forces, loads and laws are in equilibrium.
        """
        instants = self._instants(times)
        forces = self.forces
        total = forces.model.stiffness @ self.field(instants)
        total -= forces.inertia(instants) + forces.modal_damping(instants)
        for each in forces.local:
            total -= each.fields @ each.sizes(instants).T
        return total

    def field(self, times: ArrayLike) -> FloatArray:
        """Return the displacements of all dofs at some times, (dofs, time), in m and rad.

        They are seen from supports that move all together, and else from the still ground.
        """
        instants = self._instants(times)
        total = self.forces.carried(instants)
        total += self.forces.basis.shapes @ self.response.motion(0, instants).T
        for each, shapes in self._corrections:
            total += shapes @ each.sizes(instants).T
        return total

    def read(self, form: LinearForm) -> FloatArray:
        """Return a linear form of the displacements over time, (time,)."""
        times = self.response.times
        values = along(form.of(self.forces.basis.shapes), self.response.motion(0))
        values = values + carried_form(self.response.problem, form, times)
        for each, shapes in self._corrections:
            values = values + along(form.of(shapes), each.sizes(times))
        return values

    def _forces_inside(self, beam: str, at: float) -> FloatArray:
        """Return what acts between the nodes adds to the forces in a section, (6, time)."""
        element = self._sections.beam_element(beam, at)
        return self._inside(beam, at, element, partial(element.forces, at))

    def _strain_inside(self, gauge: Gauge) -> FloatArray:
        """Return what acts between the nodes adds to the strain of a fibre, (time,)."""
        element = self._sections.beam_element(gauge.beam, gauge.at)
        part = element.slice_at((gauge.at - element.start) / element.length)
        y, z = gauge.fibre
        strain = flexibility(part) * [1.0, 0.0, 0.0, 0.0, z, -y]
        if not element.bends:
            strain[1:] = 0.0

        def kernel(place: float) -> FloatArray:
            return np.asarray((strain @ element.forces(gauge.at, place))[np.newaxis])

        (added,) = self._inside(gauge.beam, gauge.at, element, kernel)
        return np.asarray(added)

    def _inside_of(self, node: str, dof: str) -> FloatArray:
        """Return what acts between nodes adds to the displacement of a point, (time,)."""
        point = beam_point(node)
        model = self.forces.model
        if point is None or not isinstance(model, SectionModel):
            return np.zeros(len(self.response.times))
        element = model.beam_element(*point)
        row = DOFS.index(dof)

        def kernel(place: float) -> FloatArray:
            return element.displacements(point[1], place)[row : row + 1]

        (added,) = self._inside(*point, element, kernel)
        return np.asarray(added)

    def _inside(
        self, beam: str, at: float, element: BeamElement, kernel: Callable[[float], FloatArray]
    ) -> FloatArray:
        """Return what acts between the nodes of an element adds to a reading, (r, time)."""
        cut = Cut(self.forces.model, beam, at, element, kernel)
        if not self.static_correction:
            return np.zeros((len(kernel(at)), len(self.response.times)))
        return self.forces.inside(cut, self.response.times)

    def _instants(self, times: ArrayLike) -> FloatArray:
        return checked_times(times, self.response.problem.duration)

    def _refuse_parts(self) -> None:
        """Raise for substructures: forces that their dofs lack are those of joints as well."""
        from bumpstop.modal.substructure.assembly import Assembly

        if isinstance(self.forces.model, Assembly):
            what = "reactions and resultants of joined parts are not known"
            raise InputError(what, key="basis", hint="section forces and stresses are")

    @property
    def _sections(self) -> SectionModel:
        model = self.forces.model
        if not isinstance(model, SectionModel):
            what = "forces in beams need a basis computed from a structure"
            raise InputError(what, key="beam", value=type(model).__name__)
        return model

    @cached_property
    def _corrections(self) -> list[tuple[ForceField, FloatArray]]:
        """What the modes do not take, each with the displacements under it, (dofs, m)."""
        if not self.static_correction:
            return []
        from bumpstop.modal.static_shapes import StaticShapes

        static = StaticShapes(self.forces.model)
        return [(each, static.under(each.fields)) for each in self.forces.untaken]

    def _in_pieces(self, reading: Callable[[FloatArray], FloatArray]) -> FloatArray:
        """Return a reading of many times, so that all dofs at all times are never kept at once."""
        pieces = max(1, len(self.forces.model.dofs) * len(self.response.times) // 2_000_000)
        parts = np.array_split(self.response.times, pieces)
        return np.concatenate([reading(times) for times in parts], axis=1)
