"""Results that a case asks for beside its motions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.errors import InputError
from bumpstop.io.case.keys import keyed

if TYPE_CHECKING:
    from bumpstop.io.case.tables import results as tables
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.post.results.reading import Result
    from bumpstop.post.results.spectra import Spectrum
    from bumpstop.post.scars import Scar
    from bumpstop.post.wear import WearLaw
    from bumpstop.problem import Problem

__all__ = ["built_results"]


def built_results(case: CaseFile, problem: Problem) -> list[Result]:
    """Return the results that the tables describe.

    Raises
    ------
    InputError
        If the problem has not what they are about.
    """
    results = []
    for name, table in case.results.items():
        with keyed(f"results.{name}"):
            result = _result(name, table)
            result.check(problem)
            results.append(result)
    return results


def _result(name: str, table: tables.ResultTable) -> Result:
    from bumpstop.post.results import contacts, forces, motion

    given = {key: value for key, value in table if key != "type"}
    match table.type:
        case "contact_statistics":
            return contacts.Statistics(name, **given)
        case "wear":
            kept = {key: given[key] for key in ("stop", "service", "start", "end")}
            return contacts.Wear(name, law=_wear_law(table), scar=_scar(table), **kept)
        case "work_by_sector":
            return contacts.SectorWork(name, **given)
        case "spectrum":
            return _spectrum(name, table)
        case "response_spectrum":
            return _floor_spectrum(name, table)
        case "section_forces":
            return forces.BeamForces(name, **given)
        case "stress":
            return forces.FibreStress(name, **given)
        case "reactions":
            return forces.Reactions(name, **given)
        case "poincare":
            return motion.Section(name, **given)
    return motion.Chaos(name, **given)


def _wear_law(table: tables.WearTable) -> WearLaw:
    from bumpstop.post.wear import ArchardWear, EdfWear, KwuEpriWear

    match table.law:
        case "archard":
            return ArchardWear(table.coefficient)
        case "edf":
            return EdfWear(
                coefficient=table.coefficient,
                exponent=table.exponent,
                threshold=table.threshold,
                slowing=table.slowing,
            )
    return KwuEpriWear(table.coefficient, impact=table.impact, sliding=table.sliding)


def _scar(table: tables.WearTable) -> Scar | None:
    from bumpstop.post.scars import FlatScar, HoleScar

    if table.radius is None:
        if table.hole_radius is not None or table.length is not None:
            raise InputError("is needed for the depth of a scar", key="radius")
        return None
    if table.length is None:
        raise InputError("is needed for the depth of a scar", key="length")
    if table.hole_radius is None:
        return FlatScar(radius=table.radius, length=table.length)
    return HoleScar(radius=table.radius, hole_radius=table.hole_radius, length=table.length)


def _spectrum(name: str, table: tables.SpectrumTable) -> Spectrum:
    from bumpstop.post.results.spectra import Spectrum
    from bumpstop.quantities import QUANTITIES

    wanted = QUANTITIES[table.quantity].target
    for key in ("node", "dof", "stop", "gauge"):
        if key in wanted and getattr(table, key) is None:
            raise InputError(f"is needed for {table.quantity}", key=key)
        if key not in wanted and getattr(table, key) is not None:
            what = f"does not belong to {table.quantity}"
            raise InputError(what, key=key, value=getattr(table, key))
    return Spectrum(
        name,
        target=(table.quantity, *(str(getattr(table, key)) for key in wanted)),
        kind=table.of,
        step=table.sample,
        segment=table.segment,
        window=table.window,
        start=table.start,
        end=table.end,
    )


def _floor_spectrum(name: str, table: tables.ResponseSpectrumTable) -> Result:
    import numpy as np

    from bumpstop.post.results.spectra import FloorSpectrum

    if table.highest <= table.lowest:
        raise InputError("must be above the lowest", key="highest", value=table.highest)
    return FloorSpectrum(
        name,
        node=table.node,
        dof=table.dof,
        frequencies=np.geomspace(table.lowest, table.highest, table.points).tolist(),
        damping=table.damping,
        step=table.sample,
        quantity=table.quantity,
        start=table.start,
        end=table.end,
    )
