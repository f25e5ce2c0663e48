"""NetCDF: a response in a file that xarray, ParaView, MATLAB and the like can open."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.errors import InputError
from bumpstop.files import written_whole
from bumpstop.instants import Grid
from bumpstop.io.netcdf_format import Growth, Variable, write_file
from bumpstop.laws.coordinate import coordinates_of
from bumpstop.post.energy import ledger
from bumpstop.projection import TRANSLATIONS
from bumpstop.quantities import (
    ENERGIES,
    IMPACTS,
    INTERNAL_VARIABLES,
    QUANTITIES,
    STATE,
    STOP_ENERGIES,
    dof_units,
    modal_attributes,
    plain_names,
)
from bumpstop.sampling import MOTIONS
from bumpstop.structure.dofs import Dof

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray

    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.modal.full import FullMatrices
    from bumpstop.post.results.reading import Result
    from bumpstop.problem import Problem
    from bumpstop.response import Response
    from bumpstop.structure.model import LinearModel

__all__ = ["internal_names", "states_of", "write_netcdf"]

MOST_NUMBERS = 1_000_000
"""Columns times instants, of which a block has no more; each makes a few numbers."""
OTHER_COLUMNS = 20
"""Columns of the ledger and of all else that is there once."""
MOST_SHAPES = 2_000_000
"""Numbers in the shapes of the largest basis that is kept with its response."""
MOST_ENTRIES = 10_000_000
"""Entries in the matrices of the largest full model that is kept with its response."""
NOTHING: Mapping[str, float] = {}
TIME: Mapping[str, str | float] = {"units": "s", "long_name": "time"}


def write_netcdf(
    response: Response,
    path: str | PathLike[str],
    *,
    title: str | None = None,
    case: str | None = None,
    variant: str | None = None,
    results: Sequence[Result] = (),
) -> None:
    """Write a response, tabulated at its times, to a NetCDF-4 file.

    Over ``time`` the file holds the modal motion (of a full model that of the independent dofs
    that the run has kept), forces, gaps and states of the stops, with
    friction also its forces, strains of the gauges, displacements of all mesh nodes along the
    axes that are free (where the basis knows its structure), motions of the problem's outputs
    and of the nodes at the stops, and the energy ledger; beside them tables of impacts, of blows
    on rigid stops and of events, and the problem itself, from which `bumpstop.read_netcdf` makes
    the response again.
    Names, units and attributes follow the CF conventions, version 1.11; attributes of the file
    say what made it and how. Long responses are written block by block.

    Parameters
    ----------
    response
        What to write.
    path
        The file; one of that name is replaced once the new one is complete.
    title, case, variant
        Where the problem comes from.
    results
        Results of its case whose numbers and curves are to be in the file.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    told = {"title": title, "case": case, "variant": variant}
    for key, text in told.items():
        if text is not None and not isinstance(text, str):
            raise InputError("must be a text", key=key, value=text)
    attributes = told | _provenance(response)
    told = {name: value for name, value in attributes.items() if value is not None}
    length, words = len(response.instants), states_of(response)
    blocks = response.blocks(_block(response))
    first = [
        *_over_time(next(blocks)[1], words, _grid(response)),
        *_of_the_run(response, words),
        *_results(response, results),
    ]
    with written_whole(path) as part:
        write_file(part, first, told, Growth("time", length, _further(blocks, words)))


def _grid(response: Response) -> Mapping[str, float]:
    """Return what tells evenly spaced instants, so that they need not be read."""
    instants = response.instants
    return {"step": instants.step, "end": instants.end} if isinstance(instants, Grid) else NOTHING


