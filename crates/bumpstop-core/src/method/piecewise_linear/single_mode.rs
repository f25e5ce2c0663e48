//! One mode by itself, `x'' + c x' + w2 x = p` with constant p, in closed form.
//!
//! Every regime has the form that keeps its accuracy: oscillation, overdamping (two real
//! exponentials), drift without stiffness, and two that no sum of exponentials serves well:
//! near critical damping, and so slow that the whole run is a small part of a period.

use crate::number::{Complex, Number};

/// Slow: `w T` and `c T` below this over the run's length T. Faster modes lose at most a
/// factor of a few in the cancellation of their exponentials.
const SLOW: f64 = 0.7;

/// Near critical: `|c^2/4 - w2|` below this part of `w2`. On either side the exponentials'
/// amplitudes grow by at most a hundred over the motion they sum to.
const NEAR_CRITICAL: f64 = 1e-4;

/// Terms of the Taylor series of a slow mode; `SLOW^20/20!` is far below rounding.
const TAYLOR_TERMS: usize = 20;

/// Rates `a lambda exp(lambda t)` of a mode's exponentials; zero where there is none.
pub(crate) type Rates = [Complex<f64>; 2];

/// The regime of a mode, with what its closed form needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Regime {
    /// `p/w2 + Re(a exp(lambda t))`
    Oscillating(Complex<f64>),
    /// `p/w2 + a exp(slow t) + b exp(fast t)`
    Overdamped { slow: f64, fast: f64 },
    /// `x0 + v0 t + p t^2/2`
    Free,
    /// `const + p t/c + a exp(-c t)`
    Coasting,
    /// `p/w2 + (x, v)` through hyperbolic or circular functions of `t sqrt(c^2/4 - w2)`.
    NearCritical,
    /// Taylor series from the start of the phase.
    Slow,
}

/// What is kept of a mode for a phase: its state at the start, less what follows the loads that
/// change in time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kept {
    pub x: f64,
    pub v: f64,
}

/// A mode's constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SingleMode {
    pub omega2: f64,
    pub damping: f64,
    pub force: f64,
    pub regime: Regime,
}

impl SingleMode {
    /// Chooses the regime for a run of the given length.
    #[inline(always)]
    pub(crate) fn new(omega2: f64, damping: f64, force: f64, duration: f64) -> Self {
        let half = 0.5 * damping;
        let discriminant = half * half - omega2;
        let regime = if omega2 == 0.0 && damping == 0.0 {
            Regime::Free
        } else if omega2.abs().sqrt() * duration < SLOW && damping * duration < SLOW {
            Regime::Slow
        } else if omega2 == 0.0 {
            Regime::Coasting
        } else if discriminant.abs() < NEAR_CRITICAL * omega2.abs() {
            Regime::NearCritical
        } else if discriminant < 0.0 {
            Regime::Oscillating(Complex::new(-half, (-discriminant).sqrt()))
        } else {
            let fast = -half - discriminant.sqrt();
            Regime::Overdamped {
                slow: omega2 / fast,
                fast,
            }
        };
        Self {
            omega2,
            damping,
            force,
            regime,
        }
    }

    /// The exponents that the mode adds to a phase.
    #[inline(always)]
    pub(crate) fn exponents(&self) -> ([Complex<f64>; 2], usize) {
        let none = Complex::zero();
        match self.regime {
            Regime::Oscillating(lambda) => ([lambda, none], 1),
            Regime::Overdamped { slow, fast } => ([Complex::real(slow), Complex::real(fast)], 2),
            Regime::Coasting => ([Complex::real(-self.damping), none], 1),
            Regime::Free | Regime::NearCritical | Regime::Slow => ([none; 2], 0),
        }
    }

