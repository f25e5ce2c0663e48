"""NetCDF: a response in a file that xarray, ParaView, MATLAB and the like can open."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.errors import InputError
from bumpstop.files import written_whole
from bumpstop.io.netcdf_format import Variable, write_file
from bumpstop.post.energy import ledger
from bumpstop.projection import TRANSLATIONS, along
from bumpstop.quantities import (
    ENERGIES,
    IMPACTS,
    QUANTITIES,
    STATE,
    STOP_ENERGIES,
    dof_units,
    modal_attributes,
    plain_name,
)
from bumpstop.response import MOTIONS
from bumpstop.structure.dofs import Dof

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray

    from bumpstop.arguments import FloatArray
    from bumpstop.response import Response
    from bumpstop.structure.model import LinearModel

__all__ = ["write_netcdf"]

TIME = {"units": "s", "long_name": "time"}


def write_netcdf(
    response: Response,
    path: str | PathLike[str],
    *,
    title: str | None = None,
    case: str | None = None,
    variant: str | None = None,
) -> None:
    """Write a response, tabulated at its times, to a NetCDF-4 file.

    Over ``time`` the file holds the modal motion, forces and gaps of the stops, with friction
    also its forces and the states, strains of the gauges, displacements of all mesh nodes along
    the axes that are free (where the basis knows its structure), motions of the problem's outputs
    and of the nodes at the stops, and the energy ledger; and beside them tables of impacts and of
    events. Names, units and attributes follow the CF conventions, version 1.11; attributes of the
    file say what made it and how.

    Parameters
    ----------
    response
        What to write.
    path
        The file; one of that name is replaced once the new one is complete.
    title, case, variant
        Where the problem comes from.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    attributes = {"title": title, "case": case, "variant": variant} | _provenance(response)
    told = {name: value for name, value in attributes.items() if value is not None}
    with written_whole(path) as part:
        write_file(part, _variables(response), told)


def _variables(response: Response) -> Iterator[Variable]:
    # Read once, used by several: reading from the core takes longer than writing.
    motions = [response.motion(derivative) for derivative in range(len(MOTIONS))]
    yield Variable("time", ("time",), response.times, TIME)
    yield from _modes(response, motions)
    yield from _stops(response)
    yield from _gauges(response, motions[0])
    yield from _outputs(response, motions)
    if response.problem.basis.model is not None:
        yield from _nodes(response, response.problem.basis.model, motions[0])
    yield from _energies(response)
    yield from _impacts(response)
    yield from _events(response)


def _modes(response: Response, motions: list[FloatArray]) -> Iterator[Variable]:
    basis = response.problem.basis
    numbers = np.arange(1, len(basis.omega2) + 1)
    hertz = {"units": "Hz", "long_name": "natural frequency"}
    ratio = {"units": "1", "long_name": "ratio of critical damping"}
    yield Variable("mode", ("mode",), numbers, {"long_name": "number of the mode"})
    yield Variable("frequency", ("mode",), basis.frequencies, hertz)
    yield Variable("damping_ratio", ("mode",), basis.damping_ratio, ratio)
    over = "mode"
    if basis.coordinates is not None:
        over, told = "vector", {"long_name": "vector of the basis as its user gave it"}
        yield Variable("vector", ("vector",), _texts(basis.labels), told)
    for name, motion in zip(("modal_displacement", "modal_velocity"), motions, strict=False):
        values = basis.amplitudes(motion)
        attributes = modal_attributes(name, unit_mass=basis.coordinates is None)
        yield Variable(name, ("time", over), values, attributes)


def _stops(response: Response) -> Iterator[Variable]:
    stops = [law.name for law in response.problem.laws]
    if not stops:
        return
    yield Variable("stop", ("stop",), _texts(stops), {"long_name": "name of the stop"})
    found = [response.history.law_motion(stop, response.times) for stop in range(len(stops))]
    distances, _, forces = (np.stack(columns, axis=1) for columns in zip(*found, strict=True))
    for name, values in (("stop_force", forces), ("gap", distances)):
        yield Variable(name, ("time", "stop"), values, QUANTITIES[name].attributes)
    if any(getattr(law, "friction", None) is not None for law in response.problem.laws):
        yield from _friction(response, stops)


def _friction(response: Response, stops: list[str]) -> Iterator[Variable]:
    """Give the forces along the obstacles and, as flags of the CF conventions, the states."""
    over = ("time", "stop")
    forces = np.stack([response.sample("friction_force", stop) for stop in stops], axis=1)
    yield Variable("friction_force", over, forces, QUANTITIES["friction_force"].attributes)
    states = np.stack([response.sample("state", stop) for stop in stops], axis=1)
    names, numbers = np.unique(states, return_inverse=True)
    flags: dict[str, Any] = {
        "long_name": STATE.long_name,
        "flag_values": np.arange(names.size, dtype=np.int32),
        "flag_meanings": " ".join(re.sub(r"\W+", "_", name) for name in names.tolist()),
    }
    yield Variable("state", over, numbers.reshape(states.shape).astype(np.int32), flags)