def _block(response: Response) -> int:
    """Return how many instants are held in memory at a time."""
    basis = response.problem.basis
    whole = len(basis.omega2) + len(basis.dofs)
    motion = whole if response.kept is None else len(MOTIONS) * len(response.kept)
    own = motion + len(response.problem.laws)
    return max(MOST_NUMBERS // (OTHER_COLUMNS + own), 1)


def _further(
    blocks: Iterator[tuple[int, Response]], words: list[str]
) -> Iterator[tuple[int, Iterator[Variable]]]:
    """Give where each further block begins, and what it holds."""
    for start, block in blocks:
        yield start, _over_time(block, words)


def _of_the_run(response: Response, words: list[str]) -> Iterator[Variable]:
    yield from _impacts(response)
    yield from _blows(response)
    yield from _events(response)
    if response.problem.laws:
        meaning = {"long_name": "what the flags of state mean"}
        yield Variable("state_name", ("state_flag",), _texts(words), meaning)
    yield from _problem(response.problem)


def _over_time(
    response: Response, words: list[str], grid: Mapping[str, float] = NOTHING
) -> Iterator[Variable]:
    """Give what is a function of time, and what its other dimensions are."""
    # Read once, used by several: reading from the core takes longer than writing.
    motions = [response.motion(derivative) for derivative in range(len(MOTIONS))]
    yield Variable("time", ("time",), response.times, {**TIME, **grid})
    if response.problem.basis.unreduced:
        from bumpstop.io.independent_dofs import independent_dofs

        yield from independent_dofs(response, motions)
    else:
        yield from _modes(response, motions)
    yield from _stops(response, words)
    yield from _gauges(response)
    yield from _outputs(response)
    if response.problem.basis.model is not None and response.kept is None:
        yield from _nodes(response, response.problem.basis.model, motions[0])
    yield from _energies(response)


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
    for quantity, motion in zip(MOTIONS, motions, strict=True):
        name = f"modal_{quantity}"
        attributes = modal_attributes(name, unit_mass=basis.coordinates is None)
        yield Variable(name, ("time", over), basis.amplitudes(motion), attributes)
        if basis.coordinates is not None:
            attributes = modal_attributes(name, unit_mass=True)
            yield Variable(f"canonical_{quantity}", ("time", "mode"), motion, attributes)


def _stops(response: Response, words: list[str]) -> Iterator[Variable]:
    stops = [law.name for law in response.problem.laws]
    if not stops:
        return
    yield Variable("stop", ("stop",), _texts(stops), {"long_name": "name of the stop"})
    found = [response.history.law_motion(stop, response.times) for stop in range(len(stops))]
    distances, rates, forces = (np.stack(columns, axis=1) for columns in zip(*found, strict=True))
    told = {name: QUANTITIES[name].attributes for name in ("stop_force", "gap")}
    told["gap_rate"] = {"units": "m/s", "long_name": "rate of the distance to the stop"}
    for name, values in (("stop_force", forces), ("gap", distances), ("gap_rate", rates)):
        yield Variable(name, ("time", "stop"), values, told[name])
    if any(getattr(law, "friction", None) is not None for law in response.problem.laws):
        times = response.times
        across = [response.history.contact_forces(stop, times) for stop in range(len(stops))]
        _, slides, axial = np.stack(across, axis=2).transpose(1, 0, 2)
        attributes = QUANTITIES["friction_force"].attributes
        yield Variable("friction_force", ("time", "stop"), slides, attributes)
        attributes = {"units": "N", "long_name": "friction force along the axis of the obstacle"}
        yield Variable("axial_force", ("time", "stop"), axial, attributes)
    yield from _law_forces(response)
    yield from _internal_variables(response)
    yield _states(response, stops, words)


def _law_forces(response: Response) -> Iterator[Variable]:
    """Give the forces along the coordinates of laws, where one has several."""
    names = coordinate_names(response.problem)
    if len(names) == len(response.problem.laws):
        return
    number = range(len(response.problem.laws))
    forces = [response.history.law_forces(law, response.times) for law in number]
    told = {"long_name": "law, and number of its coordinate"}
    yield Variable("law_coordinate", ("law_coordinate",), _texts(names), told)
    attributes = {"units": "N", "long_name": "force of each law along each of its coordinates"}
    yield Variable("law_force", ("time", "law_coordinate"), np.hstack(forces), attributes)


def coordinate_names(problem: Problem) -> list[str]:
    """Return the coordinates of all laws in the order of a file, by law and number."""
    return [
        f"{law.name} {place}"
        for law in problem.laws
        for place in range(1, 1 + len(coordinates_of(law, problem.basis)))
    ]


def _internal_variables(response: Response) -> Iterator[Variable]:
    """Give what laws remember, a variable each."""
    for name, (number, column, remembered) in internal_names(response.problem).items():
        values = response.history.internal_variables(number, response.times)[:, column].copy()
        attributes = INTERNAL_VARIABLES[remembered].attributes
        law = response.problem.laws[number].name
        yield Variable(name, ("time",), values, attributes | {"stop": law})


def internal_names(problem: Problem) -> dict[str, tuple[int, int, str]]:
    """Return what variables of internal variables are called in a file.

    For each the number of its law, its place among those that the law has, and which it is.
    """
    found = [
        (number, column, remembered)
        for number, law in enumerate(problem.laws)
        for column, remembered in enumerate(getattr(law, "internal_variables", ()))
    ]
    names = plain_names(f"internal_{what}_{problem.laws[law].name}" for law, _, what in found)
    return dict(zip(names, found, strict=True))


def _states(response: Response, stops: list[str], names: list[str]) -> Variable:
    """Return the states of the stops, as flags of the CF conventions."""
    number = {name: flag for flag, name in enumerate(names)}
    flags = [[number[name] for name in response.sample("state", stop)] for stop in stops]
    attributes: dict[str, Any] = {
        "long_name": STATE.long_name,
        "flag_values": np.arange(len(names), dtype=np.int32),
        "flag_meanings": " ".join(re.sub(r"\W+", "_", name) for name in names),
    }
    return Variable("state", ("time", "stop"), np.array(flags, dtype=np.int32).T, attributes)


def states_of(response: Response) -> list[str]:
    """Return the words for all states that the laws of a run were in, as the file counts them."""
    start = (response.sample("state", law.name, times=[0.0]) for law in response.problem.laws)
    table = response.event_table()
    words = {str(state) for column in (*start, table["before"], table["after"]) for state in column}
    return sorted(words)


def _gauges(response: Response) -> Iterator[Variable]:
    gauges = response.problem.gauges
    if not gauges:
        return
    names = _texts(gauge.name for gauge in gauges)
    strains = np.stack([response.sample("gauge", gauge.name) for gauge in gauges], axis=1)
    yield Variable("gauge", ("gauge",), names, {"long_name": "name of the gauge"})
    yield Variable("strain", ("time", "gauge"), strains, QUANTITIES["gauge"].attributes)


def _outputs(response: Response) -> Iterator[Variable]:
    """Give motions of the outputs and of the nodes at the stops, a variable each."""
    places = dict.fromkeys([*response.problem.outputs, *_stopped(response)])
    wanted = [(node, dof, quantity) for node, dof in places for quantity in MOTIONS]
    names = plain_names(f"{quantity}_{node}_{dof}" for node, dof, quantity in wanted)
    for name, (node, dof, quantity) in zip(names, wanted, strict=True):
        attributes = {
            "units": dof_units(quantity, dof),
            "long_name": f"{quantity} of {node} along {dof}",
            "node": node,
            "dof": dof,
        }
        yield Variable(name, ("time",), response.sample(quantity, node, dof), attributes)


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
    # A node without the dof rests.
    places = np.array([[rows.get((node, dof), -1) for dof in dofs] for node in nodes])
    table = np.zeros((len(motion), *places.shape))
    table[:, places >= 0] = motion @ basis.shapes[places[places >= 0]].T
    if response.problem.supports_move:
        from bumpstop.carried import carried_field

        carried = carried_field(response.problem, response.times)
        table += np.hstack([carried, np.zeros((len(carried), 1))])[:, places]
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


def _blows(response: Response) -> Iterator[Variable]:
    """Give the blows on rigid stops, which the force over time lacks."""
    if not any(hasattr(law, "restitution") for law in response.problem.laws):
        return
    from bumpstop.post.blows import blow_table

    table = blow_table(response)
    numbers = {
        "time": {"units": "s", "long_name": "instant of the blow"},
        "impulse": {"units": "N s", "long_name": "impulse on the structure along the normal"},
    }
    along, words = ("blow",), {"long_name": "name of the rigid stop"}
    yield Variable("blow_stop", along, _texts(table["stop"]), words)
    for name, attributes in numbers.items():
        yield Variable(f"blow_{name}", along, np.array(table[name], dtype=float), attributes)


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


def _results(response: Response, results: Sequence[Result]) -> Iterator[Variable]:
    """Give the numbers of results, a row each, and their curves."""
    if not results:
        return
    from bumpstop.io.curves import curve_variables
    from bumpstop.post.results.reading import read_result

    yield from curve_variables(response, results)

    facts = [(each.name, fact) for each in results for fact in read_result(each, response).facts]
    if not facts:
        return
    words = {
        "name": ("name of the result", [name for name, _ in facts]),
        "quantity": ("what was read", [fact.what.long_name for _, fact in facts]),
        "units": ("unit of the value", [fact.what.units for _, fact in facts]),
    }
    for name, (meaning, texts) in words.items():
        yield Variable(f"result_{name}", ("result",), _texts(texts), {"long_name": meaning})
    numbers = {
        "value": ("value, in its own unit", [fact.value for _, fact in facts]),
        "uncertainty": (
            "standard error, in the unit of the value",
            [f.uncertainty for _, f in facts],
        ),
    }
    for name, (meaning, values) in numbers.items():
        column = np.array(values, dtype=float)
        yield Variable(f"result_{name}", ("result",), column, {"long_name": meaning})


def _problem(problem: Problem) -> Iterator[Variable]:
    """Give the whole problem, for those who make it again; huge ones are left out."""
    if _is_huge(problem.basis):
        return
    from bumpstop.io.statement import packed

    try:
        content = packed(problem)
    except InputError:  # loads or laws of a user's own
        return
    told = {"long_name": "the problem: arrays of NumPy (npz) and a text in JSON, as bytes"}
    values = np.frombuffer(content, dtype=np.uint8)
    yield Variable("problem", ("problem_byte",), values, told)


def _is_huge(basis: ModalBasis) -> bool:
    if basis.unreduced:
        matrices: FullMatrices = basis.matrices  # type: ignore[attr-defined]  # a FullModel has them
        return sum(len(matrix.values) for matrix in matrices) > MOST_ENTRIES
    return basis.shapes.size > MOST_SHAPES


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
