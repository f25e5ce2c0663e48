//! Loads times a factor.

use super::{Channel, Forcing, Harmonic};

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
}
