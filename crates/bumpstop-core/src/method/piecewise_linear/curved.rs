//! Guards that are curved: functions of the local motion, but no sums of exponentials.
//!
//! Along a phase the local coordinates and their rates are signals. What enclosures of these give
//! on a cell is an enclosure of the guard, and judged as the jets of affine guards are. Curved
//! guards are rare, so that plain arithmetic, which gives the same bits, does.

use super::cells::{Cells, Moved, Seen};
use super::enclosure::Enclosure;
use super::jet::{Jet, Jets};
use super::phase::{Phase, Phases};
use super::signal::{Instant, Signal};
use super::spectrum::Spectrum;
use super::tables::CELLS;
use super::view::View;
use crate::law::{Affine, Law, Local, State};
use crate::number::{Number, Plain};
use crate::problem::Problem;

/// The guards of some laws in their present states, as functions of the enclosed local motion.
pub(crate) trait Functions {
    /// One guard of one law, by their numbers.
    fn guard(
        &self,
        law: usize,
        number: usize,
        position: &Local<Enclosure>,
        velocity: &Local<Enclosure>,
    ) -> Enclosure;
}

/// The guards of a problem's laws.
pub(crate) struct Guards<'a, L> {
    pub problem: &'a Problem<L>,
    pub states: &'a [State],
}

impl<L: Law> Functions for Guards<'_, L> {
    fn guard(
        &self,
        law: usize,
        number: usize,
        position: &Local<Enclosure>,
        velocity: &Local<Enclosure>,
    ) -> Enclosure {
        self.problem.laws[law].guard_value(self.states[law], number, position, velocity)
    }
}

/// A curved guard that is watched.
#[derive(Debug)]
pub(crate) struct Curved {
    /// Which one of which law.
    law: usize,
    number: usize,
    /// The local coordinates and their rates.
    positions: Vec<Signal>,
    velocities: Vec<Signal>,
}

/// Curved guards, and what they are functions of.
#[derive(Clone, Copy)]
pub(crate) struct CurvedGuards<'a> {
    pub list: &'a [Curved],
    pub functions: &'a dyn Functions,
}

impl Curved {
    /// A guard of a law that has so many coordinates, seen through `views`.
    pub(crate) fn new(
        [law, number, coordinates]: [usize; 3],
        phases: &Phases,
        phase: Phase,
        views: &[View],
        remaining: f64,
    ) -> Self {
        let signal = |function: Affine| {
            let mut signal = Signal::default();
            signal.set::<Plain>(phases, phase, views, &function, remaining);
            signal
        };
        Self {
            law,
            number,
            positions: (0..coordinates)
                .map(Affine::coordinate)
                .map(signal)
                .collect(),
            velocities: (0..coordinates).map(Affine::rate).map(signal).collect(),
        }
    }

    /// A typical angular frequency of its coordinates, in rad/s.
    pub(crate) fn pace(&self, spectrum: &Spectrum) -> f64 {
        (self.positions.iter()).fold(0.0, |pace, signal| pace.max(signal.pace(spectrum)))
    }

    /// The guard on eight consecutive cells; `moved` is room for terms.
    pub(crate) fn look(
        &self,
        functions: &dyn Functions,
        cells: &Cells<'_>,
        (phases, phase): (&Phases, Phase),
        moved: &mut Vec<Moved>,
    ) -> Seen {
        let radius = 0.5 * cells.level.width;
        let look = |signals: &[Signal], moved: &mut Vec<Moved>| -> Vec<Jets> {
            let seen = |signal| {
                let mut seen = Seen::default();
                cells.look::<Plain>(signal, phases, phase, moved, &mut seen);
                seen.jets
            };
            signals.iter().map(seen).collect()
        };
        let positions = look(&self.positions, moved);
        let velocities = look(&self.velocities, moved);
        let mut seen = Seen::default();
        let jets = &mut seen.jets;
        for cell in 0..CELLS {
            let on_cell = |jets: &Jets| with_rounding(jets.cell(cell), radius);
            let position = local(positions.iter().map(on_cell));
            let velocity = local(velocities.iter().map(on_cell));
            let guard = functions.guard(self.law, self.number, &position, &velocity);
            jets.set_cell(cell, &guard.jet);
        }
        seen.clear = jets.clear::<Plain>(radius);
        seen
    }

    /// Value, slope and curvature at an instant, with bounds of their rounding in the rest.
    pub(crate) fn at(
        &self,
        functions: &dyn Functions,
        phases: &Phases,
        phase: Phase,
        at: &Instant<'_>,
    ) -> Jet {
        let known = |signal: &Signal| {
            let [value, slope, curvature] = signal.values::<Plain>(phases, phase, at);
            let [of_slope, of_curvature] = signal.rate_rounding(phases, phase);
            let rounding = signal.rounding(at.time);
            let jet = Jet {
                value,
                slope,
                curvature,
                third: 0.0,
                rest: [rounding, of_slope, of_curvature],
                rounding: 0.0,
            };
            Enclosure::new(jet, 0.0)
        };
        let position = local(self.positions.iter().map(known));
        let velocity = local(self.velocities.iter().map(known));
        let mut jet = functions
            .guard(self.law, self.number, &position, &velocity)
            .jet;
        jet.rest[0] += jet.rounding;
        jet
    }
}

/// A jet whose bounds hold its rounding, that of slope and curvature too, so that what is made of
/// it is off by no more than its bounds say.
fn with_rounding(mut jet: Jet, radius: f64) -> Enclosure {
    let mut rounding = jet.rounding;
    for rest in &mut jet.rest {
        *rest += rounding;
        rounding /= radius;
    }
    Enclosure::new(jet, radius)
}

/// Local coordinates; those that are not there are zero.
fn local(known: impl Iterator<Item = Enclosure>) -> Local<Enclosure> {
    let mut all = [Enclosure::of(0.0); 3];
    for (to, enclosure) in all.iter_mut().zip(known) {
        *to = enclosure;
    }
    all
}
