//! Order 3, with an error estimate of order 2 and a cubic as dense output; three evaluations a
//! step, for tolerances of a percent or so. Stable along the imaginary axis up to |h omega| = 1.73.
//!
//! Source: P. Bogacki, L. F. Shampine, A 3(2) pair of Runge-Kutta formulas, Applied Mathematics
//! Letters 2, 321-325, 1989.

use super::Pair;

pub(super) const PAIR: Pair = Pair {
    name: "rk32",
    error_order: 3.0,
    c: &[0.0, 1.0 / 2.0, 3.0 / 4.0],
    a: &[&[], &[1.0 / 2.0], &[0.0, 3.0 / 4.0]],
    b: &[2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0],
    errors: &[&[5.0 / 72.0, -1.0 / 12.0, -1.0 / 9.0, 1.0 / 8.0]],
    extra: &[],
    corrections: &[],
};
