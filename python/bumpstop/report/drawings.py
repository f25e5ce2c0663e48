"""Drawings of a response, one call each: figures of plotly, to show, change or save.

`plot` draws whatever was read out of a run as a labelled array: histories, spectra, histograms.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.arguments import one_of, positive
from bumpstop.errors import InputError
from bumpstop.post.of_run import of_run
from bumpstop.report import figures
from bumpstop.report.figures import as_plotly

if TYPE_CHECKING:
    import plotly.graph_objects as go
    import xarray as xr

    from bumpstop.response import Response

__all__ = [
    "draw_energy",
    "draw_friction_loop",
    "draw_history",
    "draw_loop",
    "draw_orbit",
    "draw_phase_portrait",
    "draw_scene",
    "draw_section",
    "draw_sectors",
]

HISTORIES = (
    "displacement", "velocity", "acceleration", "stop_force", "friction_force", "gap", "gauge"
)  # fmt: skip


@of_run
def draw_scene(response: Response, magnification: float | None = None) -> go.Figure:
    """Draw the structure in space with its stops, moving.

    Buttons play it, and show it at its true scale or enlarged; a slider goes to an instant. Gaps
    are enlarged with the motion. Obstacles, springs, dampers and devices turn orange while they
    push, and arrows show the forces on the structure. Laws along sums of dofs are not drawn.

    Parameters
    ----------
    response
        What to draw.
    magnification
        How much larger than true the enlarged motion is; what can be seen well where left out.

    Raises
    ------
    InputError
        If the magnification is not positive.

    Examples
    --------
    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[2.0], shapes={("P", "dx"): [1.0]})
    >>> wall = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=0.01, stiffness=1e4)
    >>> thrown = bs.ModalState(velocity=[-0.5])
    >>> run = bs.simulate(bs.Problem(basis, laws=[wall], initial=thrown, duration=1.0))
    >>> figure = bs.draw_scene(run)
    >>> [button.label for button in figure.layout.updatemenus[0].buttons]
    ['Play', 'Pause']
    """
    from bumpstop.report.space import scene_figure, still_at_first

    if magnification is not None:
        magnification = positive("magnification", magnification)
    return still_at_first(scene_figure(response, magnification))


@of_run
def draw_history(response: Response, quantity: str, *target: str) -> go.Figure:
    """Draw a quantity over time, with contacts shaded.

    Parameters
    ----------
    response
        What to draw.
    quantity, target
        ``displacement``, ``velocity`` or ``acceleration`` of a node and dof; ``stop_force``,
        ``friction_force`` or ``gap`` of a stop or another law; ``gauge`` of a gauge.

    Raises
    ------
    InputError
        If there is no such thing.
    """
    one_of("quantity", quantity, HISTORIES)
    count = 2 if quantity in HISTORIES[:3] else 1
    if len(target) != count:
        wanted = "a node and a dof" if count == 2 else "one name"
        raise InputError(f"{quantity} is of {wanted}", key="target", value=target)
    if count == 2:
        return as_plotly(figures.node_motion(response, quantity, target[0], target[1]))
    draw = {
        "stop_force": figures.stop_force,
        "friction_force": figures.friction_force,
        "gap": figures.gap,
        "gauge": figures.gauge_strain,
    }
    return as_plotly(draw[quantity](response, target[0]))


@of_run
def draw_phase_portrait(response: Response, node: str, dof: str) -> go.Figure:
    """Draw velocity against displacement of a node, with its impacts marked.

    Raises
    ------
    InputError
        If there is no such node or dof.
    """
    return as_plotly(figures.phase_portrait(response, node, dof))


@of_run
def draw_section(
    response: Response,
    node: str,
    dof: str,
    period: float,
    *,
    phase: float = 0.0,
    start: float = 0.0,
) -> go.Figure:
    """Draw a Poincaré section: velocity against displacement once in each period.

    Parameters
    ----------
    response, node, dof, period, phase, start
        As `stroboscopic_section` takes them.

    Raises
    ------
    InputError
        If the run has no such node, or no such instant.
    """
    from bumpstop.report.sections import section_figure

    return as_plotly(section_figure(response, node, dof, period, phase=phase, start=start))


@of_run
def draw_orbit(response: Response, stop: str) -> go.Figure:
    """Draw the path of a node within a round or polygonal stop, with the forces on it.

    Its colour tells the contact force, arrows its direction at the hardest contacts.

    Raises
    ------
    InputError
        If there is no such stop, or it is not about an axis.
    """
    from bumpstop.laws.around_axis import StopAroundAxis
    from bumpstop.report.orbit import orbit

    law = response.problem.laws[response.stop_index(stop)]
    if not isinstance(law, StopAroundAxis):
        hint = "CircleStop and PolarStop are; draw_phase_portrait is for the others"
        raise InputError("is no obstacle about an axis", key="stop", value=stop, hint=hint)
    return as_plotly(orbit(response, law))


@of_run
def draw_loop(response: Response, law: str) -> go.Figure:
    """Draw the force of a stop or another law against what it resists: depth, or deformation.

    The area of a loop is the work lost in it.

    Raises
    ------
    InputError
        If there is no such law.
    """
    from bumpstop.report.loops import force_loop

    return as_plotly(force_loop(response, law))


@of_run
def draw_friction_loop(response: Response, stop: str) -> go.Figure:
    """Draw the friction force of a stop against how far its node has slid along the obstacle.

    Raises
    ------
    InputError
        If there is no such stop, or it does not rub along one known direction.
    """
    from bumpstop.report.loops import friction_loop

    return as_plotly(friction_loop(response, stop))


@of_run
def draw_energy(response: Response) -> go.Figure:
    """Stack where the energy is over time, against what was put in."""
    return as_plotly(figures.energy_ledger(response))


def draw_sectors(array: xr.DataArray) -> go.Figure:
    """Draw what is told by the sectors of a circle, such as `work_by_sector`, around it.

    Raises
    ------
    InputError
        If the array is not over angles.

    Examples
    --------
    >>> import xarray as xr
    >>> rate = xr.DataArray([1e-3, 3e-3], coords={"angle": [1.57, 4.71]}, name="work rate")
    >>> figure = draw_sectors(rate.assign_attrs(units="W", long_name="work rate by sector"))
    >>> figure.layout.title.text
    'Work rate by sector (mW)'
    """
    from bumpstop.report.sectors import sector_figure

    return as_plotly(sector_figure(array))
