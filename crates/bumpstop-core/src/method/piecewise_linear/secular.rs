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

use crate::number::{Complex, LANES, Lanes, Number, padded};

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
    pub(crate) fn solve(&self) -> Option<Roots> {
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
            self.solve_lanes(offset, &mut roots)?;
            offset += LANES;
        }
        Some(roots)
    }

    /// Eight roots at once, from the pole with number `offset` on.
    #[inline(always)]
    fn solve_lanes(&self, offset: usize, roots: &mut Roots) -> Option<()> {
        let bracket = Bracket::new(self, offset);
        let (origin, start) = self.undamped(&bracket);
        let lambda = self.damped(&bracket, origin, start)?;
        let live = |lane: usize| offset + lane < self.omega2.len();
        for lane in 0..LANES {
            if live(lane) && lambda.value.im.0[lane] <= 0.0 {
                return None;
            }
        }
        let keep = |x: Lanes| Lanes(std::array::from_fn(|l| if live(l) { x.0[l] } else { 0.0 }));
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
    fn undamped(&self, bracket: &Bracket) -> (Nearest, Undamped) {
        let k = Lanes::of(self.stiffness);
        let middle = (bracket.upper - bracket.lower) * Lanes::of(0.5);
        // The rest of f at the middle, all but the two poles beside the root.
        let mut rest = Lanes::of(1.0);
        for i in 0..self.omega2.len() {
            let z = k * Lanes::of(self.phi[i] * self.phi[i]);
            let distance = Lanes::of(self.omega2[i]) - bracket.lower - middle;
            let other = bracket.outside(i, Lanes::of(1.0), Lanes::of(0.0));
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
            let (mut below, mut below_slope) = (Lanes::of(0.0), Lanes::of(0.0));
            let (mut above, mut above_slope) = (Lanes::of(0.0), Lanes::of(0.0));
            sums = DampingSums::new(self);
            for i in 0..self.omega2.len() {
                let z = k * Lanes::of(self.phi[i] * self.phi[i]);
                let distance = Lanes::of(self.omega2[i]) - origin.omega2 - root;
                let inverse = Lanes::of(1.0) / distance;
                let term = z * inverse;
                let slope = term * inverse;
                sums.add(self.damping[i], slope);
                let is_below = bracket.below(i, Lanes::of(1.0), Lanes::of(0.0));
                let is_above = Lanes::of(1.0) - is_below;
                below += is_below * term;
                below_slope += is_below * slope;
                above += is_above * term;
                above_slope += is_above * slope;
            }
            let (to_low, to_high) = (low - root, high - root);
            let constant =
                Lanes::of(1.0) + (below - to_low * below_slope) + (above - to_high * above_slope);
            let (weight_low, weight_high) =
                (to_low * to_low * below_slope, to_high * to_high * above_slope);
            root = middle_way(constant, weight_low, weight_high, low, high, root);
        }
        (
            origin,
            Undamped {
                root,
                damping: sums.ratio(self),
            },
        )
    }

    /// Newton's method on `D_o f`, all lanes together.
    #[inline(always)]
    fn damped(
        &self,
        bracket: &Bracket,
        origin: Nearest,
        start: Undamped,
    ) -> Option<Eigenvalue> {
        let pole = origin.pole();
        let mu = origin.omega2 + start.root;
        let half = start.damping * Lanes::of(0.5);
        let guess = Complex::new(-half, (mu - half * half).max(Lanes::of(0.0)).sqrt());
        // s - p_o without cancellation: (s^2 + c_o s + w_o^2) / (s - conj p_o), to first order.
        let slope = (guess - pole.conj()).norm2();
        let first = Complex::new(
            -start.root + (origin.damping - start.damping) * guess.re,
            (origin.damping - start.damping) * guess.im,
        );
        let mut eigenvalue = Eigenvalue::new(origin, pole);
        let careful = slope.0.iter().all(|s| *s > 0.0);
        let delta = if careful {
            first * (guess - pole.conj()).conj().scale(Lanes::of(1.0) / slope)
        } else {
            guess - pole
        };
        eigenvalue.set(delta);
        let k = Lanes::of(self.stiffness);
        let c = Lanes::of(self.stop_damping);
        for _ in 0..NEWTON_STEPS {
            let s = eigenvalue.value;
            let kappa = Complex::new(k + c * s.re, c * s.im);
            let mut sum = Complex::zero();
            let mut slope = Complex::zero();
            for i in 0..self.omega2.len() {
                let phi2 = Lanes::of(self.phi[i] * self.phi[i]);
                let d = eigenvalue.pole(self, i);
                let zero = Lanes::of(0.0);
                let weight = origin.differs(i, phi2, zero);
                let norm = origin.differs(i, d.norm2(), Lanes::of(1.0));
                let inverse = d.conj().scale(Lanes::of(1.0) / norm);
                let term = inverse.scale(weight);
                sum += term;
                let rate = Complex::new(
                    Lanes::of(2.0) * s.re + Lanes::of(self.damping[i]),
                    Lanes::of(2.0) * s.im,
                );
                slope = slope - term * inverse * rate;
            }
            let own = eigenvalue.own_pole();
            let own_rate = Complex::new(
                Lanes::of(2.0) * s.re + origin.damping,
                Lanes::of(2.0) * s.im,
            );
            let inner = (own * sum).plus(origin.phi2);
            let value = own + kappa * inner;
            let rate = own_rate + inner.scale(c) + kappa * (own_rate * sum + own * slope);
            let step = value * rate.recip();
            eigenvalue.set(eigenvalue.delta - step);
            let tolerance = Lanes::of(CONVERGED * CONVERGED) * eigenvalue.delta.norm2();
            let size = step.norm2();
            let done = |lane: usize| {
                size.0[lane] <= tolerance.0[lane] || bracket.first + lane >= self.omega2.len()
            };
            if (0..LANES).all(done) {
                return Some(eigenvalue);
            }
        }
        None
    }
}

