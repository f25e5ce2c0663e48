"""A problem in words: what was modelled, and how it was solved."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bumpstop.laws import (
    BucklingStop,
    CircleStop,
    CrackedRotor,
    DamperLaw,
    ForceRelation,
    Friction,
    HardeningSpring,
    HertzStop,
    OutsideProgram,
    PlaneStop,
    PolarStop,
    RigidStop,
    SeismicDevice,
    SpringLaw,
    Stop,
    UserLaw,
    ZenerDamper,
)
from bumpstop.laws.shaped_stop import ShapedStop
from bumpstop.loads import (
    BaseMotion,
    Gravity,
    Harmonic,
    ModalState,
    NodalForce,
    Polynomial,
    RigidRotation,
    RigidTranslation,
    TimeTable,
)
from bumpstop.loads.time import time_functions
from bumpstop.methods import PARAMETERS
from bumpstop.modal.substructure import Assembly
from bumpstop.report.scales import significant, with_unit
from bumpstop.structure.sections.rectangle import Rectangle
from bumpstop.structure.structure import Structure

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bumpstop.laws.coordinate import Coordinate
    from bumpstop.loads.time import TimeFunction
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.modal.substructure import Joint, Placed
    from bumpstop.problem import InitialState, Law, Load, Problem
    from bumpstop.response import Response
    from bumpstop.structure.beam import Beam
    from bumpstop.structure.bearing import Bearing
    from bumpstop.structure.gauge import Gauge
    from bumpstop.structure.model import LinearModel
    from bumpstop.structure.sections.section import Section
    from bumpstop.structure.spring import Spring
    from bumpstop.structure.support import Support

__all__ = ["METHODS", "Row", "basis_rows", "method_words", "model_rows"]

Row = tuple[str, list[str]]
"""A term and what there is to say about it, one line each."""

_MOST_LINES = 12

_SHAPES = {"Rectangle": "hollow rectangle", "Circle": "circle", "Tube": "tube"}
"""Names of sections that are told by their area."""

METHODS = {
    "exact": (
        "Exact",
        "closed form between two switches of contact; every step is proved to miss none",
    ),
    "rk32": ("Bogacki-Shampine", "a Runge-Kutta pair of order 3; every switch of contact located"),
    "rk54": ("Dormand-Prince", "a Runge-Kutta pair of order 5; every switch of contact located"),
    "dop853": (
        "Dormand-Prince 8",
        "a Runge-Kutta pair of order 8; every switch of contact located",
    ),
    "exprk43": (
        "Hochbruck-Ostermann",
        "an exponential Runge-Kutta pair of order 4, each mode by its own exponential; every "
        "switch of contact located",
    ),
    "adaptive_central_difference": (
        "Adaptive central difference",
        "second order, steps by the frequency that the motion shows; every switch of contact "
        "located",
    ),
    "symplectic_euler": ("Symplectic Euler", "equal steps, first order"),
    "central_difference": ("Central difference", "equal steps, second order"),
    "newmark": ("Newmark", "equal implicit steps, second order with gamma = 1/2"),
    "hht": ("Hilber-Hughes-Taylor", "equal implicit steps, second order"),
    "generalized_alpha": ("Generalised alpha", "equal implicit steps, second order"),
    "trbdf2": ("TR-BDF2", "equal implicit steps, second order"),
    "devogelaere": ("De Vogelaere-Fu", "equal explicit steps, fourth order"),
    "exponential": (
        "Exponential",
        "equal steps, exact for the modes, second order for laws and loads",
    ),
    "moreau_jean": ("Moreau-Jean", "equal implicit steps over the impulses of rigid stops"),
}
"""Name and nature of each method."""


def method_words(response: Response) -> tuple[str, str]:
    """Return a method's name, with its step or tolerance, and its nature and reason."""
    name, nature = METHODS.get(response.method, (response.method, ""))
    step = response.options.get("dt")
    if step is not None:
        name = f"{name}, dt = {with_unit(step, 's')}"
    for parameter in PARAMETERS.get(response.method, {}):
        if parameter in response.options:
            name = f"{name}, {parameter} = {response.options[parameter]:g}"
    if "rtol" in response.options:
        name = f"{name}, rtol = {response.options['rtol']:g}"
    reason = f"Chosen because {response.method_reason}." if response.method_reason else ""
    if response.method_reason == "asked for":
        reason = "As asked for."
    sentence = f"{nature[0].upper()}{nature[1:]}." if nature else ""
    return name, f"{sentence} {reason}".strip()


