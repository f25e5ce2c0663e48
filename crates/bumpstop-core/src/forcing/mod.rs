//! Modal forces as functions of time that the core integrates exactly.
//!
//! `p(t) = constant + sum_k direction_k f_k(t) + sum_m Re[(cosine_m - i sine_m) exp(i omega_m t)]`
//! with polynomials and tables f_k. Over a phase each f_k is a polynomial in the time since the
//! phase began, and each harmonic a turning complex number: [`Onset`] keeps both.
//!
//! The same functions move obstacles: what they add up to is taken off the first local coordinate
//! of a law.

mod harmonic;
mod table;

mod motion;
mod scaled;

pub use harmonic::Harmonic;
pub use motion::Moved;
pub use table::{Beyond, Table};

use crate::error::{Error, Result, check_finite, check_length};
use crate::number::Complex;

/// The highest degree of a polynomial in time.
pub const HIGHEST_DEGREE: usize = 5;

/// A force along one modal vector.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Modal forces at the value one, in N per unit modal displacement.
    pub direction: Vec<f64>,
    /// What it moves, if that is an obstacle; the direction is zero then.
    pub moves: Option<Moved>,
    /// How it changes.
    pub history: History,
}

/// How a force along one modal vector changes.
#[derive(Debug, Clone, PartialEq)]
pub enum History {
    /// Coefficients of the powers of t, the constant first.
    Polynomial(Vec<f64>),
    /// Straight lines between knots.
    Table(Table),
}

/// The forces around the start of a phase.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Onset {
    /// For each channel the coefficients of its polynomial in the time since the start,
    /// [`Forcing::stride`] of them.
    pub coefficients: Vec<f64>,
    /// `exp(i omega start)` for each harmonic.
    pub units: Vec<Complex<f64>>,
}

/// Modal forces of the loads.
#[derive(Debug, Clone, PartialEq)]
pub struct Forcing {
    constant: Vec<f64>,
    channels: Vec<Channel>,
    harmonics: Vec<Harmonic>,
}

impl Forcing {
    /// Forces that do not change, one for each mode, in N per unit modal displacement.
    ///
    /// # Errors
    /// When a force is not finite.
    pub fn constant(forces: Vec<f64>) -> Result<Self> {
        check_finite("force", &forces)?;
        Ok(Self {
            constant: forces,
            channels: Vec::new(),
            harmonics: Vec::new(),
        })
    }

    /// Adds `direction (c_0 + c_1 t + c_2 t^2 + ...)`, t from the start of the run.
    ///
    /// # Errors
    /// When a number is not finite, the direction has the wrong length, or the degree is above
    /// [`HIGHEST_DEGREE`].
    pub fn with_polynomial(mut self, direction: Vec<f64>, coefficients: Vec<f64>) -> Result<Self> {
        self.check_direction(&direction)?;
        check_finite("a load's polynomial", &coefficients)?;
        if coefficients.len() > HIGHEST_DEGREE + 1 {
            return Err(Error::Degree {
                found: coefficients.len() - 1,
                highest: HIGHEST_DEGREE,
            });
        }
        self.channels.push(Channel {
            direction,
            moves: None,
            history: History::Polynomial(coefficients),
        });
        Ok(self)
    }

    /// Adds `direction` times a piecewise-linear function of time.
    ///
    /// # Errors
    /// When a number is not finite or the direction has the wrong length.
    pub fn with_table(mut self, direction: Vec<f64>, table: Table) -> Result<Self> {
        self.check_direction(&direction)?;
        self.channels.push(Channel {
            direction,
            moves: None,
            history: History::Table(table),
        });
        Ok(self)
    }

    /// Adds `cosine cos(omega t) + sine sin(omega t)`, omega in rad/s. Harmonics of one frequency
    /// are joined.
    ///
    /// # Errors
    /// When a number is not finite, a vector has the wrong length, or the frequency is not
    /// positive.
    pub fn with_harmonic(mut self, omega: f64, cosine: &[f64], sine: &[f64]) -> Result<Self> {
        self.check_direction(cosine)?;
        self.check_direction(sine)?;
        let fresh = Harmonic::new(omega, cosine, sine)?;
        self.join(fresh);
        Ok(self)
    }

