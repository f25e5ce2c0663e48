//! A force that oscillates at one frequency.

use super::Moved;
use crate::error::{Error, Result, check_finite};
use crate::number::{Complex, Number};

/// `Re[amplitude exp(i omega t)]`
#[derive(Debug, Clone, PartialEq)]
pub struct Harmonic {
    /// Angular frequency, in rad/s.
    pub omega: f64,
    /// One for each mode.
    pub amplitude: Vec<Complex<f64>>,
    /// Amplitudes in m of the obstacles that it moves.
    pub motions: Vec<(Moved, Complex<f64>)>,
}

impl Harmonic {
    /// `cosine cos(omega t) + sine sin(omega t)`
    pub(super) fn new(omega: f64, cosine: &[f64], sine: &[f64]) -> Result<Self> {
        const WHAT: &str = "a harmonic load's frequency";
        check_finite(WHAT, &[omega])?;
        if omega <= 0.0 {
            return Err(Error::NotPositive {
                what: WHAT,
                value: omega,
            });
        }
        let both = cosine.iter().zip(sine);
        Ok(Self {
            omega,
            amplitude: both.map(|(c, s)| Complex::new(*c, -s)).collect(),
            motions: Vec::new(),
        })
    }

    pub(super) fn add(&mut self, other: &Self) {
        for (own, other) in self.amplitude.iter_mut().zip(&other.amplitude) {
            *own += *other;
        }
        self.motions.extend_from_slice(&other.motions);
    }

    /// `exp(i omega t)`. The angle is kept with what its rounding lacks, so that only the
    /// frequency's own last bit is felt after many periods.
    pub fn unit(&self, time: f64) -> Complex<f64> {
        let angle = self.omega * time;
        let lack = f64::mul_add(self.omega, time, -angle);
        let (sin, cos) = Number::sin_cos(angle);
        Complex::new(cos - lack * sin, sin + lack * cos)
    }
}
