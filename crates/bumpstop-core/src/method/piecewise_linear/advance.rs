//! The certified walk: from the start of a phase to the first instant at which a guard reaches
//! zero, by steps on which the jets prove that none does.

use super::jet::Verdict;
use super::phase::{Phase, Phases};
use super::rows::{ComplexBlock, RealBlock};
use super::signal::{Instant, Signal};
use super::spectrum::Spectrum;
use super::tables::{CELLS_BETWEEN_ANCHORS, Level, Tables};
use crate::number::{Instructions, Lanes, Number};

/// The smallest cell, relative to the time since the start of the phase (or to the typical
/// period where that is longer): below it nothing can be told from rounding.
const SMALLEST_CELL: f64 = 1e-13;

/// Most iterations when a bracketed zero is refined; bisection alone needs about sixty.
const REFINEMENTS: usize = 100;

/// A Halley step below this part of its bracket is the last.
const SMALL_STEP: f64 = 2e-6;

/// Where a zero is, and a guess of it.
#[derive(Debug, Clone, Copy)]
struct Bracket {
    left: f64,
    right: f64,
    guess: f64,
}

impl Bracket {
    /// The guess is used where it lies inside.
    #[inline(always)]
    fn new(left: f64, right: f64, guess: f64) -> Self {
        let inside = guess > left && guess < right;
        Self {
            left,
            right,
            guess: if inside { guess } else { 0.5 * (left + right) },
        }
    }
}

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
    left: Vec<ComplexBlock>,
    sizes: Vec<RealBlock>,
    bound: Vec<RealBlock>,
    middle: Vec<ComplexBlock>,
    right: Vec<ComplexBlock>,
    probe: Vec<ComplexBlock>,
}

/// What is walked along.
#[derive(Clone, Copy)]
pub(crate) struct Path<'a> {
    pub phases: &'a Phases,
    pub phase: Phase,
    /// The guards, and how each starts.
    pub signals: &'a [Signal],
    pub starts: &'a [Start],
    /// Where the walk begins and ends, in s since the start of the phase.
    pub from: f64,
    pub limit: f64,
}

impl Path<'_> {
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

