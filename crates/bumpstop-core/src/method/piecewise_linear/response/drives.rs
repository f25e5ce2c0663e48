//! What the functions of time push: the modes, by loads, and springs and dampers, by the motions
//! of their obstacles.
//!
//! A spring and damper behind an obstacle that has moved by w makes the force `-k (x - w) - c (x' -
//! w')`: beside that of a still one, `k w + c w'`.

use crate::forcing::{Channel, Moved};
use crate::law::{Law, Piece, State};
use crate::number::Complex;
use crate::problem::Problem;

/// A force on the modes that goes with a derivative of a channel's function.
#[derive(Debug, Clone)]
pub(crate) struct Push {
    pub channel: usize,
    pub order: usize,
    pub direction: Vec<f64>,
}

/// All forces on the modes that change in time, for laws in given states.
#[derive(Debug, Clone, Default)]
pub(crate) struct Drives {
    pub pushes: Vec<Push>,
    /// Amplitudes of each harmonic.
    pub harmonics: Vec<Vec<Complex<f64>>>,
}

impl Drives {
    pub(crate) fn of<L: Law>(problem: &Problem<L>, states: &[State]) -> Self {
        let forcing = &problem.forcing;
        let mut pushes = Vec::new();
        for (channel, load) in forcing.channels().iter().enumerate() {
            let push = |(order, direction)| Push {
                channel,
                order,
                direction,
            };
            pushes.extend(of_channel(problem, states, load).into_iter().map(push));
        }
        let harmonics = forcing.harmonics().iter().map(|harmonic| {
            let mut amplitudes = harmonic.amplitude.clone();
            for (moved, motion) in &harmonic.motions {
                let [spring, damper] = behind(problem, states, *moved);
                let turn = Complex::new(0.0, harmonic.omega);
                for (to, (k, c)) in amplitudes.iter_mut().zip(spring.iter().zip(&damper)) {
                    *to += *motion * turn.scale(*c).plus(*k);
                }
            }
            amplitudes
        });
        Self {
            pushes,
            harmonics: harmonics.collect(),
        }
    }
}

/// Orders of derivatives and directions.
fn of_channel<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    channel: &Channel,
) -> Vec<(usize, Vec<f64>)> {
    let Some(moved) = channel.moves else {
        return vec![(0, channel.direction.clone())];
    };
    let pushed = behind(problem, states, moved).into_iter().enumerate();
    let felt = |(_, direction): &(usize, Vec<f64>)| direction.iter().any(|p| *p != 0.0);
    pushed.filter(felt).collect()
}

/// Forces on the modes by a law whose obstacle has moved by one, and moves with a speed of one.
fn behind<L: Law>(problem: &Problem<L>, states: &[State], moved: Moved) -> [Vec<f64>; 2] {
    let which = &problem.laws[moved.law];
    let piece = which.piece(states[moved.law]).unwrap_or(Piece::FREE);
    [piece.stiffness, piece.damping].map(|matrix| {
        let mut force = vec![0.0; problem.system.modes()];
        for (row, factors) in which.rows().iter().zip(matrix) {
            for (force, factor) in force.iter_mut().zip(row) {
                *force += factor * factors[moved.coordinate];
            }
        }
        force
    })
}
