//! Eigenvalues of modes coupled by one spring and damper, from the secular equation.
//!
//! The modes `q_i'' + c_i q_i' + w_i^2 q_i = phi_i F` with `F = -(k + c s) sum phi_i q_i` have
//! the eigenvalues where
//!
//! ```text
//! f(s) = 1 + (k + c s) sum_i phi_i^2 / D_i(s) = 0,   D_i(s) = s^2 + c_i s + w_i^2.
//! ```
//!
//! Without damping there is one root between neighbouring poles (G. H. Golub, Some modified
//! matrix eigenvalue problems, SIAM Review 15, 1973). It is found with the nearer pole as
//! origin by rational interpolation in the "middle way" (R.-C. Li, Solving secular equations
//! stably and efficiently, LAPACK Working Note 89, 1993); first-order damping then starts
//! Halley's method on `D_o f` in the complex plane, with the distance from the nearest damped
//! pole as unknown, so that weakly coupled modes lose no digits.

use super::poles::{Eigenvalue, Nearest};
use super::rows::Rows;
use crate::number::{Complex, Instructions, LANES, Lanes, Number};

/// Corrections of the middle way before damping comes in: the damping's first-order estimate is no
/// better than one leaves the root.
const MIDDLE_WAY_STEPS: usize = 1;

/// Halley steps allowed; two suffice for light damping.
const HALLEY_STEPS: usize = 8;

/// A step below this part of the unknown makes the next error vanish in rounding, even where
/// damping leaves no more than Newton's order.
const CONVERGED: f64 = 6e-8;

/// Modes that one spring couples, sorted by `omega2`, no two of them alike, no `phi` zero.
#[derive(Debug, Clone, Default)]
pub(crate) struct Coupling {
    pub omega2: Vec<f64>,
    pub damping: Vec<f64>,
    pub phi: Vec<f64>,
    pub stiffness: f64,
    pub stop_damping: f64,
}

impl Coupling {
    /// Forgets the modes and takes another spring and damper.
    #[inline(always)]
    pub(crate) fn start(&mut self, stiffness: f64, stop_damping: f64) {
        self.omega2.clear();
        self.damping.clear();
        self.phi.clear();
        (self.stiffness, self.stop_damping) = (stiffness, stop_damping);
    }

    /// Adds a mode; returns its number.
    #[inline(always)]
    pub(crate) fn push(&mut self, omega2: f64, damping: f64, phi: f64) -> usize {
        self.omega2.push(omega2);
        self.damping.push(damping);
        self.phi.push(phi);
        self.phi.len() - 1
    }

    /// Whether every mode by itself oscillates with light damping, as this path needs.
    #[inline(always)]
    pub(crate) fn is_lightly_damped(&self) -> bool {
        for (w2, c) in self.omega2.iter().zip(&self.damping) {
            let oscillates = *w2 == 0.0 && *c == 0.0 || c * c < 2.0 * w2;
            if !oscillates {
                return false;
            }
        }
        true
    }

    /// Eight eigenvalues with positive imaginary part, those between the poles from number
    /// `8 block` on; zero in the padding. Row i of `inverses` gets `1 / D_i` of each. `None`
    /// where the iteration does not settle on oscillating ones.
    #[inline(always)]
    pub(crate) fn solve_block<I: Instructions>(
        &self,
        block: usize,
        inverses: &mut Rows,
    ) -> Option<Complex<Lanes<I>>> {
        let first = block * LANES;
        let bracket = Bracket::<I>::new(self, first);
        let (origin, start) = self.undamped(&bracket);
        let lambda = self.damped(&bracket, origin, start, block, inverses)?;
        let im = lambda.im.numbers();
        for im in im.iter().take(self.omega2.len() - first) {
            if *im <= 0.0 {
                return None;
            }
        }
        Some(bracket.keep(lambda))
    }

