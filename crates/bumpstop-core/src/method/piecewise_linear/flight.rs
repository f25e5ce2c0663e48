//! Free flight, the usual open phase: no law acts, and each mode oscillates or has no exponent.
//!
//! Each mode has the column of its own number, so that eight of them are taken at once, where
//! [`super::singles`] goes through one after the other. Both give the same bits.

use super::phase::Workspace;
use super::rows::{ComplexBlock, eight_of, put_eight, set_entry};
use super::single_mode::{Regime, SingleMode};
use super::singles::{Single, Subject};
use super::spectrum::Spectrum;
use super::view::View;
use crate::law::Law;
use crate::number::{Complex, Instructions, LANES, Lanes, Number};
use crate::problem::Problem;

impl Spectrum {
    /// Adds every mode as a single, and tells whether that is free flight.
    #[inline(always)]
    pub(super) fn add_modes<L: Law>(&mut self, problem: &Problem<L>) {
        let (omega2, damping) = (problem.system.omega2(), problem.system.damping());
        let modes = omega2.iter().zip(damping).zip(problem.forcing.forces());
        self.singles.reserve_exact(omega2.len());
        self.rests.clear();
        self.rests
            .resize(omega2.len().div_ceil(LANES), [0.0; LANES]);
        let rests = self.rests.as_flattened_mut();
        self.aside.clear();
        self.is_flight = true;
        let longest = self.span.longest(problem.duration);
        for (mode, ((omega2, damping), force)) in modes.enumerate() {
            let motion = SingleMode::new(*omega2, *damping, *force, longest);
            match motion.regime {
                Regime::Oscillating(_) => rests[mode] = motion.force / motion.omega2,
                _ if motion.count() == 0 => self.aside.push(mode),
                _ => self.is_flight = false,
            }
            self.singles.push(Single {
                subject: Subject::Mode(mode),
                motion,
                at: 0,
                modal_share: 1.0,
                law: None,
            });
        }
    }

    /// Amplitudes in free flight from a state: `x - i (v - Re lambda x) / Im lambda`, x from rest.
    #[inline(always)]
    pub(super) fn flight_amplitudes<I: Instructions>(
        &self,
        q: &[f64],
        v: &[f64],
        to: &mut [ComplexBlock],
    ) {
        let zero = Lanes::<I>::of(0.0);
        let state = q.chunks(LANES).zip(v.chunks(LANES));
        let modes = self.lambda.iter().zip(&self.rests);
        for (to, ((lambda, rest), (q, v))) in to.iter_mut().zip(modes.zip(state)) {
            let lambda = lambda.lanes::<I>();
            let x = eight_of::<I>(q) - Lanes::of_block(rest);
            let lack = eight_of::<I>(v) - lambda.re * x;
            // What has no exponent has no amplitude.
            let re = zero.select_less(lambda.im, x, zero);
            let im = zero.select_less(lambda.im, -lack / lambda.im, zero);
            to.put(Complex::new(re, im));
        }
    }

    /// The state in free flight from the exponentials and their rates, but for modes that have
    /// none.
    #[inline(always)]
    pub(super) fn flight_motion<I: Instructions>(
        &self,
        work: &Workspace,
        q: &mut [f64],
        v: &mut [f64],
    ) {
        let state = q.chunks_mut(LANES).zip(v.chunks_mut(LANES));
        let turned = work.z.iter().zip(&work.rate).zip(&self.rests);
        for ((q, v), ((z, rate), rest)) in state.zip(turned) {
            let x = Lanes::<I>::of_block(rest) + Lanes::of_block(&z.re);
            put_eight(x, q);
            put_eight(Lanes::<I>::of_block(&rate.re), v);
        }
    }
}

impl View {
    /// Sets the view of `row . q` in free flight.
    #[inline(always)]
    pub(super) fn set_flight(&mut self, spectrum: &Spectrum, row: &[f64]) {
        for (weights, row) in self.exponents.iter_mut().zip(row.chunks(LANES)) {
            weights.re[..row.len()].copy_from_slice(row);
        }
        for (weight, rest) in row.iter().zip(spectrum.rests.as_flattened()) {
            self.rest += weight * rest;
        }
        self.singles.extend_from_slice(row);
        for &mode in &spectrum.aside {
            set_entry(&mut self.exponents, mode, Complex::zero());
            if row[mode] != 0.0 {
                self.drifting.push(mode);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::forcing::Forcing;
    use crate::history::Derivative;
    use crate::law::Stop;
    use crate::method::piecewise_linear::simulate;
    use crate::problem::Problem;
    use crate::system::ModalSystem;
    use std::sync::Arc;

    /// Modal displacements and velocities of some modes in flight; each mode is told by angular
    /// frequency, damping, force, displacement and velocity.
    fn motion(modes: &[[f64; 5]]) -> Vec<Vec<f64>> {
        let column = |i: usize| modes.iter().map(|mode| mode[i]).collect::<Vec<f64>>();
        let omega2 = column(0).iter().map(|w| w * w).collect();
        let system = ModalSystem::new(omega2, column(1)).unwrap();
        let forcing = Forcing::constant(column(2)).unwrap();
        let nothing: Vec<Stop> = Vec::new();
        let problem = Problem::new(system, nothing, forcing, column(3), column(4), 2.0).unwrap();
        let history = simulate(&Arc::new(problem), &mut |_| true).unwrap();
        let times: Vec<f64> = (0..=40).map(|n| 0.05 * f64::from(n)).collect();
        let mut of_modes = vec![Vec::new(); modes.len()];
        for derivative in [Derivative::Displacement, Derivative::Velocity] {
            let rows = history.motion(&times, derivative).unwrap();
            for row in rows.chunks(modes.len()) {
                for (of_mode, x) in of_modes.iter_mut().zip(row) {
                    of_mode.push(*x);
                }
            }
        }
        of_modes
    }

    #[test]
    fn modes_taken_together_move_as_one_by_one() {
        let mut modes: Vec<[f64; 5]> = (1..=17u8)
            .map(f64::from)
            .map(|n| [3.0 * n, 0.1 * n, 2.0 - 0.3 * n, 0.02 * n, 1.0 - 0.2 * n])
            .collect();
        // Without stiffness, so slow that it is followed by series, and critically damped.
        modes[0] = [0.0, 0.0, 0.4, 0.1, -0.3];
        modes[5] = [0.2, 0.0, 0.4, 0.1, -0.3];
        modes[11] = [4.0, 8.0, 0.4, 0.1, -0.3];
        let together = motion(&modes);
        // An overdamped mode has two exponents: no mode then has the column of its number.
        modes.push([2.0, 30.0, 0.0, 0.0, 0.0]);
        let one_by_one = motion(&modes);
        for (mode, (a, b)) in together.iter().zip(&one_by_one).enumerate() {
            assert_eq!(a, b, "mode {mode}");
            assert!(a.iter().any(|x| x.abs() > 1e-3));
        }
    }
}
