//! What the explicit fixed-step schemes share: their march, their record and the check of the
//! step.

mod laws;
mod ledgers;
mod loads;
mod many;
mod march;
mod memories;
mod record;
mod setting;
mod states;

pub use record::{StepRecord, VelocityRule};

pub(crate) use laws::{coupling, law_force, pushed};
pub(crate) use ledgers::{check_growth, sampled_states, step_ledgers};
pub(crate) use loads::ChangingLoads;
pub(crate) use many::{Follow, Scheme, among_many};
pub(crate) use march::{Any, Count, March, Modal, in_lanes, modal, run};
pub(crate) use setting::Setting;

use crate::error::{Error, Result};
use crate::law::{COORDINATES, Law, Local};
use crate::system::ModalSystem;

/// A fixed step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Its length, in s.
    pub dt: f64,
    /// Whether it may lie above the stability limit.
    pub beyond_stability_limit: bool,
}

/// Refuses a system whose modes are coupled: the schemes carry each by itself.
pub(crate) fn check_uncoupled(method: &'static str, system: &ModalSystem) -> Result<()> {
    if system.is_coupled() {
        return Err(Error::CoupledModes { method });
    }
    Ok(())
}

/// Refuses laws at which velocities jump: the schemes go by forces.
pub(crate) fn check_forces<L: Law>(method: &'static str, laws: &[L]) -> Result<()> {
    if laws.iter().any(|law| law.restitution().is_some()) {
        return Err(Error::RigidStops { method });
    }
    Ok(())
}

/// Refuses a step above the limit, unless it was asked for by name.
pub(crate) fn check_step(method: &'static str, step: Step, limit: f64) -> Result<()> {
    if step.dt > limit && !step.beyond_stability_limit {
        return Err(Error::Unstable {
            method,
            dt: step.dt,
            limit,
        });
    }
    Ok(())
}

/// Highest angular frequency with every law in its stiffest state, in rad/s, from above:
/// the largest eigenvalue of a sum is at most the sum of the largest eigenvalues.
pub(crate) fn highest_frequency<L: Law>(system: &ModalSystem, laws: &[L]) -> f64 {
    let laws_stiffness: f64 = (laws.iter())
        .map(|law| on_modes(law, &law.stiffest().stiffness))
        .sum();
    (system.highest_frequency().powi(2) + laws_stiffness).sqrt()
}

/// Damping that laws in their stiffest states add to any motion, in rad/s, from above.
pub(crate) fn laws_damping<L: Law>(laws: &[L]) -> f64 {
    (laws.iter())
        .map(|law| on_modes(law, &law.stiffest().damping))
        .sum()
}