    /// How many exponents the mode adds to a phase.
    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        match self.regime {
            Regime::Oscillating(_) | Regime::Coasting => 1,
            Regime::Overdamped { .. } => 2,
            Regime::Free | Regime::NearCritical | Regime::Slow => 0,
        }
    }

    /// Where it rests, if its motion is exponentials around that.
    #[inline(always)]
    pub(crate) fn rest(&self) -> Option<f64> {
        match self.regime {
            Regime::Oscillating(_) | Regime::Overdamped { .. } => Some(self.force / self.omega2),
            _ => None,
        }
    }

    /// Amplitudes of the exponents from the state at the start of a phase.
    #[inline(always)]
    pub(crate) fn amplitudes(&self, x0: f64, v0: f64) -> [Complex<f64>; 2] {
        let none = Complex::zero();
        match self.regime {
            Regime::Oscillating(lambda) => {
                let x = x0 - self.force / self.omega2;
                [Complex::new(x, -(v0 - lambda.re * x) / lambda.im), none]
            }
            Regime::Overdamped { slow, fast } => {
                let x = x0 - self.force / self.omega2;
                let gap = slow - fast;
                [
                    Complex::real((v0 - fast * x) / gap),
                    Complex::real((slow * x - v0) / gap),
                ]
            }
            Regime::Coasting => {
                let excess = v0 - self.force / self.damping;
                [Complex::real(-excess / self.damping), none]
            }
            _ => [none; 2],
        }
    }

    /// The polynomial part from the state at the start of a phase: three coefficients.
    pub(crate) fn polynomial(&self, x0: f64, v0: f64) -> [f64; 3] {
        match self.regime {
            Regime::Oscillating(_) | Regime::Overdamped { .. } => {
                [self.force / self.omega2, 0.0, 0.0]
            }
            Regime::Free => [x0, v0, 0.5 * self.force],
            Regime::Coasting => {
                let drift = self.force / self.damping;
                [x0 + (v0 - drift) / self.damping, drift, 0.0]
            }
            Regime::NearCritical | Regime::Slow => [0.0; 3],
        }
    }

    /// Whether the motion is neither exponentials nor a polynomial.
    #[inline(always)]
    pub(crate) fn is_special(&self) -> bool {
        matches!(self.regime, Regime::NearCritical | Regime::Slow)
    }

    /// Value and first three derivatives of a special mode at time t after the start.
    pub(crate) fn special(&self, kept: Kept, t: f64) -> [f64; 4] {
        let (x, v) = match self.regime {
            Regime::Slow => self.taylor(kept, t),
            _ => self.near_critical(kept.x, kept.v, t),
        };
        let a = self.force - self.damping * v - self.omega2 * x;
        [x, v, a, -self.damping * a - self.omega2 * v]
    }

    /// A bound of the third (`order` 3) or fourth (4) derivative of a special mode over a phase.
    pub(crate) fn special_bound(&self, order: usize, kept: Kept, duration: f64) -> f64 {
        let (w2, c, p) = (self.omega2, self.damping, self.force);
        let (x0, v0) = (kept.x, kept.v);
        if self.regime == Regime::Slow {
            // speed <= |v0| + (|p| + |w2| (|x0| + speed T)) T, and |w2| T^2 < 1/2.
            let speed = 2.0 * (v0.abs() + (p.abs() + w2.abs() * x0.abs()) * duration);
            let size = x0.abs() + speed * duration;
            let second = p.abs() + c * speed + w2.abs() * size;
            let third = c * second + w2.abs() * speed;
            return if order == 3 {
                third
            } else {
                c * third + w2.abs() * second
            };
        }
        // v^2 + w2 x^2 never grows (x from rest), and each derivative is some row . (v, x).
        let x = x0 - p / w2;
        let (mut of_v, mut of_x) = (1.0, 0.0);
        for _ in 1..order {
            (of_v, of_x) = (of_x - c * of_v, -w2 * of_v);
        }
        ((of_v * of_v + of_x * of_x / w2) * (v0 * v0 + w2 * x * x)).sqrt()
    }

    /// Integral of a special mode's displacement from the start of the phase to t.
    pub(crate) fn special_integral(&self, kept: Kept, t: f64) -> f64 {
        if self.regime == Regime::Slow {
            return gauss_legendre(t, |t| self.special(kept, t)[0]);
        }
        let [x, v, ..] = self.special(kept, t);
        (self.force * t - (v - kept.v) - self.damping * (x - kept.x)) / self.omega2
    }

    fn near_critical(&self, x0: f64, v0: f64, t: f64) -> (f64, f64) {
        let half = 0.5 * self.damping;
        let static_part = self.force / self.omega2;
        let x = x0 - static_part;
        let discriminant = half * half - self.omega2;
        let (cosh, sinhc) = hyperbolic(discriminant * t * t);
        let decay = Number::exp(-half * t);
        let (c, s) = (decay * cosh, decay * t * sinhc);
        (
            static_part + x * c + (v0 + half * x) * s,
            v0 * c - (half * v0 + self.omega2 * x) * s,
        )
    }

    fn taylor(&self, kept: Kept, t: f64) -> (f64, f64) {
        let (mut x, mut v) = (0.0, 0.0);
        let (mut low, mut high) = (kept.x, kept.v);
        let mut power = 1.0;
        for n in 0..TAYLOR_TERMS {
            x += low * power;
            v += high * power;
            let constant = if n == 0 { self.force } else { 0.0 };
            let next = constant - self.damping * high - self.omega2 * low;
            (low, high) = (high, next);
            power *= t / (n + 1) as f64;
        }
        (x, v)
    }

    /// `c` times the integral of the squared velocity from the start of the phase to t. The
    /// rates of the mode's exponentials at both ends are given.
    pub(crate) fn dissipation(&self, kept: Kept, t: f64, rates: [Rates; 2]) -> f64 {
        let c = self.damping;
        if c == 0.0 {
            return 0.0;
        }
        match self.regime {
            Regime::Oscillating(lambda) => {
                let primitive = |[z, _]: Rates| {
                    0.25 * ((z * z) * lambda.recip()).re + 0.25 * z.norm2() / lambda.re
                };
                c * (primitive(rates[1]) - primitive(rates[0]))
            }
            Regime::Overdamped { slow, fast } => {
                let primitive = |[a, b]: Rates| {
                    0.5 * (a.re * a.re / slow + b.re * b.re / fast)
                        + 2.0 * a.re * b.re / (slow + fast)
                };
                c * (primitive(rates[1]) - primitive(rates[0]))
            }
            Regime::Coasting => {
                let drift = self.force / c;
                let primitive = |[z, _]: Rates| (2.0 * drift * z.re + 0.5 * z.re * z.re) / c;
                c * (drift * drift * t - (primitive(rates[1]) - primitive(rates[0])))
            }
            Regime::NearCritical => {
                self.lyapunov(kept.x, kept.v) - {
                    let end = self.special(kept, t);
                    self.lyapunov(end[0], end[1])
                }
            }
            Regime::Slow => {
                let speed = |t: f64| self.special(kept, t)[1];
                c * gauss_legendre(t, |t| speed(t) * speed(t))
            }
            Regime::Free => 0.0,
        }
    }

    /// The quadratic form whose rate is `-c v^2`, for a constant force.
    fn lyapunov(&self, x: f64, v: f64) -> f64 {
        let x = x - self.force / self.omega2;
        0.5 * (v * v + self.omega2 * x * x)
    }
}

