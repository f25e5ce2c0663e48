//! How the structure follows loads that change in time, one response a spectrum.
//!
//! With `s` for the time derivative the motion under a force `p` is `(s^2 + C s + K)^-1 p`. A load
//! that is a polynomial f of the time along a vector g is followed by another polynomial,
//!
//! ```text
//! sum_m a_m f^(m),   K a_m = -C a_(m-1) - a_(m-2),   K a_0 = g,
//! ```
//!
//! the series of the inverse around s = 0. Where a single motion has no stiffness the series
//! begins with integrals of f (orders -1 and -2), taken from the start of the phase. A harmonic
//! load is followed by `(K + i omega C - omega^2)^-1 g exp(i omega t)`: one more exponent of the
//! phase, the same in all modes. What is left, the state less both at the start of the phase, moves
//! freely. Where load and motion resonate the part of the resonant exponent is split off, see
//! [`super::resonance`].

mod gradual;
mod parts;
mod single;
mod slow;

pub(crate) use gradual::{POWERS, Series};
pub(crate) use single::is_slow;

use super::impedance::Impedance;
use super::polynomial::derivative_at;
use super::resonance::{Resonant, resonates};
use super::rows::entry;
use super::spectrum::Spectrum;
use crate::error::{Error, Result};
use crate::forcing::{Forcing, Harmonic, Onset};
use crate::number::{Complex, LANES};
use gradual::{Gradual, series_of_others, value_and_slope};
use parts::{ComplexParts, Parts};
use slow::SlowLoad;

/// A vector that a derivative of a channel's function moves the modes along.
#[derive(Debug, Clone)]
pub(crate) struct Link {
    pub channel: usize,
    /// Order of the derivative; integrals are negative.
    pub order: i32,
    pub row: Vec<f64>,
}

/// A harmonic load that resonates with an exponent, and how the modes take part.
#[derive(Debug, Clone)]
pub(crate) struct Resonance {
    pub lambda: Complex<f64>,
    pub harmonic: usize,
    pub row: Vec<Complex<f64>>,
}

/// The response of all modes.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    modes: usize,
    duration: f64,
    /// Coefficients of each channel.
    pub stride: usize,
    pub links: Vec<Link>,
    /// Where the exponents of the harmonics begin.
    pub at: usize,
    pub omegas: Vec<f64>,
    /// How the modes follow each harmonic.
    pub shapes: Vec<Vec<Complex<f64>>>,
    pub resonances: Vec<Resonance>,
    pub gradual: Vec<Gradual>,
    slow: Vec<SlowLoad>,
}

impl Response {
    /// The response of a spectrum whose exponents are known; `impedance` is that of its groups.
    pub(crate) fn new(
        forcing: &Forcing,
        spectrum: &Spectrum,
        impedance: Option<&Impedance<'_>>,
        duration: f64,
    ) -> Result<Self> {
        let mut response = Self {
            modes: forcing.forces().len(),
            duration,
            stride: forcing.stride(),
            links: Vec::new(),
            at: spectrum.forced_at,
            omegas: forcing.harmonics().iter().map(|h| h.omega).collect(),
            shapes: Vec::new(),
            resonances: Vec::new(),
            gradual: Vec::new(),
            slow: SlowLoad::list(forcing, spectrum, duration),
        };
        let channels = forcing.channels().iter();
        let directions: Vec<_> = channels.map(|load| load.direction.as_slice()).collect();
        let modes = response.modes;
        response.gradual = Gradual::list(&directions, spectrum, modes, duration);
        for (channel, load) in forcing.channels().iter().enumerate() {
            response.add_links(channel, &load.direction, spectrum, impedance)?;
        }
        for (number, harmonic) in forcing.harmonics().iter().enumerate() {
            response.add_shape(number, harmonic, spectrum, impedance)?;
        }
        Ok(response)
    }

    /// Numbers in its arrays.
    pub(crate) fn numbers(&self) -> usize {
        let modes = self.links.iter().map(|link| link.row.len()).sum::<usize>();
        modes + 2 * self.shapes.iter().map(Vec::len).sum::<usize>()
    }

