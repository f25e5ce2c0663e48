"""Turbulence along a tube: correlations against double integrals, coherence, accepted power."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import dblquad
from scipy.signal import coherence

import bumpstop as bs
from bumpstop.loads.turbulence import cell_correlation

LENGTH = 2.0
DENSITY = bs.SpectralDensity([1.0, 50.0], [4.0, 4.0])


def tube(elements: int = 16) -> bs.Structure:
    steel = bs.Material(young_modulus=200e9, poisson_ratio=0.3, density=7800.0)
    section = bs.Tube(outer_radius=0.01, thickness=0.001)
    beam = bs.Beam("AB", nodes=("A", "B"), elements=elements, material=steel, section=section)
    ends = [
        bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx")),
        bs.Support(nodes="B", fixed=("dy", "dz")),
    ]
    return bs.Structure(nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)}, beams=[beam], supports=ends)


def flow(**options: Any) -> bs.Turbulence:
    said: dict[str, Any] = {
        "beam": "AB",
        "direction": (0, 1.0, 0),
        "density": DENSITY,
        "correlation_length": 0.3,
        "seed": 2,
        "period": 100.0,
    }
    return bs.Turbulence("flow", **said | options)


@pytest.mark.parametrize(("length", "correlated"), [(0.1, 0.3), (0.5, 0.1), (1e-5, 1.0)])
def test_means_over_cells(length: float, correlated: float) -> None:
    joint = cell_correlation(3, length, correlated)
    for other in range(3):
        low = other * length
        parts = [(low, low + length)] if other else [(0.0, None), (None, length)]
        total = 0.0
        for begin, end in parts:  # the kink at x = x' on an edge
            found, _ = dblquad(
                lambda y, x: np.exp(-abs(x - y) / correlated),
                0.0,
                length,
                (lambda x: x) if begin is None else begin,
                (lambda x: x) if end is None else end,
                epsabs=1e-16,
            )
            total += found
        assert joint[0, other] == pytest.approx(total / length**2, rel=1e-8)
    np.testing.assert_array_equal(joint, joint.T)


@pytest.mark.parametrize("correlated", [0.15, 0.6, 10.0])
def test_the_power_that_a_mode_accepts(correlated: float) -> None:
    """Its force has the density S times the joint acceptance of its shape with itself."""
    basis = bs.ModalBasis.from_structure(tube(), modes=8)
    parts = flow(correlation_length=correlated).components(basis)
    force = np.stack([part.force for part in parts], axis=1)
    for mode in range(len(basis.omega2)):
        shape = [basis.row(f"AB@{x}", "dy")[mode] for x in np.linspace(0, LENGTH, 201).tolist()]
        size = float(np.max(np.abs(shape)))
        if size < 1e-6:
            continue  # a mode across the flow, or along the tube
        waves = int(np.count_nonzero(np.diff(np.sign(shape[1:-1])))) + 1
        turn = waves * np.pi / LENGTH

        def accepted(y: float, x: float, turn: float = turn) -> float:
            shaped = np.sin(turn * x) * np.sin(turn * y)
            return float(shaped * np.exp(-(x - y) / correlated))

        half, _ = dblquad(accepted, 0.0, LENGTH, 0.0, lambda x: x)
        # What a quarter of the correlation length does not tell, and 16 elements.
        assert force[mode] @ force[mode] == pytest.approx(2.0 * half * size**2, rel=0.02)


def test_the_coherence_between_cells() -> None:
    """Forces of cells at a distance, from the signals as they are, by SciPy's estimate."""
    load = flow(cells=8)
    h = LENGTH / 8
    model = tube()
    columns = load.nodal_forces(model)
    # The mean force on a cell, from its share of the whole force along y: its factor's row.
    mixing = np.linalg.cholesky(cell_correlation(8, h, 0.3))
    along = model.rigid_field(translation=(0, 1.0, 0))
    np.testing.assert_allclose(along @ columns, h * mixing.sum(axis=0), rtol=1e-12)
    times = np.arange(100_000) / 1000.0
    parts = load.components(bs.ModalBasis.from_structure(model, modes=2))
    signals = np.stack([part.functions[0].at(times) for part in parts])
    forces = mixing @ signals
    joint = mixing @ mixing.T
    segments = 100
    for other in (1, 2, 4):
        _, found = coherence(forces[0], forces[other], 1000.0, nperseg=1000)
        expected = joint[0, other] ** 2 / (joint[0, 0] * joint[other, other])
        mean = found[3:48].mean()
        bias = (1.0 - expected) ** 2 / segments
        spread = (1.0 - expected) * np.sqrt(2.0 * max(expected, 1e-3) / segments / 20)
        assert mean == pytest.approx(expected, abs=bias + 4.0 * spread)
    assert np.var(forces, axis=1) == pytest.approx(joint[0, 0] * DENSITY.rms**2, rel=0.06)


def test_a_problem_under_it_is_repeatable() -> None:
    basis = bs.ModalBasis.from_structure(tube(), modes=2)
    found = [
        bs.simulate(bs.Problem(basis, loads=[flow(period=2.0)], duration=0.5)).motion()
        for _ in range(2)
    ]
    assert found[0].tobytes() == found[1].tobytes()
    assert found[0].any()


@pytest.mark.parametrize(
    ("options", "key", "what"),
    [
        ({"direction": (0, 0, 0)}, "direction", "have a length"),
        ({"correlation_length": 0.0}, "correlation_length", "positive"),
        ({"cells": 0}, "cells", "1 or more"),
        ({"period": 0.01}, "period", "fewer than 10 waves"),
        ({"beam": "XY"}, "beam", "unknown beam"),
        ({"end": 3.0}, "end", "on the beam, which is 2 m long"),
        ({"start": 1.0, "end": 0.5}, "end", "beyond the start"),
    ],
)
def test_mistakes_are_one_line(options: dict[str, Any], key: str, what: str) -> None:
    with pytest.raises(bs.InputError, match=what) as caught:
        flow(**options).nodal_forces(tube())
    assert caught.value.key == key