/// The poles on either side of eight consecutive undamped roots.
struct Bracket {
    first: usize,
    count: usize,
    lower: Lanes,
    upper: Lanes,
    phi2_lower: Lanes,
    phi2_upper: Lanes,
}

impl Bracket {
    #[inline(always)]
    fn new(coupling: &Coupling, first: usize) -> Self {
        let n = coupling.omega2.len();
        let total: f64 = coupling.phi.iter().map(|p| p * p).sum();
        // No root lies above the last pole by more than k sum phi^2: a pole without weight.
        let beyond = coupling.omega2[n - 1] + 1.000_001 * coupling.stiffness * total;
        let index = |lane: usize| (first + lane).min(n - 1);
        let at = |i: usize| if i < n { coupling.omega2[i] } else { beyond };
        let phi2 = |i: usize| if i < n { coupling.phi[i] * coupling.phi[i] } else { 0.0 };
        Self {
            first,
            count: n,
            lower: Lanes(std::array::from_fn(|l| at(index(l)))),
            upper: Lanes(std::array::from_fn(|l| at(index(l) + 1))),
            phi2_lower: Lanes(std::array::from_fn(|l| phi2(index(l)))),
            phi2_upper: Lanes(std::array::from_fn(|l| phi2(index(l) + 1))),
        }
    }

    #[inline(always)]
    fn index(&self, lane: usize) -> usize {
        (self.first + lane).min(self.count - 1)
    }

    /// `yes` in the lanes whose root lies above pole i.
    #[inline(always)]
    fn below(&self, i: usize, yes: Lanes, no: Lanes) -> Lanes {
        Lanes(std::array::from_fn(|l| {
            if i <= self.index(l) { yes.0[l] } else { no.0[l] }
        }))
    }

    /// `yes` in the lanes for which pole i is not beside the root.
    #[inline(always)]
    fn outside(&self, i: usize, yes: Lanes, no: Lanes) -> Lanes {
        Lanes(std::array::from_fn(|l| {
            let at = self.index(l);
            if i != at && i != at + 1 { yes.0[l] } else { no.0[l] }
        }))
    }
}

/// The pole nearest to each root.
#[derive(Clone, Copy)]
struct Nearest {
    index: [usize; LANES],
    omega2: Lanes,
    damping: Lanes,
    phi2: Lanes,
}

impl Nearest {
    /// f increases between poles: positive at the middle means a root in the lower half.
    #[inline(always)]
    fn new(coupling: &Coupling, bracket: &Bracket, at_middle: Lanes) -> Self {
        let n = coupling.omega2.len();
        let index: [usize; LANES] = std::array::from_fn(|l| {
            let lower = bracket.index(l);
            if at_middle.0[l] > 0.0 || lower + 1 == n { lower } else { lower + 1 }
        });
        Self {
            index,
            omega2: Lanes(index.map(|i| coupling.omega2[i])),
            damping: Lanes(index.map(|i| coupling.damping[i])),
            phi2: Lanes(index.map(|i| coupling.phi[i] * coupling.phi[i])),
        }
    }

