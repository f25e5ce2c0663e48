//! The spectra of eight problems in contact, a problem a lane: the secular equation of
//! [`crate::method::piecewise_linear`], each of whose roots lies between the same poles in all
//! lanes.

use super::mask::{ALL, blend_both, chosen};
use super::shape::Shape;
use crate::method::piecewise_linear::{ComplexBlock, Eigenvalue, Nearest, middle_way};
use crate::number::{Complex, Instructions, Lanes, Number};

/// Steps of Halley's method after which lanes are given up.
const MOST_STEPS: usize = 5;

/// A last step below this part of the unknown makes the next error vanish in rounding.
const CONVERGED: f64 = 6e-8;

/// Exponents and vectors in contact.
#[derive(Debug, Default)]
pub(super) struct Contact {
    pub lambda: Vec<ComplexBlock>,
    /// `phi_i / D_i(lambda_j)`, the modes of each root one after the other.
    pub psi: Vec<ComplexBlock>,
    /// `2 / (psi' (2 lambda + C) psi)`
    pub factor: Vec<ComplexBlock>,
}

impl Contact {
    pub(super) fn new(modes: usize) -> Self {
        Self {
            lambda: vec![ComplexBlock::ZERO; modes],
            psi: vec![ComplexBlock::ZERO; modes * modes],
            factor: vec![ComplexBlock::ZERO; modes],
        }
    }

    /// Solves for eight stiffnesses; returns the lanes in which it did not succeed.
    #[inline(always)]
    pub(super) fn solve<I: Instructions>(&mut self, shape: &Shape, stiffness: Lanes<I>) -> u8 {
        let modes = shape.modes;
        let mut failed = 0;
        for root in 0..modes {
            let (origin, mu, damping) = undamped::<I>(shape, stiffness, root);
            let row = &mut self.psi[root * modes..(root + 1) * modes];
            let (lambda, late) = damped::<I>(shape, stiffness, origin, mu, damping, row);
            self.lambda[root].put(lambda);
            failed |= late | !Lanes::<I>::of(0.0).less(lambda.im);
            self.factor[root].put(normalise::<I>(shape, lambda, row));
        }
        failed
    }
}

/// `1/D_i` becomes `phi_i/D_i`; returns the factor of the left vector.
#[inline(always)]
fn normalise<I: Instructions>(
    shape: &Shape,
    lambda: Complex<Lanes<I>>,
    row: &mut [ComplexBlock],
) -> Complex<Lanes<I>> {
    let twice = lambda + lambda;
    let mut norm = Complex::zero();
    for ((phi, damping), inverse) in shape.phi.iter().zip(&shape.damping).zip(row) {
        let psi = inverse.lanes::<I>().scale(Lanes::of(*phi));
        inverse.put(psi);
        norm = (psi * psi).mul_add(twice.plus(Lanes::of(*damping)), norm);
    }
    let inverse = norm.recip();
    inverse + inverse
}

/// The undamped root `mu = -s^2` above one pole, measured from the nearer one, and its first-order
/// damping.
#[inline(always)]
fn undamped<I: Instructions>(
    shape: &Shape,
    k: Lanes<I>,
    root: usize,
) -> (Nearest<I>, Lanes<I>, Lanes<I>) {
    let zero = Lanes::<I>::of(0.0);
    let one = Lanes::<I>::of(1.0);
    let last = root + 1 == shape.modes;
    let lower = Lanes::<I>::of(shape.omega2[root]);
    let (upper, z_high) = if last {
        // No root lies above the last pole by more than k sum phi^2: a pole without weight.
        (lower + Lanes::of(1.000_001 * shape.total) * k, zero)
    } else {
        let phi = shape.phi[root + 1];
        (Lanes::of(shape.omega2[root + 1]), k * Lanes::of(phi * phi))
    };
    let phi = shape.phi[root];
    let z_low = k * Lanes::of(phi * phi);
    let middle = (upper - lower) * Lanes::of(0.5);
    let rest = if last {
        let mut rest = one;
        for i in 0..root {
            let z = k * Lanes::of(shape.phi[i] * shape.phi[i]);
            let distance = Lanes::<I>::of(shape.omega2[i]) - lower - middle;
            rest = z.mul_add(distance.rough_recip(), rest);
        }
        rest
    } else {
        k.mul_add(Lanes::of(shape.beside[root]), one)
    };
    let at_middle = rest + (z_high - z_low) / middle;
    let above = if last { root } else { root + 1 };
    let origin = Nearest {
        omega2: zero.select_less(at_middle, lower, Lanes::of(shape.omega2[above])),
        damping: zero.select_less(
            at_middle,
            Lanes::of(shape.damping[root]),
            Lanes::of(shape.damping[above]),
        ),
    };
    let (low, high) = (lower - origin.omega2, upper - origin.omega2);
    let mut mu = middle_way(rest, z_low, z_high, low, high, low + middle);
    let (mut below, mut below_slope) = (zero, zero);
    let (mut over, mut over_slope) = (zero, zero);
    let (mut weighted, mut total) = (zero, zero);
    for i in 0..shape.modes {
        let z = k * Lanes::of(shape.phi[i] * shape.phi[i]);
        let distance = Lanes::<I>::of(shape.omega2[i]) - origin.omega2 - mu;
        let inverse = distance.rough_recip();
        let term = z * inverse;
        let slope = term * inverse;
        weighted = slope.mul_add(Lanes::of(shape.damping[i]), weighted);
        total += slope;
        if i <= root {
            below += term;
            below_slope += slope;
        } else {
            over += term;
            over_slope += slope;
        }
    }
    let (to_low, to_high) = (low - mu, high - mu);
    let constant = one + (below - to_low * below_slope) + (over - to_high * over_slope);
    mu = middle_way(
        constant,
        to_low * to_low * below_slope,
        to_high * to_high * over_slope,
        low,
        high,
        mu,
    );
    (origin, mu, weighted / total)
}

