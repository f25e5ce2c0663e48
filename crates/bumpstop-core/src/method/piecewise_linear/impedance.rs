//! What resists a force on the coupled groups: at rest, and at a frequency.

use super::coupled::Coupled;
use super::secular::Coupling;
use crate::number::Complex;
use faer::Mat;

/// The coupled groups of a spectrum, `y'' + C y' + K y = p`.
pub(crate) enum Impedance<'a> {
    /// Groups that one spring and damper couples.
    OneLaw(&'a Coupling),
    /// Any.
    Dense(Box<Coupled>),
}

impl Impedance<'_> {
    /// `K^-1 p`; `None` where some motion that it pushes has no stiffness.
    pub(crate) fn rest(&self, forces: &[f64]) -> Option<Vec<f64>> {
        match self {
            Self::OneLaw(coupling) => {
                let forces: Vec<_> = forces.iter().map(|p| Complex::real(*p)).collect();
                let rest = behind_one_law(coupling, 0.0, &forces)?;
                Some(rest.iter().map(|y| y.re).collect())
            }
            Self::Dense(coupled) => coupled.rest(&Mat::from_fn(forces.len(), 1, |i, _| forces[i])),
        }
    }

    /// `C y`
    pub(crate) fn damped(&self, y: &[f64]) -> Vec<f64> {
        match self {
            Self::OneLaw(coupling) => {
                let seen: f64 = coupling.phi.iter().zip(y).map(|(phi, y)| phi * y).sum();
                let push = coupling.stop_damping * seen;
                let both = coupling.damping.iter().zip(&coupling.phi);
                both.zip(y)
                    .map(|((c, phi), y)| c * y + phi * push)
                    .collect()
            }
            Self::Dense(coupled) => coupled.damped(y),
        }
    }

    /// `K y`
    pub(crate) fn held(&self, y: &[f64]) -> Vec<f64> {
        match self {
            Self::OneLaw(coupling) => {
                let seen: f64 = coupling.phi.iter().zip(y).map(|(phi, y)| phi * y).sum();
                let push = coupling.stiffness * seen;
                let both = coupling.omega2.iter().zip(&coupling.phi);
                both.zip(y)
                    .map(|((w2, phi), y)| w2 * y + phi * push)
                    .collect()
            }
            Self::Dense(coupled) => coupled.held(y),
        }
    }

    /// `(K + i omega C - omega^2)^-1 p`; `None` where several motions resist nothing.
    pub(crate) fn harmonic(
        &self,
        omega: f64,
        forces: &[Complex<f64>],
    ) -> Option<Vec<Complex<f64>>> {
        match self {
            Self::OneLaw(coupling) => behind_one_law(coupling, omega, forces),
            Self::Dense(coupled) => Some(coupled.harmonic(omega, forces)),
        }
    }
}

/// Solves `D_i y_i + phi_i kappa sum_k phi_k y_k = p_i`. The mode of the smallest D, which may be
/// zero, is eliminated last: with A and B the sums of `phi p / D` and `phi^2 / D` over the others,
///
/// ```text
/// y_s = [p_s (1 + kappa B) - phi_s kappa A] / [D_s (1 + kappa B) + kappa phi_s^2],
/// F = -kappa (phi_s p_s + D_s A) / [...],   y_i = (p_i + phi_i F) / D_i.
/// ```
fn behind_one_law(
    coupling: &Coupling,
    omega: f64,
    forces: &[Complex<f64>],
) -> Option<Vec<Complex<f64>>> {
    let Coupling {
        omega2,
        damping,
        phi,
        stiffness,
        stop_damping,
    } = coupling;
    let dynamic: Vec<_> = (omega2.iter().zip(damping))
        .map(|(w2, c)| Complex::new(w2 - omega * omega, omega * c))
        .collect();
    let kappa = Complex::new(*stiffness, omega * stop_damping);
    let one = Complex::real(1.0);
    let soft = (0..dynamic.len())
        .min_by(|&a, &b| dynamic[a].norm2().total_cmp(&dynamic[b].norm2()))
        .unwrap_or(0);
    let (mut pushed, mut flexibility) = (Complex::zero(), Complex::zero());
    for i in 0..dynamic.len() {
        if i != soft {
            if dynamic[i].norm2() == 0.0 {
                return None;
            }
            let share = dynamic[i].recip().scale(phi[i]);
            pushed += share * forces[i];
            flexibility += share.scale(phi[i]);
        }
    }
    let others = one + kappa * flexibility;
    let (own, at) = (dynamic[soft], phi[soft]);
    let whole = (own * others + kappa.scale(at * at)).recip();
    let force = -(kappa * (forces[soft].scale(at) + own * pushed) * whole);
    let solution = (0..dynamic.len()).map(|i| {
        if i == soft {
            (forces[i] * others - (kappa * pushed).scale(at)) * whole
        } else {
            (forces[i] + force.scale(phi[i])) * dynamic[i].recip()
        }
    });
    Some(solution.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_law_agrees_with_the_dense_solution() {
        let mut coupling = Coupling::default();
        coupling.start(300.0, 0.7);
        for (omega2, damping, phi) in [(0.0, 0.3, 0.4), (9.0, 0.0, -0.05), (50.0, 0.4, 1.3)] {
            coupling.push(omega2, damping, phi);
        }
        let one = Impedance::OneLaw(&coupling);
        let other = Impedance::Dense(Box::new(Coupled::by_one(&coupling, &[0.0; 3], 0.0, 1.0)));
        let forces = [1.0, -2.0, 0.5];
        let close = |a: f64, b: f64, size: f64| assert!((a - b).abs() < 1e-12 * size, "{a} {b}");
        let (a, b) = (one.rest(&forces).unwrap(), other.rest(&forces).unwrap());
        for i in 0..3 {
            close(a[i], b[i], 1.0);
            close(one.damped(&forces)[i], other.damped(&forces)[i], 1.0);
            close(one.held(&forces)[i], other.held(&forces)[i], 1e3);
        }
        let complex = [1.0, -2.0, 0.5].map(|p| Complex::new(p, 0.3 - p));
        // At 3 rad/s the second mode by itself resists nothing.
        for omega in [0.5, 3.0, 3.0001, 8.0] {
            let a = one.harmonic(omega, &complex).unwrap();
            let b = other.harmonic(omega, &complex).unwrap();
            let size = a.iter().map(|z| z.norm()).fold(0.0, f64::max);
            for (a, b) in a.iter().zip(&b) {
                close(a.re, b.re, size);
                close(a.im, b.im, size);
            }
        }
    }
}
