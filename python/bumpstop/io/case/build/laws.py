"""Stops and other laws."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bumpstop.io.case.keys import keyed
from bumpstop.io.case.tables.table import Table
from bumpstop.laws import Stop

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.laws import LawTable
    from bumpstop.io.case.tables.stops import StopTable
    from bumpstop.laws import BucklingStop, DamperLaw, SpringLaw
    from bumpstop.problem import Law

__all__ = ["built_laws"]

ELASTIC = (
    "stiffness",
    "damping",
    "friction",
    "sliding",
    "tangential_stiffness",
    "tangential_damping",
    "motion",
    "frame",
)
"""What a stop that gives way can have."""
POWER = ("exponent", "hunt_crossley")
"""What makes a stop one whose force is a power of its depth."""
NOT_POWER = (
    *(key for key in ELASTIC if key not in ("stiffness", "motion", "frame")),
    "buckling",
)
"""What such a stop cannot have."""
SHAPED = ("axis", "roll", "centre", "radius", "body_radius", "side", "profile")
"""What obstacles about an axis alone have."""

CONNECTIONS = {
    "zener": "ZenerDamper",
    "relation": "ForceRelation",
    "seismic": "SeismicDevice",
    "hardening": "HardeningSpring",
}
"""The class of each type of law that takes what its table has."""
PROGRAMMED = ("python", "program")
"""The types of laws that a program of the user computes."""
SLOPES = {"spring": ("stiffness", "breaks", "preload"), "damper": ("damping", "breaks", "offset")}
"""What a curve tells of the types that have several slopes."""


def built_laws(case: CaseFile, folder: Path) -> list[Law]:
    """Return the laws that the tables describe; files in them are relative to the folder."""
    laws: list[Law] = []
    for name, table in case.stops.items():
        with keyed(f"stops.{name}"):
            laws.extend(_stops(name, table, folder))
    for name, law in case.laws.items():
        with keyed(f"laws.{name}"):
            if law.type == "cracked_rotor":
                from bumpstop.io.case.build.cracked_rotor import built_crack

                laws.append(built_crack(name, law, case, folder))
            else:
                laws.append(_connection(name, law, folder))
    return laws


def _stops(name: str, table: StopTable, folder: Path) -> Iterator[Law]:
    """Yield the stop of a table, or those of its nodes and of both its planes."""
    if table.nodes is None and table.obstacle == "plane":
        yield _stop(name, table, folder)
        return
    from bumpstop.io.case.build.shapes import AROUND, faces, shaped_stop

    for own, each in faces(name, table):
        if each.obstacle in AROUND:
            yield shaped_stop(own, _moving(_given(each), each, folder))
        else:
            yield _stop(own, each, folder)


def _stop(name: str, table: StopTable, folder: Path) -> Law:
    from bumpstop.errors import InputError
    from bumpstop.io.case.fields.laws import contact_stiffness

    given = _given(table)
    _refuse(given, SHAPED, "a plane", 'take obstacle = "circle" or "polar"')
    for key in ("half_thickness", "other_half_thickness"):
        given["gap"] -= given.pop(key, 0.0)
    _moving(given, table, folder)
    if table.restitution is not None:
        from bumpstop.laws import RigidStop

        elastic = [key for key in ELASTIC if key not in ("friction", "sliding")]
        _refuse(given, (*elastic, *POWER, "buckling"), "a rigid stop", "restitution")
        return RigidStop(name, **given)
    if table.stiffness is None:
        hint = "a rigid stop has a restitution instead"
        raise InputError("is missing", key="stiffness", hint=hint)
    if "resolution" in given:
        what, value = "belongs to rigid stops", given["resolution"]
        raise InputError(what, key="resolution", value=value, hint="leave it out")
    if given.get("sliding") == "plane":
        from bumpstop.io.case.build.shapes import plane_stop

        return plane_stop(name, given)
    power = any(key in given for key in POWER)
    exponent = given.get("exponent", 1.5 if power else 1.0)
    given["stiffness"] = contact_stiffness(table.stiffness, exponent)
    if power:
        from bumpstop.laws import HertzStop

        _refuse(given, NOT_POWER, "a stop whose force is a power of its depth", "exponent")
        return HertzStop(name, **given)
    if table.buckling is not None:
        return _buckling(name, given)
    return Stop(name, **given)


def _moving(given: dict[str, Any], table: StopTable, folder: Path) -> dict[str, Any]:
    """Return keys of a stop with the functions of time that move its obstacle."""
    if table.motion is not None:
        from bumpstop.io.case.build.motion import along_axes, along_normal
        from bumpstop.io.case.build.shapes import AROUND

        has_shape = table.obstacle in AROUND or table.sliding == "plane"
        with keyed("motion"):
            moved = along_axes if has_shape else along_normal
            given["motion"] = moved(table.motion, folder)
    return given


def _buckling(name: str, given: dict[str, Any]) -> BucklingStop:
    from bumpstop.laws import BucklingStop

    kept = ("stiffness", "damping")
    unlike = [key for key in ELASTIC if key not in kept]
    _refuse(given, unlike, "a stop that buckles", "buckling")
    after = {key: value for key, value in given.pop("buckling") if value is not None}
    return BucklingStop(name, **given, **after)


def _refuse(given: dict[str, Any], keys: Iterable[str], kind: str, reason: str) -> None:
    """Raise for keys that a kind of stop has no use for; those at their defaults are taken out."""
    from bumpstop.errors import InputError

    for key in keys:
        value = given.pop(key, None)
        if value:
            hint = f"leave it out, or {reason}"
            raise InputError(f"is of no use to {kind}", key=key, value=value, hint=hint)


def _connection(name: str, table: LawTable, folder: Path) -> Law:
    import bumpstop.laws as known

    given = _given(table)
    kind = given.pop("type")
    if kind in PROGRAMMED:
        from bumpstop.io.case.build import programs

        return (
            programs.user_law(name, given, folder)
            if kind == "python"
            else (programs.outside_program(name, given, folder))
        )
    if kind in SLOPES:
        return _of_slopes(name, kind, given)
    law: Law = getattr(known, CONNECTIONS[kind])(name, **given)
    return law


def _of_slopes(name: str, kind: str, given: dict[str, Any]) -> SpringLaw | DamperLaw:
    """Return a law whose force has several slopes."""
    from bumpstop.errors import InputError
    from bumpstop.laws import DamperLaw, SpringLaw

    law, told = SpringLaw if kind == "spring" else DamperLaw, SLOPES[kind]
    curve = given.pop("curve", None)
    if curve is None:
        if told[0] not in given:
            raise InputError("must have the slopes of its segments, or a curve", key=told[0])
        return law(name, **given)
    for key in told:
        if key in given:
            raise InputError("is told by the curve already", key=key, value=given[key])
    return law.through(curve, name, **given)


def _given(table: Table) -> dict[str, Any]:
    """Return the keys that have a value, the terms as weights by node and dof."""
    given = {key: value for key, value in table if value is not None}
    if "terms" in given:
        given["terms"] = {
            (node, dof): weight
            for node, weights in given["terms"].items()
            for dof, weight in weights.items()
        }
    return given
