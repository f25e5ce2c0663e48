//! What motions leave of the equations of motion.

use super::equations::leave_out;
use crate::law::Law;
use crate::method::piecewise_linear::cluster::{Cluster, Columns, NOTHING};
use crate::method::piecewise_linear::coupled::Coupled;
use crate::method::piecewise_linear::response::Leader;
use crate::method::piecewise_linear::rows::entry;
use crate::method::piecewise_linear::spectrum::Spectrum;
use crate::method::piecewise_linear::view::View;
use crate::number::{Complex, LANES};
use crate::problem::Problem;
use faer::Mat;

/// Rounding of a sum of n products, each of up to three factors, relative to their sizes.
pub(super) fn rounding(terms: usize) -> f64 {
    (terms as f64 + 8.0) * 0.5 * f64::EPSILON
}

/// What a cluster leaves of the equations.
pub(super) struct ClusterResidual {
    /// Of its own columns, a bound of the norm.
    pub moving: f64,
    /// Of each mode, and of each column that drives it.
    pub driving: Vec<Vec<Complex<f64>>>,
    /// Whether a harmonic load drives it.
    pub turns: bool,
}

/// Exponents that are equal, and the residual of each at unit amplitude.
pub(super) struct Class {
    pub exponent: Complex<f64>,
    pub members: Vec<(usize, Vec<Complex<f64>>)>,
    /// Rounding of the residuals, one a member.
    pub roundings: Vec<f64>,
}

/// A sum and the sizes of what was added.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sum {
    pub value: f64,
    pub size: f64,
}

impl Sum {
    pub(super) fn add(&mut self, term: f64) {
        self.value += term;
        self.size += term.abs();
    }
}

/// A residual at unit amplitude, and a bound of the rounding with which it is computed.
struct Rounded {
    vector: Vec<Complex<f64>>,
    rounding: f64,
}

impl Rounded {
    fn norm(&self) -> f64 {
        self.rounding + (self.vector.iter()).map(|r| r.norm2()).sum::<f64>().sqrt()
    }
}

/// Puts motions into the equations.
pub(super) struct Residual<'a> {
    pub coupled: &'a Coupled,
    pub solved: &'a [bool],
    /// Directions in which reactions take up whatever is left.
    pub held: Option<&'a Mat<f64>>,
}