    /// The undamped roots `mu = -s^2`: the nearer poles, and the root measured from them.
    #[inline(always)]
    fn undamped<I: Instructions>(&self, bracket: &Bracket<I>) -> (Nearest<I>, Undamped<I>) {
        let k = Lanes::<I>::of(self.stiffness);
        let middle = (bracket.upper - bracket.lower) * Lanes::<I>::of(0.5);
        // The rest of f at the middle, all but the two poles beside the root.
        let mut rest = Lanes::<I>::of(1.0);
        for (i, (omega2, phi)) in self.omega2.iter().zip(&self.phi).enumerate() {
            let z = k * Lanes::<I>::of(phi * phi);
            let distance = Lanes::<I>::of(*omega2) - bracket.lower - middle;
            rest = bracket
                .outside(i, z, Lanes::<I>::of(0.0))
                .mul_add(distance.rough_recip(), rest);
        }
        let (z_low, z_high) = (k * bracket.phi2_lower, k * bracket.phi2_upper);
        let at_middle = rest + (z_high - z_low) / middle;
        let origin = bracket.nearest(at_middle);
        // Distances of the two poles from the present point, here from the origin pole.
        let low = bracket.lower - origin.omega2;
        let high = bracket.upper - origin.omega2;
        let mut root = middle_way(rest, z_low, z_high, low, high, low + middle);
        let mut sums = DampingSums::new(self);
        for _ in 0..MIDDLE_WAY_STEPS {
            let (mut below, mut below_slope) = (Lanes::<I>::of(0.0), Lanes::<I>::of(0.0));
            let (mut above, mut above_slope) = (Lanes::<I>::of(0.0), Lanes::<I>::of(0.0));
            sums = DampingSums::new(self);
            let modes = self.omega2.iter().zip(&self.damping).zip(&self.phi);
            for (i, ((omega2, damping), phi)) in modes.enumerate() {
                let z = k * Lanes::<I>::of(phi * phi);
                let distance = Lanes::<I>::of(*omega2) - origin.omega2 - root;
                let inverse = distance.rough_recip();
                let term = z * inverse;
                let slope = term * inverse;
                sums.add(*damping, slope);
                let zero = Lanes::<I>::of(0.0);
                below += bracket.below(i, term, zero);
                below_slope += bracket.below(i, slope, zero);
                above += bracket.below(i, zero, term);
                above_slope += bracket.below(i, zero, slope);
            }
            let (to_low, to_high) = (low - root, high - root);
            let constant = Lanes::<I>::of(1.0)
                + (below - to_low * below_slope)
                + (above - to_high * above_slope);
            let (weight_low, weight_high) = (
                to_low * to_low * below_slope,
                to_high * to_high * above_slope,
            );
            root = middle_way(constant, weight_low, weight_high, low, high, root);
        }
        (
            origin,
            Undamped {
                root,
                damping: sums.ratio(),
            },
        )
    }

    /// Halley's method on `D_o f`, all lanes together. In its second derivative all modes have the
    /// damping of the nearest one: exact where no root is, between the modes, and otherwise an
    /// error of the step that is small with the damping.
    #[inline(always)]
    fn damped<I: Instructions>(
        &self,
        bracket: &Bracket<I>,
        origin: Nearest<I>,
        start: Undamped<I>,
        block: usize,
        inverses: &mut Rows,
    ) -> Option<Complex<Lanes<I>>> {
        let pole = origin.pole();
        let mu = origin.omega2 + start.root;
        let half = start.damping * Lanes::<I>::of(0.5);
        let guess = Complex::new(-half, (mu - half * half).max(Lanes::<I>::of(0.0)).sqrt());
        // s - p_o without cancellation: (s^2 + c_o s + w_o^2) / (s - conj p_o), to first order.
        let slope = (guess - pole.conj()).norm2();
        let first = Complex::new(
            -start.root + (origin.damping - start.damping) * guess.re,
            (origin.damping - start.damping) * guess.im,
        );
        let mut eigenvalue = Eigenvalue::new(origin, pole);
        let careful = slope.numbers().iter().all(|s| *s > 0.0);
        let delta = if careful {
            first
                * (guess - pole.conj())
                    .conj()
                    .scale(Lanes::<I>::of(1.0) / slope)
        } else {
            guess - pole
        };
        eigenvalue.set(delta);
        let k = Lanes::<I>::of(self.stiffness);
        let c = Lanes::<I>::of(self.stop_damping);
        let one = Lanes::<I>::of(1.0);
        for _ in 0..HALLEY_STEPS {
            let s = eigenvalue.value;
            let kappa = Complex::new(c.mul_add(s.re, k), c * s.im);
            // sums of phi^2/D, phi^2/D^2, phi^2/D^3 and c phi^2/D^2
            let mut sum = Complex::zero();
            let mut squares = Complex::zero();
            let mut cubes = Complex::zero();
            let mut damped_squares = Complex::zero();
            let near = eigenvalue.near();
            let modes = self.omega2.iter().zip(&self.damping).zip(&self.phi);
            let rows = inverses.rows_mut(0, self.omega2.len());
            for (((omega2, damping), phi), row) in modes.zip(rows) {
                let phi2 = Lanes::<I>::of(phi * phi);
                let pole = eigenvalue.pole(near, *omega2, *damping);
                // A division: the units that multiply have enough to do.
                let inverse = pole.conj().scale(one / pole.norm2());
                row[block].put(inverse);
                let term = inverse.scale(phi2);
                sum += term;
                let square = term * inverse;
                squares += square;
                cubes = square.mul_add(inverse, cubes);
                damped_squares = square.scale_add(Lanes::<I>::of(*damping), damped_squares);
            }
            // f = 1 + kappa sum,  f' = c sum - kappa falls,
            // f'' / 2 = kappa ((2 s + c_o)^2 cubes - squares) - c falls
            let turn = s + s;
            let rate = turn.plus(origin.damping);
            let falls = turn.mul_add(squares, damped_squares);
            let f = (kappa * sum).plus(one);
            let slope = sum.scale(c) - kappa * falls;
            let bend = kappa * ((rate * rate) * cubes - squares) - falls.scale(c);
            // With g = D_o f the step is g / (g' - g g''/(2 g')), here all over D_o.
            let own = eigenvalue.own_pole().recip();
            let own_rate = rate * own;
            let slope_of_product = own_rate.mul_add(f, slope);
            let bend_of_product = own.mul_add(f, own_rate.mul_add(slope, bend));
            let denominator = slope_of_product * slope_of_product - f * bend_of_product;
            let step = f * slope_of_product * denominator.recip();
            eigenvalue.set(eigenvalue.delta - step);
            let tolerance = Lanes::<I>::of(CONVERGED * CONVERGED) * eigenvalue.delta.norm2();
            let late = tolerance.select_less(step.norm2(), bracket.live, Lanes::<I>::of(0.0));
            if late.numbers() == [0.0; LANES] {
                self.follow(bracket, &eigenvalue, s, block, inverses);
                return Some(eigenvalue.value);
            }
        }
        None
    }
}

