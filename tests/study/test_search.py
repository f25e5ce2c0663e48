"""Searches for the worst case: against closed forms, broken off and gone on with, read back."""

import math
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.study import search
from bumpstop.study.execution import Progress
from tests.study.bouncing import CASE, STUDY

GAP, STIFFNESS = "stops.spring.gap", "stops.spring.stiffness"
FORCE = bs.Output(quantity="largest_force", stop="spring")
LAST = bs.Output(quantity="displacement", node="P", dof="dz", statistic="last")
MEAN = bs.Output(quantity="displacement", node="P", dof="dz", statistic="mean")
"""Not read by the core, so that processes make the runs."""
RANGES = {GAP: bs.Range(0.0, 0.5), STIFFNESS: bs.Range(50.0, 800.0)}


@pytest.fixture
def case(tmp_path: Path) -> bs.Case:
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return bs.load_case(path)


def searching(case: bs.Case, count: int = 96, **more: bs.Output) -> bs.Study:
    """Return a search for the largest place of the ball at the end."""
    sampling = bs.Sampling("worst_case", count, seed=3, of="place")
    return bs.Study(case, RANGES, {"force": FORCE, "place": LAST, **more}, sampling=sampling)


def content(store: Path) -> dict[str, bytes]:
    found = (path for path in store.rglob("*") if path.is_file())
    return {str(path.relative_to(store)): path.read_bytes() for path in found}


def test_the_worst_case_is_found(case: bs.Case) -> None:
    found = searching(case, 800).run()
    # After the impact, -gap + 3 (t - gap / 3 - pi sqrt(m / k)) is largest for a gap of 0 and the
    # stiffest spring.
    best = 3.0 * (2.0 - math.pi * math.sqrt(2.0 / 800.0))
    assert found.place.max() <= best * (1 + 1e-12)
    assert float(found.place.max()) == pytest.approx(best, rel=2e-3)
    worst = found.isel(run=int(found.place.values.argmax()))
    assert float(worst[STIFFNESS]) == pytest.approx(800.0, rel=0.02)
    # All else of a run is kept, too: 3 sqrt(k m) of each.
    expected = 3.0 * np.sqrt(2.0 * found[STIFFNESS])
    np.testing.assert_allclose(found.force, expected, rtol=1e-12)


def test_generations_go_where_it_was_worst(case: bs.Case) -> None:
    found = searching(case, 800).run().place
    early, late = found[:64], found[-64:]
    assert late.mean() > early.mean() + 0.5 * (found.max() - early.mean())


@pytest.mark.parametrize("more", [{}, {"mean": MEAN}])
def test_no_bit_depends_on_who_makes_the_runs(
    tmp_path: Path, case: bs.Case, more: dict[str, bs.Output]
) -> None:
    for workers in (1, 2):
        searching(case, 48, **more).run(tmp_path / str(workers), workers=workers)
    assert content(tmp_path / "1") == content(tmp_path / "2")


def test_one_that_was_broken_off_goes_on(tmp_path: Path, case: bs.Case) -> None:
    searching(case).run(tmp_path / "whole")

    def interrupt(progress: Progress) -> None:
        if progress.done == 48:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        searching(case).run(tmp_path / "broken", progress=interrupt)
    told: list[Progress] = []
    found = searching(case).run(tmp_path / "broken", resume=True, progress=told.append)
    assert content(tmp_path / "whole") == content(tmp_path / "broken")
    assert [(each.done, each.made) for each in told] == [(64, 16), (80, 32), (96, 48)]
    assert not np.isnan(found.place).any()


def test_runs_of_another_search_are_refused(tmp_path: Path, case: bs.Case) -> None:
    import zarr

    searching(case).run(tmp_path / "store")
    gaps = zarr.open_group(tmp_path / "store")[GAP]
    assert isinstance(gaps, zarr.Array)
    gaps[20] = 0.123
    with pytest.raises(bs.InputError, match=r"store: has runs of a search that went another way"):
        searching(case).run(tmp_path / "store", resume=True)


def test_runs_that_fail_are_no_worst_case(case: bs.Case) -> None:
    ranges = {STIFFNESS: bs.Range(-100.0, 800.0)}
    sampling = bs.Sampling("worst_case", 80)
    found = bs.Study(case, ranges, {"force": FORCE}, sampling=sampling).run()
    assert found.failed.any()
    assert (found[STIFFNESS].values[found.failed] <= 0.0).all()
    assert float(found.force.max()) == pytest.approx(3.0 * math.sqrt(2.0 * 800.0), rel=0.01)
    assert str(found.message.values[found.failed][0]).startswith("stops")


