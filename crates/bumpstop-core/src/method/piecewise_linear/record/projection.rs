//! Reading one linear combination of the modal coordinates.

use super::PhaseRecord;
use crate::law::Affine;
use crate::method::piecewise_linear::rows::ComplexBlock;
use crate::method::piecewise_linear::signal::{Instant, Signal};
use crate::method::piecewise_linear::view::View;
use crate::number::{Instructions, Vectorised};
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
    exponentials: Vec<ComplexBlock>,
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
        let mut present = None;
        let mut values = Vec::with_capacity(self.times.len());
        let mut number = 0;
        for time in self.times {
            number = self.record.phase_from(number, *time);
            let phase = phases.list[number];
            let spectrum = &phases.spectra[phase.spectrum];
            let Reader {
                view,
                signal,
                combined,
                exponentials,
            } = &mut *reader;
            if present != Some(number) {
                view[0].set::<I>(spectrum, self.row, combined);
                signal.set::<I>(phases, phase, view, &COORDINATE, self.record.duration);
                exponentials.resize(spectrum.lambda.len(), ComplexBlock::ZERO);
                present = Some(number);
            }
            let time = time - phase.start;
            spectrum.exponentials::<I>(time, exponentials);
            let at = Instant { time, exponentials };
            values.push(signal.derivative_value::<I>(self.order, phases, phase, &at));
        }
        READER.set(Some(reader));
        values
    }
}
