"""How flexible structures vibrate when they hit stops: exact, certified, fast.

Names are imported when they are first used, so that ``import bumpstop`` costs next to nothing.
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import TYPE_CHECKING

from bumpstop.lazy import lazy_names

if TYPE_CHECKING:
    from bumpstop.continued import continued
    from bumpstop.errors import BumpstopError, ComputationError, InputError, ModellingWarning
    from bumpstop.io.case import Case, load_case
    from bumpstop.io.curves import read_curves
    from bumpstop.io.matrices import read_matrices, write_matrices
    from bumpstop.io.meshes import read_mesh
    from bumpstop.io.modes import identify_modes, read_modes
    from bumpstop.io.stored import read_netcdf, read_results
    from bumpstop.laws.buckling_stop import BucklingStop
    from bumpstop.laws.circle_stop import CircleStop
    from bumpstop.laws.cracked_rotor import CrackedRotor
    from bumpstop.laws.damper import DamperLaw
    from bumpstop.laws.force_relation import ForceRelation
    from bumpstop.laws.friction import Friction
    from bumpstop.laws.hardening_spring import HardeningSpring
    from bumpstop.laws.hertz_stop import HertzStop
    from bumpstop.laws.outside_program import OutsideProgram
    from bumpstop.laws.piped_program import PipedProgram
    from bumpstop.laws.plane_stop import PlaneStop
    from bumpstop.laws.polar_stop import PolarStop
    from bumpstop.laws.rigid_stop import RigidStop
    from bumpstop.laws.seismic_device import SeismicDevice
    from bumpstop.laws.spring import SpringLaw
    from bumpstop.laws.stop import Stop
    from bumpstop.laws.user_law import UserLaw
    from bumpstop.laws.zener_damper import ZenerDamper
    from bumpstop.loads.accelerogram import Accelerogram
    from bumpstop.loads.base_motion import BaseMotion
    from bumpstop.loads.density import SpectralDensity
    from bumpstop.loads.expression import Expression
    from bumpstop.loads.force import NodalForce
    from bumpstop.loads.gravity import Gravity
    from bumpstop.loads.initial import ModalState, RigidRotation
    from bumpstop.loads.line_force import LineForce
    from bumpstop.loads.moving_force import MovingForce
    from bumpstop.loads.nodal_state import NodalState
    from bumpstop.loads.product import Product
    from bumpstop.loads.random_signal import RandomSignal
    from bumpstop.loads.shaft_rotation import ShaftRotation
    from bumpstop.loads.static_state import StaticState
    from bumpstop.loads.support_motion import SupportMotion
    from bumpstop.loads.sweep import Sweep
    from bumpstop.loads.time import Harmonic, Polynomial, TimeTable
    from bumpstop.loads.translation import RigidTranslation
    from bumpstop.loads.turbulence import Turbulence
    from bumpstop.loads.unbalance import Unbalance
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.modal.certificate import SturmCount
    from bumpstop.modal.damping import RayleighDamping, StructuralDamping
    from bumpstop.modal.frequency_response import FrequencyResponse
    from bumpstop.modal.full import FullModel
    from bumpstop.modal.masses import Participation, generalised_mass, participation
    from bumpstop.modal.oscillation import ComplexModes, complex_modes
    from bumpstop.modal.rotor import Campbell, campbell
    from bumpstop.modal.selection import AllModes, LowestModes, ModesAround, ModesInBand
    from bumpstop.modal.static_shapes import StaticShapes
    from bumpstop.modal.substructure.assembly import Assembly
    from bumpstop.modal.substructure.component import Component
    from bumpstop.modal.substructure.craig_bampton import craig_bampton
    from bumpstop.modal.substructure.free_interface import free_interface
    from bumpstop.modal.substructure.joint import Joint
    from bumpstop.modal.substructure.placed import Placed
    from bumpstop.modal.substructure.reduced import ReducedComponent
    from bumpstop.modal.substructure.rotation import Rotation
    from bumpstop.post.contacts import contact_impacts
    from bumpstop.post.force_spectrum import force_spectrum
    from bumpstop.post.lyapunov import LyapunovExponents, lyapunov_exponents
    from bumpstop.post.poincare import (
        Periodicity,
        bifurcation,
        impact_section,
        periodicity,
        stroboscopic_section,
    )
    from bumpstop.post.recovery import Recovery, recovery
    from bumpstop.post.response_spectrum import response_spectrum
    from bumpstop.post.sampled import sampled_impacts
    from bumpstop.post.scars import FlatScar, HoleScar, PadScar
    from bumpstop.post.sectors import wear_by_sector, work_by_sector
    from bumpstop.post.signals import (
        amplitude_spectrum,
        envelope,
        power_spectral_density,
        spectrogram,
    )
    from bumpstop.post.statistics import ContactStatistics, contact_statistics
    from bumpstop.post.streams import SignalStatistics, Stream, signal_statistics
    from bumpstop.post.wear import ArchardWear, EdfWear, KwuEpriWear, WearWork, wear, wear_work
    from bumpstop.problem import Problem
    from bumpstop.report.arrays import plot
    from bumpstop.report.drawings import (
        draw_energy,
        draw_friction_loop,
        draw_history,
        draw_loop,
        draw_orbit,
        draw_phase_portrait,
        draw_scene,
        draw_section,
        draw_sectors,
    )
    from bumpstop.report.modes_drawn import draw_modes
    from bumpstop.report.studies.bars import sobol_chart, tornado_chart
    from bumpstop.report.studies.grids import basin_map, heat_map
    from bumpstop.report.studies.points import bifurcation_diagram
    from bumpstop.report.studies.searched import search_chart
    from bumpstop.response import Response
    from bumpstop.simulate import simulate
    from bumpstop.structure.beam import Beam
    from bumpstop.structure.bearing import Bearing
    from bumpstop.structure.gauge import Gauge
    from bumpstop.structure.link import RigidLink
    from bumpstop.structure.mass import PointMass
    from bumpstop.structure.material import Material
    from bumpstop.structure.matrices import Matrices
    from bumpstop.structure.relation import Relation
    from bumpstop.structure.sections.circle import Circle
    from bumpstop.structure.sections.general import GeneralSection
    from bumpstop.structure.sections.rectangle import Rectangle
    from bumpstop.structure.sections.section import Section
    from bumpstop.structure.sections.tube import Tube
    from bumpstop.structure.spring import Spring
    from bumpstop.structure.structure import Structure
    from bumpstop.structure.support import Support
    from bumpstop.study.basins import Basins
    from bumpstop.study.batch import batch
    from bumpstop.study.continuation import continuation
    from bumpstop.study.convergence import Convergence, converge
    from bumpstop.study.follow import follow
    from bumpstop.study.load import load_study
    from bumpstop.study.outputs import Output
    from bumpstop.study.parameters import Distribution, Range, Values
    from bumpstop.study.sampling import Sampling
    from bumpstop.study.sensitivity import sobol_indices
    from bumpstop.study.single import write_case
    from bumpstop.study.study import Study, open_study, study
    from bumpstop.study.tornado import one_at_a_time
    from bumpstop.study.worst import WorstCase, worst_case

__version__ = "0.1.0"

__all__ = [
    "Accelerogram",
    "AllModes",
    "ArchardWear",
    "Assembly",
    "BaseMotion",
    "Basins",
    "Beam",
    "Bearing",
    "BucklingStop",
    "BumpstopError",
    "Campbell",
    "Case",
    "Circle",
    "CircleStop",
    "ComplexModes",
    "Component",
    "ComputationError",
    "ContactStatistics",
    "Convergence",
    "CrackedRotor",
    "DamperLaw",
    "Distribution",
    "EdfWear",
    "Expression",
    "FlatScar",
    "ForceRelation",
    "FrequencyResponse",
    "Friction",
    "FullModel",
    "Gauge",
    "GeneralSection",
    "Gravity",
    "HardeningSpring",
    "Harmonic",
    "HertzStop",
    "HoleScar",
    "InputError",
    "Joint",
    "KwuEpriWear",
    "LineForce",
    "LowestModes",
    "LyapunovExponents",
    "Material",
    "Matrices",
    "ModalBasis",
    "ModalState",
    "ModellingWarning",
    "ModesAround",
    "ModesInBand",
    "MovingForce",
    "NodalForce",
    "NodalState",
    "Output",
    "OutsideProgram",
    "PadScar",
    "Participation",
    "Periodicity",
    "PipedProgram",
    "Placed",
    "PlaneStop",
    "PointMass",
    "PolarStop",
    "Polynomial",
    "Problem",
    "Product",
    "RandomSignal",
    "Range",
    "RayleighDamping",
    "Recovery",
    "Rectangle",
    "ReducedComponent",
    "Relation",
    "Response",
    "RigidLink",
    "RigidRotation",
    "RigidStop",
    "RigidTranslation",
    "Rotation",
    "Sampling",
    "Section",
    "SeismicDevice",
    "ShaftRotation",
    "SignalStatistics",
    "SpectralDensity",
    "Spring",
    "SpringLaw",
    "StaticShapes",
    "StaticState",
    "Stop",
    "Stream",
    "StructuralDamping",
    "Structure",
    "Study",
    "SturmCount",
    "Support",
    "SupportMotion",
    "Sweep",
    "TimeTable",
    "Tube",
    "Turbulence",
    "Unbalance",
    "UserLaw",
    "Values",
    "WearWork",
    "WorstCase",
    "ZenerDamper",
    "amplitude_spectrum",
    "basin_map",
    "batch",
    "bifurcation",
    "bifurcation_diagram",
    "campbell",
    "complex_modes",
    "contact_impacts",
    "contact_statistics",
    "continuation",
    "continued",
    "converge",
    "craig_bampton",
    "draw_energy",
    "draw_friction_loop",
    "draw_history",
    "draw_loop",
    "draw_modes",
    "draw_orbit",
    "draw_phase_portrait",
    "draw_scene",
    "draw_section",
    "draw_sectors",
    "envelope",
    "follow",
    "force_spectrum",
    "free_interface",
    "generalised_mass",
    "heat_map",
    "identify_modes",
    "impact_section",
    "load_case",
    "load_study",
    "lyapunov_exponents",
    "one_at_a_time",
    "open_study",
    "participation",
    "periodicity",
    "plot",
    "power_spectral_density",
    "read_curves",
    "read_matrices",
    "read_mesh",
    "read_modes",
    "read_netcdf",
    "read_results",
    "recovery",
    "response_spectrum",
    "sampled_impacts",
    "search_chart",
    "signal_statistics",
    "simulate",
    "sobol_chart",
    "sobol_indices",
    "spectrogram",
    "stroboscopic_section",
    "study",
    "tornado_chart",
    "wear",
    "wear_by_sector",
    "wear_work",
    "work_by_sector",
    "worst_case",
    "write_case",
    "write_matrices",
]

_HOME = {
    "Accelerogram": "loads.accelerogram",
    "AllModes": "modal.selection",
    "ArchardWear": "post.wear",
    "Assembly": "modal.substructure.assembly",
    "BaseMotion": "loads.base_motion",
    "Basins": "study.basins",
    "Beam": "structure.beam",
    "Bearing": "structure.bearing",
    "BucklingStop": "laws.buckling_stop",
    "BumpstopError": "errors",
    "Campbell": "modal.rotor",
    "Case": "io.case",
    "Circle": "structure.sections.circle",
    "CircleStop": "laws.circle_stop",
    "ComplexModes": "modal.oscillation",
    "Component": "modal.substructure.component",
    "ComputationError": "errors",
    "ContactStatistics": "post.statistics",
    "Convergence": "study.convergence",
    "CrackedRotor": "laws.cracked_rotor",
    "DamperLaw": "laws.damper",
    "Distribution": "study.parameters",
    "EdfWear": "post.wear",
    "Expression": "loads.expression",
    "FlatScar": "post.scars",
    "ForceRelation": "laws.force_relation",
    "FrequencyResponse": "modal.frequency_response",
    "Friction": "laws.friction",
    "FullModel": "modal.full",
    "Gauge": "structure.gauge",
    "GeneralSection": "structure.sections.general",
    "Gravity": "loads.gravity",
    "HardeningSpring": "laws.hardening_spring",
    "Harmonic": "loads.time",
    "HertzStop": "laws.hertz_stop",
    "HoleScar": "post.scars",
    "InputError": "errors",
    "Joint": "modal.substructure.joint",
    "KwuEpriWear": "post.wear",
    "LineForce": "loads.line_force",
    "LowestModes": "modal.selection",
    "LyapunovExponents": "post.lyapunov",
    "Material": "structure.material",
    "Matrices": "structure.matrices",
    "ModalBasis": "modal.basis",
    "ModalState": "loads.initial",
    "ModellingWarning": "errors",
    "ModesAround": "modal.selection",
    "ModesInBand": "modal.selection",
    "MovingForce": "loads.moving_force",
    "NodalForce": "loads.force",
    "NodalState": "loads.nodal_state",
    "Output": "study.outputs",
    "OutsideProgram": "laws.outside_program",
    "PipedProgram": "laws.piped_program",
    "PadScar": "post.scars",
    "Participation": "modal.masses",
    "Periodicity": "post.poincare",
    "Placed": "modal.substructure.placed",
    "PlaneStop": "laws.plane_stop",
    "PointMass": "structure.mass",
    "PolarStop": "laws.polar_stop",
    "Polynomial": "loads.time",
    "Problem": "problem",
    "Product": "loads.product",
    "RandomSignal": "loads.random_signal",
    "Range": "study.parameters",
    "RayleighDamping": "modal.damping",
    "Recovery": "post.recovery",
    "Rectangle": "structure.sections.rectangle",
    "ReducedComponent": "modal.substructure.reduced",
    "Relation": "structure.relation",
    "Response": "response",
    "RigidLink": "structure.link",
    "RigidRotation": "loads.initial",
    "RigidStop": "laws.rigid_stop",
    "RigidTranslation": "loads.translation",
    "Rotation": "modal.substructure.rotation",
    "Sampling": "study.sampling",
    "Section": "structure.sections.section",
    "SeismicDevice": "laws.seismic_device",
    "ShaftRotation": "loads.shaft_rotation",
    "SignalStatistics": "post.streams",
    "SpectralDensity": "loads.density",
    "Spring": "structure.spring",
    "SpringLaw": "laws.spring",
    "StaticShapes": "modal.static_shapes",
    "StaticState": "loads.static_state",
    "Stop": "laws.stop",
    "Stream": "post.streams",
    "StructuralDamping": "modal.damping",
    "Structure": "structure.structure",
    "Study": "study.study",
    "SturmCount": "modal.certificate",
    "Support": "structure.support",
    "SupportMotion": "loads.support_motion",
    "Sweep": "loads.sweep",
    "TimeTable": "loads.time",
    "Tube": "structure.sections.tube",
    "Turbulence": "loads.turbulence",
    "Unbalance": "loads.unbalance",
    "UserLaw": "laws.user_law",
    "Values": "study.parameters",
    "WearWork": "post.wear",
    "WorstCase": "study.worst",
    "ZenerDamper": "laws.zener_damper",
    "amplitude_spectrum": "post.signals",
    "basin_map": "report.studies.grids",
    "batch": "study.batch",
    "bifurcation": "post.poincare",
    "bifurcation_diagram": "report.studies.points",
    "campbell": "modal.rotor",
    "complex_modes": "modal.oscillation",
    "contact_impacts": "post.contacts",
    "contact_statistics": "post.statistics",
    "continuation": "study.continuation",
    "continued": "continued",
    "converge": "study.convergence",
    "craig_bampton": "modal.substructure.craig_bampton",
    "draw_energy": "report.drawings",
    "draw_friction_loop": "report.drawings",
    "draw_history": "report.drawings",
    "draw_loop": "report.drawings",
    "draw_modes": "report.modes_drawn",
    "draw_orbit": "report.drawings",
    "draw_phase_portrait": "report.drawings",
    "draw_scene": "report.drawings",
    "draw_section": "report.drawings",
    "draw_sectors": "report.drawings",
    "envelope": "post.signals",
    "follow": "study.follow",
    "force_spectrum": "post.force_spectrum",
    "free_interface": "modal.substructure.free_interface",
    "generalised_mass": "modal.masses",
    "heat_map": "report.studies.grids",
    "identify_modes": "io.modes",
    "impact_section": "post.poincare",
    "load_case": "io.case",
    "load_study": "study.load",
    "lyapunov_exponents": "post.lyapunov",
    "one_at_a_time": "study.tornado",
    "open_study": "study.study",
    "participation": "modal.masses",
    "periodicity": "post.poincare",
    "plot": "report.arrays",
    "power_spectral_density": "post.signals",
    "read_matrices": "io.matrices",
    "read_mesh": "io.meshes",
    "read_modes": "io.modes",
    "read_curves": "io.curves",
    "read_netcdf": "io.stored",
    "read_results": "io.stored",
    "recovery": "post.recovery",
    "response_spectrum": "post.response_spectrum",
    "sampled_impacts": "post.sampled",
    "search_chart": "report.studies.searched",
    "signal_statistics": "post.streams",
    "simulate": "simulate",
    "sobol_chart": "report.studies.bars",
    "sobol_indices": "study.sensitivity",
    "spectrogram": "post.signals",
    "stroboscopic_section": "post.poincare",
    "study": "study.study",
    "tornado_chart": "report.studies.bars",
    "wear": "post.wear",
    "wear_by_sector": "post.sectors",
    "wear_work": "post.wear",
    "work_by_sector": "post.sectors",
    "worst_case": "study.worst",
    "write_case": "study.single",
    "write_matrices": "io.matrices",
}
"""Where each public name lives."""


class _Package(ModuleType):
    """Keeps ``bumpstop.simulate`` the function, although a module has the same name."""

    def __setattr__(self, name: str, value: object) -> None:
        # On import of a submodule, Python binds it in its package under its last name.
        if not (name in _HOME and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package

__getattr__ = lazy_names(__name__, _HOME)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
