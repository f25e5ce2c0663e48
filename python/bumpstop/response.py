"""Response: what a simulation leaves behind, to be read at any time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, SupportsIndex

from bumpstop.arguments import FloatArray, count, one_of
from bumpstop.errors import ComputationError
from bumpstop.instants import Grid, checked_times
from bumpstop.labelled import modes_over_time, over_time
from bumpstop.quantities import STATE, dof_units
from bumpstop.sampling import sampled

if TYPE_CHECKING:
    from os import PathLike

    import pandas as pd
    import xarray as xr
    from numpy.typing import ArrayLike

    from bumpstop._core import History
    from bumpstop.post.impacts import Table
    from bumpstop.post.results.reading import Reading, Result
    from bumpstop.problem import Problem
    from bumpstop.structure.sparse import IndexArray

__all__ = ["Response"]


@dataclass(frozen=True, eq=False, repr=False)
class Response:
    """The motion of a problem, kept as the core's phases or steps and sampled when asked for.

    Parameters
    ----------
    problem
        What was simulated.
    history
        The core's record of the run.
    instants
        Times in s at which quantities are tabulated; `at` gives the same response on others.
    method_reason
        Why this method was taken.
    options
        Options of the method: its step ``dt`` in s, where it has one.
    kept
        The coordinates of a full model whose motion was kept; all where None.
    """

    problem: Problem
    history: History
    _: KW_ONLY
    instants: Grid | FloatArray
    method_reason: str
    options: Mapping[str, float]
    kept: IndexArray | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.instants, Grid):
            instants = checked_times(self.instants, self.problem.duration)
            object.__setattr__(self, "instants", instants)

    def __repr__(self) -> str:
        return (
            f"<Response: {self.problem.duration:g} s by the {self.method} method, "
            f"{self.steps} steps, {self.event_count} events>"
        )

    def _repr_html_(self) -> str:
        from bumpstop.post.card import response_card

        return response_card(self)

    @cached_property
    def times(self) -> FloatArray:
        """Instants in s at which quantities are tabulated."""
        return self.instants[:]

    @property
    def is_dense(self) -> bool:
        """Whether it is at hand for any instant.

        Where it comes from a file, its run is repeated for what the file does not hold.
        """
        return getattr(self.history, "is_dense", True)

    @property
    def method(self) -> str:
        """Name of the method that was used."""
        return self.history.method

    @property
    def steps(self) -> int:
        """Cells that the exact method certified, or time steps of the others."""
        return self.history.steps

    @property
    def certified_steps(self) -> int | None:
        """Steps within which the method has proved that no contact was missed.

        All of the exact method; None for methods that prove nothing.
        """
        return None if self.missed_penetration is None else self.steps

    @property
    def missed_penetration(self) -> float | None:
        """Depth in m that no contact which the method has missed can have exceeded.

        The exact method misses none but for rounding, and this is a bound of its rounding;
        None for methods without such a bound.
        """
        return self.history.missed_penetration

    @property
    def motion_error(self) -> float | None:
        """Bound in m of the error that rounding leaves in the motion between two switches.

        At every instant, where a law acts, the motion of the exact method is this close to
        the solution of the equations of motion that starts where the last switch left it;
        without laws, this is the error of any modal coordinate. The bound comes from what the
        computed motion leaves of the equations (see the theory page on the certificate), the same
        for any problem; infinite where it says nothing, None for methods without such a bound.
        """
        return self.history.motion_error

    @property
    def event_count(self) -> int:
        """How many times a law switched."""
        return self.history.event_count

    @cached_property
    def solve_seconds(self) -> float:
        """Time in s spent in the core: integration and all read until this was first asked for.

        Kept from then on, so that a run's table, files and report tell one number.
        """
        return self.history.seconds

    @cached_property
    def known_impacts(self) -> dict[int, dict[str, FloatArray]]:
        """The impacts of those stops that were asked for so far, by their numbers."""
        return {}

    @cached_property
    def known_readings(self) -> dict[str, tuple[Result, Reading]]:
        """What was read of it so far for results of its case, by their names."""
        return {}

    @property
    def energy_residual(self) -> float:
        """Largest imbalance of the energy ledger relative to the largest energy seen.

        Looked at after each step, or for the exact method at the switches and at the end of
        the run; between switches `energy` has it at any instant.

        Raises
        ------
        ComputationError
            If energies have left the range of numbers.
        """
        residual = self.history.energy_residual()
        if not math.isfinite(residual):
            raise ComputationError("the energies leave the range of numbers; check the units")
        return residual

    def at(self, times: ArrayLike) -> Response:
        """Return this response tabulated at other instants.

        Parameters
        ----------
        times
            Instants in s within the simulated time, shape (n,).

        Raises
        ------
        InputError
            If an instant is outside the simulated time.
        """
        return replace(self, instants=checked_times(times, self.problem.duration))

    def blocks(self, most: int) -> Iterator[tuple[int, Response]]:
        """Yield this response in blocks of its instants, each with the number of its first one.

        What is read of one block after the other takes the memory of one block, however long the
        run was.

        Parameters
        ----------
        most
            Instants of a block, at least 1.

        Examples
        --------
        >>> import bumpstop as bs
        >>> basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
        >>> swing = bs.simulate(bs.Problem(basis, duration=1.0, sample=0.1))
        >>> [(start, len(block.times)) for start, block in swing.blocks(4)]
        [(0, 4), (4, 4), (8, 3)]
        """
        size = count("most", most)
        for start in range(0, len(self.instants), size):
            yield start, self.at(self.instants[start : start + size])

    # Plain arrays: what everything inside uses, so that a run needs no xarray or pandas.

    def motion(self, derivative: int = 0, times: ArrayLike | None = None) -> FloatArray:
        """Return displacement (0), velocity (1) or acceleration (2) of the canonical modes.

        Shape (time, N). `sample` gives the amplitudes of the vectors that the user gave.
        """
        return self.history.motion(self._instants(times), derivative)

    def sample(
        self, quantity: str, *target: str | SupportsIndex, times: ArrayLike | None = None
    ) -> FloatArray:
        """Return a quantity over time as a plain array.

        Parameters
        ----------
        quantity
            ``displacement``, ``velocity``, ``acceleration`` of a node and dof (m or rad, and
            per s and s2); ``modal_displacement``, ``modal_velocity``, ``modal_acceleration``
            of a mode counted from 1, or of all, where a mode is a vector of the basis as its
            user gave it; ``stop_force``, ``friction_force`` (N) and ``gap`` (m) of a stop, and
            its ``state`` in words; ``internal_variable`` of a law that remembers something, by
            the law and what it is called (`internal_variables`); ``gauge`` (strain) of a gauge.
        target
            What it is the quantity of: ``"B", "dy"``, or ``"guide"``.
        times
            Instants in s; those of the response where left out.

        Returns
        -------
        ndarray
            Values (time,), or (time, U) for all modes; texts for states.

        Raises
        ------
        InputError
            If quantity or target are unknown, or an instant is outside the simulated time.

        Examples
        --------
        >>> import bumpstop as bs
        >>> basis = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dx"): [1]})
        >>> drift = bs.Problem(basis, initial=bs.ModalState(velocity=[2.0]), duration=1.0)
        >>> bs.simulate(drift).sample("displacement", "P", "dx", times=[0.0, 0.5]).tolist()
        [0.0, 1.0]
        """
        return sampled(self, quantity, target, self._instants(times))

    def law_index(self, stop: str) -> int:
        """Return the number of a stop or another law in the core, counted from 0.

        Raises
        ------
        InputError
            If there is no such law.
        """
        names = [law.name for law in self.problem.laws]
        return names.index(one_of("stop", stop, names))

    def stop_index(self, stop: str) -> int:
        """Return the number of a stop in the core, counted from 0 among all laws.

        Raises
        ------
        InputError
            If there is no such stop.
        """
        return self.law_index(one_of("stop", stop, self.problem.stop_names))

    def energy_terms(self, times: ArrayLike | None = None) -> dict[str, FloatArray]:
        """Return the energy ledger as plain arrays (time,), in J; see `energy`."""
        from bumpstop.post.energy import ledger

        return ledger(self, self._instants(times)).terms

    def impact_table(self) -> Table:
        """Return the impacts as plain columns; see `impacts`."""
        from bumpstop.post.impacts import impact_table

        return impact_table(self)

    def event_table(self) -> Table:
        """Return the events as plain columns; see `events`."""
        from bumpstop.post.impacts import event_table

        return event_table(self)

    # Labelled results.

    def displacement(self, node: str, dof: str) -> xr.DataArray:
        """Return the displacement of a node over time, in m (rad for a rotation).

        Parameters
        ----------
        node
            A node's name or a point along a beam (``"AB@0.462"``).
        dof
            One of ``dx dy dz drx dry drz``.

        Raises
        ------
        InputError
            If the basis knows no such node or dof.
        """
        return self._nodal("displacement", node, dof)

    def velocity(self, node: str, dof: str) -> xr.DataArray:
        """Return the velocity of a node over time, in m/s (rad/s); see `displacement`."""
        return self._nodal("velocity", node, dof)

    def acceleration(self, node: str, dof: str) -> xr.DataArray:
        """Return the acceleration of a node over time, in m/s2 (rad/s2); see `displacement`."""
        return self._nodal("acceleration", node, dof)

    def modal_displacement(self) -> xr.DataArray:
        """Return the modal displacements (time, mode), in kg^0.5 m, modes counted from 1.

        They are the amplitudes of the basis' vectors as the user gave them, its ``labels``.
        """
        return modes_over_time(
            "modal_displacement",
            self.times,
            self.sample("modal_displacement"),
            self.problem.basis,
        )

    def stop_force(self, name: str) -> xr.DataArray:
        """Return the force of a stop on the structure over time, in N along its normal.

        Raises
        ------
        InputError
            If there is no such stop.
        """
        return over_time("stop_force", self.times, self.sample("stop_force", name), stop=name)

    def contact_forces(self, name: str) -> xr.DataArray:
        """Return the force of a stop on the structure by directions of its contact, in N.

        Over ``time`` and ``direction``: ``normal``, ``around`` and ``axial``. A plane's friction is
        in ``around``, along its sliding direction.

        Raises
        ------
        InputError
            If there is no such stop.
        """
        from bumpstop.post.contacts import contact_forces

        return contact_forces(self, name)

    def friction_force(self, name: str) -> xr.DataArray:
        """Return the force of a stop on the structure along its sliding direction, in N.

        It is zero for stops without friction. Of an obstacle around an axis it is that around the
        axis; `contact_forces` has that along it too.

        Raises
        ------
        InputError
            If there is no such stop.
        """
        values = self.sample("friction_force", name)
        return over_time("friction_force", self.times, values, stop=name)

    def state(self, name: str) -> xr.DataArray:
        """Return what a stop or another law does over time, in the words of the events.

        A stop is ``open``, ``closed`` or ``released``; one with friction does ``stick``, ``slip
        forward`` or ``slip back`` while it is closed; a rigid one is ``open`` or ``resting``.

        Raises
        ------
        InputError
            If there is no such law.
        """
        import xarray as xr

        from bumpstop.labelled import time_coordinate

        return xr.DataArray(
            self.sample("state", name),
            coords={"time": time_coordinate(self.times)},
            name="state",
            attrs={"long_name": STATE.long_name, "stop": name},
        )

    def internal_variables(self, name: str) -> xr.Dataset:
        """Return what a stop or another law remembers over time.

        The ``anchor`` of friction in one direction, in m: where its slider stands; the stretches of
        round and plane stops that rub, ``stretch_around`` and ``stretch_axial``; the
        ``plastic_elongation`` of a hardening spring and the ``plastic_path``, the same summed up;
        ``largest_crushing`` and ``residual_crushing`` of a stop that buckles; the
        ``dashpot_elongation`` of a Zener damper; the ``bending_direction`` of a cracked rotor;
        the ``memory`` of a law of one's own. NaN where there is none, as the anchor of a stop
        that is open.

        Raises
        ------
        InputError
            If there is no such law, or it remembers nothing.
        """
        from bumpstop.labelled import internal_variables

        return internal_variables(self, name)

    def gap(self, name: str) -> xr.DataArray:
        """Return the distance to a stop over time, in m; it is negative while pressed.

        Raises
        ------
        InputError
            If there is no such stop.
        """
        return over_time("gap", self.times, self.sample("gap", name), stop=name)

    def gauge(self, name: str) -> xr.DataArray:
        """Return the axial strain at a gauge over time.

        It is that of the modes of the basis, as displacements are; ``recovery(response).strain``
        adds what the modes left out do, most of it near stops and loads.

        Raises
        ------
        InputError
            If there is no such gauge.
        """
        return over_time("gauge", self.times, self.sample("gauge", name), gauge=name)

    @property
    def energy(self) -> xr.Dataset:
        """The energy ledger over time, in J.

        ``kinetic``, ``elastic`` (of the linear structure), ``stored`` (in the stops, and
        ``stored_in_stop`` for each), ``dissipated_damping``, ``dissipated_stops`` (and
        ``dissipated_in_stop``), ``load_work``, ``circulatory_work`` (of the forces of a
        circulatory matrix), ``obstacle_work`` (of obstacles that move); ``total`` is what is
        there or was dissipated, ``total_initial`` what was there at t = 0, and ``residual = total
        - total_initial - load_work - circulatory_work - obstacle_work``. Every term is integrated
        from its own power.
        """
        from bumpstop.post.energy import energy_dataset

        return energy_dataset(self)

    @property
    def impacts(self) -> pd.DataFrame:
        """Every contact of every stop, in the order of closing.

        Columns: ``stop``; ``start``, ``end`` and ``duration`` in s (``end`` and ``duration``
        are NaN while the stop is still closed); ``closing_speed`` and ``opening_speed`` in
        m/s, the rate of the distance at both instants, positive towards and away from the
        stop; ``peak_force`` in N; ``impulse`` in N s, the integral of the force;
        ``energy_returned`` in J, the work of the stop on the structure while they part;
        ``peak_time`` in s.
        """
        import pandas as pd

        return pd.DataFrame(self.impact_table())

    @property
    def impulses(self) -> pd.DataFrame:
        """Every blow on a rigid stop, in the order of time: ``time`` in s, ``stop``, ``impulse``.

        The impulse, in N s, is that on the structure along the normal of the stop. `stop_force`
        lacks the blows, which take no time and whose force is infinite: the force of a rigid stop
        is that of rests on it, and these impulses as Dirac functions. Stops that give way have no
        blows; the impulses of their contacts are in `impacts`.
        """
        import pandas as pd

        from bumpstop.post.blows import blow_table

        table = pd.DataFrame(blow_table(self))
        table.attrs["units"] = {"time": "s", "impulse": "N s"}
        return table

    @property
    def events(self) -> pd.DataFrame:
        """Every switch of every law: ``time`` in s, ``law``, ``guard``, ``before``, ``after``."""
        import pandas as pd

        return pd.DataFrame(self.event_table())

    def to_netcdf(
        self,
        path: str | PathLike[str],
        *,
        title: str | None = None,
        case: str | None = None,
        variant: str | None = None,
        results: Sequence[Result] = (),
    ) -> None:
        """Write the response, tabulated at its times, to a NetCDF-4 file.

        Parameters
        ----------
        path
            File to write; a file of that name is replaced once the new one is complete.
        title, case, variant
            What to say in the file about where the problem comes from.
        results
            Results of its case whose numbers and curves are to be in the file; `read_results` and
            `read_curves` read them.

        Raises
        ------
        InputError
            If the file cannot be written there.
        """
        from bumpstop.io.netcdf import write_netcdf

        told = {"title": title, "case": case, "variant": variant}
        write_netcdf(self, path, **told, results=results)

    def equals(self, other: Response) -> bool:
        """Return whether another response tells the same, to the bit.

        The same instants; at them the same motion of every mode, the same forces, gaps and their
        rates, states and energies; the same impacts and events; the same account of the method
        (steps, certificate, bounds, residual, options); and problems that say the same, from
        which all else follows. How long it took does not count, nor what is between the instants.
        """
        from bumpstop.post.equality import equal_responses

        return equal_responses(self, other)

    def export(self, path: str | PathLike[str], form: str | None = None) -> None:
        """Write the response, tabulated at its times, in a format that other programs read.

        Parameters
        ----------
        path
            File to write; a file of that name is replaced once the new one is complete.
        form
            ``netcdf``, ``csv``, ``parquet``, ``uff`` (universal file), ``vtk`` (ParaView),
            ``mat`` (MATLAB) or ``wav`` (sound); as the file's ending says where left out.

        Raises
        ------
        InputError
            If the format is unknown, the response has nothing that it holds, a package for it
            is missing, or the file cannot be written there.
        """
        from bumpstop.io.export import export

        export(self, path, form)

    def _instants(self, times: ArrayLike | None) -> FloatArray:
        return self.times if times is None else checked_times(times, self.problem.duration)

    def _nodal(self, quantity: str, node: str, dof: str) -> xr.DataArray:
        return over_time(
            quantity,
            self.times,
            self.sample(quantity, node, dof),
            units=dof_units(quantity, dof),
            long_name=f"{quantity} of {node} along {dof}",
            node=node,
            dof=dof,
        )
