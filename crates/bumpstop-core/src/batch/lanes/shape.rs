//! The common shape: modes that oscillate with light damping, one of them rigid perhaps, one
//! plain stop, and forces that do not change.

use crate::law::{Law, Stop};
use crate::method::piecewise_linear::ComplexBlock;
use crate::number::{Complex, LANES};
use crate::system::ModalSystem;

/// Modes slower than this over a run are followed by series, which lanes do not have.
pub(super) const SLOWEST: f64 = 0.7;

/// Modes closer to each other than this part of their `omega2` may have to be joined.
const CLOSEST: f64 = 1e-6;

/// What all problems have in common.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    pub modes: usize,
    pub omega2: Vec<f64>,
    pub damping: Vec<f64>,
    pub phi: Vec<f64>,
    pub forces: Vec<f64>,
    pub duration: f64,
    /// Whether the first mode is rigid.
    pub is_rigid: bool,
    /// `sum phi^2`
    pub total: f64,
    /// `sum phi_i^2 / (w_i^2 - m)` over all modes but the two beside each gap between poles, m in
    /// its middle.
    pub beside: Vec<f64>,
    /// Exponents in flight, the same in all lanes; zero for a rigid mode.
    pub flight: Vec<ComplexBlock>,
    /// Positions at rest in flight; zero for a rigid mode.
    pub rests: Vec<f64>,
}

impl Shape {
    /// `None` where the modes are not of this shape.
    pub(super) fn new(
        system: &ModalSystem,
        stop: &Stop,
        forces: &[f64],
        duration: f64,
    ) -> Option<Self> {
        let (omega2, damping) = (system.omega2(), system.damping());
        let phi = stop.rows()[0].as_slice();
        let modes = omega2.len();
        let is_rigid = modes > 0 && omega2[0] == 0.0 && damping[0] == 0.0;
        let flexible = usize::from(is_rigid)..modes;
        let oscillates = |i: usize| {
            damping[i] * damping[i] < omega2[i] && omega2[i].sqrt() * duration >= SLOWEST
        };
        let apart = |i: usize| omega2[i] - omega2[i - 1] > CLOSEST * omega2[i];
        let is_common = modes > 0
            && flexible.clone().all(oscillates)
            && (1..modes).all(apart)
            && phi.iter().all(|phi| *phi != 0.0);
        if !is_common {
            return None;
        }
        let mut flight = vec![ComplexBlock::ZERO; modes];
        let mut rests = vec![0.0; modes];
        for i in flexible {
            let half = 0.5 * damping[i];
            let exponent = Complex::new(-half, (omega2[i] - half * half).sqrt());
            flight[i] = ComplexBlock {
                re: [exponent.re; LANES],
                im: [exponent.im; LANES],
            };
            rests[i] = forces[i] / omega2[i];
        }
        Some(Self {
            modes,
            omega2: omega2.to_vec(),
            damping: damping.to_vec(),
            phi: phi.to_vec(),
            forces: forces.to_vec(),
            duration,
            is_rigid,
            total: phi.iter().map(|phi| phi * phi).sum(),
            beside: (1..modes)
                .map(|root| beside(omega2, phi, root - 1))
                .collect(),
            flight,
            rests,
        })
    }
}

fn beside(omega2: &[f64], phi: &[f64], root: usize) -> f64 {
    let middle = 0.5 * (omega2[root] + omega2[root + 1]);
    (0..omega2.len())
        .filter(|i| *i != root && *i != root + 1)
        .map(|i| phi[i] * phi[i] / (omega2[i] - middle))
        .sum()
}
