"""The exact method with several stops on random problems: no event missed, none invented."""

import pytest

from .several.coupled import random_coupled
from .several.grazing import random_grazing
from .several.multilinear import random_multilinear
from .several.problem import SeveralStops
from .several.random_problems import random_several
from .several.rigid import random_rigid
from .several.rubbing import random_rubbing
from .several.verdict import compare


def check(problem: SeveralStops) -> None:
    """Hold the core against the judge."""
    verdict = compare(problem)
    assert verdict.difference is None or verdict.undecidable
    assert verdict.excess < 1.0
    assert verdict.energy < 1e-9


@pytest.mark.parametrize("seed", range(1000, 1060))
def test_random_problem_of_several_stops(seed: int) -> None:
    check(random_several(seed))


@pytest.mark.parametrize("seed", [17944, 80065])
def test_dampers_take_nothing_out_of_motions_that_they_do_not_see(seed: int) -> None:
    # Stops close in mirrored pairs, and a heavily damped mode does not move.
    check(random_several(seed))


@pytest.mark.parametrize("seed", [26491, 51961, 81613])
def test_mirrored_stops_are_hit_beside_stops_that_hold_a_mode_at_rest(seed: int) -> None:
    check(random_several(seed))


@pytest.mark.parametrize("seed", [36814, 89429])
def test_a_mode_comes_to_rest_between_stops_without_clearance(seed: int) -> None:
    # What is left of it is rounding, by which no stop switches for ever, also beyond the instant up
    # to which the judge goes.
    problem = random_several(seed)
    check(problem)
    assert problem.solve().energy_residual() < 1e-9


def test_one_of_two_close_real_exponents_is_slow() -> None:
    # A rigid mode with drag on a soft stop, held by stiff ones: under the force its place at rest
    # would be a thousand times further away than it ever moves.
    verdict = compare(random_several(47264))
    assert verdict.difference is None
    assert verdict.excess < 0.1


@pytest.mark.parametrize("seed", [9938, 45570, 57302, 93454])
def test_places_at_rest_far_beside_motions_between_hits(seed: int) -> None:
    # Exponents some three times as slow as the run: one phase from hit to hit would lose the
    # digits by which a place at rest exceeds the motion.
    assert compare(random_several(seed)).excess < 0.1


@pytest.mark.parametrize("seed", [21009, 66164, 76087, 91239])
def test_slow_exponentials_of_fast_motions_between_hits(seed: int) -> None:
    # Hundreds of hits at such speeds that modes would go ten to a hundred times as far without.
    assert compare(random_several(seed)).excess < 0.3


@pytest.mark.parametrize("seed", [17965, 65853, 68227, 71272, 83050])
def test_more_slow_exponents_than_sixteen(seed: int) -> None:
    # Runs of about 1e-4 periods on a stiff stop, under constant forces.
    check(random_several(seed))


def test_a_stiff_stop_resists_all_of_a_force_but_what_moves_it() -> None:
    # The force lies along the stop, which is twenty million times stiffer than the modes.
    problem = random_several(37082)
    assert problem.solve().energy_residual() < 1e-14


def test_a_slow_motion_that_no_force_drives_beside_forces_on_others() -> None:
    # Mirrored stops push two of three modes; the third, damped critically, is not pushed at all.
    check(random_several(30300))


@pytest.mark.parametrize("seed", [2, 3, 4, 6, 7, 10, 14, 17, 21, 22])
def test_random_problem_of_coupled_modes(seed: int) -> None:
    check(random_coupled(seed))


@pytest.mark.parametrize("seed", [11, 12, 59, 64, 70, 78])
def test_a_place_that_damped_rigid_modes_keep_counts_in_the_walk(seed: int) -> None:
    # Rigid modes that dampers couple have an exponent of zero: a constant part of the motion.
    check(random_coupled(seed))


@pytest.mark.parametrize("seed", [0, 1, 2, 4, 5, 6, 7, 8, 9, 10, 259, 514])
def test_random_problem_of_a_stop_only_just_touched(seed: int) -> None:
    # The last two start at rest: one in a run so short that all its modes are slow, one with modes
    # so close to each other that amplitudes need further rounds.
    check(random_grazing(seed))


@pytest.mark.parametrize("seed", [0, 1, 3, 5, 8, 10, 12, 33, 209, 255, 450])
def test_random_problem_of_stops_that_rub(seed: int) -> None:
    # In 209 and 255 the accelerations after a jump of the force decide whether it sticks again,
    # in 450 two sliders stop at one instant.
    check(random_rubbing(seed))


@pytest.mark.parametrize("seed", [0, 2, 4, 6, 8, 10])
def test_random_problem_of_springs_of_several_slopes(seed: int) -> None:
    check(random_multilinear(seed))


@pytest.mark.parametrize("seed", [2, 4, 9, 15, 17, 26, 29, 41, 1184, 1192])
def test_random_problem_of_rigid_stops(seed: int) -> None:
    check(random_rigid(seed))


def test_a_stop_that_is_left_with_a_cluster_of_exponents_is_touched_again() -> None:
    # Rest on other stops leaves two exponents together, which see the stop that is left.
    check(random_rigid(0))


@pytest.mark.parametrize("seed", [59, 1132, 1172])
def test_what_a_mode_beside_a_cluster_dissipates_counts_once(seed: int) -> None:
    # No stop sees one of the modes, and where the structure rests others make a cluster.
    check(random_rigid(seed))


def test_springs_that_push_two_equal_modes_nearly_alike() -> None:
    # The forces between them lose digits: 2.6 times too much by way of these, where a dense problem
    # loses none.
    assert compare(random_several(21241)).excess < 0.1
