"""Free-interface reduction: modes of the component as it is, and residual attachment modes."""

from __future__ import annotations

import numpy as np

from bumpstop.modal.independent import independent_vectors
from bumpstop.modal.substructure.component import Component
from bumpstop.modal.substructure.inner_modes import flexible_modes
from bumpstop.modal.substructure.interface import InterfaceStatics
from bumpstop.modal.substructure.reduced import ReducedComponent, reduced_component

__all__ = ["free_interface"]


def free_interface(component: Component, *, modes: int | str) -> ReducedComponent:
    """Reduce a component to its lowest free modes and the residual flexibility of its interface.

    The displacements are combinations of the rigid motions, the lowest flexible modes with
    the interface free, and the attachment modes (static shapes under a unit force on each dof
    of the interface, in balance with inertia where the component is free). Attachment modes
    less the part that the kept modes carry already, the residual ones, span the same space;
    the mass of that residual is kept (Rubin), not neglected (MacNeal), so that frequencies
    converge from above. Statically the result is exact for forces on the interface.

    It is more exact than ``craig_bampton`` with the same number of modes, for a few
    coordinates more: as many as the component has rigid motions.

    Parameters
    ----------
    component
        The component.
    modes
        Number of flexible modes with the interface free, 0 or more, or ``"all"``.

    Raises
    ------
    InputError
        If there are fewer modes.

    References
    ----------
    S. Rubin, Improved component-mode representation for structural dynamic analysis, *AIAA
    Journal* 13 (1975), 995-1006; R. H. MacNeal, A hybrid method of component mode synthesis,
    *Computers & Structures* 1 (1971), 581-601; R. R. Craig and C.-J. Chang, On the use of
    attachment modes in substructure coupling, *AIAA SDM conference*, 1977, 89-99.
    """
    model = component.model
    statics = InterfaceStatics(component)
    rigid = statics.loose.shape[1] + statics.leading.shape[1]
    free = flexible_modes(model, modes, rigid)
    # An attachment mode is its own motion of the interface, carried by constraint modes, and
    # what the inertia in balance with its force does to the inside: relief modes. So constraint
    # modes, relief modes and the free modes less the constraint modes in them span the lot.
    follows = model.expansion @ statics.constraint_modes
    loose = model.expansion @ statics.loose
    relief = model.expansion @ statics.relief_modes
    candidates = np.hstack([loose, free - follows @ free[component.boundary], relief])
    found = independent_vectors(candidates, model.mass)
    first = loose.shape[1]
    labels = [_label(number - first, free.shape[1]) for number in found.kept[first:]]
    return reduced_component(component, statics, found.vectors[:, first:], labels)


def _label(number: int, modes: int) -> str:
    return f"mode {number + 1}" if number < modes else f"inertia relief {number - modes + 1}"