def _gauges(response: Response, displacement: FloatArray) -> Iterator[Variable]:
    gauges, basis = response.problem.gauges, response.problem.basis
    if not gauges:
        return
    names = _texts(gauge.name for gauge in gauges)
    strains = np.stack([along(basis.gauge_row(gauge), displacement) for gauge in gauges], axis=1)
    if response.problem.supports_move:
        strains = np.stack([response.sample("gauge", gauge.name) for gauge in gauges], axis=1)
    yield Variable("gauge", ("gauge",), names, {"long_name": "name of the gauge"})
    yield Variable("strain", ("time", "gauge"), strains, QUANTITIES["gauge"].attributes)


def _outputs(response: Response, motions: list[FloatArray]) -> Iterator[Variable]:
    """Give motions of the outputs and of the nodes at the stops, a variable each."""
    for node, dof in dict.fromkeys([*response.problem.outputs, *_stopped(response)]):
        row = response.problem.basis.row(node, dof)
        for quantity, motion in zip(MOTIONS, motions, strict=True):
            attributes = {
                "units": dof_units(quantity, dof),
                "long_name": f"{quantity} of {node} along {dof}",
                "node": node,
                "dof": dof,
            }
            name = plain_name(f"{quantity}_{node}_{dof}")
            values = along(row, motion)
            if response.problem.supports_move:
                values = response.sample(quantity, node, dof)
            yield Variable(name, ("time",), values, attributes)


def _stopped(response: Response) -> list[Dof]:
    """Return the dofs along which the stops push."""
    return [dof for law in response.problem.laws for dof in law.coordinate.dofs]


def _nodes(response: Response, model: LinearModel, motion: FloatArray) -> Iterator[Variable]:
    """Give places and displacements of all nodes, where their places are known."""
    basis = response.problem.basis
    nodes = list(dict.fromkeys(node for node, dof in model.dofs if dof in TRANSLATIONS))
    try:
        positions = np.array([model.position(node) for node in nodes])
    except InputError:  # matrices need not come with places
        return
    yield Variable("node", ("node",), _texts(nodes), {"long_name": "name of the node"})
    for axis, values in zip("xyz", positions.T, strict=True):
        long_name = f"{axis} of the node at rest"
        yield Variable(axis, ("node",), values, {"units": "m", "long_name": long_name})
    moving = {model.dofs[row][1] for row in model.expansion.rows.tolist()}
    dofs = [dof for dof in TRANSLATIONS if dof in moving]
    if not dofs:
        return
    rows = {dof: row for row, dof in enumerate(model.dofs)}
    # A node without the dof gets the row of zeros behind all others.
    shapes = np.vstack([basis.shapes, np.zeros(basis.shapes.shape[1])])
    places = np.array([[rows.get((node, dof), -1) for dof in dofs] for node in nodes])
    table = (motion @ shapes[places.ravel()].T).reshape(-1, *places.shape)
    attributes = QUANTITIES["displacement"].attributes | {"coordinates": "x y z"}
    yield Variable("dof", ("dof",), _texts(dofs), {"long_name": "degree of freedom"})
    yield Variable("displacement", ("time", "node", "dof"), table, attributes)


def _energies(response: Response) -> Iterator[Variable]:
    found = ledger(response, response.times)
    for name, values in found.terms.items():
        yield Variable(f"energy_{name}", ("time",), values, ENERGIES[name].attributes)
    if response.problem.laws:
        for name, values in found.stops.items():
            attributes = STOP_ENERGIES[name].attributes
            yield Variable(f"energy_{name}", ("time", "stop"), values, attributes)


def _impacts(response: Response) -> Iterator[Variable]:
    table = response.impact_table()
    along = ("impact",)
    yield Variable("impact_stop", along, _texts(table["stop"]), {"long_name": "name of the stop"})
    for name, quantity in IMPACTS.items():
        values = np.array(table[name], dtype=float)
        yield Variable(f"impact_{name}", along, values, quantity.attributes)


def _events(response: Response) -> Iterator[Variable]:
    words = {
        "law": "law that switched",
        "guard": "what made it switch",
        "before": "its state before",
        "after": "its state after",
    }
    table = response.event_table()
    instant = {"units": "s", "long_name": "instant of the switch"}
    yield Variable("event_time", ("event",), np.array(table["time"], dtype=float), instant)
    for name, meaning in words.items():
        yield Variable(f"event_{name}", ("event",), _texts(table[name]), {"long_name": meaning})


def _texts(texts: Iterable[object]) -> NDArray[Any]:
    return np.array(list(texts), dtype=object)


def _provenance(response: Response) -> dict[str, Any]:
    from bumpstop import __version__

    now = datetime.now(UTC).isoformat(timespec="seconds")
    return {
        "Conventions": "CF-1.11",
        "source": f"bumpstop {__version__}",
        "history": f"{now} written by bumpstop {__version__}",
        "date_created": now,
        "bumpstop_version": __version__,
        "method": response.method,
        "method_reason": response.method_reason,
        **{f"method_{option}": value for option, value in response.options.items()},
        "steps": response.steps,
        "certified_steps": response.certified_steps,
        "missed_penetration": response.missed_penetration,
        "motion_error": response.motion_error,
        "event_count": response.event_count,
        "relative_energy_residual": response.energy_residual,
        "solve_seconds": response.solve_seconds,
    }