    fn add_links(
        &mut self,
        channel: usize,
        direction: &[f64],
        spectrum: &Spectrum,
        impedance: Option<&Impedance<'_>>,
    ) -> Result<()> {
        let parts = Parts::of(spectrum, direction);
        let groups = match series_of_others(spectrum, &parts, self.stride, self.duration) {
            Some(series) => series,
            None => group_series(&parts.combined, impedance, self.stride)?,
        };
        let singles: Vec<_> = (spectrum.singles.iter().zip(&parts.singles))
            .map(|(single, force)| {
                single::series(&single.motion, *force, self.stride, self.duration)
            })
            .collect();
        for (number, order) in (-2..self.stride as i32).enumerate() {
            let zero = vec![0.0; spectrum.combinations];
            let of_groups = usize::try_from(order).ok().and_then(|m| groups.get(m));
            let parts = Parts {
                combined: of_groups.cloned().unwrap_or(zero),
                singles: singles.iter().map(|series| series[number]).collect(),
            };
            let row = parts.modes(spectrum, self.modes);
            // A reaction resists a load even where nothing moves.
            let is_resisted = order == 0 && spectrum.held.is_some();
            if is_resisted || row.iter().any(|x| *x != 0.0) {
                self.links.push(Link {
                    channel,
                    order,
                    row,
                });
            }
        }
        Ok(())
    }

    fn add_shape(
        &mut self,
        number: usize,
        harmonic: &Harmonic,
        spectrum: &Spectrum,
        impedance: Option<&Impedance<'_>>,
    ) -> Result<()> {
        let forces = ComplexParts::of(spectrum, &harmonic.amplitude);
        let mut shape = ComplexParts::zero(spectrum);
        if let Some(impedance) = impedance {
            shape.combined = self.group_shape(number, &forces.combined, spectrum, impedance)?;
        }
        for (index, single) in spectrum.singles.iter().enumerate() {
            let force = forces.singles[index];
            let (follows, partner) =
                single::shape(&single.motion, harmonic.omega, force, self.duration);
            shape.singles[index] = follows;
            if let Some(partner) = partner.filter(|_| force.norm2() > 0.0) {
                let mut alone = ComplexParts::zero(spectrum);
                alone.singles[index] = partner.weight;
                let row = alone.modes(spectrum, self.modes);
                self.resonances.push(Resonance {
                    lambda: partner.lambda,
                    harmonic: number,
                    row,
                });
            }
        }
        self.shapes.push(shape.modes(spectrum, self.modes));
        Ok(())
    }

    /// How the coupled groups follow a harmonic. By the sum over their exponents
    /// `shape_j l_j p / (i omega - lambda_j)` where one of them resonates.
    fn group_shape(
        &mut self,
        number: usize,
        forces: &[Complex<f64>],
        spectrum: &Spectrum,
        impedance: &Impedance<'_>,
    ) -> Result<Vec<Complex<f64>>> {
        let omega = self.omegas[number];
        let exponents = 0..spectrum.coupled_width * LANES;
        let lambda = |j: usize| entry(&spectrum.lambda, j);
        let none = |z: Complex<f64>| z.norm2() == 0.0;
        let resonant = |j: &usize| !none(lambda(*j)) && resonates(omega, lambda(*j), self.duration);
        if !exponents.clone().any(|j| resonant(&j)) {
            return impedance.harmonic(omega, forces);
        }
        if (spectrum.clusters.iter()).any(|c| resonant(&c.at)) {
            return Err(Error::NoRest);
        }
        let turn = Complex::new(0.0, omega);
        let mut shape = vec![Complex::zero(); spectrum.groups];
        let alone = |j: &usize| !spectrum.clusters.iter().any(|cluster| cluster.holds(*j));
        for j in exponents.filter(|j| !none(lambda(*j)) && alone(j)) {
            // Half of the real force belongs to exp(i omega t), half to its conjugate.
            let (mut with, mut against) = (Complex::zero(), Complex::zero());
            for (group, force) in forces.iter().enumerate() {
                let left = entry(spectrum.left_velocity(group), j).scale(0.5);
                with += left * *force;
                against += left.conj() * *force;
            }
            let mut row = ComplexParts::zero(spectrum);
            for (group, shape) in shape.iter_mut().enumerate() {
                let own = entry(spectrum.shape(group), j);
                let conjugate = own.conj() * against * (turn - lambda(j).conj()).recip();
                *shape += conjugate;
                if resonant(&j) {
                    row.combined[group] = own * with;
                } else {
                    *shape += own * with * (turn - lambda(j)).recip();
                }
            }
            if resonant(&j) {
                self.resonances.push(Resonance {
                    lambda: lambda(j),
                    harmonic: number,
                    row: row.modes(spectrum, self.modes),
                });
            }
        }
        for cluster in &spectrum.clusters {
            cluster.add_harmonic(spectrum, turn, forces, &mut shape);
        }
        Ok(shape)
    }

