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
//! Newton's method on `D_o f` in the complex plane, with the distance from the nearest damped
//! pole as unknown, so that weakly coupled modes lose no digits.

use crate::number::{Complex, Instructions, LANES, Lanes, Number, padded};

/// Corrections of the middle way before damping comes in.
const MIDDLE_WAY_STEPS: usize = 2;

/// Newton steps allowed; two suffice for light damping.
const NEWTON_STEPS: usize = 8;

/// A Newton step below this part of the unknown makes the next error vanish in rounding.
const CONVERGED: f64 = 3e-8;

/// Modes that one spring couples, sorted by `omega2`, no two of them alike, no `phi` zero.
#[derive(Debug, Clone, Default)]
pub(crate) struct Coupling {
    pub omega2: Vec<f64>,
    pub damping: Vec<f64>,
    pub phi: Vec<f64>,
    pub stiffness: f64,
    pub stop_damping: f64,
}

/// The roots and what the shapes are made of, in arrays of whole lanes.
#[derive(Debug, Clone)]
pub(crate) struct Roots {
    /// Eigenvalues with positive imaginary part.
    pub lambda_re: Vec<f64>,
    pub lambda_im: Vec<f64>,
    /// `1 / D_i(lambda_j)`, row i of `stride` roots.
    pub inverse_re: Vec<f64>,
    pub inverse_im: Vec<f64>,
    /// Length of a row.
    pub stride: usize,
}

impl Coupling {
    /// All eigenvalues, or `None` where a mode is not lightly enough damped for this path.
    #[inline(always)]
    pub(crate) fn solve<I: Instructions>(&self) -> Option<Roots> {
        let oscillates = |(w2, c): (&f64, &f64)| *w2 == 0.0 && *c == 0.0 || c * c < 2.0 * w2;
        if !self.omega2.iter().zip(&self.damping).all(oscillates) {
            return None;
        }
        let n = self.omega2.len();
        let stride = padded(n);
        let mut roots = Roots {
            lambda_re: vec![0.0; stride],
            lambda_im: vec![0.0; stride],
            inverse_re: vec![0.0; n * stride],
            inverse_im: vec![0.0; n * stride],
            stride,
        };
        let mut offset = 0;
        while offset < n {
            self.solve_lanes::<I>(offset, &mut roots)?;
            offset += LANES;
        }
        Some(roots)
    }

    /// Eight roots at once, from the pole with number `offset` on.
    #[inline(always)]
    fn solve_lanes<I: Instructions>(&self, offset: usize, roots: &mut Roots) -> Option<()> {
        let bracket = Bracket::<I>::new(self, offset);
        let (origin, start) = self.undamped(&bracket);
        let lambda = self.damped(&bracket, origin, start)?;
        let im = lambda.value.im.numbers();
        if (im.iter().take(self.omega2.len() - offset)).any(|im| *im <= 0.0) {
            return None;
        }
        let keep = |x| {
            bracket
                .live
                .select_less(Lanes::<I>::of(0.0), x, Lanes::<I>::of(0.0))
        };
        keep(lambda.value.re).store(&mut roots.lambda_re[offset..]);
        keep(lambda.value.im).store(&mut roots.lambda_im[offset..]);
        for i in 0..self.omega2.len() {
            let inverse = lambda.pole(self, i).recip();
            let at = i * roots.stride + offset;
            keep(inverse.re).store(&mut roots.inverse_re[at..]);
            keep(inverse.im).store(&mut roots.inverse_im[at..]);
        }
        Some(())
    }