/// `cosh(sqrt z)` and `sinh(sqrt z)/sqrt z`, entire functions of z.
fn hyperbolic(z: f64) -> (f64, f64) {
    if z.abs() < 0.1 {
        let (mut cosh, mut sinhc) = (0.0, 0.0);
        let mut term = 1.0;
        for n in 0..10 {
            let even = 2.0 * f64::from(n);
            cosh += term;
            sinhc += term / (even + 1.0);
            term *= z / ((even + 1.0) * (even + 2.0));
        }
        (cosh, sinhc)
    } else if z > 0.0 {
        let root = z.sqrt();
        let (up, down) = (Number::exp(root), Number::exp(-root));
        (0.5 * (up + down), 0.5 * (up - down) / root)
    } else {
        let root = (-z).sqrt();
        let (sin, cos) = Number::sin_cos(root);
        (cos, sin / root)
    }
}

/// Integral from 0 to t by the Gauss-Legendre rule of eight points.
fn gauss_legendre(t: f64, f: impl Fn(f64) -> f64) -> f64 {
    const RULE: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    let half = 0.5 * t;
    let pair = |x: f64| f(half * (1.0 - x)) + f(half * (1.0 + x));
    half * RULE.iter().map(|(x, w)| w * pair(*x)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn free(x: f64, v: f64) -> Kept {
        Kept { x, v }
    }

    fn motion(mode: &SingleMode, x0: f64, v0: f64, t: f64) -> (f64, f64) {
        if mode.is_special() {
            let [x, v, ..] = mode.special(free(x0, v0), t);
            return (x, v);
        }
        let (exponents, count) = mode.exponents();
        let amplitudes = mode.amplitudes(x0, v0);
        let p = mode.polynomial(x0, v0);
        let (mut x, mut v) = (p[0] + t * (p[1] + t * p[2]), p[1] + 2.0 * t * p[2]);
        for i in 0..count {
            let z = amplitudes[i] * exponents[i].scale(t).exp();
            x += z.re;
            v += (z * exponents[i]).re;
        }
        (x, v)
    }

    /// Classical Runge-Kutta with Richardson's correction, sharing nothing with the code.
    fn reference(mode: &SingleMode, x0: f64, v0: f64, t: f64) -> (f64, f64) {
        let run = |steps: usize| {
            let h = t / steps as f64;
            let rate = |x: f64, v: f64| mode.force - mode.damping * v - mode.omega2 * x;
            let (mut x, mut v) = (x0, v0);
            for _ in 0..steps {
                let (k1, l1) = (v, rate(x, v));
                let (k2, l2) = (v + 0.5 * h * l1, rate(x + 0.5 * h * k1, v + 0.5 * h * l1));
                let (k3, l3) = (v + 0.5 * h * l2, rate(x + 0.5 * h * k2, v + 0.5 * h * l2));
                let (k4, l4) = (v + h * l3, rate(x + h * k3, v + h * l3));
                x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
                v += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
            }
            (x, v)
        };
        let (coarse, fine) = (run(1000), run(2000));
        (
            fine.0 + (fine.0 - coarse.0) / 15.0,
            fine.1 + (fine.1 - coarse.1) / 15.0,
        )
    }

    proptest! {
        #[test]
        fn every_regime_solves_the_equation(
            omega in prop_oneof![Just(0.0), 1e-4f64..0.1, 0.5f64..6.0],
            xi in prop_oneof![Just(0.0), Just(1.0), 0.001f64..0.9, 0.99999f64..1.00001, 1.1f64..3.0],
            coast in prop_oneof![Just(0.0), 1e-3f64..4.0],
            sign in prop_oneof![3 => Just(1.0), 1 => Just(-1.0)],
            force in -3.0f64..3.0, x0 in -1.0f64..1.0, v0 in -1.0f64..1.0, t in 0.1f64..2.0,
        ) {
            let damping = if omega == 0.0 { coast } else { 2.0 * xi * omega };
            let mode = SingleMode::new(sign * omega * omega, damping, force, 3.0);
            let (x, v) = motion(&mode, x0, v0, t);
            let (xr, vr) = reference(&mode, x0, v0, t);
            let scale = 10.0 + xr.abs() + vr.abs();
            prop_assert!((x - xr).abs() < 2e-11 * scale, "{mode:?}: {x} {xr}");
            prop_assert!((v - vr).abs() < 2e-11 * scale, "{mode:?}: {v} {vr}");
        }

        #[test]
        fn dissipation_is_the_integral_of_its_power(
            omega in prop_oneof![Just(0.0), 1e-4f64..0.1, 0.5f64..6.0],
            xi in prop_oneof![Just(1.0), 0.01f64..0.9, 1.1f64..3.0],
            coast in 1e-3f64..4.0,
            force in -3.0f64..3.0, x0 in -1.0f64..1.0, v0 in -1.0f64..1.0, t in 0.1f64..2.0,
        ) {
            let damping = if omega == 0.0 { coast } else { 2.0 * xi * omega };
            let mode = SingleMode::new(omega * omega, damping, force, 3.0);
            let pieces = 200;
            let h = t / f64::from(pieces);
            let expected: f64 = (0..pieces).map(|i| gauss_legendre(h, |s| {
                let v = motion(&mode, x0, v0, f64::from(i) * h + s).1;
                damping * v * v
            })).sum();
            let (exponents, _) = mode.exponents();
            let amplitudes = mode.amplitudes(x0, v0);
            let rates = [0.0, t].map(|t| {
                std::array::from_fn(|i| amplitudes[i] * exponents[i] * exponents[i].scale(t).exp())
            });
            let found = mode.dissipation(free(x0, v0), t, rates);
            prop_assert!((found - expected).abs() < 1e-10 * (1.0 + expected.abs()), "{mode:?}");
        }
    }
}
