//! Reading one linear combination of the modal coordinates.

use super::PhaseRecord;
use crate::law::Affine;
use crate::method::piecewise_linear::signal::Signal;
use crate::method::piecewise_linear::view::View;
use crate::number::{Instructions, LANES, Vectorised};
use std::cell::Cell;

/// A time derivative (0, 1 or 2) of `row . q` at each time.
pub(super) struct Projection<'a> {
    pub(super) record: &'a PhaseRecord,
    pub(super) row: &'a [f64],
    pub(super) times: &'a [f64],
    pub(super) order: usize,
}

/// Room for reading a linear combination, used again and again.
#[derive(Debug, Default)]
struct Reader {
    view: [View; 1],
    signal: Signal,
    combined: Vec<f64>,
}

thread_local! {
    static READER: Cell<Option<Box<Reader>>> = const { Cell::new(None) };
}

/// The combination as the only local coordinate.
pub(super) const COORDINATE: Affine = Affine::coordinate(0);

impl Vectorised for Projection<'_> {
    type Output = Vec<f64>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Vec<f64> {
        let phases = &self.record.phases;
        let mut reader = READER.take().unwrap_or_default();
        let Reader {
            view,
            signal,
            combined,
        } = &mut *reader;
        let mut values = Vec::with_capacity(self.times.len());
        let mut number = 0;
        let mut left = self.times;
        while let Some(first) = left.first() {
            number = self.record.phase_from(number, *first);
            let phase = phases.list[number];
            let until = (phases.list.get(number + 1)).map_or(f64::INFINITY, |next| next.start);
            view[0].set::<I>(&phases.spectra[phase.spectrum], self.row, combined);
            signal.set::<I>(phases, phase, view, &COORDINATE, self.record.duration);
            // At least the first, so that the loop ends whatever times are asked for.
            let mut count = 1;
            while count < left.len() && phase.start <= left[count] && left[count] < until {
                count += 1;
            }
            let (inside, later) = left.split_at(count);
            for times in inside.chunks(LANES) {
                let mut since = [0.0; LANES];
                for (since, time) in since.iter_mut().zip(times) {
                    *since = time - phase.start;
                }
                let since = &since[..times.len()];
                signal.sample::<I>(self.order, phases, phase, since, &mut values);
            }
            left = later;
        }
        READER.set(Some(reader));
        values
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

    #[test]
    fn values_do_not_depend_on_the_other_times() {
        let omega: Vec<f64> = (1..=10).map(|n| 40.0 * f64::from(n * n)).collect();
        let omega2 = omega.iter().map(|w| w * w).collect();
        let damping = omega.iter().map(|w| 0.01 * w).collect();
        let row: Vec<f64> = (0..10).map(|n| 1.0 - 0.05 * f64::from(n)).collect();
        let stop = Stop::new(row.clone(), 0.0, 2e4, 0.0).unwrap();
        let velocity = vec![-0.5; 10];
        let problem = Problem::new(
            ModalSystem::new(omega2, damping).unwrap(),
            vec![stop],
            Forcing::constant(vec![0.0; 10]).unwrap(),
            vec![0.0; 10],
            velocity,
            0.2,
        );
        let history = simulate(&Arc::new(problem.unwrap()), &mut |_| true).unwrap();
        let times: Vec<f64> = (0..=200).map(|n| 1e-3 * f64::from(n)).collect();
        for order in [
            Derivative::Displacement,
            Derivative::Velocity,
            Derivative::Acceleration,
        ] {
            let together = history.project(&row, &times, order).unwrap();
            for (time, value) in times.iter().zip(together) {
                let alone = history.project(&row, &[*time], order).unwrap();
                assert_eq!(alone, [value], "at {time} s");
            }
        }
    }
}