def test_words_and_whole_numbers_are_searched_too(case: bs.Case) -> None:
    ranges = {GAP: ["250 mm", 0.5], STIFFNESS: [100, 200, 300]}
    sampling = bs.Sampling("worst_case", 64)
    study = bs.Study(case, ranges, {"force": FORCE}, sampling=sampling)
    found = study.run()
    worst = int(found.force.values.argmax())
    assert set(found[STIFFNESS].values) <= {100, 200, 300}
    assert found[STIFFNESS].values[worst] == 300
    assert float(found.force.max()) == pytest.approx(3.0 * math.sqrt(2.0 * 300.0), rel=1e-12)


def test_a_run_is_opened_with_the_values_of_the_store(tmp_path: Path, case: bs.Case) -> None:
    found = searching(case).run(tmp_path / "store")
    anew = searching(case)
    with pytest.raises(bs.InputError, match="run: has values that the search told"):
        bs.write_case(anew, 40, tmp_path / "one.toml")
    single = bs.write_case(anew, 40, tmp_path / "one.toml", store=tmp_path / "store")
    opened = bs.load_case(single)
    response = bs.simulate(next(iter(opened.problems.values())))
    assert LAST.value(response) == found.place.values[40]
    with pytest.raises(bs.InputError, match="the study has runs 0 to 95"):
        bs.write_case(anew, 96, tmp_path / "one.toml", store=tmp_path / "store")


def test_a_run_not_made_yet_is_not_opened(tmp_path: Path, case: bs.Case) -> None:
    def interrupt(_: Progress) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        searching(case).run(tmp_path / "store", progress=interrupt)
    with pytest.raises(bs.InputError, match="run: has not been made"):
        bs.write_case(searching(case), 40, tmp_path / "one.toml", store=tmp_path / "store")


def test_searches_from_files(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(CASE)
    file = tmp_path / "study.toml"
    text = STUDY.replace("[execution]\nchunk = 3", '[sampling]\nmethod = "worst_case"\ncount = 50')
    file.write_text(text)
    with pytest.raises(bs.InputError, match=r"study\.toml: sampling\.of: is missing; name the out"):
        bs.load_study(file)
    file.write_text(f'{text}of = "force"\n')
    assert bs.load_study(file).runs.count == 48
    file.write_text(f'{text}of = "forces"\n')
    with pytest.raises(bs.InputError, match=r"no such output .*force"):
        bs.load_study(file)
    file.write_text(f'{text}of = "place"\n')
    with pytest.raises(bs.InputError, match=r"outputs\.place: must be a single number"):
        bs.load_study(file)
    file.write_text(f'{text}of = "force"\n[execution]\nchunk = 3\n')
    with pytest.raises(bs.InputError, match=r"execution\.chunk: is a generation in a search"):
        bs.load_study(file)
    file.write_text(text.replace("count = 50", 'count = 15\nof = "force"'))
    with pytest.raises(bs.InputError, match=r"sampling\.count: a generation has 16 runs, 8 for"):
        bs.load_study(file)
    file.write_text(text.replace("count = 50", 'of = "force"'))
    with pytest.raises(bs.InputError, match=r"count: is missing; say how many"):
        bs.load_study(file)
    file.write_text(text.replace('"worst_case"\ncount = 50', '"list"\nof = "force"'))
    with pytest.raises(bs.InputError, match=r"sampling\.of: is what a worst_case is searched for"):
        bs.load_study(file)


def test_lists_longer_than_the_search(case: bs.Case) -> None:
    sampling = bs.Sampling("worst_case", 8)
    levels = np.linspace(0.1, 0.2, 9).tolist()
    with pytest.raises(bs.InputError, match="has 9 values, and the search 8 runs"):
        bs.Study(case, {GAP: levels}, {"force": FORCE}, sampling=sampling)


def test_what_has_no_value_is_poorer_than_any() -> None:
    poor = search._poorness(np.array([np.nan, 3.0, -5.0, np.inf]))
    assert poor.argmin() == 3
    assert poor.argmax() == 0
    assert np.isfinite(poor).all()