impl Coupling {
    /// Carries `1 / D_i` along the last step, from `before` to the eigenvalue. With
    /// `D_i(new) = D_i(old) (1 + x)` the step is so small that `1 - x + x^2` is `1/(1 + x)`.
    #[inline(always)]
    fn follow<I: Instructions>(
        &self,
        bracket: &Bracket<I>,
        eigenvalue: &Eigenvalue<I>,
        before: Complex<Lanes<I>>,
        block: usize,
        inverses: &mut Rows,
    ) {
        let step = eigenvalue.value - before;
        let twice = eigenvalue.value + before;
        let one = Lanes::<I>::of(1.0);
        let rows = inverses.rows_mut(0, self.omega2.len());
        for (damping, row) in self.damping.iter().zip(rows) {
            let old = row[block].lanes();
            let x = step * twice.plus(Lanes::<I>::of(*damping)) * old;
            let new = old * x.mul_add(x, -x).plus(one);
            row[block].put(bracket.keep(new));
        }
    }
}

/// The poles on either side of eight consecutive undamped roots.
struct Bracket<I: Instructions> {
    /// Number of the lower pole of each lane, plus a half.
    place: Lanes<I>,
    /// Minus one in lanes with a root, zero in the padding.
    live: Lanes<I>,
    /// The modes below and above; above the last pole the last mode once more.
    beside: [Nearest<I>; 2],
    lower: Lanes<I>,
    upper: Lanes<I>,
    phi2_lower: Lanes<I>,
    phi2_upper: Lanes<I>,
}

impl<I: Instructions> Bracket<I> {
    #[inline(always)]
    fn new(coupling: &Coupling, first: usize) -> Self {
        let n = coupling.omega2.len();
        let total: f64 = coupling.phi.iter().map(|p| p * p).sum();
        // No root lies above the last pole by more than k sum phi^2: a pole without weight.
        let beyond = coupling.omega2[n - 1] + 1.000_001 * coupling.stiffness * total;
        let mut places = [0.0; LANES];
        let mut live = [0.0; LANES];
        let (mut lower, mut upper) = ([0.0; LANES], [0.0; LANES]);
        let (mut phi2_lower, mut phi2_upper) = ([0.0; LANES], [0.0; LANES]);
        let (mut damping_lower, mut damping_upper) = ([0.0; LANES], [0.0; LANES]);
        let mut above = [0.0; LANES];
        for lane in 0..LANES {
            let index = (first + lane).min(n - 1);
            let next = (index + 1).min(n - 1);
            let (phi, phi_next) = (coupling.phi[index], coupling.phi[next]);
            places[lane] = index as f64 + 0.5;
            live[lane] = if first + lane < n { -1.0 } else { 0.0 };
            (lower[lane], phi2_lower[lane]) = (coupling.omega2[index], phi * phi);
            (above[lane], phi2_upper[lane]) = (coupling.omega2[next], phi_next * phi_next);
            upper[lane] = above[lane];
            damping_lower[lane] = coupling.damping[index];
            damping_upper[lane] = coupling.damping[next];
            if next == index {
                (upper[lane], phi2_upper[lane]) = (beyond, 0.0);
            }
        }
        let beside = [
            Nearest {
                omega2: Lanes::new(lower),
                damping: Lanes::new(damping_lower),
            },
            Nearest {
                omega2: Lanes::new(above),
                damping: Lanes::new(damping_upper),
            },
        ];
        Self {
            place: Lanes::new(places),
            live: Lanes::new(live),
            beside,
            lower: Lanes::new(lower),
            upper: Lanes::new(upper),
            phi2_lower: Lanes::new(phi2_lower),
            phi2_upper: Lanes::new(phi2_upper),
        }
    }

