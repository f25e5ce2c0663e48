"""From checked tables to the objects that are simulated."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, TypeVar

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io.case.keys import keyed
from bumpstop.laws import Stop
from bumpstop.loads import Gravity, ModalState, NodalForce, RigidRotation
from bumpstop.modal.basis import ModalBasis
from bumpstop.problem import Problem
from bumpstop.structure import Beam, Gauge, Material, PointMass, Rectangle, Structure, Support

if TYPE_CHECKING:
    from bumpstop.io.case.tables.beams import BeamTable
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.initial import InitialTable
    from bumpstop.io.case.tables.loads import LoadTable
    from bumpstop.problem import InitialState, Load

__all__ = ["Builder"]

_STRUCTURE = ("nodes", "materials", "sections", "beams", "masses", "supports", "basis")
_Part = TypeVar("_Part")


class Builder:
    """Builds the problems of one case; variants of the same structure share its modes."""

    def __init__(self) -> None:
        self._bases: list[tuple[CaseFile, ModalBasis]] = []

    def problem(self, case: CaseFile) -> Problem:
        """Return the problem that the tables describe.

        Raises
        ------
        InputError
            If something named is not there or numbers do not fit together; its key is that
            of the file.
        """
        basis = self._basis(case)
        initial = _initial(case.initial)
        with keyed(renamed=_renamed(case)):
            return Problem(
                basis,
                laws=_stops(case),
                loads=[_load(name, table) for name, table in case.loads.items()],
                initial=initial,
                duration=case.run.duration,
                sample=case.run.sample,
                gauges=_gauges(case),
                outputs=[(output.node, output.dof) for output in case.outputs],
            )

    def _basis(self, case: CaseFile) -> ModalBasis:
        for known, basis in self._bases:
            if all(getattr(known, table) == getattr(case, table) for table in _STRUCTURE):
                return basis
        basis = _basis(case)
        self._bases.append((case, basis))
        return basis


def _renamed(case: CaseFile) -> dict[str, str]:
    """Return where in the file the arguments of a problem stand."""
    state = "initial.rotation" if case.initial and case.initial.rotation else "initial.modal"
    return {"duration": "run.duration", "sample": "run.sample", "initial": state}


def _basis(case: CaseFile) -> ModalBasis:
    with keyed():
        structure = _structure(case)
    with keyed("basis"):
        return ModalBasis.from_structure(
            structure, modes=case.basis.modes, damping=case.basis.damping
        )


def _structure(case: CaseFile) -> Structure:
    return Structure(
        nodes=case.nodes,
        beams=_beams(case),
        masses=[
            PointMass(name, node=table.node, mass=table.mass) for name, table in case.masses.items()
        ],
        supports=[
            Support(nodes=_all_or(table.nodes), fixed=tuple(table.fixed)) for table in case.supports
        ],
    )


def _all_or(nodes: list[str]) -> str | tuple[str, ...]:
    return "all" if nodes == ["all"] else tuple(nodes)


def _beams(case: CaseFile) -> list[Beam]:
    materials, sections = {}, {}
    for name, material in case.materials.items():
        with keyed(f"materials.{name}"):
            materials[name] = Material(**material.model_dump())
    for name, section in case.sections.items():
        with keyed(f"sections.{name}"):
            sections[name] = Rectangle(height=section.height, width=section.width)
    return [_beam(name, table, materials, sections) for name, table in case.beams.items()]


def _beam(
    name: str,
    table: BeamTable,
    materials: Mapping[str, Material],
    sections: Mapping[str, Rectangle],
) -> Beam:
    with keyed(f"beams.{name}"):
        return Beam(
            name,
            nodes=table.nodes,
            elements=table.elements,
            theory=table.theory,
            material=_named("material", table.material, materials),
            section=_named("section", table.section, sections),
        )


def _named(key: str, name: str, known: Mapping[str, _Part]) -> _Part:
    if name not in known:
        raise InputError(f"unknown {key}", key=key, value=name, hint=did_you_mean(name, known))
    return known[name]


def _stops(case: CaseFile) -> list[Stop]:
    stops = []
    for name, table in case.stops.items():
        with keyed(f"stops.{name}"):
            stops.append(Stop(name, **table.model_dump()))
    return stops


def _load(name: str, table: LoadTable) -> Load:
    with keyed(f"loads.{name}"):
        if table.type == "gravity":
            return Gravity(name, acceleration=table.acceleration)
        return NodalForce(name, node=table.node, force=table.force, moment=table.moment)


def _initial(table: InitialTable | None) -> InitialState | None:
    if table is None:
        return None
    with keyed("initial"):
        if table.rotation and table.modal:
            raise InputError("rotation and modal exclude each other", hint="give one of them")
        if table.rotation:
            return RigidRotation(about=table.rotation.about, rate=table.rotation.rate)
        if table.modal:
            state = table.modal
            return ModalState(displacement=state.displacement, velocity=state.velocity)
        raise InputError("is empty", hint="give rotation or modal, or leave [initial] out")


def _gauges(case: CaseFile) -> list[Gauge]:
    gauges = []
    for name, table in case.gauges.items():
        with keyed(f"gauges.{name}"):
            gauges.append(Gauge(name, beam=table.beam, at=table.at, fibre=table.fibre))
    return gauges
