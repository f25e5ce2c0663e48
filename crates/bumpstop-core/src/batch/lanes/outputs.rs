//! What is kept of eight runs, read phase by phase as they go.

use super::guard::{Guard, three};
use super::mask::{blend, chosen};
use super::motion::Motion;
use super::peaks::Peaks;
use super::plan::{Item, OfImpacts, Plan};
use super::run::Eight;
use super::shape::Shape;
use super::walk::Ends;
use crate::batch::quantity::largest_force;
use crate::impacts::Impact;
use crate::method::piecewise_linear::ComplexBlock;
use crate::number::{Block, Complex, Instructions, LANES, Lanes, Number};

/// A phase that has ended.
#[derive(Clone, Copy)]
pub(super) struct Span<'a, I: Instructions> {
    pub is_closed: bool,
    /// When it began.
    pub start: Lanes<I>,
    pub ends: &'a Ends,
    /// The lanes that have it.
    pub live: u8,
}

/// A linear combination along the phases.
#[derive(Debug, Clone, Default)]
struct Signal {
    /// Of each exponent in contact, and at rest.
    weights: Vec<ComplexBlock>,
    rest: Block,
    /// Amplitudes in the present phase, and the parabola beside them.
    terms: Vec<ComplexBlock>,
    polynomial: [Block; 3],
}

/// Reading of eight runs.
#[derive(Debug, Default)]
pub(super) struct Outputs {
    /// The numbers, a block for each.
    pub kept: Vec<Block>,
    signals: Vec<Signal>,
    exponentials: Vec<ComplexBlock>,
    /// The first sample that some lane has not reached.
    next: usize,
    impacts: [Vec<Impact>; LANES],
    events: [u32; LANES],
    peaks: Peaks,
}

impl Outputs {
    pub(super) fn new(modes: usize, plan: &Plan) -> Self {
        let signal = Signal {
            weights: vec![ComplexBlock::ZERO; modes],
            terms: vec![ComplexBlock::ZERO; modes],
            ..Signal::default()
        };
        Self {
            kept: vec![[0.0; LANES]; plan.width],
            signals: vec![signal; plan.rows.len()],
            exponentials: vec![ComplexBlock::ZERO; modes],
            peaks: Peaks::new(modes),
            ..Self::default()
        }
    }

    /// Turns to new runs.
    #[inline(always)]
    pub(super) fn start<I: Instructions>(&mut self, shape: &Shape, plan: &Plan, motion: &Motion) {
        self.next = 0;
        self.events = [0; LANES];
        for impacts in &mut self.impacts {
            impacts.clear();
        }
        if plan.needs_peaks {
            self.peaks.turn_to::<I>(&motion.contact_guard.lambda);
        }
        for (signal, row) in self.signals.iter_mut().zip(&plan.rows) {
            signal.start::<I>(shape, row, motion);
        }
    }

    /// Reads what lies in a phase that has ended; returns the lanes in which that does not succeed.
    #[inline(always)]
    pub(super) fn read<I: Instructions>(
        &mut self,
        motion: &Motion,
        shape: &Shape,
        plan: &Plan,
        eight: &Eight,
        span: Span<'_, I>,
    ) -> u8 {
        if !plan.of_impacts.is_empty() {
            self.see_impacts(motion, shape, span);
        }
        self.sample(motion, shape, plan, eight, span);
        if plan.needs_peaks && span.is_closed {
            return self.see_peaks(motion, eight, span);
        }
        0
    }

    /// Reads the samples in a phase.
    #[inline(always)]
    fn sample<I: Instructions>(
        &mut self,
        motion: &Motion,
        shape: &Shape,
        plan: &Plan,
        eight: &Eight,
        span: Span<'_, I>,
    ) {
        let end = span.start + Lanes::of_block(&span.ends.time);
        let goes_on = span.live & span.ends.found;
        let mut is_set = false;
        for (number, sample) in plan.samples.iter().enumerate().skip(self.next) {
            let time = Lanes::<I>::of(sample.time);
            let before = time.less(end) | !goes_on;
            let inside = span.live & before & !time.less(span.start);
            if span.live & !before == 0 && number == self.next {
                self.next += 1;
            }
            if inside == 0 {
                continue;
            }
            if !is_set {
                for (signal, row) in self.signals.iter_mut().zip(&plan.rows) {
                    signal.set::<I>(shape, row, motion, span.is_closed);
                }
                is_set = true;
            }
            let since = time - span.start;
            let guard = motion.guard(span.is_closed);
            for (e, lambda) in self.exponentials.iter_mut().zip(&guard.lambda) {
                e.put(lambda.lanes::<I>().scale(since).exp());
            }
            let which = chosen::<I>(inside);
            for (item, column) in &sample.items {
                let value = self.value::<I>(*item, guard, span.is_closed, eight, since);
                let to = &mut self.kept[*column];
                blend(which, value, Lanes::of_block(to)).to_block(to);
            }
        }
    }

    #[inline(always)]
    fn value<I: Instructions>(
        &self,
        item: Item,
        guard: &Guard,
        is_closed: bool,
        eight: &Eight,
        t: Lanes<I>,
    ) -> Lanes<I> {
        match item {
            Item::Motion { row, is_rate } => {
                let signal = &self.signals[row];
                self.sum(&signal.terms, &signal.polynomial, guard, is_rate, t)
            }
            Item::Distance { is_rate } => {
                let inward = self.sum(&guard.b, &guard.polynomial, guard, is_rate, t);
                if is_closed { -inward } else { inward }
            }
            Item::Force if is_closed => {
                let depth = self.sum(&guard.b, &guard.polynomial, guard, false, t);
                (depth * Lanes::of_block(&eight.stiffness)).max(Lanes::of(0.0))
            }
            Item::Force => Lanes::of(0.0),
        }
    }