    /// The lanes with a root; zero in the padding.
    #[inline(always)]
    fn keep(&self, z: Complex<Lanes<I>>) -> Complex<Lanes<I>> {
        let zero = Lanes::<I>::of(0.0);
        Complex::new(
            self.live.select_less(zero, z.re, zero),
            self.live.select_less(zero, z.im, zero),
        )
    }

    /// The pole nearer to each root. f increases between poles: positive at the middle means a root
    /// in the lower half.
    #[inline(always)]
    fn nearest(&self, at_middle: Lanes<I>) -> Nearest<I> {
        let zero = Lanes::<I>::of(0.0);
        let [below, above] = &self.beside;
        Nearest {
            omega2: zero.select_less(at_middle, below.omega2, above.omega2),
            damping: zero.select_less(at_middle, below.damping, above.damping),
        }
    }

    /// `yes` in the lanes whose root lies above pole i.
    #[inline(always)]
    fn below(&self, i: usize, yes: Lanes<I>, no: Lanes<I>) -> Lanes<I> {
        Lanes::<I>::of(i as f64).select_less(self.place, yes, no)
    }

    /// `yes` in the lanes for which pole i is not beside the root.
    #[inline(always)]
    fn outside(&self, i: usize, yes: Lanes<I>, no: Lanes<I>) -> Lanes<I> {
        // The poles beside the root have numbers place - 1/2 and place + 1/2.
        let apart = (Lanes::<I>::of(i as f64) - self.place).abs();
        Lanes::<I>::of(0.75).select_less(apart, yes, no)
    }
}

/// An undamped root: `mu - w_o^2` and its first-order damping.
struct Undamped<I: Instructions> {
    root: Lanes<I>,
    damping: Lanes<I>,
}

/// `c = x' C x / x' x` of the undamped shape, the damper of the stop included.
struct DampingSums<I: Instructions> {
    weighted: Lanes<I>,
    total: Lanes<I>,
}

impl<I: Instructions> DampingSums<I> {
    #[inline(always)]
    fn new(coupling: &Coupling) -> Self {
        // sum z/(w_i^2 - mu) = -1 at a root, so the damper adds (c/k) in these units.
        Self {
            weighted: Lanes::<I>::of(coupling.stop_damping / coupling.stiffness),
            total: Lanes::<I>::of(0.0),
        }
    }

    #[inline(always)]
    fn add(&mut self, damping: f64, slope: Lanes<I>) {
        self.weighted += Lanes::<I>::of(damping) * slope;
        self.total += slope;
    }

    #[inline(always)]
    fn ratio(&self) -> Lanes<I> {
        self.weighted / self.total
    }
}

/// The zero of `constant + low/(a - y) + high/(b - y)` between a and b; `fallback` where the
/// formula leaves the interval.
#[inline(always)]
pub(crate) fn middle_way<I: Instructions>(
    constant: Lanes<I>,
    low: Lanes<I>,
    high: Lanes<I>,
    a: Lanes<I>,
    b: Lanes<I>,
    present: Lanes<I>,
) -> Lanes<I> {
    // With x = y - present the poles lie at da < 0 < db.
    let (da, db) = (a - present, b - present);
    let linear = constant * (da + db) + low + high;
    let last = constant * da * db + low * db + high * da;
    let discriminant =
        (linear * linear - Lanes::<I>::of(4.0) * constant * last).max(Lanes::<I>::of(0.0));
    let root = discriminant.sqrt();
    let zero = Lanes::<I>::of(0.0);
    let two = Lanes::<I>::of(2.0);
    let x = zero.select_less(
        linear,
        two * last / (linear + root),
        (linear - root) / (two * constant),
    );
    let y = present + x;
    let middle = Lanes::<I>::of(0.5) * (a + b);
    a.select_less(y, y.select_less(b, y, middle), middle)
}
