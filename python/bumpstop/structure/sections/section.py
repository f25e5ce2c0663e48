"""What the elements need to know of a cross section, whatever its shape."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, TypeVar

from bumpstop.arguments import pair, positive
from bumpstop.errors import InputError

__all__ = ["EDGE", "Section", "shear_factor_pair"]

EDGE = 1.0 + 1e-9
"""A fibre on the edge is in the section, whatever the rounding of its place."""

S = TypeVar("S", bound="Section")


class Section(ABC):
    """A cross section in the beam's local y and z axes, both principal, from its centroid.

    Shapes are frozen dataclasses whose fields are all numbers or pairs of numbers, so that a
    section between two others is known.
    """

    if TYPE_CHECKING:
        # Numbers that a shape has as properties, or as fields: inherited properties would be
        # in the way of fields.
        @property
        def shear_factors(self) -> tuple[float, float]:
            """Shares of the area that carry shear along local y and along local z."""

        @property
        def area(self) -> float:
            """Area in m2."""

        @property
        def inertia_y(self) -> float:
            """Second moment of area about local y, the integral of z2, in m4."""

        @property
        def inertia_z(self) -> float:
            """Second moment of area about local z, the integral of y2, in m4."""

        @property
        def torsion_constant(self) -> float:
            """Saint-Venant torsion constant in m4."""

        @property
        def shear_center(self) -> tuple[float, float]:
            """Place (y, z) of the shear centre from the centroid, in m."""

    @abstractmethod
    def contains(self, y: float, z: float) -> bool:
        """Tell whether the fibre (y, z), in m from the centroid, is in the section."""

    def between(self: S, other: S, part: float) -> S:
        """Return the section ``part`` (0 to 1) of the way to another one of the same shape.

        Every dimension changes linearly.

        Raises
        ------
        InputError
            If the two sections do not have the same shape.
        """
        if type(self) is not type(other) or _given(self) != _given(other):
            raise InputError(
                "the sections at the two ends must have the same shape",
                key="end_section",
                value=type(other).__name__,
                hint=f"the first is a {type(self).__name__}",
            )
        mixed = {
            name: _mixed(getattr(self, name), getattr(other, name), part) for name in _given(self)
        }
        return replace(self, **mixed)  # type: ignore[type-var]  # every shape is a dataclass


def shear_factor_pair(value: object) -> tuple[float, float]:
    """Return two positive shear factors.

    Raises
    ------
    InputError
        If they are not two finite positive numbers.
    """
    for factor in pair("shear_factors", value):
        positive("shear_factors", factor)
    return pair("shear_factors", value)


def _given(section: Section) -> list[str]:
    """Return the names of the fields that are not left out."""
    known: Any = section
    return [part.name for part in fields(known) if getattr(section, part.name) is not None]


def _mixed(first: Any, second: Any, part: float) -> Any:
    if isinstance(first, Sequence):
        return tuple(_mixed(a, b, part) for a, b in zip(first, second, strict=True))
    return (1.0 - part) * first + part * second