def model_rows(problem: Problem) -> list[Row]:
    """Return the model of a problem, one row a subject, those without content left out."""
    rows = [
        *basis_rows(problem.basis),
        ("Stops", [_stop(law) + _moving(law) for law in problem.laws if isinstance(law, Stop)]),
        ("Laws", [_law(law) + _moving(law) for law in problem.laws if not isinstance(law, Stop)]),
        ("Loads", [_load(load) for load in problem.loads]),
        ("Initial state", [_initial(problem.initial), *problem.initial_remarks]),
        ("Gauges", [_gauge(gauge) for gauge in problem.gauges]),
        ("Time", [_time(problem)]),
    ]
    return [(term, lines) for term, lines in rows if lines]


def basis_rows(basis: ModalBasis) -> list[Row]:
    """Return the model of a basis and what was made of it, those rows without content left out."""
    rows = [*_model_parts(basis.model), ("Basis", [_basis(basis)])]
    return [(term, lines) for term, lines in rows if lines]


def _model_parts(model: LinearModel | None) -> list[Row]:
    if isinstance(model, Structure):
        return _structure_rows(model)
    return _assembly_rows(model) if isinstance(model, Assembly) else []


def _assembly_rows(assembly: Assembly) -> list[Row]:
    parts = [_part(name, placed) for name, placed in assembly.parts.items()]
    joints = [f"{joint.first} and {joint.second}{_shared(joint)}" for joint in assembly.joined]
    return [
        ("Parts", _short(parts)),
        ("Joints", _short(joints)),
        ("Supports", _short([_support(support) for support in assembly.supports])),
    ]


def _part(name: str, placed: Placed) -> str:
    reduced = placed.component
    interface = ", ".join(node for node, _ in reduced.component.nodes)
    kept = len(reduced.labels)
    shapes = "1 inner shape" if kept == 1 else f"{kept} inner shapes"
    turned = "" if np.array_equal(placed.axes, np.eye(3)) else ", turned"
    return f"{name}: at {_vector(placed.at, 'm')}{turned}, interface {interface}, {shapes}"


def _shared(joint: Joint) -> str:
    return f": {', '.join(joint.dofs)}" if joint.dofs is not None else ""


def _structure_rows(structure: Structure) -> list[Row]:
    masses = [f"{mass.name}: {_plain(mass.mass)} kg at {mass.node}" for mass in structure.masses]
    return [
        ("Nodes", _short([f"{n} at {_vector(x, 'm')}" for n, x in structure.nodes.items()])),
        ("Beams", _short([_beam(beam, structure) for beam in structure.beams])),
        ("Masses", _short(masses)),
        ("Springs", _short([_joined(spring) for spring in structure.springs])),
        ("Bearings", _short([_joined(bearing) for bearing in structure.bearings])),
        ("Supports", _short([_support(support) for support in structure.supports])),
    ]


def _beam(beam: Beam, structure: Structure) -> str:
    start, end = (np.array(structure.nodes[node], dtype=float) for node in beam.nodes)
    material, section = beam.material, beam.section
    shape = _shape(section)
    if beam.end_section is not None:
        shape += f" to {_shape(beam.end_section)}"
    elements = "element" if beam.elements == 1 else "elements"
    return (
        f"{beam.name}: {with_unit(float(np.linalg.norm(end - start)), 'm')} from {beam.nodes[0]} "
        f"to {beam.nodes[1]}, {beam.elements} {_theory(beam.theory)} {elements}, section {shape}, "
        f"E = {with_unit(material.young_modulus, 'Pa')}, ν = {_plain(material.poisson_ratio)}, "
        f"ρ = {_plain(material.density)} kg/m³"
    )


