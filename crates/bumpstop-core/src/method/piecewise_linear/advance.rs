//! The certified walk: from the start of a phase to the first instant at which a guard reaches
//! zero, by cells on which the jets prove that none does, eight at once.

use super::bracket::{Bracket, Probe, Watched};
use super::cells::{Cells, Moved, Seen};
use super::curved::CurvedGuards;
use super::jet::{Jet, Verdict};
use super::phase::{Phase, Phases};
use super::rows::{ComplexBlock, RealBlock};
use super::signal::{Instant, Signal};
use super::spectrum::Spectrum;
use super::tables::{CELLS, Tables};
use crate::number::{Instructions, Lanes, Number, Plain};

/// The smallest cell, relative to the time since the start of the phase (or to the typical
/// period where that is longer): below it nothing can be told from rounding.
const SMALLEST_CELL: f64 = 1e-13;

/// The first cells are so wide that a typical frequency of the guard turns by this angle.
const FIRST_TURN: f64 = 1.0;

/// The rank, among guards that are negative at once, from which on rounding may have made them so.
const DOUBTFUL: usize = 4;

/// A guard that is watched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Start {
    /// Positive at the start of the phase.
    Positive,
    /// Zero there: it has just switched, and departs. With slope and curvature where they are
    /// known better than from the signal.
    Zero(Option<[f64; 2]>),
    /// Zero there with its first two derivatives: its third one decides.
    Tangent,
    /// On the wrong side of zero, for velocities have jumped: its law switches at once.
    Below,
}

/// The zero that was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crossing {
    /// Which of the watched guards.
    pub watched: usize,
    /// Time since the start of the phase, in s.
    pub time: f64,
}

/// How the walk went.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Certificate {
    /// Cells looked at.
    pub cells: usize,
    /// The largest size that a guard could have had on the wrong side of zero, in the guard's
    /// own unit.
    pub missed: f64,
}

/// The walker, with its tables for each spectrum of a run.
#[derive(Debug, Default)]
pub(crate) struct Walk {
    tables: Tables,
    /// The shortest typical time of the present phase.
    period: f64,
    /// Exponentials at the left end of the first cell, and their moduli.
    left: Vec<ComplexBlock>,
    sizes: Vec<RealBlock>,
    moved: Vec<Moved>,
    seen: Vec<Seen>,
    probe: Vec<ComplexBlock>,
}

/// What is walked along.
#[derive(Clone, Copy)]
pub(crate) struct Path<'a> {
    pub phases: &'a Phases,
    pub phase: Phase,
    /// The guards, the affine ones first, and how each starts.
    pub signals: &'a [Signal],
    pub curved: CurvedGuards<'a>,
    pub starts: &'a [Start],
    /// Where the walk begins and ends, in s since the start of the phase.
    pub from: f64,
    pub limit: f64,
}

impl<'a> Path<'a> {
    /// One of the guards.
    #[inline(always)]
    fn guard(&self, watched: usize) -> Watched<'a> {
        match self.signals.get(watched) {
            Some(signal) => Watched::Affine(signal),
            None => {
                let CurvedGuards { list, functions } = self.curved;
                Watched::Curved(&list[watched - self.signals.len()], functions)
            }
        }
    }

    #[inline(always)]
    fn spectrum(&self) -> &Spectrum {
        &self.phases.spectra[self.phase.spectrum]
    }

    /// Whether a guard leaves zero at this time.
    #[inline(always)]
    fn departs(&self, watched: usize, time: f64) -> bool {
        time == self.from && !matches!(self.starts[watched], Start::Positive)
    }
}

/// A stretch of time on which a guard's jet is known.
#[derive(Clone, Copy)]
struct Cell {
    left: f64,
    width: f64,
    level: usize,
}

impl Cell {
    #[inline(always)]
    fn bracket(&self, guess: f64) -> Bracket {
        let radius = 0.5 * self.width;
        Bracket::new(
            self.left,
            self.left + self.width,
            self.left + radius + guess,
        )
    }
}

/// What some cells, or one of them, came to.
enum Outcome {
    Clear,
    Found(Crossing),
    /// Nothing is proved on the cell of this number: smaller ones are needed from there on.
    Halve(usize),
}

/// What is seen of one guard on one cell.
enum Sight {
    /// It stays positive.
    Clear,
    /// It is negative as soon as the path begins; of several such, the lowest rank goes first.
    AtOnce(usize),
    /// It has a zero there.
    Crosses(Bracket),
    /// It has one there if it is negative at the right end.
    EndDecides(Bracket),
    /// Nothing is proved.
    Unclear,
}

