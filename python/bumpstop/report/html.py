"""The report: one HTML page that needs nothing but a browser."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bumpstop.errors import ComputationError
from bumpstop.files import written_whole
from bumpstop.report.convergence import add_convergence
from bumpstop.report.encode import script_json
from bumpstop.report.page import modes_content, page_content
from bumpstop.report.palette import style_rules

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping, Sequence

    import xarray as xr
    from jinja2 import Environment

    from bumpstop.io.case import Case
    from bumpstop.post.references import Check
    from bumpstop.response import Response
    from bumpstop.study.convergence import Convergence
    from bumpstop.study.study import Study

__all__ = ["write_comparison", "write_modes", "write_report", "write_study"]

TEMPLATES = Path(__file__).parent / "templates"
SCRIPTS = (
    "data",
    "paper",
    "theme",
    "plots",
    "tabs",
    "svg",
    "stage",
    "turntable",
    "laws",
    "orbits",
    "motion",
    "modes",
    "runs",
    "main",
)
PLOTLY_MARK = "<!--plotly.js-->"


def write_report(
    case: Case,
    responses: Mapping[str, Response],
    checks: Mapping[str, Sequence[Check]],
    path: str | os.PathLike[str],
    convergence: Convergence | None = None,
) -> list[str]:
    """Write the report of a case to one HTML file.

    Parameters
    ----------
    case
        What was run.
    responses
        The response of each variant, in the order of their tabs.
    checks
        Computed beside published values of each variant; a variant may have none.
    path
        File to write. A file of that name is replaced once the new one is complete.
    convergence
        How wrong the results can be, where that was found.

    Returns
    -------
    list of str
        A line for each result of the case that could not be read; the page says so, too.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    content, data = page_content(case, responses, checks)
    if convergence is not None:
        add_convergence(convergence, content, data)
    _write_with_plots(_page("report.html.j2", content, data), path)
    results = [result for variant in content["variants"] for result in variant["results"]]
    return list(dict.fromkeys(each["missing"] for each in results if each["missing"]))


def write_comparison(responses: Mapping[str, Response], path: str | os.PathLike[str]) -> None:
    """Write a page that compares several runs to one HTML file.

    Curves of what they have in common lie over each other; extremes, contacts and energies stand
    side by side, each with its difference from the first run.

    Parameters
    ----------
    responses
        The runs by name, two or more; those read back from files, too.
    path
        File to write. A file of that name is replaced once the new one is complete.

    Raises
    ------
    InputError
        If there are fewer than two, or the file cannot be written there.
    """
    from bumpstop.report.comparison import comparison_content

    _write_with_plots(_page("compare.html.j2", *comparison_content(responses)), path)


def write_study(
    study: Study,
    results: xr.Dataset,
    path: str | os.PathLike[str],
    *,
    title: str | None = None,
    opened_by: str,
) -> None:
    """Write the page of a study to one HTML file.

    Parameters
    ----------
    study
        What was run.
    results
        What came out, as `Study.run` gives it.
    path
        File to write. A file of that name is replaced once the new one is complete.
    title
        What stands above it; the title of the case where left out.
    opened_by
        The command that opens a run, up to its number; the page offers it for every point.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    from bumpstop.report.studies.page import study_content

    content, data = study_content(study, results, opened_by)
    content["title"] = title or study.case.title
    _write_with_plots(_page("study.html.j2", content, data), path)


def _write_with_plots(page: str, path: str | os.PathLike[str]) -> None:
    # plotly.js is most of the page: it is copied as bytes and never decoded.
    before, after = page.split(PLOTLY_MARK)
    with written_whole(path) as part, part.open("wb") as file:
        file.writelines([before.encode(), _plotly_script(), after.encode()])


def write_modes(
    case: Case,
    checks: Mapping[str, Sequence[Check]],
    path: str | os.PathLike[str],
    convergence: Convergence | None = None,
) -> None:
    """Write a page that draws the modes of a case to one HTML file.

    Parameters
    ----------
    case
        Whose modes.
    checks
        Computed beside published frequencies of each variant; a variant may have none.
    path
        File to write. A file of that name is replaced once the new one is complete.
    convergence
        How wrong the frequencies can be, where that was found; told in tables alone.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    content, data = modes_content(case, checks)
    if convergence is not None:
        add_convergence(convergence, content, data, drawn=False)
    page = _page("modes.html.j2", content, data)
    with written_whole(path) as part:
        part.write_text(page, encoding="utf-8")


def _page(template: str, content: dict[str, Any], data: dict[str, Any]) -> str:
    from markupsafe import Markup

    return (
        _environment()
        .get_template(template)
        .render(
            content,
            data=Markup(script_json(data)),
            style=Markup(style_rules() + _template("report.css")),
            script=Markup(_script()),
        )
    )


def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    return Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )


def _template(name: str) -> str:
    return (TEMPLATES / name).read_text(encoding="utf-8")


def _script() -> str:
    parts = "\n".join(_template(f"js/{name}.js") for name in SCRIPTS)
    return f'(() => {{\n"use strict";\n{parts}}})();'


def _plotly_script() -> bytes:
    # Found without importing plotly, which takes longer than all the rest of the report.
    spec = find_spec("plotly")
    if spec is None or spec.origin is None:
        raise ComputationError("the report needs plotly, which is missing: pip install plotly")
    return (Path(spec.origin).parent / "package_data" / "plotly.min.js").read_bytes()
