//! What no double can tell apart.

use crate::error::{Error, Result};
use crate::law::{COORDINATES, Law};
use crate::problem::Problem;

/// The most radians that a motion against a law may turn through in a run. Instants are known to
/// the rounding of the run's length, by which so fast a motion turns through a thousandth.
const MOST_TURNS: f64 = 1e13;

/// Refuses laws so stiff that the run cannot tell the instants at which they let go.
pub(super) fn check<L: Law>(problem: &Problem<L>) -> Result<()> {
    let slowest = (MOST_TURNS / problem.duration).powi(2);
    for (number, law) in problem.laws.iter().enumerate() {
        let piece = law.stiffest();
        for (coordinate, row) in law.rows().iter().enumerate().take(COORDINATES) {
            let stiffness = piece.stiffness[coordinate][coordinate].abs();
            let yields: f64 = row.iter().map(|factor| factor * factor).sum();
            let most = slowest / yields;
            if stiffness > most {
                return Err(Error::TooStiff {
                    law: number,
                    stiffness,
                    most,
                    duration: problem.duration,
                });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::error::Error;
    use crate::forcing::Forcing;
    use crate::law::Stop;
    use crate::method::{Method, simulate};
    use crate::problem::Problem;
    use crate::system::ModalSystem;
    use std::sync::Arc;

    /// A mass that swings against a stop of a stiffness.
    fn run(stiffness: f64) -> Result<f64, Error> {
        let problem = Problem::new(
            ModalSystem::new(vec![1.0], vec![0.0]).unwrap(),
            vec![Stop::new(vec![2.0], 0.5, stiffness, 0.0).unwrap()],
            Forcing::constant(vec![0.0]).unwrap(),
            vec![0.0],
            vec![-1.0],
            20.0,
        );
        let history = simulate(&Arc::new(problem.unwrap()), Method::Exact, &mut |_| true)?;
        Ok(history.energy_residual())
    }

    #[test]
    fn stops_are_followed_or_refused_at_any_stiffness() {
        // sqrt(k) 2 T = 1e13
        let most = 6.25e22;
        for exponent in (0..300).step_by(4) {
            let stiffness = 10f64.powi(exponent);
            match run(stiffness) {
                Ok(residual) => {
                    assert!(
                        stiffness <= most && residual < 1e-6,
                        "{stiffness}: {residual}"
                    );
                }
                Err(Error::TooStiff {
                    law: 0, most: told, ..
                }) => {
                    assert!(stiffness > most && (told / most - 1.0).abs() < 1e-9);
                }
                Err(other) => panic!("{stiffness}: {other}"),
            }
        }
    }
}