impl Walk {
    /// Turns to another run, whose longest cell is given.
    pub(crate) fn start(&mut self, longest: f64) {
        self.tables.start(longest);
    }

    /// The first zero of any signal on the path, if there is one.
    #[inline(always)]
    pub(crate) fn first_zero<I: Instructions>(
        &mut self,
        path: Path<'_>,
        certificate: &mut Certificate,
    ) -> Option<Crossing> {
        let mut level = self.prepare::<I>(&path);
        let mut time = path.from;
        while time < path.limit {
            if time > path.from {
                self.anchor::<I>(path.spectrum(), time);
            }
            let width = self.tables.width(level);
            self.look::<I>(&path, time, level, certificate);
            match self.judge::<I>(&path, time, level) {
                Outcome::Clear => {
                    time += CELLS as f64 * width;
                    certificate.cells += CELLS;
                    level = level.saturating_sub(1);
                }
                Outcome::Found(crossing) => {
                    certificate.cells += 1 + ((crossing.time - time) / width) as usize;
                    return (crossing.time < path.limit).then_some(crossing);
                }
                Outcome::Halve(cell) => {
                    time += cell as f64 * width;
                    certificate.cells += cell + 1;
                    level += 1;
                }
            }
        }
        None
    }

    /// Stands at the start of a path; returns the first level.
    #[inline(always)]
    fn prepare<I: Instructions>(&mut self, path: &Path<'_>) -> usize {
        let spectrum = path.spectrum();
        let blocks = spectrum.lambda.len();
        self.left.resize(blocks, ComplexBlock::ONE);
        self.probe.resize(blocks, ComplexBlock::ONE);
        self.sizes.resize(blocks, RealBlock::ONE);
        if path.from > 0.0 {
            self.anchor::<I>(spectrum, path.from);
        } else {
            self.left.fill(ComplexBlock::ONE);
            self.sizes.fill(RealBlock::ONE);
        }
        self.period = self.tables.longest().min(1.0 / spectrum.fastest);
        let mut pace = 0.0f64;
        for signal in path.signals {
            pace = pace.max(signal.pace(spectrum));
        }
        for curved in path.curved.list {
            pace = pace.max(curved.pace(spectrum));
        }
        let mut level = 0;
        while self.tables.width(level) * pace > FIRST_TURN && level < 1000 {
            level += 1;
        }
        level
    }

    #[inline(always)]
    fn anchor<I: Instructions>(&mut self, spectrum: &Spectrum, time: f64) {
        let time = Lanes::<I>::of(time);
        let rows = self.left.iter_mut().zip(&mut self.sizes);
        for (lambda, (left, sizes)) in spectrum.lambda.iter().zip(rows) {
            let (exponential, size) = lambda.lanes::<I>().scale(time).exp_and_size();
            left.put(exponential);
            sizes.put(size);
        }
    }

    /// Looks at all guards on the cells of the given level from `time` on.
    #[inline(always)]
    fn look<I: Instructions>(
        &mut self,
        path: &Path<'_>,
        time: f64,
        level: usize,
        certificate: &mut Certificate,
    ) {
        let cells = Cells {
            time,
            limit: path.limit,
            left: &self.left,
            sizes: &self.sizes,
            level: (self.tables).level::<I>(path.phase.spectrum, path.spectrum(), level),
        };
        self.seen.resize(path.signals.len(), Seen::default());
        for (watched, (signal, seen)) in path.signals.iter().zip(&mut self.seen).enumerate() {
            cells.look::<I>(signal, path.phases, path.phase, &mut self.moved, seen);
            certificate.missed = certificate.missed.max(seen.jets.rounding);
            if path.departs(watched, time) {
                // The first cell has a verdict of its own.
                seen.clear &= !1;
            }
        }
        if !path.curved.list.is_empty() {
            self.look_at_curved(path, time, level, certificate);
        }
    }

    /// Looks at the curved guards, behind the affine ones.
    #[cold]
    fn look_at_curved(
        &mut self,
        path: &Path<'_>,
        time: f64,
        level: usize,
        certificate: &mut Certificate,
    ) {
        let motion = (path.phases, path.phase);
        let cells = Cells {
            time,
            limit: path.limit,
            left: &self.left,
            sizes: &self.sizes,
            level: (self.tables).level::<Plain>(path.phase.spectrum, path.spectrum(), level),
        };
        for curved in path.curved.list {
            let functions = path.curved.functions;
            let mut seen = curved.look(functions, &cells, motion, &mut self.moved);
            certificate.missed = certificate.missed.max(seen.jets.rounding);
            if path.departs(self.seen.len(), time) {
                seen.clear &= !1;
            }
            self.seen.push(seen);
        }
    }

