//! Blocks that follow a load from rest: where neither the load's own motion nor the block's can be
//! measured against the other.
//!
//! The block is bordered by the generator of the load, `(z, u)' = ((B, G), (0, J)) (z, u)`, and
//! starts at `z = 0`. Resonance is then nothing but a cluster with one exponent more: where B and
//! J are both `i omega` its motion is `t exp(i omega t)`.

use super::drives::Push;
use crate::forcing::Onset;
use crate::method::piecewise_linear::cluster::{Cluster, Columns, Drive, NOTHING};
use crate::method::piecewise_linear::polynomial::derivative_at;
use crate::number::Complex;
use faer::{Mat, c64};

/// What is followed, by number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Leader {
    /// A derivative of a channel's function.
    Channel {
        number: usize,
        order: usize,
    },
    Harmonic(usize),
}

/// A block that follows one load.
#[derive(Debug, Clone)]
pub(crate) struct Follower {
    pub leader: Leader,
    /// How each mode sees its columns, those of the load left out.
    pub shapes: Vec<Vec<Complex<f64>>>,
    /// Size of the load's columns under a load of one.
    pub size: f64,
    /// Unit of the time in the columns of a polynomial.
    unit: f64,
}

/// A load as the motion that drives a block.
pub(super) struct Load {
    pub leader: Leader,
    generator: Mat<c64>,
}

impl Load {
    /// A derivative of a polynomial and those after it, each in the unit of the time for which it
    /// is followed.
    pub(super) fn channel(push: &Push, coefficients: usize, length: f64) -> Self {
        let left = coefficients.saturating_sub(push.order);
        let next = |r: usize, c: usize| if c == r + 1 { 1.0 / length } else { 0.0 };
        Self {
            leader: Leader::Channel {
                number: push.channel,
                order: push.order,
            },
            generator: Mat::from_fn(left, left, |r, c| c64::new(next(r, c), 0.0)),
        }
    }

    pub(super) fn harmonic(number: usize, omega: f64) -> Self {
        Self {
            leader: Leader::Harmonic(number),
            generator: Mat::from_fn(1, 1, |_, _| c64::new(0.0, omega)),
        }
    }
}

impl Follower {
    /// A block that the load gives so much to, and the cluster of both, whose columns start at
    /// `at`, for times up to a length. `None` where the load gives it nothing.
    pub(super) fn new(
        load: &Load,
        generator: &Mat<c64>,
        gains: &[Complex<f64>],
        shapes: Vec<Vec<Complex<f64>>>,
        at: usize,
        length: f64,
    ) -> Option<(Self, Cluster)> {
        let gain = gains.iter().map(|g| g.norm2()).sum::<f64>().sqrt();
        if gain == 0.0 || load.generator.nrows() == 0 {
            return None;
        }
        // What a load gives meanwhile: its columns are about as large as the block's.
        let speed = 1.0 / length;
        let columns = load.generator.nrows();
        let drive = Drive {
            gains: Mat::from_fn(gains.len(), columns, |r, c| {
                let own = if c == 0 {
                    gains[r].scale(speed / gain)
                } else {
                    Complex::zero()
                };
                c64::new(own.re, own.im)
            }),
            generator: load.generator.clone(),
            values: vec![Complex::zero(); columns],
        };
        let follower = Self {
            leader: load.leader,
            shapes,
            size: gain / speed,
            unit: length,
        };
        Some((follower, Cluster::driven(at, generator, drive, length)))
    }

    /// Its columns at the start of a phase.
    pub(super) fn start(&self, cluster: &Cluster, onset: &Onset, stride: usize) -> Columns {
        let mut columns = NOTHING;
        let load = &mut columns[cluster.size - cluster.drives()..cluster.size];
        match self.leader {
            Leader::Channel { number, order } => {
                let coefficients = &onset.coefficients[number * stride..][..stride];
                let mut size = self.size;
                for (to, order) in load.iter_mut().zip(order as i32..) {
                    *to = Complex::real(size * derivative_at(coefficients, order, 0.0));
                    size *= self.unit;
                }
            }
            Leader::Harmonic(number) => load[0] = onset.units[number].scale(self.size),
        }
        columns
    }

    /// Adds displacement and velocity of all modes, times `sign`.
    pub(super) fn add_motion(
        &self,
        cluster: &Cluster,
        columns: &Columns,
        sign: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) {
        let rates = cluster.rate(columns);
        for (shape, (z, rate)) in self.shapes.iter().zip(columns.iter().zip(&rates)) {
            let (z, rate) = (z.scale(sign), rate.scale(sign));
            for (shape, (q, v)) in shape.iter().zip(q.iter_mut().zip(v.iter_mut())) {
                *q = shape.add_real_product(z, *q);
                *v = shape.add_real_product(rate, *v);
            }
        }
    }
}
