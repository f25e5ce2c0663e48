"""What vibrates: nodes, beams, masses and supports, and the matrices they make."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.lazy import lazy_names

if TYPE_CHECKING:
    from bumpstop.structure.beam import Beam
    from bumpstop.structure.bearing import Bearing
    from bumpstop.structure.gauge import Gauge
    from bumpstop.structure.link import RigidLink
    from bumpstop.structure.mass import PointMass
    from bumpstop.structure.material import Material
    from bumpstop.structure.relation import Relation
    from bumpstop.structure.sections.rectangle import Rectangle
    from bumpstop.structure.spring import Spring
    from bumpstop.structure.structure import Structure
    from bumpstop.structure.support import Support

__all__ = [
    "Beam",
    "Bearing",
    "Gauge",
    "Material",
    "PointMass",
    "Rectangle",
    "Relation",
    "RigidLink",
    "Spring",
    "Structure",
    "Support",
]

__getattr__ = lazy_names(
    __name__,
    {
        "Beam": "beam",
        "Bearing": "bearing",
        "Gauge": "gauge",
        "Material": "material",
        "PointMass": "mass",
        "Rectangle": "sections.rectangle",
        "Relation": "relation",
        "RigidLink": "link",
        "Spring": "spring",
        "Structure": "structure",
        "Support": "support",
    },
)