    /// Goes through the cells on which some guard is not clear.
    #[inline(always)]
    fn judge<I: Instructions>(&mut self, path: &Path<'_>, time: f64, level: usize) -> Outcome {
        let width = self.tables.width(level);
        let mut open = self.seen.iter().fold(0, |open, seen| open | !seen.clear);
        while open != 0 {
            let number = open.trailing_zeros() as usize;
            open &= open - 1;
            let cell = Cell {
                left: time + number as f64 * width,
                width,
                level,
            };
            if cell.left >= path.limit {
                return Outcome::Clear;
            }
            match self.judge_cell::<I>(path, cell, number) {
                Outcome::Clear => {}
                outcome => return outcome,
            }
        }
        Outcome::Clear
    }

    /// The first zero on a cell that is not clear.
    ///
    /// Of guards that are negative at once the one goes first that is so by its lowest derivative,
    /// and last what rounding may decide. Stops that are hit at one instant switch one after the
    /// other, and while only some of them have, the others' forces are lacking in the higher
    /// derivatives: by these a stop at rest between them would open and close for ever, and never
    /// let the next one have its turn.
    #[inline(always)]
    fn judge_cell<I: Instructions>(
        &mut self,
        path: &Path<'_>,
        cell: Cell,
        number: usize,
    ) -> Outcome {
        let smallest = SMALLEST_CELL * (cell.left + cell.width).max(self.period);
        let mut first: Option<Crossing> = None;
        let mut at_once: Option<(usize, usize)> = None;
        let mut is_unclear = false;
        for watched in 0..path.starts.len() {
            let departs = path.departs(watched, cell.left);
            let sight = if self.seen[watched].clear >> number & 1 == 1 {
                Sight::Clear
            } else if departs {
                self.depart(path, watched, cell)
            } else {
                self.examine::<I>(path, watched, cell, number)
            };
            let (bracket, crosses) = match sight {
                Sight::Clear => continue,
                Sight::AtOnce(rank) => {
                    if at_once.is_none_or(|(least, _)| rank < least) {
                        at_once = Some((rank, watched));
                    }
                    continue;
                }
                Sight::Crosses(bracket) => (bracket, true),
                Sight::EndDecides(bracket) => (bracket, false),
                Sight::Unclear if cell.width >= smallest => {
                    is_unclear = true;
                    continue;
                }
                // A departure that cannot be told from rounding is taken as one.
                Sight::Unclear if departs => continue,
                Sight::Unclear => (cell.bracket(0.0), false),
            };
            if is_unclear || at_once.is_some() {
                continue;
            }
            let probe = &mut self.probe(path, watched);
            if !crosses && probe.values::<I>(bracket.right)[0] > 0.0 {
                continue;
            }
            let time = bracket.refine::<I>(probe);
            if first.is_none_or(|f| time < f.time) {
                first = Some(Crossing { watched, time });
            }
        }
        match at_once {
            Some((_, watched)) => Outcome::Found(Crossing {
                watched,
                time: cell.left,
            }),
            None if is_unclear => Outcome::Halve(number),
            None => first.map_or(Outcome::Clear, Outcome::Found),
        }
    }

    /// What one guard does on a cell on which it is not clear.
    #[inline(always)]
    fn examine<I: Instructions>(
        &mut self,
        path: &Path<'_>,
        watched: usize,
        cell: Cell,
        number: usize,
    ) -> Sight {
        let jet = self.seen[watched].jets.cell(number);
        let bracket = cell.bracket(jet.descent());
        match jet.verdict(0.5 * cell.width) {
            Verdict::Crosses => Sight::Crosses(bracket),
            Verdict::EndDecides => Sight::EndDecides(bracket),
            Verdict::Convex(curvature) => {
                let probe = &mut self.probe(path, watched);
                match bracket.valley::<I>(probe, curvature, jet.rounding) {
                    None => Sight::Clear,
                    Some(before) if before.right < bracket.right => Sight::Crosses(before),
                    Some(after) => Sight::EndDecides(after),
                }
            }
            Verdict::Open => Sight::Unclear,
        }
    }

    #[inline(always)]
    fn probe<'a>(&'a mut self, path: &Path<'a>, watched: usize) -> Probe<'a> {
        Probe {
            phases: path.phases,
            phase: path.phase,
            guard: path.guard(watched),
            exponentials: &mut self.probe,
        }
    }

