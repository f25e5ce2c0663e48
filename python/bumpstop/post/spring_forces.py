"""Forces of springs, dampers and bearings on the nodes that they join."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, one_of
from bumpstop.carried import carried_form
from bumpstop.errors import InputError
from bumpstop.labelled import time_coordinate
from bumpstop.projection import along
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.structure import Structure

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.post.recovery import Recovery
    from bumpstop.structure.bearing import Bearing
    from bumpstop.structure.spring import Spring

__all__ = ["spring_forces"]


def spring_forces(recovery: Recovery, spring: str) -> xr.Dataset:
    """Return what a spring or bearing does to its nodes; see `Recovery.spring_forces`."""
    import xarray as xr

    structure = recovery.forces.model
    if not isinstance(structure, Structure):
        what = "forces of springs need a basis computed from a structure"
        raise InputError(what, key="basis", hint="of joined parts and matrices none are named")
    part = _part(structure, spring)
    nodes = [part.node] if part.other is None else [part.node, part.other]
    forces = _forces(recovery, structure, part, nodes)
    found = {}
    for number, dof in enumerate(DOFS):
        word, units = ("force", "N") if number < 3 else ("moment", "N m")
        attributes = {"units": units, "long_name": f"{word} {dof} of {spring}"}
        found[dof] = (("node", "time"), forces[:, number], attributes)
    coordinates = {"node": nodes, "time": time_coordinate(recovery.response.times)}
    return xr.Dataset(found, coords=coordinates, attrs={"spring": spring})


def _part(structure: Structure, spring: str) -> Spring | Bearing:
    parts: dict[str, Spring | Bearing] = {each.name: each for each in structure.springs}
    parts |= {each.name: each for each in structure.bearings}
    if not parts:
        raise InputError("the structure has no springs or bearings", key="spring", value=spring)
    return parts[one_of("spring", spring, tuple(parts))]


def _forces(
    recovery: Recovery, structure: Structure, part: Spring | Bearing, nodes: list[str]
) -> FloatArray:
    """Return ``-(K + N) u - (C + G) u'`` on the nodes, (node, 6, time)."""
    block = part.block(structure.mesh)
    forms = [structure.displacement_form(node, dof) for node in nodes for dof in DOFS]
    displacement = np.stack([recovery.read(form) for form in forms])
    total = np.zeros(displacement.shape)
    for matrix in (block.stiffness, block.circulatory):
        if matrix is not None:
            total -= matrix @ displacement
    rates = [matrix for matrix in (block.damping, block.gyroscopic) if matrix is not None]
    if rates:
        response = recovery.response
        shapes, motion = recovery.forces.basis.shapes, response.motion(1)
        velocity = np.stack(
            [
                along(form.of(shapes), motion)
                + carried_form(response.problem, form, response.times, 1)
                for form in forms
            ]
        )
        for matrix in rates:
            total -= matrix @ velocity
    return total.reshape(len(nodes), len(DOFS), -1)