    /// A resonance with the load's phase and a weight of its own.
    pub(crate) fn resonant(
        &self,
        resonance: &Resonance,
        unit: Complex<f64>,
        weight: Complex<f64>,
    ) -> Resonant {
        Resonant {
            lambda: resonance.lambda,
            omega: self.omegas[resonance.harmonic],
            at: self.at + resonance.harmonic,
            weight: weight * unit,
        }
    }

    /// Adds displacement and velocity of all modes, times `sign`, `t` after the start of a phase:
    /// `units` are the harmonics' exponentials at the start.
    pub(crate) fn add_motion(
        &self,
        sign: f64,
        coefficients: &[f64],
        units: impl Fn(usize) -> Complex<f64>,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) {
        for link in &self.links {
            let channel = &coefficients[link.channel * self.stride..][..self.stride];
            let value = sign * derivative_at(channel, link.order, t);
            let slope = sign * derivative_at(channel, link.order + 1, t);
            for ((q, v), row) in q.iter_mut().zip(v.iter_mut()).zip(&link.row) {
                *q += row * value;
                *v += row * slope;
            }
        }
        for gradual in &self.gradual {
            let columns = gradual.series(coefficients, self.stride);
            for (series, row) in columns.iter().zip(&gradual.rows) {
                let [value, slope] = value_and_slope(series, t).map(|z| z.scale(sign));
                for ((q, v), row) in q.iter_mut().zip(v.iter_mut()).zip(row) {
                    *q = row.add_real_product(value, *q);
                    *v = row.add_real_product(slope, *v);
                }
            }
        }
        for (number, (shape, omega)) in self.shapes.iter().zip(&self.omegas).enumerate() {
            let turned = units(number) * Complex::new(0.0, omega * t).exp();
            let value = turned.scale(sign);
            let slope = value * Complex::new(0.0, *omega);
            for ((q, v), shape) in q.iter_mut().zip(v.iter_mut()).zip(shape) {
                *q = shape.add_real_product(value, *q);
                *v = shape.add_real_product(slope, *v);
            }
        }
        for resonance in &self.resonances {
            let unit = units(resonance.harmonic).scale(sign);
            for (mode, row) in resonance.row.iter().enumerate() {
                if row.norm2() > 0.0 {
                    let [x, rate, _] = self.resonant(resonance, unit, *row).values(t);
                    q[mode] += x;
                    v[mode] += rate;
                }
            }
        }
    }

    /// Puts the loads on slow singles behind what is kept of a phase.
    pub(crate) fn keep_slow_loads(&self, onset: &Onset, kept: &mut Vec<f64>) {
        for load in &self.slow {
            load.keep(onset, self.stride, &self.omegas, kept);
        }
    }

    /// The polynomial of the load on a slow single.
    pub(crate) fn slow_load<'a>(&self, single: usize, kept: &'a [f64]) -> &'a [f64] {
        let load = self.slow.iter().find(|load| load.single == single);
        load.map_or(&[], |load| load.coefficients(kept))
    }
}

/// The series of the coupled groups under a force, from order 0 on.
fn group_series(
    force: &[f64],
    impedance: Option<&Impedance<'_>>,
    orders: usize,
) -> Result<Vec<Vec<f64>>> {
    let Some(impedance) = impedance.filter(|_| force.iter().any(|p| *p != 0.0)) else {
        return Ok(Vec::new());
    };
    let mut series: Vec<Vec<f64>> = Vec::with_capacity(orders);
    for order in 0..orders {
        let next = match order {
            0 => impedance.rest(force)?,
            _ => {
                let mut right = impedance.damped(&series[order - 1]);
                for (i, right) in right.iter_mut().enumerate() {
                    let before = if order > 1 { series[order - 2][i] } else { 0.0 };
                    *right = -(*right + before);
                }
                impedance.rest(&right)?
            }
        };
        series.push(next);
    }
    Ok(series)
}