def _shape(section: Section) -> str:
    """Return a rectangle by its sides, others by their area."""
    if isinstance(section, Rectangle) and section.thickness is None:
        return f"{with_unit(section.height, 'm')} × {with_unit(section.width, 'm')}"
    return f"{_SHAPES.get(type(section).__name__, 'shape')} of area {_plain(section.area)} m²"


def _joined(part: Spring | Bearing) -> str:
    return f"{part.name}: {part.node} to {part.other or 'the ground'}"


def _theory(name: str) -> str:
    return "-".join(word.capitalize() for word in name.split("_"))


def _support(support: Support) -> str:
    where = "all nodes" if support.nodes == "all" else ", ".join(support.nodes)
    return f"{where}: {', '.join(support.fixed)} fixed"


def _basis(basis: ModalBasis) -> str:
    count = len(basis.omega2)
    if basis.unreduced:
        return f"none: a full model of {count:,} dofs"
    rigid = int(np.count_nonzero(basis.omega2 == 0.0))
    if rigid == count:
        return "1 rigid mode" if count == 1 else f"{count} rigid modes"
    beside = sum(not label.startswith("mode ") for label in basis.labels)
    plain = count - beside if beside < count else count
    modes = f"{plain} {'mode' if plain == 1 else 'modes'}"
    if rigid:
        modes += f", {rigid} of them rigid"
    if plain < count:
        modes += f", and {beside} static {'shape' if beside == 1 else 'shapes'}"
    ratios = basis.damping_ratio
    low, high = float(np.min(ratios)), float(np.max(ratios))
    damping = _ratio(low) if low == high else f"{_ratio(low)} to {_ratio(high)}"
    highest = f"{_plain(float(np.max(basis.frequencies)))} Hz"
    if high == 0.0:
        return f"{modes}, up to {highest}, undamped"
    return f"{modes}, up to {highest}, {damping} of critical damping"


def _ratio(value: float) -> str:
    return f"{significant(value * 100.0, 3, zeros=False)} %"


def _stop(law: Stop) -> str:
    gap = "no gap" if law.gap == 0.0 else f"gap {with_unit(law.gap, 'm')}"
    damping = f", {with_unit(law.damping, 'N s/m')}" if law.damping else ", no damping"
    return (
        f"{law.name}: a {law.obstacle} {_pushing(law.coordinate)}, {gap}, "
        f"{with_unit(law.stiffness, 'N/m')}{damping}{_friction(law)}"
    )


def _friction(law: Stop | ShapedStop) -> str:
    if law.friction is None or law.tangential_stiffness is None:
        return ""
    friction = Friction.of(law.friction)
    static, dynamic = _plain(friction.static), _plain(friction.while_sliding)
    words = static if static == dynamic else f"{static}, {dynamic} while it slides"
    if friction.goes_by_steps:
        words += ", by the velocity at steps"
    return f"; friction {words}, {with_unit(law.tangential_stiffness, 'N/m')} along the obstacle"


def _where(along: Coordinate) -> str:
    if along.terms is not None:
        return "on " + " + ".join(f"{_plain(w)} {n}.{dof}" for (n, dof), w in along.terms.items())
    return f"at {along.node}" if along.other is None else f"between {along.node} and {along.other}"


def _pushing(along: Coordinate) -> str:
    return f"{_where(along)} that pushes along {_vector(along.direction)}"


