//! Loads times a factor, and loads so many times as fast.

use super::{Channel, Forcing, Harmonic, History};

impl Forcing {
    /// The same loads, each times a factor; obstacles move as they did.
    pub fn scaled(&self, factor: f64) -> Self {
        let channel = |channel: &Channel| Channel {
            direction: channel.direction.iter().map(|x| factor * x).collect(),
            ..channel.clone()
        };
        let harmonic = |harmonic: &Harmonic| Harmonic {
            amplitude: (harmonic.amplitude.iter())
                .map(|amplitude| amplitude.scale(factor))
                .collect(),
            ..harmonic.clone()
        };
        Self {
            constant: self.constant.iter().map(|x| factor * x).collect(),
            channels: self.channels.iter().map(channel).collect(),
            harmonics: self.harmonics.iter().map(harmonic).collect(),
        }
    }

    /// The same loads and obstacles in motion, all so many times as fast: `p(factor t)`.
    pub fn faster(&self, factor: f64) -> Self {
        let channel = |channel: &Channel| Channel {
            history: match &channel.history {
                History::Polynomial(coefficients) => History::Polynomial(
                    (coefficients.iter().zip(powers(factor)))
                        .map(|(coefficient, power)| coefficient * power)
                        .collect(),
                ),
                History::Table(table) => History::Table(table.faster(factor)),
            },
            ..channel.clone()
        };
        let harmonic = |harmonic: &Harmonic| Harmonic {
            omega: factor * harmonic.omega,
            ..harmonic.clone()
        };
        Self {
            constant: self.constant.clone(),
            channels: self.channels.iter().map(channel).collect(),
            harmonics: self.harmonics.iter().map(harmonic).collect(),
        }
    }
}

/// `1, x, x^2, ...`
fn powers(x: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(1.0), move |power| Some(power * x))
}