/// Halley's method on `D_o f`. A lane that has settled keeps its numbers while others go on, so that
/// none sees the others. Returns the eigenvalues and the lanes that have not settled; the row gets
/// `1/D_i`.
#[inline(always)]
fn damped<I: Instructions>(
    shape: &Shape,
    k: Lanes<I>,
    origin: Nearest<I>,
    root: Lanes<I>,
    damping: Lanes<I>,
    row: &mut [ComplexBlock],
) -> (Complex<Lanes<I>>, u8) {
    let (zero, one) = (Lanes::<I>::of(0.0), Lanes::<I>::of(1.0));
    let pole = origin.pole();
    let mu = origin.omega2 + root;
    let half = damping * Lanes::of(0.5);
    let guess = Complex::new(-half, (mu - half * half).max(zero).sqrt());
    // s - p_o without cancellation: (s^2 + c_o s + w_o^2) / (s - conj p_o), to first order.
    let apart = guess - pole.conj();
    let change = origin.damping - damping;
    let first = Complex::new(change.mul_add(guess.re, -root), change * guess.im);
    let mut eigenvalue = Eigenvalue::new(origin, pole);
    eigenvalue.set(first * apart.recip());
    let mut open = ALL;
    let mut before = eigenvalue.value;
    for _ in 0..MOST_STEPS {
        let searching = chosen::<I>(open);
        before = blend_both(searching, eigenvalue.value, before);
        let (mut sum, mut squares) = (Complex::zero(), Complex::zero());
        let (mut cubes, mut damped_squares) = (Complex::zero(), Complex::zero());
        let near = eigenvalue.near();
        for (i, to) in row.iter_mut().enumerate() {
            let phi2 = Lanes::<I>::of(shape.phi[i] * shape.phi[i]);
            let pole = eigenvalue.pole(near, shape.omega2[i], shape.damping[i]);
            let inverse = pole.conj().scale(one / pole.norm2());
            to.put(blend_both(searching, inverse, to.lanes()));
            let term = inverse.scale(phi2);
            sum += term;
            let square = term * inverse;
            squares += square;
            cubes = square.mul_add(inverse, cubes);
            damped_squares = square.scale_add(Lanes::of(shape.damping[i]), damped_squares);
        }
        let turn = eigenvalue.value + eigenvalue.value;
        let rate = turn.plus(origin.damping);
        let falls = turn.mul_add(squares, damped_squares);
        let f = sum.scale(k).plus(one);
        let slope = -falls.scale(k);
        let bend = ((rate * rate) * cubes - squares).scale(k);
        // With g = D_o f the step is g / (g' - g g''/(2 g')), here all over D_o.
        let own = eigenvalue.own_pole().recip();
        let own_rate = rate * own;
        let slope_of_product = own_rate.mul_add(f, slope);
        let bend_of_product = own.mul_add(f, own_rate.mul_add(slope, bend));
        let denominator = slope_of_product * slope_of_product - f * bend_of_product;
        let step = f * slope_of_product * denominator.recip();
        let next = eigenvalue.delta - step;
        eigenvalue.set(blend_both(searching, next, eigenvalue.delta));
        let tolerance = Lanes::of(CONVERGED * CONVERGED) * next.norm2();
        open &= !step.norm2().less(tolerance);
        if open == 0 {
            break;
        }
    }
    // With `D_i(new) = D_i(old) (1 + x)` the last step is so small that `1 - x + x^2` is `1/(1+x)`.
    let step = eigenvalue.value - before;
    let twice = eigenvalue.value + before;
    for (damping, inverse) in shape.damping.iter().zip(row) {
        let old = inverse.lanes::<I>();
        let x = step * twice.plus(Lanes::of(*damping)) * old;
        inverse.put(old * x.mul_add(x, -x).plus(one));
    }
    (eigenvalue.value, open)
}
