"""Modes from measured functions of one reference.

Poles: least squares in the z-domain with a common denominator (LSCF), kept where they are stable
over rising orders, then polished by Gauss-Newton steps on the sum of modes itself. Residues: linear
least squares with a lower and an upper residual (LSFD). Shapes: from the function at the reference
itself, for unit modal mass.
Sources: P. Guillaume, P. Verboven, S. Vanlanduit, Frequency-domain maximum likelihood
identification of modal parameters with confidence intervals, ISMA 23, 1998; H. Van der Auweraer
et al., Application of a fast-stabilizing frequency domain parameter estimation method, J. Dyn.
Syst. Meas. Control 123, 2001; for residues and modal mass, D. J. Ewins, Modal Testing, 2nd ed.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray, count, pair
from bumpstop.errors import InputError
from bumpstop.modal.frequency_response import DERIVATIVES, ComplexArray, FrequencyResponse
from bumpstop.structure.dofs import Dof
from bumpstop.structure.sparse import IndexArray

__all__ = ["IdentifiedModes", "identified"]

IN_PHASE = 0.2
"""Largest part of a mode that may move out of phase, by its norm, to be taken as real."""
SAME_FREQUENCY, SAME_DAMPING = 0.01, 0.05
"""How far, relatively, a stable pole may move from one order to the next."""
MOST_DAMPING = 0.5
"""Poles with a greater ratio of critical damping stand in for modes outside the band."""
FAINT = 1e-3
"""Poles whose part in all functions is below this, by norm, are not modes but noise."""

_MOST_ORDER = 40
_STABLE_ORDERS = 3
_STEPS = 12


class IdentifiedModes(NamedTuple):
    """Real modes of unit modal mass."""

    frequency: FloatArray
    """In Hz, (N,)."""
    damping: FloatArray
    """Ratios of critical damping, (N,)."""
    dofs: tuple[Dof, ...]
    shapes: FloatArray
    """(dofs, N), in 1/sqrt(kg) and rad/m/sqrt(kg)."""


class _Measured(NamedTuple):
    """Functions in the band, each scaled to unit size."""

    omega: FloatArray
    values: ComplexArray
    """(functions, frequencies)."""
    derivatives: tuple[int, ...]
    scale: FloatArray


def identified(
    functions: Sequence[FrequencyResponse],
    band: tuple[float, float] | None = None,
    number: int | None = None,
) -> IdentifiedModes:
    """Return the modes that measured functions of one reference show in a band.

    Raises
    ------
    InputError
        If the functions do not belong together, the drive point is missing, the band holds too
        little, no or fewer stable modes are found than wanted, or a mode is complex.
    """
    drive = _drive_point(functions)
    measured = _in_band(functions, band)
    poles = _stable_poles(measured)
    if poles.size:
        poles = _without_faint(measured, poles)
    if number is not None:
        poles = _strongest(measured, poles, count("count", number))
    if not poles.size:
        hint = "widen the band, or measure more finely"
        raise InputError("no stable mode in the band", key="band", value=band, hint=hint)
    poles = _polished(measured, poles)
    poles = poles[np.argsort(np.abs(poles))]
    shapes = _real_shapes(poles, _residues(measured, poles), drive)
    return IdentifiedModes(
        frequency=np.abs(poles) / (2.0 * np.pi),
        damping=-poles.real / np.abs(poles),
        dofs=tuple(function.response for function in functions),
        shapes=shapes,
    )


def _drive_point(functions: Sequence[FrequencyResponse]) -> int:
    """Return the number of the function whose response is the reference."""
    if not functions:
        raise InputError("must hold a function", key="functions")
    references = sorted({".".join(function.reference) for function in functions})
    if len(references) > 1:
        hint = "give the functions of one reference"
        raise InputError("have several references", value=", ".join(references), hint=hint)
    responses = [function.response for function in functions]
    for response in responses:
        if responses.count(response) > 1:
            raise InputError("is measured twice", key=".".join(response))
    reference = functions[0].reference
    if reference not in responses:
        hint = "without it nobody knows what the shapes are scaled to"
        what = f"the drive point is missing: response and reference {references[0]}"
        raise InputError(what, hint=hint)
    return responses.index(reference)


def _in_band(functions: Sequence[FrequencyResponse], band: tuple[float, float] | None) -> _Measured:
    frequency = functions[0].frequency
    for function in functions[1:]:
        if not np.array_equal(function.frequency, frequency):
            raise InputError("has other frequencies", key=".".join(function.response))
    low, high = (0.0, np.inf) if band is None else pair("band", band)
    if not 0.0 <= low < high:
        raise InputError("must be two frequencies, the lower one first", key="band", value=band)
    inside = (frequency >= low) & (frequency <= high) & (frequency > 0.0)
    if np.count_nonzero(inside) < 16:
        what = f"holds {np.count_nonzero(inside)} frequencies, too few to identify modes"
        raise InputError(what, key="band", value=band)
    values = np.array([function.values[inside] for function in functions])
    scale = np.linalg.norm(values, axis=1)
    if not scale.all():
        dead = functions[int(np.argmin(scale))]
        raise InputError("is zero in the whole band", key=".".join(dead.response))
    return _Measured(
        omega=2.0 * np.pi * frequency[inside],
        values=values / scale[:, np.newaxis],
        derivatives=tuple(DERIVATIVES[function.kind] for function in functions),
        scale=scale,
    )


def _stable_poles(measured: _Measured) -> ComplexArray:
    """Return the poles of the order that has most stable ones, the highest of such orders."""
    before: ComplexArray = np.empty(0, dtype=complex)
    runs: IndexArray = np.empty(0, dtype=np.int64)
    best: ComplexArray = before
    most = min(_MOST_ORDER, (len(measured.omega) - 2) // 2)
    for order in range(2, most + 1):
        poles = _poles(measured, order)
        runs = np.array([_run(pole, before, runs) for pole in poles], dtype=np.int64)
        stable = poles[runs >= _STABLE_ORDERS]
        if len(stable) >= len(best):
            best = stable
        before = poles
    return best


def _run(pole: complex, before: ComplexArray, runs: IndexArray) -> int:
    """Return over how many orders a pole has been stable."""
    size, damping = np.abs(before), -before.real
    near = np.abs(size - abs(pole)) <= SAME_FREQUENCY * abs(pole)
    near &= np.abs(damping / size + pole.real / abs(pole)) <= SAME_DAMPING * -pole.real / abs(pole)
    return 1 + int(runs[near].max()) if near.any() else 0


def _poles(measured: _Measured, order: int) -> ComplexArray:
    """Return the damped poles in the band of the common denominator of an order.

    The band is half a turn of the unit circle. The lowest coefficient is one: poles that only
    mimic noise are then undamped, and go.
    """
    omega = measured.omega
    start, step = omega[0], np.pi / (omega[-1] - omega[0])
    powers = np.exp(1j * step * np.outer(omega - start, np.arange(order + 1)))
    inside, _ = np.linalg.qr(powers)
    rows = []
    for values in measured.values:
        weighted = values[:, np.newaxis] * powers
        # What numerators of this order cannot take is up to the denominator.
        rest = weighted - inside @ (inside.conj().T @ weighted)
        rows.append(np.linalg.qr(rest, mode="r"))
    stacked = np.concatenate(rows)
    coefficients = np.linalg.lstsq(stacked[:, 1:], -stacked[:, 0], rcond=1e-13)[0]
    roots = np.roots([*coefficients[::-1], 1.0])
    roots = roots[roots != 0.0]
    poles: ComplexArray = np.log(roots) / step + 1j * start
    size = np.abs(poles)
    damped = (poles.real < 0.0) & (-poles.real <= MOST_DAMPING * size) & (poles.imag > 0.0)
    inside_band = (size >= omega[0]) & (size <= omega[-1])
    return np.asarray(poles[damped & inside_band])


def _columns(measured: _Measured, poles: ComplexArray, derivatives: int) -> FloatArray:
    """Return what unit residues, real and imaginary, and unit residuals do, (2 n, 2 N + 2)."""
    s = 1j * measured.omega[:, np.newaxis]
    forward, backward = 1.0 / (s - poles), 1.0 / (s - poles.conj())
    residuals = np.concatenate([1.0 / s**2, np.ones_like(s)], axis=1)
    both = [forward + backward, 1j * (forward - backward), residuals]
    return _split(np.concatenate(both, axis=1) * s**derivatives)


def _split(values: ComplexArray) -> FloatArray:
    return np.concatenate([values.real, values.imag])


def _fit(measured: _Measured, poles: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Return residues and residuals, (2 N + 2, functions), and the errors, (2 n, functions)."""
    unknown = np.empty((2 * len(poles) + 2, len(measured.values)))
    errors = np.empty((2 * len(measured.omega), len(measured.values)))
    for kind in set(measured.derivatives):
        those = np.array(measured.derivatives) == kind
        columns = _columns(measured, poles, kind)
        size = np.linalg.norm(columns, axis=0)
        given = _split(measured.values[those].T)
        solved = np.linalg.lstsq(columns / size, given, rcond=None)[0]
        unknown[:, those] = solved / size[:, np.newaxis]
        errors[:, those] = given - columns @ unknown[:, those]
    return unknown, errors


