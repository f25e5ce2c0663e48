//! Order 5, with an error estimate of order 4 and a dense output of order 4; six evaluations a
//! step. Stable along the imaginary axis up to |h omega| = 1.
//!
//! Sources: J. R. Dormand, P. J. Prince, A family of embedded Runge-Kutta formulae, Journal of
//! Computational and Applied Mathematics 6, 19-26, 1980; the dense output is that of
//! L. F. Shampine, Some practical Runge-Kutta formulas, Mathematics of Computation 46, 135-150,
//! 1986, in the form of E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential
//! Equations I, 2nd edition, 1993, section II.6.

use super::Pair;

pub(super) const PAIR: Pair = Pair {
    name: "rk54",
    error_order: 5.0,
    c: &[0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0],
    a: &[
        &[],
        &[1.0 / 5.0],
        &[3.0 / 40.0, 9.0 / 40.0],
        &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        &[
            19372.0 / 6561.0,
            -25360.0 / 2187.0,
            64448.0 / 6561.0,
            -212.0 / 729.0,
        ],
        &[
            9017.0 / 3168.0,
            -355.0 / 33.0,
            46732.0 / 5247.0,
            49.0 / 176.0,
            -5103.0 / 18656.0,
        ],
    ],
    b: &[
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
    errors: &[&[
        71.0 / 57600.0,
        0.0,
        -71.0 / 16695.0,
        71.0 / 1920.0,
        -17253.0 / 339200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ]],
    extra: &[],
    corrections: &[&[
        -12715105075.0 / 11282082432.0,
        0.0,
        87487479700.0 / 32700410799.0,
        -10690763975.0 / 1880347072.0,
        701980252875.0 / 199316789632.0,
        -1453857185.0 / 822651844.0,
        69997945.0 / 29380423.0,
    ]],
};
