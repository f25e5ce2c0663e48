"""What stands on the page: the words for the template, and the data for its scripts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop import __version__
from bumpstop.report import tables
from bumpstop.report.outline import outline
from bumpstop.report.palette import DARK, LIGHT
from bumpstop.report.published import verdict
from bumpstop.report.scene import mode_scene
from bumpstop.report.variant import Variant

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from bumpstop.io.case import Case
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.post.references import Check
    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = ["page_content"]


def page_content(
    case: Case, responses: Mapping[str, Response], checks: Mapping[str, Sequence[Check]]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return what the template fills in, and the data that the page's scripts read.

    Parameters
    ----------
    case, responses, checks
        As `bumpstop.report.write_report` takes them.
    """
    # The core's clock goes on with everything that is read, and the report reads a lot.
    solve_seconds = {name: response.solve_seconds for name, response in responses.items()}
    problems = {name: response.problem for name, response in responses.items()}
    notes = tables.variant_notes(problems)
    bases = _shared_bases(problems)
    drawings = {name: shared.drawing for shared in bases for name in shared.variants}
    variants = {
        name: Variant(f"variant-{number}", response, case.references.get(name, []), drawings[name])
        for number, (name, response) in enumerate(responses.items(), start=1)
    }
    content = {
        "title": case.title,
        "description": case.description,
        "case_name": case.name,
        "version": __version__,
        "verdict": verdict([check for some in checks.values() for check in some]),
        "facts": tables.facts(responses, checks, solve_seconds),
        "overview": tables.overview(responses, checks, solve_seconds),
        "methods": tables.methods(responses),
        "model": tables.model(problems),
        "variants": [
            {"name": name, "note": notes[name], **variant.content(checks.get(name, []))}
            for name, variant in variants.items()
        ],
        "modes": [
            {
                "id": shared.identity,
                "variants": ", ".join(shared.variants) if len(bases) > 1 else "",
                "rows": tables.modes(shared.basis),
            }
            for shared in bases
        ],
    }
    data = {
        "themes": {"light": LIGHT, "dark": DARK},
        "figures": {key: plot for each in variants.values() for key, plot in each.plots().items()},
        "motions": {f"{each.identity}-motion": each.scene for each in variants.values()},
        "modes": {each.identity: mode_scene(each.basis, each.drawing) for each in bases},
    }
    return content, data


class _SharedBasis:
    """A basis, the variants that have it, and its outline."""

    def __init__(self, identity: str, basis: ModalBasis, problems: Mapping[str, Problem]) -> None:
        self.identity = identity
        self.basis = basis
        self.variants = list(problems)
        stops = [law.node for problem in problems.values() for law in problem.laws]
        self.drawing = outline(basis, stops)


def _shared_bases(problems: Mapping[str, Problem]) -> list[_SharedBasis]:
    """Return the bases that differ; variants with the same modes share one."""
    groups: list[tuple[ModalBasis, dict[str, Problem]]] = []
    for name, problem in problems.items():
        for basis, users in groups:
            if _same_modes(basis, problem.basis):
                users[name] = problem
                break
        else:
            groups.append((problem.basis, {name: problem}))
    return [
        _SharedBasis(f"modes-{number}", basis, users)
        for number, (basis, users) in enumerate(groups, start=1)
    ]


def _same_modes(one: ModalBasis, other: ModalBasis) -> bool:
    return one is other or (
        one.dofs == other.dofs
        and np.array_equal(one.omega2, other.omega2)
        and np.array_equal(one.damping_ratio, other.damping_ratio)
        and np.array_equal(one.shapes, other.shapes)
    )
