//! What follows loads that change in time, as part of a signal.

use super::{ROUNDING, Signal};
use crate::law::Affine;
use crate::method::piecewise_linear::phase::{Phase, Phases};
use crate::method::piecewise_linear::polynomial::of_derivative;
use crate::method::piecewise_linear::resonance::Resonant;
use crate::method::piecewise_linear::response::{POWERS, Response, Series};
use crate::method::piecewise_linear::rows::{entry, set_entry};
use crate::method::piecewise_linear::view::View;
use crate::number::{Complex, LANES};

impl Signal {
    /// Adds it for one local coordinate, beside its exponents.
    pub(super) fn add_loads(
        &mut self,
        response: &Response,
        phases: &Phases,
        phase: Phase,
        view: &View,
        function: &Affine,
        coordinate: usize,
    ) {
        let derivatives = [
            function.position[coordinate],
            function.velocity[coordinate],
            function.acceleration[coordinate],
        ];
        let coefficients = phases.coefficients(phase);
        for (link, weight) in response.links.iter().zip(&view.links) {
            let channel = &coefficients[link.channel * response.stride..][..response.stride];
            for (order, factor) in (link.order..).zip(derivatives) {
                let weight = weight * factor;
                if weight == 0.0 {
                    continue;
                }
                for power in 0..(response.stride as i32 - order).max(0) as usize {
                    let term = weight * of_derivative(channel, order, power);
                    self.polynomial.add(power, term);
                }
            }
        }
        let gradual = response.gradual.iter();
        let series = gradual.flat_map(|gradual| gradual.series(coefficients, response.stride));
        for (series, weight) in series.zip(&view.gradual) {
            self.add_series(&series, *weight, &derivatives);
        }
        for (resonance, weight) in response.resonances.iter().zip(&view.resonances) {
            let unit = phases.unit(phase, response, resonance.harmonic);
            let resonant = response.resonant(resonance, unit, *weight);
            let [position, velocity, acceleration] = derivatives;
            self.add_resonant(resonant.times(Complex::real(position)));
            self.add_resonant_rate(resonant.times(Complex::real(velocity)));
            let [own, load] = resonant.times(Complex::real(acceleration)).rate();
            self.add_resonant_rate(resonant.with_weight(own));
            self.add_load_term(&resonant, load * Complex::new(0.0, resonant.omega));
        }
    }

    /// Adds the power series of an exponent, and its derivatives with factors of their own.
    fn add_series(&mut self, series: &Series, weight: Complex<f64>, derivatives: &[f64; 3]) {
        let mut terms = series.map(|c| weight.real_product(c));
        for factor in derivatives {
            if *factor != 0.0 {
                for (power, term) in terms.iter().enumerate() {
                    self.polynomial.add(power, factor * term);
                }
            }
            for n in 1..POWERS {
                terms[n - 1] = n as f64 * terms[n];
            }
            terms[POWERS - 1] = 0.0;
        }
    }

    fn add_resonant(&mut self, resonant: Resonant) {
        if resonant.weight.norm2() > 0.0 {
            self.resonances.push(resonant);
        }
    }

    /// Adds the rate of a resonance.
    pub(super) fn add_resonant_rate(&mut self, of: Resonant) {
        let [own, load] = of.rate();
        self.add_resonant(of.with_weight(own));
        self.add_load_term(&of, load);
    }

    /// Adds `Re (amplitude exp(i omega t))` of the load in a resonance.
    fn add_load_term(&mut self, of: &Resonant, amplitude: Complex<f64>) {
        let lane = of.at % LANES;
        let terms = &mut self.terms[of.at / LANES];
        let mut term = amplitude;
        let mut size = term.norm();
        terms.size.0[lane] += size;
        for order in 0..3 {
            let sum = entry(&terms.of[order..=order], lane) + term;
            set_entry(&mut terms.of[order..=order], lane, sum);
            self.at_start[order] += term.re;
            self.totals[order] += size;
            term = term * Complex::new(0.0, of.omega);
            size *= of.omega;
        }
    }

    /// A resonance is the product of two exponentials, with the same error of the exponents.
    pub(super) fn rounding_of_resonances(&self, t: f64) -> f64 {
        let each = self.resonances.iter().map(|resonant| {
            let [size, rate] = resonant.sizes(t);
            ROUNDING * size + f64::EPSILON * rate * t
        });
        each.sum()
    }

    /// Bound of the third derivative of polynomial and resonances up to t.
    #[inline(always)]
    pub(super) fn third_of_loads(&self, t: f64) -> f64 {
        let mut third = self.polynomial.third(t);
        for resonant in &self.resonances {
            third += resonant.third(t);
        }
        third
    }
}
