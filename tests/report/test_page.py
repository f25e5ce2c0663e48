"""The page as a file: sound HTML, complete in itself, and safe whatever names say."""

import json
import re
import subprocess
import sys
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.errors import InputError
from bumpstop.post.references import Reference
from bumpstop.report import html
from bumpstop.report.encode import script_json

from .conftest import Run, made_case, run

VOID = {"meta", "link", "input", "br", "hr", "img"}


class Page(HTMLParser):
    """Elements with their attributes, the text around them, and the order of headings."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.open: list[str] = []
        self.elements: list[tuple[str, dict[str, str]]] = []
        self.scripts: list[str] = []
        self.text = ""
        self.feed(path.read_text(encoding="utf-8"))
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, {name: value or "" for name, value in attrs}))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, {name: value or "" for name, value in attrs}))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] == "script":
            self.scripts.append(data)
        else:
            self.text += data

    def all(self, tag: str) -> list[dict[str, str]]:
        return [attributes for name, attributes in self.elements if name == tag]

    def data(self) -> dict[str, Any]:
        found = json.loads(self.scripts[0])
        assert isinstance(found, dict)
        return found


@pytest.fixture(scope="module", params=["sdnl32_page", "ball_page"])
def page(request: pytest.FixtureRequest) -> Page:
    return Page(request.getfixturevalue(request.param))


def test_elements_are_closed(page: Page) -> None:
    assert page.open == []
    assert len(page.all("html")) == len(page.all("main")) == len(page.all("h1")) == 1
    assert ("html", {"lang": "en"}) in page.elements


def test_names_are_unique_and_references_lead_somewhere(page: Page) -> None:
    names = [attributes["id"] for _, attributes in page.elements if "id" in attributes]
    assert len(names) == len(set(names))
    for _, attributes in page.elements:
        for key in ("aria-labelledby", "aria-controls", "for"):
            assert set(attributes.get(key, "").split()) <= set(names)


def test_headings_descend_step_by_step(page: Page) -> None:
    levels = [int(tag[1]) for tag, _ in page.elements if re.fullmatch("h[1-6]", tag)]
    assert levels[0] == 1
    assert all(later <= earlier + 1 for earlier, later in pairwise(levels))


def test_every_control_has_a_name(page: Page) -> None:
    labels = sum(tag == "label" for tag, _ in page.elements)
    unnamed = [
        attributes
        for tag, attributes in page.elements
        if tag in ("input", "select") and "aria-label" not in attributes
    ]
    # Each of the others stands inside its label.
    assert len(unnamed) == labels


def test_nothing_is_loaded_from_elsewhere(page: Page) -> None:
    for tag, attributes in page.elements:
        for key in ("src", "href", "action", "data", "poster", "srcset"):
            assert attributes.get(key, "#").startswith(("#", "data:")), (tag, attributes)
    (policy,) = [a for a in page.all("meta") if a.get("http-equiv") == "Content-Security-Policy"]
    assert policy["content"].startswith("default-src 'none'")
    own = "".join(page.scripts[:1] + page.scripts[2:])
    assert "http://" not in own.replace("http://www.w3.org/2000/svg", "")
    assert "https://" not in own


def test_figures_have_their_places(page: Page) -> None:
    places = {
        attributes["data-figure"] for attributes in page.all("div") if "data-figure" in attributes
    }
    data = page.data()
    assert places == set(data["figures"])
    names = {attributes.get("id") for _, attributes in page.elements}
    assert set(data["motions"]) | set(data["modes"]) <= names


def test_size(sdnl32_page: Path) -> None:
    assert sdnl32_page.stat().st_size < 8e6


def test_same_input_same_page(ball: Run, ball_page: Path, tmp_path: Path) -> None:
    """Only the time that the core took may differ."""

    def without_times(path: Path) -> str:
        return re.sub(
            r"[\d.]+ [mµn]?s</dd>|[\d.]+ [mµn]?s <small>|[\d.]+ [mµn]?s</td>", "", path.read_text()
        )

    assert without_times(ball.write(tmp_path / "again.html")) == without_times(ball_page)


NASTY = "</script><script>alert(1)</script><!-- <!--plotly.js--> {{ 7*7 }} \"'&\u2028"


@pytest.fixture(scope="module")
def nasty(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A case whose every name tries to break out of its place."""
    basis = bs.ModalBasis.from_modes(frequency=[3.0], damping=0.01, shapes={(NASTY, "dx"): [1.0]})
    stop = bs.Stop(NASTY, node=NASTY, normal=(-1, 0, 0), gap=1e-3, stiffness=1e6)
    load = bs.NodalForce(NASTY, node=NASTY, force=(1.0, 0, 0))
    start = bs.ModalState(velocity=[0.2])
    problem = bs.Problem(basis, laws=[stop], loads=[load], initial=start, duration=1.0)
    reference = Reference(
        quantity="gap", stop=NASTY, times=[0.1, 0.2], values=[1.0, 1.0], tolerance=1.0, source=NASTY
    )
    case = made_case({NASTY: problem}, {NASTY: [reference]}, title=NASTY)
    return run(case).write(tmp_path_factory.mktemp("nasty") / "report.html")