    /// Exponentials and a parabola, or their rate.
    #[inline(always)]
    fn sum<I: Instructions>(
        &self,
        terms: &[ComplexBlock],
        polynomial: &[Block; 3],
        guard: &Guard,
        is_rate: bool,
        t: Lanes<I>,
    ) -> Lanes<I> {
        let [a, b, c] = three::<I>(polynomial);
        let with_exponents = terms.iter().zip(&self.exponentials).zip(&guard.lambda);
        if is_rate {
            let mut sum = t.mul_add(c + c, b);
            for ((term, e), lambda) in with_exponents {
                let rate = term.lanes::<I>() * lambda.lanes();
                sum = rate.add_real_product(e.lanes(), sum);
            }
            return sum;
        }
        let mut sum = t.mul_add(t.mul_add(c, b), a);
        for ((term, e), _) in with_exponents {
            sum = term.lanes().add_real_product(e.lanes(), sum);
        }
        sum
    }

    /// Takes note of the impacts that begin or end with a phase.
    #[inline(always)]
    fn see_impacts<I: Instructions>(&mut self, motion: &Motion, shape: &Shape, span: Span<'_, I>) {
        let speed = motion.speed::<I>(shape).numbers();
        let start = span.start.numbers();
        for lane in 0..LANES {
            let bit = 1 << lane;
            if span.live & bit == 0 {
                continue;
            }
            self.events[lane] += u32::from(span.ends.found & bit != 0);
            let impacts = &mut self.impacts[lane];
            if span.is_closed {
                impacts.push(Impact::starting(start[lane], -speed[lane]));
            } else if let Some(impact) = impacts.last_mut() {
                impact.end = start[lane];
                impact.opening_speed = speed[lane];
            }
        }
    }

    /// Takes note of the largest forces of contacts; returns the lanes that are given up.
    #[inline(always)]
    fn see_peaks<I: Instructions>(
        &mut self,
        motion: &Motion,
        eight: &Eight,
        span: Span<'_, I>,
    ) -> u8 {
        let end = Lanes::of_block(&span.ends.time);
        let failed = (self.peaks).find::<I>(motion.guard(true), end, span.live);
        let forces = Lanes::of_block(&self.peaks.depth) * Lanes::<I>::of_block(&eight.stiffness);
        let times = span.start + Lanes::of_block(&self.peaks.time);
        let peaks = times.numbers().into_iter().zip(forces.numbers());
        for ((lane, impacts), (time, force)) in self.impacts.iter_mut().enumerate().zip(peaks) {
            if span.live >> lane & 1 == 1
                && let Some(impact) = impacts.last_mut()
            {
                impact.see_force(time, force);
            }
        }
        failed
    }

    /// Reads what is known at the end.
    pub(super) fn finish(&mut self, plan: &Plan) {
        for (what, column) in &plan.of_impacts {
            for lane in 0..LANES {
                let impacts = &self.impacts[lane];
                self.kept[*column][lane] = match what {
                    OfImpacts::Number(column, pick) => {
                        pick.of(impacts.iter().map(|impact| column.of(impact)))
                    }
                    OfImpacts::Count => impacts.len() as f64,
                    OfImpacts::LargestForce => largest_force(impacts),
                    OfImpacts::Events => f64::from(self.events[lane]),
                };
            }
        }
    }
}

impl Signal {
    /// The weights in contact.
    #[inline(always)]
    fn start<I: Instructions>(&mut self, shape: &Shape, row: &[f64], motion: &Motion) {
        let modes = shape.modes;
        let mut at_rest = Lanes::<I>::of(0.0);
        for (rest, factor) in motion.rests.iter().zip(row) {
            at_rest = Lanes::of_block(rest).mul_add(Lanes::of(*factor), at_rest);
        }
        at_rest.to_block(&mut self.rest);
        for (to, psi) in (self.weights.iter_mut()).zip(motion.contact.psi.chunks_exact(modes)) {
            let mut weight = Complex::<Lanes<I>>::zero();
            for (psi, factor) in psi.iter().zip(row) {
                weight = psi.lanes().scale_add(Lanes::of(*factor), weight);
            }
            to.put(weight);
        }
    }

    /// Takes the amplitudes of the present phase.
    #[inline(always)]
    fn set<I: Instructions>(
        &mut self,
        shape: &Shape,
        row: &[f64],
        motion: &Motion,
        is_closed: bool,
    ) {
        self.polynomial = [[0.0; LANES]; 3];
        if is_closed {
            self.polynomial[0] = self.rest;
            for j in 0..shape.modes {
                let amplitude = motion.amplitudes[j].lanes::<I>();
                self.terms[j].put(self.weights[j].lanes::<I>() * amplitude);
            }
            return;
        }
        let mut at_rest = 0.0;
        for (j, factor) in row.iter().enumerate() {
            let amplitude = motion.amplitudes[j].lanes::<I>();
            self.terms[j].put(amplitude.scale(Lanes::of(*factor)));
            at_rest += factor * shape.rests[j];
        }
        self.polynomial[0] = [at_rest; LANES];
        if shape.is_rigid {
            let factor = Lanes::<I>::of(row[0]);
            let constant = factor.mul_add(Lanes::of_block(&motion.q[0]), Lanes::of(at_rest));
            constant.to_block(&mut self.polynomial[0]);
            (factor * Lanes::of_block(&motion.v[0])).to_block(&mut self.polynomial[1]);
            self.polynomial[2] = [0.5 * row[0] * shape.forces[0]; LANES];
        }
    }
}
