"""Seeded random problems that visit what is special: rigid, equal, uncoupled, critical modes."""

import numpy as np

from .problem import Array, StopProblem

LARGEST_ANGLE = 300.0  # fastest rate times duration


def frequencies(rng: np.random.Generator, modes: int) -> Array:
    """Return circular frequencies with few bits, so that their squares and doubles are exact."""
    omega = np.sort(np.round(2 * np.pi * 10 ** rng.uniform(0, 1.5, modes) * 64) / 64)
    if modes > 1 and rng.random() < 0.25:
        omega[1] = omega[0]
    if rng.random() < 0.3:
        omega[: 1 + int(rng.random() < 0.3)] = 0.0
    return omega


def ratios(rng: np.random.Generator, modes: int) -> Array:
    """Return damping ratios: none, one small value, or anything up to overdamped and critical."""
    kind = rng.random()
    if kind < 0.3:
        return np.zeros(modes)
    if kind < 0.6:
        return np.full(modes, 10 ** rng.uniform(-3, -1))
    return rng.choice([0.0, 0.01, 0.3, 0.99, 1.0, 1.0, 1.5, 4.0], modes)


def random_problem(seed: int) -> StopProblem:
    """Return one problem of 1 to 12 modes."""
    rng = np.random.default_rng(seed)
    modes = int(rng.integers(1, 13))
    omega = frequencies(rng, modes)
    row = rng.normal(size=modes)
    if rng.random() < 0.3:
        row[rng.integers(modes)] = 0.0
    if not row.any():
        row[0] = 1.0
    reference = float(np.median(omega[omega > 0])) if omega.any() else 10.0
    damping = 2 * ratios(rng, modes) * omega
    if omega[0] == 0.0 and rng.random() < 0.3:
        # Rigid modes with drag; rigid modes of different drag are refused under a push.
        damping[omega == 0.0] = reference * 10 ** rng.uniform(-2, 0)
    stiffness = reference**2 / (row @ row) * 10 ** rng.uniform(-2, 4)
    if rng.random() < 0.1:
        stiffness *= 1e4
    rate = np.sqrt(stiffness * (row @ row) + omega.max() ** 2) + damping.max()
    stop_damping = 0.0
    if rng.random() < 0.4:
        stop_damping = stiffness / rate * 10 ** rng.uniform(-3, 0.5)
    amplitude = float(np.abs(row).sum()) / reference
    gap = amplitude * float(rng.choice([0.0, 1.0, -1.0])) * 10 ** rng.uniform(-3, -0.5)
    force = np.zeros(modes)
    if rng.random() < 0.5:
        force = -row * reference * 10 ** rng.uniform(-2, 0.5)
    if rng.random() < 0.2:
        force = force + rng.normal(size=modes) * reference
    displacement = np.zeros(modes)
    if rng.random() < 0.5:
        displacement = rng.normal(size=modes) / reference * 10 ** rng.uniform(-3, 0)
    rate += stop_damping * (row @ row)
    slowest = omega[omega > 0].min() if omega.any() else reference
    duration = min(4 * 2 * np.pi / slowest, LARGEST_ANGLE / rate)
    return StopProblem(
        omega2=omega**2,
        damping=damping,
        row=row,
        stiffness=float(stiffness),
        duration=float(duration),
        gap=gap,
        stop_damping=float(stop_damping),
        force=force,
        displacement=displacement,
        velocity=rng.normal(size=modes),
    )