impl Residual<'_> {
    /// The residuals of all exponents, equal ones together: those of modes that are alike cancel
    /// only in their sum.
    pub(super) fn classes<L: Law>(
        &self,
        problem: &Problem<L>,
        spectrum: &Spectrum,
        views: &[View],
        clusters: &[ClusterResidual],
    ) -> Vec<Class> {
        let mut classes: Vec<Class> = Vec::new();
        for exponent in 0..spectrum.lambda.len() * LANES {
            let lambda = entry(&spectrum.lambda, exponent);
            let shape: Vec<Complex<f64>> = (views.iter())
                .map(|view| entry(&view.exponents, exponent))
                .collect();
            let harmonic = (spectrum.response.as_ref())
                .and_then(|response| exponent.checked_sub(response.at))
                .filter(|number| *number < problem.forcing.harmonics().len());
            if harmonic.is_none() && shape.iter().all(|psi| psi.norm2() == 0.0) {
                continue;
            }
            let mut residual = self.of_exponent(lambda, &shape);
            if let Some(harmonic) = harmonic {
                self.take_load(spectrum, clusters, harmonic, &mut residual);
            }
            let Rounded { vector, rounding } = self.without_reactions(residual);
            let class = match classes.iter_mut().find(|class| class.exponent == lambda) {
                Some(class) => class,
                None => {
                    classes.push(Class {
                        exponent: lambda,
                        members: Vec::new(),
                        roundings: Vec::new(),
                    });
                    classes.last_mut().expect("just pushed")
                }
            };
            class.members.push((exponent, vector));
            class.roundings.push(rounding);
        }
        classes
    }

    fn without_reactions(&self, mut residual: Rounded) -> Rounded {
        if let Some(held) = self.held {
            leave_out(held, &mut residual.vector);
        }
        residual
    }

    /// `(lambda^2 + lambda C + K) psi`
    fn of_exponent(&self, lambda: Complex<f64>, shape: &[Complex<f64>]) -> Rounded {
        let (square, modulus) = (lambda * lambda, lambda.norm());
        let Coupled {
            stiffness, damping, ..
        } = self.coupled;
        let mut vector = Vec::with_capacity(shape.len());
        let mut squares = 0.0;
        for (i, own) in shape.iter().enumerate() {
            if self.solved[i] {
                vector.push(Complex::zero());
                continue;
            }
            let mut total = square * *own;
            let mut size = modulus * modulus * own.norm();
            for (k, psi) in shape.iter().enumerate() {
                let (stiffness, damping) = (stiffness[(i, k)], damping[(i, k)]);
                total += *psi * lambda.scale(damping).plus(stiffness);
                size += (stiffness.abs() + modulus * damping.abs()) * psi.norm();
            }
            squares += (rounding(2 * shape.len()) * size).powi(2);
            vector.push(total);
        }
        Rounded {
            vector,
            rounding: squares.sqrt(),
        }
    }

    /// Takes a harmonic load from the residual of its exponent, and adds what drives the clusters
    /// that follow it.
    fn take_load(
        &self,
        spectrum: &Spectrum,
        clusters: &[ClusterResidual],
        number: usize,
        residual: &mut Rounded,
    ) {
        let drives = spectrum.response.iter().map(|response| &response.drives);
        let (mut size, modes) = (0.0, residual.vector.len());
        let followers = spectrum.response.iter().flat_map(|r| &r.followers);
        let first = clusters.len() - followers.clone().count();
        let following: Vec<_> = (followers.zip(&clusters[first..]))
            .filter(|(follower, _)| follower.leader == Leader::Harmonic(number))
            .collect();
        for i in (0..modes).filter(|&i| !self.solved[i]) {
            let mut add = |term: Complex<f64>| {
                residual.vector[i] += term;
                size += term.norm();
            };
            for drives in drives.clone() {
                add(drives.harmonics[number][i].scale(-1.0));
            }
            for (follower, cluster) in &following {
                add(cluster.driving[i][0].scale(follower.size));
            }
        }
        residual.rounding += rounding(2 * modes) * size;
    }

    /// `X B^2 + C X B + K X` of each cluster, X how the modes see its columns.
    pub(super) fn clusters(&self, spectrum: &Spectrum, views: &[View]) -> Vec<ClusterResidual> {
        let mut first = 0;
        let mut residuals = Vec::with_capacity(spectrum.clusters.len());
        for cluster in &spectrum.clusters {
            let columns = first..first + cluster.size;
            first += cluster.size;
            let rate = |row: &Columns| {
                let mut to = NOTHING;
                cluster.row_rate(&row[..cluster.size], &mut to[..cluster.size]);
                to
            };
            let mut seen = Vec::with_capacity(views.len());
            for view in views {
                let mut row = NOTHING;
                row[..cluster.size].copy_from_slice(&view.clusters[columns.clone()]);
                let slope = rate(&row);
                seen.push([row, slope, rate(&slope)]);
            }
            residuals.push(self.of_cluster(cluster, &seen));
        }
        let followers = spectrum.response.iter().flat_map(|r| &r.followers);
        let first = residuals.len() - followers.clone().count();
        for (follower, residual) in followers.zip(&mut residuals[first..]) {
            residual.turns = matches!(follower.leader, Leader::Harmonic(_));
        }
        residuals
    }

    fn of_cluster(&self, cluster: &Cluster, seen: &[[Columns; 3]]) -> ClusterResidual {
        let moving = cluster.size - cluster.drives();
        let mut squares = 0.0;
        let mut driving = vec![vec![Complex::zero(); cluster.drives()]; seen.len()];
        for column in 0..cluster.size {
            let mut vector = vec![Complex::zero(); seen.len()];
            let mut noises = 0.0;
            for (i, [_, _, curvature]) in seen.iter().enumerate().filter(|(i, _)| !self.solved[*i])
            {
                let mut total = curvature[column];
                let mut size = total.norm();
                for (k, [row, slope, _]) in seen.iter().enumerate() {
                    let stiffness = row[column].scale(self.coupled.stiffness[(i, k)]);
                    let damping = slope[column].scale(self.coupled.damping[(i, k)]);
                    total += stiffness + damping;
                    size += stiffness.norm() + damping.norm();
                }
                let noise = rounding(2 * seen.len() + 4 * cluster.size) * size;
                noises += noise * noise;
                vector[i] = total;
            }
            let column_left = self.without_reactions(Rounded {
                vector,
                rounding: f64::sqrt(noises),
            });
            match column.checked_sub(moving) {
                // Its rounding is that of the force it stands for.
                Some(drive) => {
                    for (stays, total) in driving.iter_mut().zip(column_left.vector) {
                        stays[drive] = total;
                    }
                }
                None => squares += column_left.norm().powi(2),
            }
        }
        ClusterResidual {
            moving: squares.sqrt(),
            driving,
            turns: false,
        }
    }
}