/// What a cell came to.
enum Outcome {
    Clear,
    Found(Crossing),
    Halve,
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
        let spectrum = path.spectrum();
        let mut level = self.prepare::<I>(&path);
        let mut time = path.from;
        let mut since_anchor = 0;
        let mut successes = 0;
        while time < path.limit {
            (self.tables).fill::<I>(path.phase.spectrum, spectrum, level);
            let width = self.tables.width(level);
            certificate.cells += 1;
            match self.judge::<I>(&path, time, level, certificate) {
                Outcome::Clear => {
                    time += width;
                    since_anchor += 1;
                    std::mem::swap(&mut self.left, &mut self.right);
                    self.grow::<I>(&path, level);
                    if since_anchor == CELLS_BETWEEN_ANCHORS {
                        self.anchor::<I>(spectrum, time);
                        since_anchor = 0;
                    }
                    successes += 1;
                    if successes >= 2 && level > 0 {
                        level -= 1;
                        successes = 0;
                    }
                }
                Outcome::Found(crossing) => {
                    return (crossing.time < path.limit).then_some(crossing);
                }
                Outcome::Halve => {
                    level += 1;
                    successes = 0;
                }
            }
        }
        None
    }

    /// Sets the tables for a phase; returns the first level.
    #[inline(always)]
    fn prepare<I: Instructions>(&mut self, path: &Path<'_>) -> usize {
        let spectrum = path.spectrum();
        let blocks = spectrum.lambda.len();
        for rows in [
            &mut self.left,
            &mut self.middle,
            &mut self.right,
            &mut self.probe,
        ] {
            rows.resize(blocks, ComplexBlock::ONE);
        }
        self.bound.resize(blocks, RealBlock::ONE);
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
        let mut level = 0;
        while self.tables.width(level) * pace > 2.0 && level < 1000 {
            level += 1;
        }
        level
    }

    /// Carries the sizes over a cell.
    #[inline(always)]
    fn grow<I: Instructions>(&mut self, path: &Path<'_>, level: usize) {
        let growth = &self.tables.level(path.phase.spectrum, level).growth;
        for (size, growth) in self.sizes.iter_mut().zip(growth) {
            size.put(size.lanes::<I>() * growth.lanes());
        }
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

    /// Looks at the cell of the given level that starts at `time`.
    #[inline(always)]
    fn judge<I: Instructions>(
        &mut self,
        path: &Path<'_>,
        time: f64,
        level: usize,
        certificate: &mut Certificate,
    ) -> Outcome {
        let spectrum = path.spectrum();
        let width = self.tables.width(level);
        let Level {
            half,
            whole,
            growth,
            ..
        } = self.tables.level(path.phase.spectrum, level);
        for b in 0..spectrum.lambda.len() {
            let left = self.left[b].lanes::<I>();
            self.middle[b].put(left * half[b].lanes());
            self.right[b].put(left * whole[b].lanes());
            let growth = growth[b].lanes::<I>().max(Lanes::of(1.0));
            self.bound[b].put(self.sizes[b].lanes() * growth);
        }
        let smallest = SMALLEST_CELL * (time + width).max(self.period);
        let mut first: Option<Crossing> = None;
        for watched in 0..path.signals.len() {
            let middle = time + 0.5 * width;
            let bracket = match self.look::<I>(path, watched, time, width, certificate) {
                Sight::Clear => None,
                Sight::AtOnce => return Outcome::Found(Crossing { watched, time }),
                Sight::Unclear if width >= smallest => return Outcome::Halve,
                // A departure that cannot be told from rounding is taken as one.
                Sight::Unclear if path.departs(watched, time) => None,
                Sight::Unclear => Some(Bracket::new(time, time + width, middle)),
                Sight::End(guess) => Some(Bracket::new(time, time + width, middle + guess)),
                Sight::Valley { curvature, guess } => {
                    let bracket = Bracket::new(time, time + width, middle + guess);
                    self.valley::<I>(path, watched, bracket, curvature)
                }
            };
            if let Some(bracket) = bracket
                && (bracket.right < time + width
                    || self.ends_below::<I>(path, watched, bracket.right))
            {
                let time = self.refine::<I>(path, watched, bracket);
                if first.is_none_or(|f| time < f.time) {
                    first = Some(Crossing { watched, time });
                }
            }
        }
        first.map_or(Outcome::Clear, Outcome::Found)
    }

    /// What the jet of one guard says of a cell.
    #[inline(always)]
    fn look<I: Instructions>(
        &mut self,
        path: &Path<'_>,
        watched: usize,
        time: f64,
        width: f64,
        certificate: &mut Certificate,
    ) -> Sight {
        let signal = &path.signals[watched];
        if path.departs(watched, time) {
            return match path.starts[watched] {
                Start::Below => Sight::AtOnce,
                Start::Tangent => self.depart_tangent::<I>(path, signal, time, width),
                Start::Zero(known) => self.depart::<I>(path, signal, known, time, width),
                Start::Positive => Sight::Unclear,
            };
        }
        let radius = 0.5 * width;
        let at = Instant {
            time: time + radius,
            exponentials: &self.middle,
        };
        let (phases, phase) = (path.phases, path.phase);
        let jet = signal.jet::<I>(phases, phase, &at, &self.bound, radius);
        certificate.missed = certificate.missed.max(jet.rounding);
        match jet.verdict(radius) {
            Verdict::Clear => Sight::Clear,
            Verdict::EndDecides => Sight::End(jet.descent()),
            Verdict::Convex(curvature) => Sight::Valley {
                curvature,
                guess: jet.descent(),
            },
            Verdict::Open => Sight::Unclear,
        }
    }

    /// The first cell of a guard that starts at zero, with slope and curvature where known.
    #[inline(always)]
    fn depart<I: Instructions>(
        &mut self,
        path: &Path<'_>,
        signal: &Signal,
        known: Option<[f64; 2]>,
        time: f64,
        width: f64,
    ) -> Sight {
        let at = Instant {
            time,
            exponentials: &self.left,
        };
        let mut jet = signal.jet::<I>(path.phases, path.phase, &at, &self.bound, width);
        let full = if time == 0.0 {
            signal.values_at_start(path.phases, path.phase)
        } else {
            signal.values::<I>(path.phases, path.phase, &at)
        };
        let [slope, curvature] = known.unwrap_or_else(|| {
            let noise = signal.rate_rounding(path.phases, path.phase);
            let beyond = |value: f64, noise: f64| if value.abs() > noise { value } else { 0.0 };
            [beyond(full[1], noise[0]), beyond(full[2], noise[1])]
        });
        jet.slope = slope;
        if jet.slope < 0.0 || (jet.slope == 0.0 && curvature < 0.0) {
            return Sight::AtOnce;
        }
        if jet.departs(width) {
            Sight::Clear
        } else {
            Sight::Unclear
        }
    }

    /// The first cell of a guard that starts at zero with its first two derivatives: it stays
    /// positive where its second derivative does.
    #[cold]
    fn depart_tangent<I: Instructions>(
        &mut self,
        path: &Path<'_>,
        signal: &Signal,
        time: f64,
        width: f64,
    ) -> Sight {
        let rate = signal.derivative(path.phases, path.phase);
        let second = rate.derivative(path.phases, path.phase);
        self.depart::<I>(path, &second, None, time, width)
    }

    /// Whether a guard is negative at the right end of the cell.
    #[inline(always)]
    fn ends_below<I: Instructions>(&self, path: &Path<'_>, watched: usize, right: f64) -> bool {
        let at = Instant {
            time: right,
            exponentials: &self.right,
        };
        path.signals[watched].value::<I>(path.phases, path.phase, &at) <= 0.0
    }

    /// Looks for the least value of a convex guard. A negative one ends a bracket; one that is
    /// zero to rounding is a touch, after which the right end of the cell decides.
    #[inline(always)]
    fn valley<I: Instructions>(
        &mut self,
        path: &Path<'_>,
        watched: usize,
        bracket: Bracket,
        curvature: f64,
    ) -> Option<Bracket> {
        let signal = &path.signals[watched];
        let rounding = signal.rounding(bracket.right);
        let (mut low, mut high) = (bracket.left, bracket.right);
        let mut t = 0.5 * (low + high);
        for _ in 0..REFINEMENTS {
            let values = self.probe::<I>(path, signal, t);
            // A convex function lies above every such parabola.
            let least = values[0] - 0.5 * values[1] * values[1] / curvature;
            if least > rounding {
                return None;
            }
            if values[0] < -rounding {
                return Some(Bracket::new(bracket.left, t, bracket.guess));
            }
            if values[1] > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - values[1] / values[2];
            let inside = newton > low && newton < high;
            let next = if inside { newton } else { 0.5 * (low + high) };
            if (next - t).abs() <= 4.0 * f64::EPSILON * t || next == t {
                break;
            }
            t = next;
        }
        Some(Bracket::new(low, bracket.right, bracket.guess))
    }

    /// Value and derivatives at any time.
    #[inline(always)]
    fn probe<I: Instructions>(&mut self, path: &Path<'_>, signal: &Signal, t: f64) -> [f64; 3] {
        let spectrum = path.spectrum();
        spectrum.exponentials::<I>(t, &mut self.probe);
        let at = Instant {
            time: t,
            exponentials: &self.probe,
        };
        signal.values::<I>(path.phases, path.phase, &at)
    }

    /// The zero between a positive left and a negative right end, by Halley's method kept
    /// inside the bracket.
    #[inline(always)]
    fn refine<I: Instructions>(
        &mut self,
        path: &Path<'_>,
        watched: usize,
        bracket: Bracket,
    ) -> f64 {
        let signal = &path.signals[watched];
        let (mut low, mut high) = (bracket.left, bracket.right);
        let mut t = bracket.guess;
        for _ in 0..REFINEMENTS {
            let [value, slope, curvature] = self.probe::<I>(path, signal, t);
            if value > 0.0 {
                low = t;
            } else {
                high = t;
            }
            let newton = value / slope;
            let halley = t - newton / (1.0 - 0.5 * newton * curvature / slope);
            let next = if halley > low && halley < high {
                halley
            } else {
                0.5 * (low + high)
            };
            let step = (next - t).abs();
            t = next;
            // The error after a Halley step goes with the cube of the step.
            if step < SMALL_STEP * (bracket.right - bracket.left) && halley == next
                || high - low <= 2.0 * f64::EPSILON * t
            {
                break;
            }
        }
        t
    }
}

/// What is seen of one guard on one cell.
enum Sight {
    /// It stays positive.
    Clear,
    /// It is negative as soon as the path begins.
    AtOnce,
    /// At most one zero; the right end tells. With a guess of it, from the middle.
    End(f64),
    /// Convex, with at least this curvature; with a guess of the first zero.
    Valley { curvature: f64, guess: f64 },
    /// Nothing is proved.
    Unclear,
}