    /// The undamped roots `mu = -s^2`: the nearer poles, and the root measured from them.
    #[inline(always)]
    fn undamped<I: Instructions>(&self, bracket: &Bracket<I>) -> (Nearest<I>, Undamped<I>) {
        let k = Lanes::<I>::of(self.stiffness);
        let middle = (bracket.upper - bracket.lower) * Lanes::<I>::of(0.5);
        // The rest of f at the middle, all but the two poles beside the root.
        let mut rest = Lanes::<I>::of(1.0);
        for i in 0..self.omega2.len() {
            let z = k * Lanes::<I>::of(self.phi[i] * self.phi[i]);
            let distance = Lanes::<I>::of(self.omega2[i]) - bracket.lower - middle;
            let other = bracket.outside(i, Lanes::<I>::of(1.0), Lanes::<I>::of(0.0));
            rest += other * z / distance;
        }
        let (z_low, z_high) = (k * bracket.phi2_lower, k * bracket.phi2_upper);
        let at_middle = rest + (z_high - z_low) / middle;
        let origin = Nearest::new(self, bracket, at_middle);
        // Distances of the two poles from the present point, here from the origin pole.
        let low = bracket.lower - origin.omega2;
        let high = bracket.upper - origin.omega2;
        let mut root = middle_way(rest, z_low, z_high, low, high, low + middle);
        let mut sums = DampingSums::new(self);
        for _ in 0..MIDDLE_WAY_STEPS {
            let (mut below, mut below_slope) = (Lanes::<I>::of(0.0), Lanes::<I>::of(0.0));
            let (mut above, mut above_slope) = (Lanes::<I>::of(0.0), Lanes::<I>::of(0.0));
            sums = DampingSums::new(self);
            for i in 0..self.omega2.len() {
                let z = k * Lanes::<I>::of(self.phi[i] * self.phi[i]);
                let distance = Lanes::<I>::of(self.omega2[i]) - origin.omega2 - root;
                let inverse = Lanes::<I>::of(1.0) / distance;
                let term = z * inverse;
                let slope = term * inverse;
                sums.add(self.damping[i], slope);
                let is_below = bracket.below(i, Lanes::<I>::of(1.0), Lanes::<I>::of(0.0));
                let is_above = Lanes::<I>::of(1.0) - is_below;
                below += is_below * term;
                below_slope += is_below * slope;
                above += is_above * term;
                above_slope += is_above * slope;
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

    /// Newton's method on `D_o f`, all lanes together.
    #[inline(always)]
    fn damped<I: Instructions>(
        &self,
        bracket: &Bracket<I>,
        origin: Nearest<I>,
        start: Undamped<I>,
    ) -> Option<Eigenvalue<I>> {
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
        for _ in 0..NEWTON_STEPS {
            let s = eigenvalue.value;
            let kappa = Complex::new(k + c * s.re, c * s.im);
            let mut sum = Complex::zero();
            let mut slope = Complex::zero();
            for i in 0..self.omega2.len() {
                let phi2 = Lanes::<I>::of(self.phi[i] * self.phi[i]);
                let d = eigenvalue.pole(self, i);
                let zero = Lanes::<I>::of(0.0);
                let weight = origin.differs(i, phi2, zero);
                let norm = origin.differs(i, d.norm2(), Lanes::<I>::of(1.0));
                let inverse = d.conj().scale(Lanes::<I>::of(1.0) / norm);
                let term = inverse.scale(weight);
                sum += term;
                let rate = Complex::new(
                    Lanes::<I>::of(2.0) * s.re + Lanes::<I>::of(self.damping[i]),
                    Lanes::<I>::of(2.0) * s.im,
                );
                slope = slope - term * inverse * rate;
            }
            let own = eigenvalue.own_pole();
            let own_rate = Complex::new(
                Lanes::<I>::of(2.0) * s.re + origin.damping,
                Lanes::<I>::of(2.0) * s.im,
            );
            let inner = (own * sum).plus(origin.phi2);
            let value = own + kappa * inner;
            let rate = own_rate + inner.scale(c) + kappa * (own_rate * sum + own * slope);
            let step = value * rate.recip();
            eigenvalue.set(eigenvalue.delta - step);
            let tolerance = Lanes::<I>::of(CONVERGED * CONVERGED) * eigenvalue.delta.norm2();
            let late = tolerance.select_less(step.norm2(), bracket.live, Lanes::<I>::of(0.0));
            if late.numbers().iter().all(|late| *late == 0.0) {
                return Some(eigenvalue);
            }
        }
        None
    }
}

/// The poles on either side of eight consecutive undamped roots.
struct Bracket<I: Instructions> {
    /// Number of the lower pole of each lane, plus a half.
    place: Lanes<I>,
    /// Minus one in lanes with a root, zero in the padding.
    live: Lanes<I>,
    first: usize,
    count: usize,
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
        let at = |i: usize| if i < n { coupling.omega2[i] } else { beyond };
        let phi2 = |i: usize| {
            if i < n {
                coupling.phi[i] * coupling.phi[i]
            } else {
                0.0
            }
        };
        for lane in 0..LANES {
            let index = (first + lane).min(n - 1);
            places[lane] = index as f64 + 0.5;
            live[lane] = if first + lane < n { -1.0 } else { 0.0 };
            (lower[lane], upper[lane]) = (at(index), at(index + 1));
            (phi2_lower[lane], phi2_upper[lane]) = (phi2(index), phi2(index + 1));
        }
        Self {
            place: Lanes::new(places),
            live: Lanes::new(live),
            first,
            count: n,
            lower: Lanes::new(lower),
            upper: Lanes::new(upper),
            phi2_lower: Lanes::new(phi2_lower),
            phi2_upper: Lanes::new(phi2_upper),
        }
    }

    #[inline(always)]
    fn index(&self, lane: usize) -> usize {
        (self.first + lane).min(self.count - 1)
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

/// The pole nearest to each root.
#[derive(Clone, Copy)]
struct Nearest<I: Instructions> {
    index: Lanes<I>,
    omega2: Lanes<I>,
    damping: Lanes<I>,
    phi2: Lanes<I>,
}

impl<I: Instructions> Nearest<I> {
    /// f increases between poles: positive at the middle means a root in the lower half.
    #[inline(always)]
    fn new(coupling: &Coupling, bracket: &Bracket<I>, at_middle: Lanes<I>) -> Self {
        let n = coupling.omega2.len();
        let at_middle = at_middle.numbers();
        let mut index = [0.0; LANES];
        let (mut omega2, mut damping, mut phi2) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let lower = bracket.index(lane);
            let low = at_middle[lane] > 0.0 || lower + 1 == n;
            let nearest = if low { lower } else { lower + 1 };
            index[lane] = nearest as f64;
            omega2[lane] = coupling.omega2[nearest];
            damping[lane] = coupling.damping[nearest];
            phi2[lane] = coupling.phi[nearest] * coupling.phi[nearest];
        }
        Self {
            index: Lanes::new(index),
            omega2: Lanes::new(omega2),
            damping: Lanes::new(damping),
            phi2: Lanes::new(phi2),
        }
    }

    /// The damped pole itself.
    #[inline(always)]
    fn pole(&self) -> Complex<Lanes<I>> {
        let half = self.damping * Lanes::<I>::of(0.5);
        let im2 = (self.omega2 - half * half).max(Lanes::<I>::of(0.0));
        Complex::new(-half, im2.sqrt())
    }

    /// `yes` in the lanes whose nearest pole is not i.
    #[inline(always)]
    fn differs(&self, i: usize, yes: Lanes<I>, no: Lanes<I>) -> Lanes<I> {
        let apart = (Lanes::<I>::of(i as f64) - self.index).abs();
        Lanes::<I>::of(0.5).select_less(apart, yes, no)
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
fn middle_way<I: Instructions>(
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

/// Eigenvalues as distances from their nearest poles.
struct Eigenvalue<I: Instructions> {
    origin: Nearest<I>,
    pole: Complex<Lanes<I>>,
    delta: Complex<Lanes<I>>,
    value: Complex<Lanes<I>>,
}

impl<I: Instructions> Eigenvalue<I> {
    #[inline(always)]
    fn new(origin: Nearest<I>, pole: Complex<Lanes<I>>) -> Self {
        Self {
            origin,
            pole,
            delta: Complex::zero(),
            value: pole,
        }
    }

    #[inline(always)]
    fn set(&mut self, delta: Complex<Lanes<I>>) {
        self.delta = delta;
        self.value = self.pole + delta;
    }

    /// `D_o(s) = delta (2 p_o + c_o + delta)`
    #[inline(always)]
    fn own_pole(&self) -> Complex<Lanes<I>> {
        self.delta * (self.pole + self.value).plus(self.origin.damping)
    }

    /// `D_i(s) = (w_i^2 - w_o^2) + (c_i - c_o) p_o + delta (2 p_o + c_i + delta)`
    #[inline(always)]
    fn pole(&self, coupling: &Coupling, i: usize) -> Complex<Lanes<I>> {
        let damping = Lanes::<I>::of(coupling.damping[i]);
        let apart = Lanes::<I>::of(coupling.omega2[i]) - self.origin.omega2;
        let drift = self.pole.scale(damping - self.origin.damping);
        let near = self.delta * (self.pole + self.value).plus(damping);
        (near + drift).plus(apart)
    }
}