    /// The damped pole itself.
    #[inline(always)]
    fn pole(&self) -> Complex<Lanes> {
        let half = self.damping * Lanes::of(0.5);
        let im2 = (self.omega2 - half * half).max(Lanes::of(0.0));
        Complex::new(-half, im2.sqrt())
    }

    /// `yes` in the lanes whose nearest pole is not i.
    #[inline(always)]
    fn differs(&self, i: usize, yes: Lanes, no: Lanes) -> Lanes {
        Lanes(std::array::from_fn(|l| {
            if self.index[l] == i { no.0[l] } else { yes.0[l] }
        }))
    }
}

/// An undamped root: `mu - w_o^2` and its first-order damping.
struct Undamped {
    root: Lanes,
    damping: Lanes,
}

/// `c = x' C x / x' x` of the undamped shape, the damper of the stop included.
struct DampingSums {
    weighted: Lanes,
    total: Lanes,
}

impl DampingSums {
    #[inline(always)]
    fn new(coupling: &Coupling) -> Self {
        // sum z/(w_i^2 - mu) = -1 at a root, so the damper adds (c/k) in these units.
        Self {
            weighted: Lanes::of(coupling.stop_damping / coupling.stiffness),
            total: Lanes::of(0.0),
        }
    }

    #[inline(always)]
    fn add(&mut self, damping: f64, slope: Lanes) {
        self.weighted += Lanes::of(damping) * slope;
        self.total += slope;
    }

    #[inline(always)]
    fn ratio(&self, _: &Coupling) -> Lanes {
        self.weighted / self.total
    }
}

/// The zero of `constant + low/(a - y) + high/(b - y)` between a and b; `fallback` where the
/// formula leaves the interval.
#[inline(always)]
fn middle_way(
    constant: Lanes,
    low: Lanes,
    high: Lanes,
    a: Lanes,
    b: Lanes,
    present: Lanes,
) -> Lanes {
    // With x = y - present the poles lie at da < 0 < db.
    let (da, db) = (a - present, b - present);
    let linear = constant * (da + db) + low + high;
    let last = constant * da * db + low * db + high * da;
    let discriminant = (linear * linear - Lanes::of(4.0) * constant * last).max(Lanes::of(0.0));
    let root = discriminant.sqrt();
    Lanes(std::array::from_fn(|l| {
        let x = if linear.0[l] <= 0.0 {
            (linear.0[l] - root.0[l]) / (2.0 * constant.0[l])
        } else {
            2.0 * last.0[l] / (linear.0[l] + root.0[l])
        };
        let inside = x > da.0[l] && x < db.0[l];
        let y = present.0[l] + x;
        let tame = y > a.0[l] && y < b.0[l];
        if inside && tame { y } else { 0.5 * (a.0[l] + b.0[l]) }
    }))
}

/// Eigenvalues as distances from their nearest poles.
struct Eigenvalue {
    origin: Nearest,
    pole: Complex<Lanes>,
    delta: Complex<Lanes>,
    value: Complex<Lanes>,
}

impl Eigenvalue {
    #[inline(always)]
    fn new(origin: Nearest, pole: Complex<Lanes>) -> Self {
        Self {
            origin,
            pole,
            delta: Complex::zero(),
            value: pole,
        }
    }

    #[inline(always)]
    fn set(&mut self, delta: Complex<Lanes>) {
        self.delta = delta;
        self.value = self.pole + delta;
    }

    /// `D_o(s) = delta (2 p_o + c_o + delta)`
    #[inline(always)]
    fn own_pole(&self) -> Complex<Lanes> {
        self.delta * (self.pole + self.value).plus(self.origin.damping)
    }

    /// `D_i(s) = (w_i^2 - w_o^2) + (c_i - c_o) p_o + delta (2 p_o + c_i + delta)`
    #[inline(always)]
    fn pole(&self, coupling: &Coupling, i: usize) -> Complex<Lanes> {
        let damping = Lanes::of(coupling.damping[i]);
        let apart = Lanes::of(coupling.omega2[i]) - self.origin.omega2;
        let drift = self.pole.scale(damping - self.origin.damping);
        let near = self.delta * (self.pole + self.value).plus(damping);
        (near + drift).plus(apart)
    }
}