    fn join(&mut self, fresh: Harmonic) {
        match self.harmonics.iter_mut().find(|h| h.omega == fresh.omega) {
            Some(known) => known.add(&fresh),
            None => self.harmonics.push(fresh),
        }
    }

    fn check_direction(&self, direction: &[f64]) -> Result<()> {
        check_length("a load's direction", direction, self.constant.len())?;
        check_finite("a load's direction", direction)
    }

    /// The forces that do not change.
    pub fn forces(&self) -> &[f64] {
        &self.constant
    }

    /// Polynomials and tables.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Harmonics, no two of one frequency.
    pub fn harmonics(&self) -> &[Harmonic] {
        &self.harmonics
    }

    /// Whether some force changes in time.
    #[inline(always)]
    pub fn varies(&self) -> bool {
        !(self.channels.is_empty() && self.harmonics.is_empty())
    }

    /// Coefficients that each channel has in an [`Onset`].
    pub fn stride(&self) -> usize {
        let lengths = self.channels.iter().map(|c| c.history.coefficients());
        lengths.max().unwrap_or(0)
    }

    /// The forces at a time, in N per unit modal displacement; just after it where they jump.
    pub fn at(&self, time: f64, to: &mut [f64]) {
        to.copy_from_slice(&self.constant);
        for channel in &self.channels {
            let value = channel.history.at(time);
            for (force, direction) in to.iter_mut().zip(&channel.direction) {
                *force += direction * value;
            }
        }
        for harmonic in &self.harmonics {
            let unit = harmonic.unit(time);
            for (force, amplitude) in to.iter_mut().zip(&harmonic.amplitude) {
                *force += amplitude.real_product(unit);
            }
        }
    }

    /// The forces of the loads, without the motions of obstacles, at a time and their rates just
    /// after it.
    pub fn around(&self, time: f64) -> [Vec<f64>; 2] {
        let (mut forces, mut rates) = (self.constant.clone(), vec![0.0; self.constant.len()]);
        self.at(time, &mut forces);
        let mut onset = Onset::default();
        self.onset(time, &mut Vec::new(), &mut onset);
        let stride = self.stride().max(1);
        for (channel, coefficients) in self.channels.iter().zip(onset.coefficients.chunks(stride)) {
            let slope = coefficients.get(1).copied().unwrap_or(0.0);
            for (rate, direction) in rates.iter_mut().zip(&channel.direction) {
                *rate += direction * slope;
            }
        }
        for harmonic in &self.harmonics {
            let turning = harmonic.unit(time) * Complex::new(0.0, harmonic.omega);
            for (rate, amplitude) in rates.iter_mut().zip(&harmonic.amplitude) {
                *rate += amplitude.real_product(turning);
            }
        }
        [forces, rates]
    }

    /// The forces around a time. `places` remembers where in its table each channel stands.
    pub fn onset(&self, start: f64, places: &mut Vec<usize>, to: &mut Onset) {
        let stride = self.stride();
        places.resize(self.channels.len(), 0);
        to.coefficients.clear();
        to.coefficients.resize(self.channels.len() * stride, 0.0);
        let channels = self.channels.iter().zip(places.iter_mut());
        for ((channel, place), to) in channels.zip(to.coefficients.chunks_mut(stride.max(1))) {
            match &channel.history {
                History::Polynomial(coefficients) => shift(coefficients, start, to),
                History::Table(table) => {
                    *place = table.place_from(*place, start);
                    to[..2].copy_from_slice(&table.line(*place, start));
                }
            }
        }
        to.units.clear();
        to.units
            .extend(self.harmonics.iter().map(|h| h.unit(start)));
    }

    /// The first knot of a table after the time at which `places` were set; infinity without one.
    pub fn next_knot(&self, places: &[usize]) -> f64 {
        let mut next = f64::INFINITY;
        for (channel, place) in self.channels.iter().zip(places) {
            if let History::Table(table) = &channel.history {
                next = next.min(table.knot(*place));
            }
        }
        next
    }

    /// Time between the last knot of any table and the next one, around the time at which `places`
    /// were set; infinite where there is none on either side.
    pub fn stretch(&self, places: &[usize]) -> f64 {
        let (mut last, mut next) = (f64::NEG_INFINITY, f64::INFINITY);
        for (channel, place) in self.channels.iter().zip(places) {
            if let History::Table(table) = &channel.history {
                last = last.max(table.knot_before(*place));
                next = next.min(table.knot(*place));
            }
        }
        next - last
    }