def _law(law: Law) -> str:
    if isinstance(law, SpringLaw):
        slopes = ", ".join(with_unit(slope, "N/m") for slope in law.stiffness)
        where = f"{_where(law.coordinate)} along {_vector(law.coordinate.direction)}"
        return f"{law.name}: a spring {where}, {slopes}"
    if isinstance(law, RigidStop):
        gap = "no gap" if law.gap == 0.0 else f"gap {with_unit(law.gap, 'm')}"
        restitution = f"restitution {_plain(law.restitution)}"
        if law.friction is not None:
            restitution = f"{restitution}, friction {_plain(law.friction)}"
        return (
            f"{law.name}: a rigid {law.obstacle} {_pushing(law.coordinate)}, {gap}, {restitution}"
        )
    if isinstance(law, DamperLaw):
        slopes = ", ".join(with_unit(slope, "N s/m") for slope in law.damping)
        where = f"{_where(law.coordinate)} along {_vector(law.coordinate.direction)}"
        return f"{law.name}: a damper {where}, {slopes}"
    if isinstance(law, SeismicDevice):
        stiffness = (law.first_stiffness, law.second_stiffness)
        told = " to ".join(with_unit(each, "N/m") for each in stiffness)
        where = f"{_where(law.coordinate)} along {_vector(law.coordinate.direction)}"
        return f"{law.name}: a seismic device {where}, {told} about {with_unit(law.threshold, 'N')}"
    if isinstance(law, HardeningSpring):
        where = f"{_where(law.coordinate)} along {_vector(law.coordinate.direction)}"
        told = f"{with_unit(law.stiffness, 'N/m')}, yields at {with_unit(law.curve[0][1], 'N')}"
        return f"{law.name}: a spring {where}, {told}, {law.hardening} hardening"
    if isinstance(law, BucklingStop):
        gap = "no gap" if law.gap == 0.0 else f"gap {with_unit(law.gap, 'm')}"
        forces = f"buckles at {with_unit(law.critical_force, 'N')}"
        return f"{law.name}: a {law.obstacle} {_pushing(law.coordinate)}, {gap}, {forces}"
    if isinstance(law, UserLaw | OutsideProgram):
        return f"{law.name}: a {law.kind} of the user's own {_where(law.coordinate)}"
    if isinstance(law, ForceRelation):
        where = f"{_where(law.coordinate)} along {_vector(law.coordinate.direction)}"
        return f"{law.name}: a force {where}, {law.force}"
    if isinstance(law, CrackedRotor):
        soft, stiff = (with_unit(size, "N m/rad") for size in law.extremes)
        return (
            f"{law.name}: a crack {_where(law.coordinate)}, {soft} to {stiff}, {law.rotation.words}"
        )
    if isinstance(law, ZenerDamper):
        springs = (law.series_stiffness, law.parallel_stiffness, law.branch_stiffness)
        told = ", ".join(with_unit(stiffness, "N/m") for stiffness in springs)
        where = f"{_where(law.coordinate)} along {_vector(law.coordinate.direction)}"
        dashpot = f"{with_unit(law.damping, 'N')} at 1 m/s, power {_plain(law.exponent)}"
        return f"{law.name}: a Zener damper {where}, springs of {told}, dashpot of {dashpot}"
    if isinstance(law, HertzStop):
        gap = "no gap" if law.gap == 0.0 else f"gap {with_unit(law.gap, 'm')}"
        force = f"{significant(law.stiffness, 4)} N/m^{_plain(law.exponent)}"
        damping = f", {with_unit(law.hunt_crossley, 's/m')}" if law.hunt_crossley else ""
        return f"{law.name}: a {law.obstacle} {_pushing(law.coordinate)}, {gap}, {force}{damping}"
    if isinstance(law, ShapedStop):
        return _shaped(law)
    return law.name


def _moving(law: Law) -> str:
    """Say how an obstacle moves, and where it stands while supports do."""
    motion = getattr(law, "motion", None) or ()
    along = motion if isinstance(motion, dict) else {"its normal": motion}
    moves = [
        f"moves along {axis} by {' + '.join(map(_function, functions))}, in m"
        for axis, functions in along.items()
        if functions
    ]
    if getattr(law, "frame", "relative") == "absolute":
        moves.append("stands still on the ground")
    return "".join(f"; {each}" for each in moves)


