//! Where the spectra of a run are found again.
//!
//! Phases keep their spectra for as long as the run is asked for anything; what is bounded here is
//! how many are looked through at a switch.

use super::span::Span;
use super::spectrum::Spectrum;
use crate::law::{Law, State};
use crate::problem::Problem;

/// Spectra that are looked through, at most.
const MOST: usize = 1024;

/// The numbers of spectra, the latest used last.
#[derive(Debug, Clone)]
pub(crate) struct Recent {
    /// A digest of the laws' states, and the number.
    kept: Vec<(u64, usize)>,
    most: usize,
}

impl Default for Recent {
    fn default() -> Self {
        Self::of(MOST)
    }
}

impl Recent {
    /// Room for so many.
    pub(crate) fn of(most: usize) -> Self {
        Self {
            kept: Vec::new(),
            most,
        }
    }

    /// The number of the spectrum that serves the given states in such phases.
    #[inline(always)]
    pub(crate) fn find<L: Law>(
        &mut self,
        problem: &Problem<L>,
        states: &[State],
        span: Span,
        spectra: &[Box<Spectrum>],
    ) -> Option<usize> {
        let digest = digest(states);
        let serves = |(own, number): &(u64, usize)| {
            *own == digest && spectra[*number].serves(problem, states, span)
        };
        let found = self.kept.iter().rposition(serves)?;
        let latest = self.kept.len() - 1;
        let used = self.kept[found];
        self.kept.copy_within(found + 1.., found);
        self.kept[latest] = used;
        Some(used.1)
    }

    /// Keeps a number; the one that has not been used for longest goes where there are too many.
    pub(crate) fn keep(&mut self, states: &[State], number: usize) {
        if self.kept.len() >= self.most {
            self.kept.remove(0);
        }
        self.kept.push((digest(states), number));
    }
}

/// What states of the same numbers have in common.
#[inline(always)]
fn digest(states: &[State]) -> u64 {
    let mut digest = 0u64;
    for state in states {
        digest = (digest ^ u64::from(state.number)).wrapping_mul(PRIME);
    }
    digest
}

/// The prime of Fowler, Noll and Vo's hash.
const PRIME: u64 = 0x0100_0000_01b3;

#[cfg(test)]
mod tests {
    use super::super::{Advance, Run};
    use super::*;
    use crate::forcing::Forcing;
    use crate::law::Stop;
    use crate::number::dispatch;
    use crate::system::ModalSystem;

    /// Three stops on a structure of four modes, whose contacts overlap in many ways.
    fn problem() -> Problem<Stop> {
        let system = ModalSystem::new(vec![1.0, 7.0, 19.0, 40.0], vec![0.02; 4]).unwrap();
        let rows = [
            [1.0, 0.7, -0.4, 0.2],
            [-0.8, 0.9, 0.3, -0.5],
            [0.3, -0.6, 1.0, 0.4],
        ];
        let laws = rows.map(|row| Stop::new(row.to_vec(), 0.05, 30.0, 0.1).unwrap());
        Problem::new(
            system,
            laws.to_vec(),
            Forcing::constant(vec![0.0; 4]).unwrap(),
            vec![0.1, -0.2, 0.3, 0.0],
            vec![1.0, -2.0, 0.5, 1.5],
            12.0,
        )
        .unwrap()
    }

    /// Spectra that are made again begin at other starts, and differ in their last digits.
    #[test]
    fn a_small_table_changes_no_event() {
        let problem = problem();
        let run = |most: usize| {
            let mut run = Run::new(&problem);
            run.recent = Recent::of(most);
            run.scratch.bench.keep_parts(most);
            dispatch(Advance {
                run: &mut run,
                observer: &mut |_| true,
            })
            .unwrap();
            let kept = run.recent.kept.len();
            let spectra = run.phases.spectra.len();
            (run.events, kept, spectra)
        };
        let (events, kept, spectra) = run(MOST);
        let (same, few, more) = run(2);
        assert!(events.len() > 50);
        assert_eq!((kept, few), (spectra, 2));
        assert!(more > spectra, "{more} {spectra}");
        assert_eq!(events.len(), same.len());
        for (event, again) in events.iter().zip(&same) {
            assert_eq!((event.law, event.after), (again.law, again.after));
            assert!((event.time - again.time).abs() < 1e-10);
        }
    }
}