    /// Power of the forces that change, in W.
    pub fn changing_power(&self, time: f64, velocity: &[f64]) -> f64 {
        if !self.varies() {
            return 0.0;
        }
        let mut forces = vec![0.0; velocity.len()];
        self.at(time, &mut forces);
        let changing = forces.iter().zip(&self.constant).map(|(p, c)| p - c);
        changing.zip(velocity).map(|(p, v)| p * v).sum()
    }

    /// Work of the constant forces between two modal displacements, in J.
    pub fn work(&self, from: &[f64], to: &[f64]) -> f64 {
        (self.constant.iter().zip(from).zip(to))
            .map(|((p, a), b)| p * (b - a))
            .sum()
    }
}

impl History {
    /// Coefficients of its polynomial over a phase.
    fn coefficients(&self) -> usize {
        match self {
            Self::Polynomial(coefficients) => coefficients.len(),
            Self::Table(_) => 2,
        }
    }

    fn at(&self, time: f64) -> f64 {
        match self {
            Self::Polynomial(c) => c.iter().rev().fold(0.0, |value, c| value * time + c),
            Self::Table(table) => table.line(table.place(time), time)[0],
        }
    }
}

/// Taylor's shift: the coefficients of `sum c_n (start + x)^n` in x, by repeated synthetic
/// division.
fn shift(coefficients: &[f64], start: f64, to: &mut [f64]) {
    let count = coefficients.len();
    to[..count].copy_from_slice(coefficients);
    for lowest in 0..count.saturating_sub(1) {
        for n in (lowest..count - 1).rev() {
            to[n] += start * to[n + 1];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_onset_continues_the_forces() {
        let table = Table::new(
            vec![0.1, 0.4, 0.4, 1.0],
            vec![1.0, 2.0, -1.0, 0.5],
            Beyond::Zero,
        );
        let forcing = (Forcing::constant(vec![1.0, -2.0]).unwrap())
            .with_polynomial(vec![1.0, 0.5], vec![3.0, -1.0, 2.0, 0.25])
            .and_then(|f| f.with_table(vec![0.0, 2.0], table.unwrap()))
            .and_then(|f| f.with_harmonic(7.0, &[1.0, 0.0], &[0.0, 2.0]))
            .unwrap();
        let (mut places, mut onset) = (Vec::new(), Onset::default());
        for start in [0.0, 0.1, 0.25, 0.4, 0.7, 1.0, 3.0] {
            forcing.onset(start, &mut places, &mut onset);
            let next = forcing.next_knot(&places);
            assert!(next > start);
            let x = 0.5 * (next - start).min(0.2);
            let mut expected = [0.0; 2];
            forcing.at(start + x, &mut expected);
            let value = |k: usize| {
                let c = &onset.coefficients[k * 4..][..4];
                c.iter().rev().fold(0.0, |value, c| value * x + c)
            };
            let (sin, cos) = (7.0 * (start + x)).sin_cos();
            let found = [
                1.0 + value(0) + cos,
                -2.0 + 0.5 * value(0) + 2.0 * value(1) + 2.0 * sin,
            ];
            for (a, b) in found.iter().zip(expected) {
                assert!((a - b).abs() < 1e-13, "{start}: {a} {b}");
            }
            let turned = onset.units[0] * Complex::new(0.0, 7.0 * x).exp();
            assert!((turned.re - cos).abs() < 1e-14 && (turned.im - sin).abs() < 1e-14);
        }
    }

    #[test]
    fn high_degrees_and_strange_numbers_are_refused() {
        let forcing = || Forcing::constant(vec![0.0]).unwrap();
        assert!(forcing().with_polynomial(vec![1.0], vec![0.0; 7]).is_err());
        assert!(
            forcing()
                .with_polynomial(vec![1.0, 2.0], vec![0.0])
                .is_err()
        );
        assert!(forcing().with_harmonic(0.0, &[1.0], &[0.0]).is_err());
        assert!(forcing().with_harmonic(f64::NAN, &[1.0], &[0.0]).is_err());
        assert!(!forcing().varies());
    }
}
