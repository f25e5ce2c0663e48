//! Reading one linear combination of the modal coordinates.

use super::PhaseRecord;
use crate::law::Affine;
use crate::method::piecewise_linear::signal::Signal;
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
        // The present phase, and when it starts and ends.
        let mut number = 0;
        let (mut from, mut until) = (f64::INFINITY, f64::NEG_INFINITY);
        for time in self.times {
            if !(from <= *time && *time < until) {
                number = self.record.phase_from(number, *time);
                let phase = phases.list[number];
                from = phase.start;
                until = (phases.list.get(number + 1)).map_or(f64::INFINITY, |next| next.start);
                view[0].set::<I>(&phases.spectra[phase.spectrum], self.row, combined);
                signal.set::<I>(phases, phase, view, &COORDINATE, self.record.duration);
            }
            let phase = phases.list[number];
            values.push(signal.at::<I>(self.order, phases, phase, time - from));
        }
        READER.set(Some(reader));
        values
    }
}