def _residues(measured: _Measured, poles: ComplexArray) -> ComplexArray:
    """Return the residues of the displacements, (functions, N)."""
    unknown, _ = _fit(measured, poles)
    modes = len(poles)
    residues: ComplexArray = (unknown[:modes] + 1j * unknown[modes : 2 * modes]).T
    return residues * measured.scale[:, np.newaxis]


def _parts(measured: _Measured, poles: ComplexArray) -> FloatArray:
    """Return the norm of each mode's part in all functions, of which each has the norm one."""
    unknown, _ = _fit(measured, poles)
    modes = len(poles)
    squares = np.zeros(modes)
    for function, kind in enumerate(measured.derivatives):
        columns = _columns(measured, poles, kind)
        real, imaginary = unknown[:modes, function], unknown[modes : 2 * modes, function]
        part = columns[:, :modes] * real + columns[:, modes : 2 * modes] * imaginary
        squares += np.sum(part**2, axis=0)
    return np.sqrt(squares / len(measured.values))


def _without_faint(measured: _Measured, poles: ComplexArray) -> ComplexArray:
    return poles[_parts(measured, poles) >= FAINT]


def _strongest(measured: _Measured, poles: ComplexArray, number: int) -> ComplexArray:
    if len(poles) < number:
        hint = f"{len(poles)} are stable in the band"
        raise InputError("more modes than can be identified", key="count", value=number, hint=hint)
    return poles[np.argsort(-_parts(measured, poles), kind="stable")[:number]]


