//! Threads that share the runs of a batch.

use super::{Batch, Desk, Failure, Parameters};
use crate::error::{Error, Result};
use std::slice::ChunksMut;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Is told how many runs there are; answers whether to go on.
pub type Progress<'a> = &'a mut dyn FnMut(usize) -> bool;

/// Runs that a thread takes at a time: long enough not to meet the others often, short enough
/// that all end together.
const CHUNK: usize = 1024;

/// Runs that fill the widest lanes: chunks are whole multiples of it, so that no lane is empty
/// but at the end.
const FULL_LANES: usize = 8;

/// Runs of a chunk: a chain where runs follow each other, else a share for every thread.
fn chunk(parameters: &Parameters<'_>, threads: usize) -> usize {
    if parameters.is_chained() {
        return parameters.chain;
    }
    let share = parameters.runs.div_ceil(threads.max(1));
    share.next_multiple_of(FULL_LANES).min(CHUNK)
}

/// What the threads share.
struct Shared<'a, 'v> {
    batch: &'a Batch,
    parameters: &'a Parameters<'a>,
    /// The chunks that nobody has taken yet, with the number of the next.
    left: Mutex<(usize, ChunksMut<'v, f64>)>,
    done: AtomicUsize,
    stopped: AtomicBool,
}

/// Makes all runs; see [`Batch::run`].
pub(super) fn run(
    batch: &Batch,
    parameters: &Parameters<'_>,
    threads: usize,
    values: &mut [f64],
    progress: Progress<'_>,
) -> Result<Vec<Failure>> {
    if parameters.runs == 0 || batch.width == 0 {
        return Ok(Vec::new());
    }
    let chunk = chunk(parameters, threads);
    let threads = threads.clamp(1, parameters.runs.div_ceil(chunk));
    let shared = Shared {
        batch,
        parameters,
        left: Mutex::new((0, values.chunks_mut(chunk * batch.width))),
        done: AtomicUsize::new(0),
        stopped: AtomicBool::new(false),
    };
    let mut failures = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads)
            .map(|_| scope.spawn(|| shared.work(&mut |_| true)))
            .collect();
        let mut failures = shared.work(progress);
        for other in others {
            match other.join() {
                Ok(found) => failures.extend(found),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        failures
    });
    if shared.stopped.load(Ordering::Relaxed) {
        return Err(Error::Interrupted { time: 0.0 });
    }
    failures.sort_by_key(|failure| failure.run);
    Ok(failures)
}

impl Shared<'_, '_> {
    /// Takes chunks until none is left.
    fn work(&self, progress: Progress<'_>) -> Vec<Failure> {
        let mut desk = Desk::new(self.batch);
        let mut failures = Vec::new();
        while !self.stopped.load(Ordering::Relaxed) {
            let Some((first, values)) = self.next() else {
                break;
            };
            let (batch, parameters) = (self.batch, self.parameters);
            if parameters.is_chained() {
                let mut goes_on = || self.goes_on(1, progress);
                failures.extend(batch.chain(parameters, first, values, &mut desk, &mut goes_on));
                continue;
            }
            let runs = values.len() / batch.width;
            batch.part(parameters, first, values, &mut desk, &mut failures);
            self.goes_on(runs, progress);
        }
        failures
    }

    /// Tells how many more runs there are; returns whether to go on.
    fn goes_on(&self, more: usize, progress: Progress<'_>) -> bool {
        let done = self.done.fetch_add(more, Ordering::Relaxed) + more;
        if !progress(done) {
            self.stopped.store(true, Ordering::Relaxed);
        }
        !self.stopped.load(Ordering::Relaxed)
    }
}

impl<'v> Shared<'_, 'v> {
    /// The first run of the next chunk, and the place of its numbers.
    fn next(&self) -> Option<(usize, &'v mut [f64])> {
        let mut left = self.left.lock().unwrap_or_else(PoisonError::into_inner);
        let (first, chunks) = &mut *left;
        let values = chunks.next()?;
        let start = *first;
        *first += values.len() / self.batch.width;
        Some((start, values))
    }
}