def _shaped(law: ShapedStop) -> str:
    where = _where(law.coordinate)
    damping = f", {with_unit(law.damping, 'N s/m')}" if law.damping else ", no damping"
    size = ""
    if isinstance(law, CircleStop):
        size = f" about {_vector(law.axis)}, {law.side}, reached at {with_unit(law.reach, 'm')}"
    elif isinstance(law, PolarStop):
        size = f" about {_vector(law.axis)} of {len(law.profile):,} sides"
    elif isinstance(law, PlaneStop):
        size = f" that pushes along {_vector(law.normal)}, gap {with_unit(law.gap, 'm')}"
    force = f"{with_unit(law.stiffness, 'N/m')}{damping}{_friction(law)}"
    return f"{law.name}: a {law.obstacle} {where}{size}, {force}"


def _load(load: Load) -> str:
    if isinstance(load, Gravity):
        return f"{load.name}: gravity {_vector(load.acceleration, 'm/s²')}"
    if isinstance(load, NodalForce):
        force = _vector(load.force, "N") if any(load.force) else ""
        moment = _vector(load.moment, "N m") if any(load.moment) else ""
        told = " and ".join(filter(None, [force, moment])) or "nothing"
        what = f"{told} at {load.node}"
        return f"{load.name}: {what}{_times(load.functions)}"
    if isinstance(load, BaseMotion):
        functions = load.functions if load.displacement is None else time_functions(load.time)
        return f"{load.name}: {load.words} of all supports{_times(functions)}"
    words: str = getattr(load, "words", "")
    return f"{load.name}: {words}" if words else load.name


def _times(functions: Sequence[TimeFunction]) -> str:
    """Say what a load is multiplied by."""
    return f" times {' + '.join(map(_function, functions))}" if functions else ""


def _function(function: TimeFunction) -> str:
    match function:
        case Harmonic():
            turn = f"(2π {_plain(function.frequency)} Hz t)"
            parts = [("cos", function.cosine), ("sin", function.sine)]
            told = [f"{_plain(size)} {name}{turn}" for name, size in parts if size]
            return " + ".join(told) or "0"
        case Polynomial():
            return f"a polynomial of degree {len(function.coefficients) - 1}"
        case TimeTable():
            first, last = (with_unit(float(function.times[end]), "s") for end in (0, -1))
            return f"a table of {len(function.times):,} values from {first} to {last}"
    return function.words


def _initial(initial: InitialState | None) -> str:
    if initial is None:
        return "at rest, undeformed"
    if isinstance(initial, RigidRotation):
        return f"turns about {initial.about} as a rigid body with {_vector(initial.rate, 'rad/s')}"
    if isinstance(initial, RigidTranslation):
        parts = [*(initial.nodes or ()), *(initial.beams or ())]
        told = f"moves straight with {_vector(initial.velocity, 'm/s')}"
        return f"{told}: {', '.join(parts)}" if parts else told
    if isinstance(initial, ModalState):
        given = [key for key in ("displacement", "velocity") if getattr(initial, key) is not None]
        return f"given modal {' and '.join(given) or 'state'}"
    return getattr(initial, "words", type(initial).__name__)


def _gauge(gauge: Gauge) -> str:
    y, z = (with_unit(part, "m") for part in gauge.fibre)
    return f"{gauge.name}: {with_unit(gauge.at, 'm')} along {gauge.beam}, fibre y = {y}, z = {z}"


def _time(problem: Problem) -> str:
    sample = with_unit(problem.grid.step, "s")
    return f"{with_unit(problem.duration, 's')}, tabulated every {sample}"


def _vector(components: Sequence[float], unit: str = "") -> str:
    return f"({', '.join(map(_plain, components))}) {unit}".rstrip()


def _plain(value: float) -> str:
    return significant(value, 5, zeros=False)


def _short(lines: list[str]) -> list[str]:
    if len(lines) <= _MOST_LINES:
        return lines
    return [*lines[:_MOST_LINES], f"and {len(lines) - _MOST_LINES:,} more"]