def _polished(measured: _Measured, poles: ComplexArray) -> ComplexArray:
    """Return the poles after Gauss-Newton steps that make the errors of the modes' sum least."""
    _, errors = _fit(measured, poles)
    for _ in range(_STEPS):
        moved = poles + _gauss_newton_step(measured, poles)
        if np.any(moved.real >= 0.0):
            break
        _, after = _fit(measured, moved)
        if not np.linalg.norm(after) < np.linalg.norm(errors):
            break
        poles, errors = moved, after
    return poles


def _gauss_newton_step(measured: _Measured, poles: ComplexArray) -> ComplexArray:
    """Return the step of variable projection: residues follow the poles."""
    unknown, errors = _fit(measured, poles)
    modes = len(poles)
    s = 1j * measured.omega[:, np.newaxis]
    forward, backward = 1.0 / (s - poles) ** 2, 1.0 / (s - poles.conj()) ** 2
    rows = []
    bases = {
        kind: np.linalg.qr(_columns(measured, poles, kind))[0] for kind in set(measured.derivatives)
    }
    for function, kind in enumerate(measured.derivatives):
        residue = unknown[:modes, function] + 1j * unknown[modes : 2 * modes, function]
        one, other = residue * forward, residue.conj() * backward
        slopes = np.concatenate([one + other, 1j * (one - other)], axis=1) * s**kind
        slope = _split(slopes)
        basis = bases[kind]
        rows.append(slope - basis @ (basis.T @ slope))
    step = np.linalg.lstsq(np.concatenate(rows), errors.T.ravel(), rcond=None)[0]
    return np.asarray(step[:modes] + 1j * step[modes:])


def _real_shapes(poles: ComplexArray, residues: ComplexArray, drive: int) -> FloatArray:
    """Return shapes of unit modal mass, from phi_o phi_ref = 2 i omega_d R_o."""
    products = 2j * poles.imag * residues
    for pole, product in zip(poles, products.T, strict=True):
        out = float(np.linalg.norm(product.imag) / np.linalg.norm(product))
        what = f"the mode at {abs(pole) / (2.0 * np.pi):.6g} Hz"
        if out > IN_PHASE:
            hint = "narrow the band or lower count, if it is none"
            raise InputError(f"{what} is complex: {out:.0%} of it moves out of phase", hint=hint)
        if product[drive].real <= 0.0:
            hint = "are the signs of its response and its reference right?"
            raise InputError(f"{what} is not driven at the drive point", hint=hint)
    shapes: FloatArray = products.real / np.sqrt(products[drive].real)
    return shapes