/// A bound of the largest eigenvalue of a law's diagonal local matrix on the modes.
fn on_modes<L: Law>(law: &L, matrix: &[Local<f64>; COORDINATES]) -> f64 {
    (law.rows().iter().zip(matrix).enumerate())
        .map(|(i, (row, entries))| entries[i] * row.iter().map(|r| r * r).sum::<f64>())
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forcing::Forcing;
    use crate::history::{Derivative, History};
    use crate::law::{AnyLaw, Friction, FrictionStop, SlidingRule, Stop};
    use crate::method::{Method, simulate};
    use crate::problem::Problem;
    use std::sync::Arc;

    /// Modes that move; any others stay at rest.
    const MOVING: usize = 3;
    const METHODS: [fn(Step) -> Method; 2] = [Method::CentralDifference, Method::SymplecticEuler];

    fn row(modes: usize) -> Vec<f64> {
        let entry = |i| {
            if i < MOVING {
                1.0 - 0.3 * i as f64
            } else {
                0.0
            }
        };
        (0..modes).map(entry).collect()
    }

    fn stop(modes: usize, gap: f64) -> Stop {
        Stop::new(row(modes), gap, 2e4, 3.0).unwrap()
    }

    fn rubbing(modes: usize, gap: f64) -> AnyLaw {
        let tangent = row(modes).iter().map(|x| x * x).collect();
        let friction = Friction {
            static_coefficient: 0.4,
            dynamic_coefficient: 0.3,
            stiffness: 1e4,
            damping: 0.0,
            rule: SlidingRule::default(),
        };
        FrictionStop::new(stop(modes, gap), tangent, friction)
            .unwrap()
            .into()
    }

    /// A structure of `modes` modes that bounces.
    fn run<L: Law>(method: fn(Step) -> Method, modes: usize, laws: Vec<L>) -> History<L> {
        let each = |f: &dyn Fn(usize) -> f64| (0..modes).map(f).collect::<Vec<f64>>();
        let moving = |value: f64| each(&|i| if i < MOVING { value } else { 0.0 });
        let omega2 = each(&|i| 1e3 * (i * i) as f64);
        let system = ModalSystem::new(omega2, each(&|i| 0.2 * i as f64)).unwrap();
        let forcing = Forcing::constant(moving(-2.0)).unwrap();
        let rest = vec![0.0; modes];
        let problem = Problem::new(system, laws, forcing, rest, moving(-0.5), 0.2).unwrap();
        let step = Step {
            dt: 1e-4,
            beyond_stability_limit: false,
        };
        simulate(&Arc::new(problem), method(step), &mut |_| true).unwrap()
    }

    /// The moving modes at some instants.
    fn motion<L: Law>(history: &History<L>) -> Vec<f64> {
        let times: Vec<f64> = (0..=40).map(|n| f64::from(n) * 5e-3).collect();
        let modes = history.problem().system.modes();
        let rows = history.motion(&times, Derivative::Displacement).unwrap();
        let moving = rows.chunks(modes).flat_map(|row| &row[..MOVING]);
        moving.copied().collect()
    }

    fn assert_same_bits<A: Law, B: Law>(one: &History<A>, other: &History<B>) {
        assert!(one.events().len() > 2);
        assert_eq!(motion(one), motion(other));
        assert_eq!(one.events(), other.events());
    }

    #[test]
    fn memory_of_another_run_leaves_no_trace() {
        for method in METHODS {
            let small = || motion(&run(method, 5, vec![stop(5, 1e-3)]));
            let fresh = std::thread::scope(|scope| scope.spawn(small).join().unwrap());
            drop(run(method, 20, vec![stop(20, 1e-3)]));
            assert_eq!(small(), fresh);
        }
    }

    #[test]
    fn counts_known_when_compiling_give_the_bits_of_any_other() {
        for method in METHODS {
            let known = run(method, 8, vec![stop(8, 1e-3)]);
            for modes in [16, 24] {
                assert_same_bits(&known, &run(method, modes, vec![stop(modes, 1e-3)]));
            }
            let two = vec![stop(8, 1e-3), stop(8, 1e3)];
            assert_same_bits(&known, &run(method, 8, two));
            let rubbing_known = run(method, 8, vec![rubbing(8, 1e-3)]);
            assert_same_bits(&rubbing_known, &run(method, 24, vec![rubbing(24, 1e-3)]));
        }
    }

    /// Stops that are never reached let many laws be compared with one.
    #[test]
    fn many_laws_move_the_modes_as_one_does_to_rounding() {
        for method in METHODS {
            for modes in [5, 24] {
                let one = run(method, modes, vec![rubbing(modes, 1e-3)]);
                let mut laws = vec![rubbing(modes, 1e3); 2 * many::MANY + 1];
                laws.insert(3, rubbing(modes, 1e-3));
                let many = run(method, modes, laws);
                assert_eq!(one.events().len(), many.events().len());
                for (one, many) in one.events().iter().zip(many.events()) {
                    assert_eq!((one.time, 3), (many.time, many.law));
                }
                for (one, many) in motion(&one).iter().zip(motion(&many)) {
                    assert!((one - many).abs() < 1e-14, "{one} {many}");
                }
            }
        }
    }

    #[test]
    fn the_loop_of_plain_stops_gives_the_bits_of_laws_of_any_kind() {
        for method in METHODS {
            let plain = run(method, 8, vec![stop(8, 1e-3)]);
            let mixed = vec![stop(8, 1e-3).into(), rubbing(8, 1e3)];
            assert_same_bits(&plain, &run(method, 8, mixed));
        }
    }
}
