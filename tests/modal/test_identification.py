"""Modes from functions of chains whose modes are known in closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import bumpstop as bs
from bumpstop import InputError
from bumpstop.io import ModeSet

from .measured_chain import Chain, chain

KINDS = ("displacement", "velocity", "acceleration")


def assert_found(modes: ModeSet, exact: Chain, *, of: slice, tolerances: list[float]) -> None:
    frequency, damping, shape = tolerances
    np.testing.assert_allclose(modes.frequency, exact.omega[of] / (2.0 * np.pi), rtol=frequency)
    np.testing.assert_allclose(modes.damping, exact.damping[of], rtol=damping)
    np.testing.assert_allclose(modes.shapes, exact.shapes[:, of], rtol=0.0, atol=shape)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("masses", [3, 4, 6])
def test_modes_without_noise(masses: int, kind: str) -> None:
    exact = chain(masses)
    modes = bs.identify_modes(exact.functions(kind))
    assert_found(modes, exact, of=slice(None), tolerances=[1e-12, 1e-11, 1e-11])
    np.testing.assert_array_equal(modes.modal_mass, np.ones(masses))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("masses", [3, 6])
def test_modes_with_noise_of_one_percent(masses: int, kind: str) -> None:
    exact = chain(masses)
    modes = bs.identify_modes(exact.functions(kind, noise=0.01))
    assert_found(modes, exact, of=slice(None), tolerances=[1e-3, 0.05, 0.01])


def test_functions_of_several_kinds() -> None:
    exact = chain(3)
    functions = [exact.functions(kind)[number] for number, kind in enumerate(KINDS)]
    modes = bs.identify_modes(functions)
    assert_found(modes, exact, of=slice(None), tolerances=[1e-12, 1e-11, 1e-11])


def test_residuals_stand_for_modes_outside_the_band() -> None:
    exact = chain(6)
    modes = bs.identify_modes(exact.functions("acceleration"), band=(20.0, 60.0))
    assert_found(modes, exact, of=slice(1, 4), tolerances=[1e-3, 0.05, 0.05])


def test_the_strongest_modes_are_counted() -> None:
    exact = chain(3)
    modes = bs.identify_modes(exact.functions(), count=2)
    np.testing.assert_allclose(modes.frequency, exact.omega[:2] / (2.0 * np.pi), rtol=1e-3)


def test_a_stop_on_identified_modes_moves_as_on_exact_ones() -> None:
    exact = chain(4)
    given = bs.ModalBasis.from_modes(
        frequency=(exact.omega / (2.0 * np.pi)).tolist(),
        damping=exact.damping.tolist(),
        shapes={(str(n + 1), "dx"): row.tolist() for n, row in enumerate(exact.shapes)},
    )
    found = bs.identify_modes(exact.functions("acceleration")).basis()
    times = np.linspace(0.0, 0.2, 201)
    motions = []
    for basis in (given, found):
        problem = bs.Problem(
            basis,
            laws=[bs.Stop("stop", node="4", normal=(1, 0, 0), gap=1e-3, stiffness=1e6)],
            loads=[bs.NodalForce("push", node="1", force=(500.0, 0.0, 0.0))],
            duration=0.2,
        )
        response = bs.simulate(problem)
        assert len(response.impacts) > 1
        motions.append(response.displacement("4", "dx").interp(time=times))
    error = float(np.abs(motions[0] - motions[1]).max() / np.abs(motions[0]).max())
    assert error < 1e-8


def test_a_drive_point_is_needed() -> None:
    message = r"the drive point is missing: response and reference 1\.dx; without it"
    with pytest.raises(InputError, match=message):
        bs.identify_modes(chain(3).functions()[1:])


def test_modes_out_of_phase_are_refused() -> None:
    with pytest.raises(InputError, match=r"the mode at .* Hz is complex: \d+% of it moves out"):
        bs.identify_modes(chain(3).functions(skew=1.0))


def test_a_drive_point_of_the_wrong_sign_is_refused() -> None:
    first, *others = chain(3).functions()
    turned = replace(first, values=-first.values)
    with pytest.raises(InputError, match="is not driven at the drive point; are the signs"):
        bs.identify_modes([turned, *others])


def test_functions_must_belong_together() -> None:
    first, second, third = chain(3).functions()
    with pytest.raises(InputError, match="must hold a function"):
        bs.identify_modes([])
    with pytest.raises(InputError, match=r"have several references .*1\.dx, 2\.dx"):
        bs.identify_modes([first, replace(second, reference=("2", "dx"))])
    with pytest.raises(InputError, match=r"2\.dx: is measured twice"):
        bs.identify_modes([first, second, second])
    with pytest.raises(InputError, match=r"3\.dx: has other frequencies"):
        bs.identify_modes([first, replace(third, frequency=third.frequency + 1.0)])
    with pytest.raises(InputError, match=r"3\.dx: is zero in the whole band"):
        bs.identify_modes([first, replace(third, values=0.0 * third.values)])


def test_what_is_asked_must_be_there() -> None:
    functions = chain(3).functions()
    with pytest.raises(InputError, match="band: must be two frequencies, the lower one first"):
        bs.identify_modes(functions, band=(30.0, 20.0))
    with pytest.raises(InputError, match="band: holds 11 frequencies, too few"):
        bs.identify_modes(functions, band=(30.0, 31.0))
    with pytest.raises(InputError, match=r"count: more modes than can be identified.*3 are stable"):
        bs.identify_modes(functions, count=4)
    with pytest.raises(InputError, match="no stable mode in the band"):
        bs.identify_modes(functions, band=(1.0, 5.0))


def test_a_function_is_checked() -> None:
    function = chain(3).functions()[0]
    with pytest.raises(InputError, match="values: must have one value a frequency"):
        replace(function, values=function.values[1:])
    with pytest.raises(InputError, match="values: must hold finite numbers"):
        replace(function, values=function.values * np.nan)
    with pytest.raises(InputError, match="frequency: must ascend from zero or above"):
        replace(function, frequency=function.frequency[::-1])
    with pytest.raises(InputError, match="unknown kind"):
        replace(function, kind="strain")
