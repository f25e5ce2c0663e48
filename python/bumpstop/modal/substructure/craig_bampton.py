"""Craig-Bampton reduction: modes of the component with its interface held."""

from __future__ import annotations

from bumpstop.modal.substructure.component import Component
from bumpstop.modal.substructure.inner_modes import flexible_modes
from bumpstop.modal.substructure.interface import InterfaceStatics
from bumpstop.modal.substructure.reduced import ReducedComponent, reduced_component

__all__ = ["craig_bampton"]


def craig_bampton(component: Component, *, modes: int | str) -> ReducedComponent:
    """Reduce a component to its constraint modes and its lowest modes with the interface held.

    Statically the result is exact for forces on the interface, whatever the number of modes
    (with none it is Guyan's condensation); rigid motions are exact too.

    Parameters
    ----------
    component
        The component.
    modes
        Number of modes with the interface held, 0 or more, or ``"all"``. Rigid motions that
        the interface cannot hold come on top.

    Raises
    ------
    InputError
        If there are fewer modes.

    References
    ----------
    R. R. Craig and M. C. C. Bampton, Coupling of substructures for dynamic analyses, *AIAA
    Journal* 6 (1968), 1313-1319.

    Examples
    --------
    >>> from bumpstop import Beam, Material, Rectangle, Structure
    >>> steel = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    >>> bar = Rectangle(height=0.02, width=0.02)
    >>> beam = Beam("AB", nodes=("A", "B"), elements=4, material=steel, section=bar)
    >>> bay = Structure(nodes={"A": (0, 0, 0), "B": (1, 0, 0)}, beams=[beam])
    >>> craig_bampton(Component(bay, interface=["A", "B"]), modes=3).stiffness.shape
    (15, 15)
    """
    statics = InterfaceStatics(component)
    inner = flexible_modes(statics.clamped, modes, statics.loose.shape[1])
    labels = [f"mode {number}" for number in range(1, inner.shape[1] + 1)]
    return reduced_component(component, statics, inner, labels)
