//! The certified walk of eight problems: each to the first zero of its guard, by cells on which the
//! bounds of `docs/theory/certificate.md` prove that there is none.
//!
//! All lanes take their cells of a phase together, each lane of its own width. A cell on which
//! nothing is proved is halved; a lane that needs cells too small for that, whose zero is nearly
//! a touch, or which walks for too long is given up: it belongs to the single run.

use super::bounds::{Bounds, CLEARANCE, FOLLOWED, MOST_CELLS, rounding};
use super::guard::Guard;
use super::mask::{blend, blend_both, chosen};
use crate::method::piecewise_linear::ComplexBlock;
use crate::number::{Block, Complex, Instructions, LANES, Lanes, Number};

/// Cells are so wide that a typical frequency of the guard turns by this angle.
const TURN: f64 = 0.75;

/// How often cells are halved.
const HALVINGS: usize = 6;

/// Steps of Halley's method for a zero in its bracket.
const REFINEMENTS: usize = 6;

/// A step that turns the fastest exponent by less than this is the last: the state is carried over
/// it by its second power.
const SMALL_TURN: f64 = 3e-6;

/// What a walk came to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    /// Time of the zero, or of the limit, since the start of the phase.
    pub time: Block,
    /// Lanes that met a zero, and those that are given up.
    pub found: u8,
    pub failed: u8,
}

/// Where lanes stand.
struct Lead<I: Instructions> {
    /// Lanes that walk on.
    walking: u8,
    found: u8,
    failed: u8,
    left: Lanes<I>,
    right: Lanes<I>,
    guess: Lanes<I>,
}

/// Room for walks.
#[derive(Debug, Default)]
pub(super) struct Walker {
    /// `b exp(lambda t)` in the middle of the cell of those that are followed.
    moved: Vec<ComplexBlock>,
    /// `exp(lambda h)`
    step: Vec<ComplexBlock>,
    /// At the end of the walk.
    pub exponentials: Vec<ComplexBlock>,
}

impl Walker {
    pub(super) fn new(modes: usize) -> Self {
        Self {
            moved: vec![ComplexBlock::ZERO; modes],
            step: vec![ComplexBlock::ZERO; modes],
            exponentials: vec![ComplexBlock::ZERO; modes],
        }
    }

    /// Walks the lanes `live`, of which those in `departs` start at zero, up to their limits.
    #[inline(always)]
    pub(super) fn walk<I: Instructions>(
        &mut self,
        guard: &Guard,
        limit: Lanes<I>,
        live: u8,
        departs: u8,
    ) -> Ends {
        let zero = Lanes::<I>::of(0.0);
        let mut lead = Lead {
            walking: live,
            found: 0,
            failed: 0,
            left: zero,
            right: limit,
            guess: zero,
        };
        let start = at_start::<I>(guard);
        let radius = first_radius(guard, start, limit, departs);
        let bounds = Bounds::<I>::new(guard, radius, limit);
        let follows = self.set_out::<I>(guard, radius);
        self.leave(guard, start, &bounds, departs, &mut lead);
        let width = radius + radius;
        let mut left = radius;
        for cell in 0.. {
            lead.walking &= left.less(limit);
            if lead.walking == 0 {
                break;
            }
            if cell == MOST_CELLS {
                lead.failed |= lead.walking;
                break;
            }
            let jet = self.jet::<I>(guard, follows, left + radius);
            let verdict = bounds.judge(&jet);
            let right = left + width;
            lead.take(verdict.crosses, left, right, &jet);
            let open = lead.walking & !verdict.clear;
            if open != 0 {
                self.divide(guard, open, [left, right], radius, limit, &mut lead);
            }
            left = right;
        }
        self.finish(guard, limit, live, lead)
    }

    /// Prepares the exponents that are followed in some lane; returns how many.
    #[inline(always)]
    fn set_out<I: Instructions>(&mut self, guard: &Guard, radius: Lanes<I>) -> usize {
        let mut follows = 0;
        for j in 0..guard.b.len() {
            let turn = Lanes::of_block(&guard.modulus[j]) * radius;
            let is_slow = turn.less(Lanes::of(FOLLOWED));
            if is_slow == 0 {
                self.step[j] = ComplexBlock::ONE;
                self.moved[j] = ComplexBlock::ZERO;
                continue;
            }
            follows = j + 1;
            let half = guard.lambda[j].lanes::<I>().scale(radius).exp();
            let whole = half * half;
            let b = guard.b[j].lanes::<I>() * whole;
            let slow = chosen::<I>(is_slow);
            self.step[j].put(whole);
            self.moved[j].put(blend_both(slow, b, Complex::zero()));
        }
        follows
    }

