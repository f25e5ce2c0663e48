//! What follows polynomial loads, as part of a signal.

use super::Signal;
use crate::law::Affine;
use crate::method::piecewise_linear::phase::{Phase, Phases};
use crate::method::piecewise_linear::response::Response;
use crate::method::piecewise_linear::view::View;

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
            for (rate, factor) in derivatives.into_iter().enumerate() {
                let weight = weight * factor;
                if weight == 0.0 {
                    continue;
                }
                for power in link.powers(rate, response.stride) {
                    let term = weight * link.coefficient(channel, rate, power);
                    self.polynomial.add(power, term);
                }
            }
        }
    }
}