    /// The first cell of a guard that does not start positive.
    #[inline(always)]
    fn depart(&mut self, path: &Path<'_>, watched: usize, cell: Cell) -> Sight {
        match path.starts[watched] {
            Start::Positive => Sight::Unclear,
            Start::Below => Sight::AtOnce(0),
            Start::Tangent => self.depart_tangent(path, watched, cell),
            Start::Zero(known) => match path.guard(watched) {
                Watched::Affine(signal) => {
                    let seen = &self.seen[watched];
                    self.depart_from_zero(path, signal, seen, known, cell)
                }
                Watched::Curved(..) => self.depart_curved(path, watched, cell),
            },
        }
    }

    /// The first cell of a guard that starts at zero, with slope and curvature where known.
    #[inline(always)]
    fn depart_from_zero(
        &self,
        path: &Path<'_>,
        signal: &Signal,
        seen: &Seen,
        known: Option<[f64; 2]>,
        cell: Cell,
    ) -> Sight {
        let (phases, phase) = (path.phases, path.phase);
        let is_doubtful = known.is_some();
        let [slope, curvature] = known.unwrap_or_else(|| {
            let [_, slope, curvature] = if cell.left == 0.0 {
                signal.values_at_start(phases, phase)
            } else {
                let at = Instant {
                    time: cell.left,
                    exponentials: &self.left,
                };
                signal.values::<Plain>(phases, phase, &at)
            };
            let noise = signal.rate_rounding(phases, phase);
            [beyond(slope, noise[0]), beyond(curvature, noise[1])]
        });
        if let Some(order) = falls(slope, curvature) {
            return Sight::AtOnce(if is_doubtful { DOUBTFUL + order } else { order });
        }
        let mut jet = Jet {
            curvature: seen.first_curvature,
            third: seen.jets.third,
            rest: seen.jets.rest,
            rounding: seen.jets.rounding,
            ..Jet::default()
        };
        signal.add_clusters_after(phases, phase, cell.left, cell.width, &mut jet);
        // The whole guard's, so that the clusters' parts must not come on top: a slope too large
        // would prove a departure that is none.
        (jet.value, jet.slope) = (0.0, slope);
        if jet.departs(cell.width) {
            Sight::Clear
        } else {
            Sight::Unclear
        }
    }

    /// The first cell of a curved guard that starts at zero.
    #[cold]
    fn depart_curved(&self, path: &Path<'_>, watched: usize, cell: Cell) -> Sight {
        let Watched::Curved(curved, functions) = path.guard(watched) else {
            return Sight::Unclear;
        };
        let at = Instant {
            time: cell.left,
            exponentials: &self.left,
        };
        let start = curved.at(functions, path.phases, path.phase, &at);
        let slope = beyond(start.slope, start.rest[1]);
        if let Some(order) = falls(slope, beyond(start.curvature, start.rest[2])) {
            return Sight::AtOnce(order);
        }
        if self.seen[watched].jets.cell(0).rises(0.5 * cell.width) {
            Sight::Clear
        } else {
            Sight::Unclear
        }
    }

    /// The first cell of a guard that starts at zero with its first two derivatives: it stays
    /// positive where its second derivative does. Rare, so that plain arithmetic, which gives the
    /// same bits, does.
    #[cold]
    fn depart_tangent(&mut self, path: &Path<'_>, watched: usize, cell: Cell) -> Sight {
        let (phases, phase) = (path.phases, path.phase);
        let rate = path.signals[watched].derivative(phases, phase);
        let second = rate.derivative(phases, phase);
        let cells = Cells {
            time: cell.left,
            limit: path.limit,
            left: &self.left,
            sizes: &self.sizes,
            level: (self.tables).level::<Plain>(phase.spectrum, path.spectrum(), cell.level),
        };
        let mut seen = Seen::default();
        cells.look::<Plain>(&second, phases, phase, &mut self.moved, &mut seen);
        match self.depart_from_zero(path, &second, &seen, None, cell) {
            Sight::AtOnce(rank) => Sight::AtOnce(2 + rank),
            sight => sight,
        }
    }
}

/// The order of the derivative by which a guard that is zero becomes negative, if one of the
/// first two makes it so.
#[inline(always)]
fn falls(slope: f64, curvature: f64) -> Option<usize> {
    if slope < 0.0 {
        Some(1)
    } else {
        (slope == 0.0 && curvature < 0.0).then_some(2)
    }
}

/// What is left of a rate at least, less its rounding.
#[inline(always)]
fn beyond(rate: f64, noise: f64) -> f64 {
    if rate > noise {
        rate - noise
    } else if rate < -noise {
        rate + noise
    } else {
        0.0
    }
}