    /// Value and derivatives of what is followed in the middle of a cell; goes on to the next.
    #[inline(always)]
    fn jet<I: Instructions>(
        &mut self,
        guard: &Guard,
        follows: usize,
        middle: Lanes<I>,
    ) -> [Lanes<I>; 3] {
        let mut sums = guard.slow(middle);
        for j in 0..follows {
            let z = self.moved[j].lanes::<I>();
            guard.add_term(j, z, &mut sums);
            self.moved[j].put(z * self.step[j].lanes());
        }
        sums
    }

    /// The first half of a cell: a guard that starts at zero must leave it; others are looked at.
    #[inline(always)]
    fn leave<I: Instructions>(
        &mut self,
        guard: &Guard,
        start: [Lanes<I>; 3],
        bounds: &Bounds<I>,
        departs: u8,
        lead: &mut Lead<I>,
    ) {
        let zero = Lanes::<I>::of(0.0);
        let others = lead.walking & !departs;
        if others != 0 {
            let limit = lead.right;
            self.divide(
                guard,
                others,
                [zero, bounds.radius],
                bounds.radius,
                limit,
                lead,
            );
        }
        // g(t)/t >= slope + curvature t/2 - third t^2/6, concave in t, everything followed.
        let third = Lanes::<I>::of_block(&guard.totals[3]);
        let h = bounds.radius;
        let half = Lanes::<I>::of(0.5);
        let least = start[1] + half * start[2] * h - third * h * h * Lanes::of(1.0 / 6.0);
        let margin = bounds.rounding * Lanes::of(CLEARANCE) / h;
        let sound = margin.less(least) & margin.less(start[1]);
        lead.fail(departs & !sound);
    }

    /// Goes through a stretch of time by smaller cells, each looked at anew.
    #[inline(always)]
    fn divide<I: Instructions>(
        &mut self,
        guard: &Guard,
        open: u8,
        [mut left, end]: [Lanes<I>; 2],
        width: Lanes<I>,
        limit: Lanes<I>,
        lead: &mut Lead<I>,
    ) {
        let half = Lanes::<I>::of(0.5);
        let smallest = width * Lanes::of(1.0 / (1 << HALVINGS) as f64);
        let mut width = width;
        let mut open = open & lead.walking;
        while open != 0 {
            let radius = half * width;
            let bounds = Bounds::<I>::new(guard, radius, limit);
            let jet = self.look::<I>(guard, left + radius, radius);
            let verdict = bounds.judge(&jet);
            let right = left + width;
            let crosses = verdict.crosses & open;
            lead.take(crosses, left, right, &jet);
            let clear = chosen::<I>(verdict.clear);
            left = blend(clear, right, left);
            width = blend(clear, width, half * width);
            open &= !crosses & left.less(end - half * smallest) & left.less(limit);
            let lost = open & width.less(smallest);
            lead.fail(lost);
            open &= !lost;
        }
    }

    /// Value and derivatives of the exponents that are slow over cells of some half-widths.
    #[inline(always)]
    fn look<I: Instructions>(
        &mut self,
        guard: &Guard,
        middle: Lanes<I>,
        radius: Lanes<I>,
    ) -> [Lanes<I>; 3] {
        let mut sums = guard.slow(middle);
        for j in 0..guard.b.len() {
            let turn = Lanes::of_block(&guard.modulus[j]) * radius;
            let is_slow = turn.less(Lanes::of(FOLLOWED));
            if is_slow == 0 {
                continue;
            }
            let z = guard.b[j].lanes::<I>() * guard.lambda[j].lanes::<I>().scale(middle).exp();
            let slow = chosen::<I>(is_slow);
            let z = blend_both(slow, z, Complex::zero());
            guard.add_term(j, z, &mut sums);
        }
        sums
    }

