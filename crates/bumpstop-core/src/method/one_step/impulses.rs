//! Impulses of rigid stops, as forces over a step.
//!
//! With the rate u1 of the distance at the end and u before, Newton's law of impact is `0 <= f`,
//! `0 <= w = u1 + e u`, one of them zero, and Coulomb's law of friction is that the rate along the
//! obstacle is zero while less than `mu f` does that, and against it else. Both are equations without
//! cases, `f = max(0, f - r w)` and `t = min(max(t - s v, -mu f), mu f)` for some r, s > 0, which
//! Newton's iteration solves together with the forces of all other laws, and which one force can be
//! told from the others by, again and again, where that does not end.
//!
//! Sources: P. Alart, A. Curnier, A mixed formulation for frictional contact problems, Computer
//! Methods in Applied Mechanics and Engineering 92, 353-375, 1991; M. Jean, The non-smooth contact
//! dynamics method, the same 177, 235-257, 1999 (the sweeps).

use super::laws::{Iterate, Pushes};
use crate::law::COORDINATES;

/// A residual counts as zero down to this many times the rounding of what it is made of.
const ROUNDINGS: f64 = 64.0;

/// Of a force, in an equation that tells a rate instead: stops of which one alone would do share
/// what they push.
const DEPENDENT: f64 = 1e-11;

/// How a rigid stop takes part in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    /// Rates of the distance, and along the obstacle, before.
    pub before: [f64; 2],
    pub restitution: f64,
    pub friction: f64,
}

/// What a rigid stop did in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Struck {
    /// Forces along the normal and along the obstacle, in N.
    pub push: f64,
    pub rub: f64,
    /// What the push alone makes of the rate of the distance, in m/s.
    pub speed: f64,
    pub touch: Touch,
}

impl Iterate {
    /// Looks at the forces of a rigid stop, from number `first` on; one that takes no part has
    /// none. Returns whether they are as the laws say.
    pub(super) fn strike(
        &mut self,
        first: usize,
        count: usize,
        touched: Option<&Touch>,
        pushes: &Pushes,
    ) -> bool {
        let mut settled = true;
        for at in first..first + count {
            self.slopes[1][at] = [0.0; COORDINATES];
            self.own[at] = 1.0;
            self.follows[at] = 0.0;
            self.residual[at] = -self.forces[at];
            settled &= match touched.filter(|_| self.gain_of_rate(at, pushes) > 0.0) {
                None => self.forces[at] == 0.0,
                Some(touch) if at == first => self.push(touch, at, pushes),
                Some(touch) => self.rub(touch, at, pushes),
            };
        }
        settled
    }

    /// By how much a force changes the rate of its own coordinate.
    fn gain_of_rate(&self, at: usize, pushes: &Pushes) -> f64 {
        pushes.on[1][at * self.forces.len() + at]
    }

    /// Looks at a push.
    fn push(&mut self, touch: &Touch, at: usize, pushes: &Pushes) -> bool {
        let (force, gain) = (self.forces[at], self.gain_of_rate(at, pushes));
        let bounced = touch.restitution * touch.before[0];
        let wanted = (self.motion[1][at] + bounced) / gain;
        if force <= wanted {
            return force == 0.0;
        }
        self.hold_rate(at, 0, gain, wanted);
        let size = force.abs() + (self.sizes[1][at] + bounced.abs()) / gain;
        wanted.abs() <= ROUNDINGS * f64::EPSILON * size
    }

    /// Looks at a friction, which the push before it bounds.
    fn rub(&mut self, touch: &Touch, at: usize, pushes: &Pushes) -> bool {
        let (force, gain) = (self.forces[at], self.gain_of_rate(at, pushes));
        let most = touch.friction * self.forces[at - 1].max(0.0);
        let wanted = self.motion[1][at] / gain;
        let trial = force - wanted;
        let size = force.abs() + most;
        if trial.abs() <= most {
            self.hold_rate(at, 1, gain, wanted);
            return wanted.abs() <= ROUNDINGS * f64::EPSILON * (size + self.sizes[1][at] / gain);
        }
        let side = trial.signum();
        self.follows[at] = side * touch.friction;
        self.residual[at] = side * most - force;
        self.residual[at].abs() <= ROUNDINGS * f64::EPSILON * size
    }

    /// Makes the rate of a coordinate the equation of a force.
    fn hold_rate(&mut self, at: usize, coordinate: usize, gain: f64, wanted: f64) {
        self.slopes[1][at][coordinate] = -1.0 / gain;
        self.own[at] = DEPENDENT;
        self.residual[at] = -wanted;
    }

    /// The force of a rigid stop that is told by those of all others.
    pub(super) fn impulse(&self, touch: &Touch, first: usize, at: usize, pushes: &Pushes) -> f64 {
        let gain = self.gain_of_rate(at, pushes);
        if gain <= 0.0 {
            return 0.0;
        }
        let bounced = touch.restitution * touch.before[0];
        if at == first {
            return (self.forces[at] - (self.motion[1][at] + bounced) / gain).max(0.0);
        }
        let most = touch.friction * self.forces[first];
        (self.forces[at] - self.motion[1][at] / gain).clamp(-most, most)
    }
}