def test_names_are_only_text(nasty: Path, ball_page: Path) -> None:
    page, plain = Page(nasty), Page(ball_page)
    assert len(page.all("script")) == len(plain.all("script")) == 3
    assert NASTY in page.text
    assert page.data()["motions"]["variant-1-motion"]["laws"][0]["name"] == NASTY


def test_json_for_scripts_reads_back() -> None:
    data = {"text": NASTY, "list": [1, 2.5, None, True], "number": np.float64(0.1)}
    text = script_json(data)
    assert "<" not in text
    assert json.loads(text) == data


def test_json_refuses_what_it_cannot_say() -> None:
    with pytest.raises(ValueError, match="JSON"):
        script_json({"value": float("nan")})
    with pytest.raises(TypeError, match="Path"):
        script_json({"value": Path()})


def test_a_missed_value_is_said_at_the_head(tmp_path: Path, pendulum: bs.Problem) -> None:
    wrong = Reference(
        quantity="displacement", node="P", dof="dx", times=[0.1], values=[1.0], tolerance=0.01
    )
    path = run(made_case({"base": pendulum}, {"base": [wrong]})).write(tmp_path / "report.html")
    page = Page(path)
    (verdict,) = [a for a in page.all("p") if "data-verdict" in a]
    assert verdict["data-verdict"] == "failed"
    assert "1 of 1 published values missed" in page.text


def test_a_problem_without_stops_or_references(tmp_path: Path) -> None:
    basis = bs.ModalBasis.from_modes(frequency=[3.0], shapes={("P", "dx"): [1.0]})
    swing = bs.Problem(basis, initial=bs.ModalState(velocity=[0.2]), duration=1.0)
    page = Page(run(made_case({"base": swing})).write(tmp_path / "report.html"))
    assert "No published values to compare with" in page.text
    assert "Impacts" not in [text.strip() for text in page.text.splitlines()]


def test_variants_with_their_own_modes_each_show_them(tmp_path: Path, pendulum: bs.Problem) -> None:
    other = bs.ModalBasis.from_modes(
        frequency=[6.0, 13.0], shapes={("P", "dx"): [1.0, 0.4], ("Q", "dx"): [0.5, -0.9]}
    )
    stiffer = bs.Problem(other, laws=pendulum.laws, duration=0.1)
    case = made_case({"one": pendulum, "two": stiffer, "three": pendulum})
    page = Page(run(case).write(tmp_path / "report.html"))
    assert set(page.data()["modes"]) == {"modes-1", "modes-2"}
    assert "one, three" in page.text


class TestWriting:
    def test_a_former_report_is_replaced(self, ball: Run, tmp_path: Path) -> None:
        path = tmp_path / "report.html"
        path.write_text("old")
        ball.write(path)
        assert path.read_text().startswith("<!doctype html>")
        assert [found.name for found in tmp_path.iterdir()] == ["report.html"]

    def test_a_folder_that_is_not_there(self, ball: Run, tmp_path: Path) -> None:
        with pytest.raises(InputError, match="cannot be written"):
            ball.write(tmp_path / "missing" / "report.html")

    def test_a_failure_leaves_the_former_report(
        self, ball: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        path = tmp_path / "report.html"
        path.write_text("old")

        def fail() -> bytes:
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(html, "_plotly_script", fail)
        with pytest.raises(InputError, match="No space left"):
            ball.write(path)
        assert path.read_text() == "old"
        assert len(list(tmp_path.iterdir())) == 1


def test_heavy_libraries_are_not_loaded(tmp_path: Path) -> None:
    code = (
        "import sys, bumpstop as bs\n"
        "from bumpstop.report import write_report\n"
        f"case = bs.load_case({str(Path(__file__).parents[2] / 'cases/sdnl32/case.toml')!r})\n"
        "responses = {name: bs.simulate(p) for name, p in case.problems.items()}\n"
        f"write_report(case, responses, {{}}, {str(tmp_path / 'report.html')!r})\n"
        "print(*{'plotly', 'pandas', 'xarray', 'scipy', 'pint'} & set(sys.modules))\n"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.split() == []


def test_templates_travel_with_the_package() -> None:
    """What the page is made of lies inside the package, so that a wheel holds it."""
    package = Path(bs.__file__).parent
    assert html.TEMPLATES.is_relative_to(package)
    scripts = {path.stem for path in (html.TEMPLATES / "js").iterdir()}
    assert scripts == set(html.SCRIPTS)