    /// Finds the zeros in their brackets, by Halley's method, and the exponentials there.
    #[inline(always)]
    fn finish<I: Instructions>(
        &mut self,
        guard: &Guard,
        limit: Lanes<I>,
        live: u8,
        mut lead: Lead<I>,
    ) -> Ends {
        let (zero, one) = (Lanes::<I>::of(0.0), Lanes::<I>::of(1.0));
        let fastest = Lanes::of_block(&guard.modulus[guard.modulus.len() - 1]);
        let mut t = blend(chosen(lead.found), lead.guess, limit);
        let mut step = zero;
        let mut searching = lead.found & live;
        let mut rounds = 0;
        while searching != 0 {
            let next = t - step;
            t = blend(chosen(searching), next, t);
            let [value, slope, curvature] = guard.values::<I>(t, &mut self.exponentials);
            let newton = value / slope;
            let halley = newton / (one - Lanes::of(0.5) * newton * curvature / slope);
            step = blend(chosen(searching), halley, step);
            // A touch, or nearly: single runs tell it from a contact.
            let rounding = rounding::<I>(guard, limit) * Lanes::of(CLEARANCE * CLEARANCE);
            let depth = slope * slope - (rounding + rounding) * curvature.abs();
            let sound = slope.less(zero) & zero.less(depth);
            let target = t - step;
            let inside = lead.left.less(target) & target.less(lead.right);
            let lost = searching & !(sound & inside);
            rounds += 1;
            let lost = if rounds == REFINEMENTS {
                searching
            } else {
                lost
            };
            lead.fail(lost);
            lead.found &= !lost;
            let small = (step.abs() * fastest).less(Lanes::of(SMALL_TURN));
            searching &= !lost & !small;
        }
        let ended = chosen::<I>(lead.found);
        let last = blend(ended, step, zero);
        t -= last;
        // exp(lambda (t - s)) = exp(lambda t) (1 - lambda s + (lambda s)^2/2)
        for (e, lambda) in self.exponentials.iter_mut().zip(&guard.lambda) {
            let turn = lambda.lanes::<I>().scale(last);
            let change = turn * turn.scale(Lanes::of(0.5)).plus(-one);
            let whole = e.lanes::<I>();
            e.put(change.mul_add(whole, whole));
        }
        // A zero behind the end of the run is none.
        let edge = limit * Lanes::of(1e-12);
        let late = lead.found & limit.less(t + edge);
        lead.fail(late & (t - edge).less(limit));
        lead.found &= !late;
        t = blend(chosen(late), limit, t);
        let mut ends = Ends {
            time: [0.0; LANES],
            found: lead.found & live,
            failed: lead.failed & live,
        };
        t.to_block(&mut ends.time);
        ends
    }
}

impl<I: Instructions> Lead<I> {
    /// Takes cells with a zero.
    #[inline(always)]
    fn take(&mut self, crosses: u8, left: Lanes<I>, right: Lanes<I>, jet: &[Lanes<I>; 3]) {
        let crosses = crosses & self.walking;
        if crosses == 0 {
            return;
        }
        let which = chosen::<I>(crosses);
        let [value, slope, curvature] = *jet;
        let root = (slope * slope - (curvature + curvature) * value)
            .max(Lanes::of(0.0))
            .sqrt();
        let middle = Lanes::of(0.5) * (left + right);
        let guess = middle + (value + value) / (root - slope);
        let inside = chosen::<I>(left.less(guess) & guess.less(right));
        self.guess = blend(which, blend(inside, guess, middle), self.guess);
        self.left = blend(which, left, self.left);
        self.right = blend(which, right, self.right);
        self.found |= crosses;
        self.walking &= !crosses;
    }

    /// Gives lanes up.
    #[inline(always)]
    fn fail(&mut self, lost: u8) {
        self.failed |= lost;
        self.walking &= !lost;
    }
}

/// Value, slope and curvature at the start of the phase.
#[inline(always)]
fn at_start<I: Instructions>(guard: &Guard) -> [Lanes<I>; 3] {
    let mut sums = guard.slow(Lanes::of(0.0));
    for j in 0..guard.b.len() {
        guard.add_term(j, guard.b[j].lanes::<I>(), &mut sums);
    }
    sums
}

/// Half of the width of the cells: a typical frequency turns little over it, and a guard that
/// starts at zero leaves it on half a cell.
#[inline(always)]
fn first_radius<I: Instructions>(
    guard: &Guard,
    [_, slope, curvature]: [Lanes<I>; 3],
    limit: Lanes<I>,
    departs: u8,
) -> Lanes<I> {
    let [size, _, bending, third] = &guard.totals;
    let size = Lanes::<I>::of_block(size);
    let bending = Lanes::<I>::of_block(bending);
    let third = Lanes::<I>::of_block(third);
    let tiny = Lanes::<I>::of(f64::MIN_POSITIVE);
    let by_pace = (size / bending.max(tiny)).sqrt() * Lanes::of(0.5 * TURN);
    // slope + curvature h/2 - third h^2/6 is a tenth of the slope at h.
    let quarter = curvature * Lanes::of(0.25);
    let root = (quarter * quarter + third * slope.max(tiny) * Lanes::of(0.15)).sqrt();
    let by_departure = (quarter + root) * Lanes::of(6.0) / third.max(tiny);
    let by_departure = blend(chosen(departs), by_departure, by_pace);
    let shortest = by_pace.select_less(by_departure, by_pace, by_departure);
    let longest = limit * Lanes::of(0.25);
    let chosen = shortest.select_less(longest, shortest, longest);
    // Not a number, or nothing, where nothing bends.
    tiny.select_less(chosen, chosen, longest)
}
