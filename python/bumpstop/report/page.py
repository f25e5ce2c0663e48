"""What stands on the page: the words for the template, and the data for its scripts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop import __version__
from bumpstop.report import tables
from bumpstop.report.law_scene import law_nodes
from bumpstop.report.outline import outline
from bumpstop.report.palette import DARK, LIGHT
from bumpstop.report.published import published, verdict
from bumpstop.report.remarks import remarks
from bumpstop.report.scene import mode_scene
from bumpstop.report.variant import Variant

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from bumpstop.io.case import Case
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.post.references import Check
    from bumpstop.response import Response

__all__ = ["modes_content", "page_content"]


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
    bases = _shared_bases(
        {name: problem.basis for name, problem in problems.items()},
        {name: law_nodes(problem) for name, problem in problems.items()},
    )
    drawings = {name: shared.drawing for shared in bases for name in shared.variants}
    variants = {
        name: Variant(
            f"variant-{number}",
            response,
            case.references.get(name, []),
            drawings[name],
            case.results.get(name, []),
        )
        for number, (name, response) in enumerate(responses.items(), start=1)
    }
    content = _head(case, checks) | {
        "facts": tables.facts(responses, checks, solve_seconds),
        "overview": tables.overview(responses, checks, solve_seconds),
        "methods": tables.methods(responses),
        "model": tables.model(problems),
        "variants": [
            {"name": name, "note": notes[name], **variant.content(checks.get(name, []))}
            for name, variant in variants.items()
        ],
        "modes": _viewers(bases),
    }
    data = {
        "themes": _THEMES,
        "figures": {key: plot for each in variants.values() for key, plot in each.plots().items()},
        "motions": {f"{each.identity}-motion": each.scene for each in variants.values()},
        "modes": _scenes(bases),
    }
    return content, data


def modes_content(
    case: Case, checks: Mapping[str, Sequence[Check]]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the same for the page that shows the modes of a case alone.

    Parameters
    ----------
    case, checks
        As `bumpstop.report.write_modes` takes them.
    """
    stops = {name: law_nodes(problem) for name, problem in case.problems.items()}
    stops = {name: stops.get(name, []) for name in case.bases}
    bases = _shared_bases(case.bases, stops)
    checked = [(name, some) for name, some in checks.items() if some]
    content = _head(case, checks) | {
        "facts": tables.modal_facts(case.bases, checks),
        "model": tables.modal_model(case.bases),
        "modes": _viewers(bases),
        "checked": [
            {
                "id": f"variant-{number}",
                "name": name if len(case.bases) > 1 else "",
                "published": published(some),
                "sources": list(dict.fromkeys(check.source for check in some if check.source)),
            }
            for number, (name, some) in enumerate(checked, start=1)
        ],
    }
    return content, {"themes": _THEMES, "figures": {}, "motions": {}, "modes": _scenes(bases)}


_THEMES = {"light": LIGHT, "dark": DARK}


def _head(case: Case, checks: Mapping[str, Sequence[Check]]) -> dict[str, Any]:
    return {
        "title": case.title,
        "description": case.description,
        "case_name": case.name,
        "version": __version__,
        "verdict": verdict([check for some in checks.values() for check in some]),
        "convergence": [],
    }


def _viewers(bases: Sequence[_SharedBasis]) -> list[dict[str, Any]]:
    """Return what stands around the drawings of modes."""
    return [
        {
            "id": shared.identity,
            "variants": ", ".join(shared.variants) if len(bases) > 1 else "",
            "rows": tables.modes(shared.basis, shared.drawing.seen),
            "remarks": remarks(shared.basis),
            "turns": shared.drawing.spatial,
        }
        for shared in bases
    ]


def _scenes(bases: Sequence[_SharedBasis]) -> dict[str, Any]:
    return {each.identity: mode_scene(each.basis, each.drawing) for each in bases}


class _SharedBasis:
    """A basis, the variants that have it, and its outline."""

    def __init__(
        self, identity: str, basis: ModalBasis, variants: Sequence[str], stops: Sequence[str]
    ) -> None:
        self.identity = identity
        self.basis = basis
        self.variants = variants
        self.drawing = outline(basis, stops)


def _shared_bases(
    bases: Mapping[str, ModalBasis], stops: Mapping[str, Sequence[str]]
) -> list[_SharedBasis]:
    """Return the bases that differ, with the nodes of the stops; same modes share one."""
    groups: list[tuple[ModalBasis, list[str]]] = []
    for name, own in bases.items():
        for basis, users in groups:
            if _same_modes(basis, own):
                users.append(name)
                break
        else:
            groups.append((own, [name]))
    return [
        _SharedBasis(f"modes-{number}", basis, users, [node for u in users for node in stops[u]])
        for number, (basis, users) in enumerate(groups, start=1)
    ]


def _same_modes(one: ModalBasis, other: ModalBasis) -> bool:
    return one is other or (
        one.dofs == other.dofs
        and np.array_equal(one.omega2, other.omega2)
        and np.array_equal(one.damping_ratio, other.damping_ratio)
        and np.array_equal(one.shapes, other.shapes)
    )
