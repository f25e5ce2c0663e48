//! Newton's method for the exponents of groups that several springs couple, eight at a time.

use super::{Springs, Start, TILE};
use crate::method::piecewise_linear::poles::{Eigenvalue, Nearest};
use crate::method::piecewise_linear::rows::{ComplexBlock, RealBlock, Rows, entry};
use crate::number::{Complex, Instructions, LANES, Lanes, Number, Vectorised};

/// Newton steps allowed.
const NEWTON_STEPS: usize = 12;

/// A Newton step below this part of the distance from the pole, or this part of the exponent,
/// makes the next error vanish in rounding.
const CONVERGED: [f64; 2] = [3e-8, 1e-15];

/// Newton steps after that, until one is below a part of the exponent: the shapes are those before
/// the last one.
const POLISHES: usize = 3;
const POLISHED: f64 = 1e-14;

/// The last Newton step, relative to the exponent, above which it was not the last. Where roots
/// nearly meet, rounding does not let it become shorter.
const LAST_STEP: f64 = 1e-11;

/// What is lacking of the forces after elimination, relative to them, above which it failed.
const LACK: f64 = 1e-5;

/// The size of a shape, which is one in the mode that tells its root, above which another mode
/// tells it: elimination of that one loses as many digits as it is larger.
const LARGEST_SHAPE: f64 = 16.0;

/// Room for the search of eight roots.
struct Room {
    /// `1 / D_i`, zero for the mode that is not eliminated.
    inverses: Vec<ComplexBlock>,
    /// The same times the factors of one spring.
    terms: Vec<ComplexBlock>,
    /// The upper triangle of S, and its factors.
    matrix: Vec<ComplexBlock>,
    factors: Vec<ComplexBlock>,
    /// `phi_o`, `f`, and what is lacking of the former.
    own: Vec<RealBlock>,
    forces: Vec<ComplexBlock>,
    lack: Vec<ComplexBlock>,
}

impl Room {
    fn new(springs: &Springs) -> Self {
        let (modes, stride) = (springs.modes(), springs.stride);
        let blocks = |count: usize| vec![ComplexBlock::ZERO; count];
        Self {
            inverses: blocks(modes),
            terms: blocks(modes),
            matrix: blocks(stride * stride),
            factors: blocks(stride * stride),
            own: vec![RealBlock::ZERO; stride],
            forces: blocks(stride),
            lack: blocks(stride),
        }
    }
}

/// The search of all roots.
pub(super) struct Search<'a> {
    springs: &'a Springs,
    starts: Vec<Start>,
    room: Room,
    vectors: &'a mut Rows,
}

impl<'a> Search<'a> {
    pub(super) fn new(springs: &'a Springs, starts: Vec<Start>, vectors: &'a mut Rows) -> Self {
        Self {
            springs,
            starts,
            room: Room::new(springs),
            vectors,
        }
    }
}

impl Vectorised for Search<'_> {
    type Output = Option<Vec<ComplexBlock>>;
    #[inline(always)]
    fn run<I: Instructions>(mut self) -> Self::Output {
        let mut exponents = Vec::with_capacity(self.vectors.width());
        for block in 0..self.vectors.width() {
            let mut lambda = ComplexBlock::ZERO;
            lambda.put(self.solve_block::<I>(block)?);
            if self.tell_by_largest(block, &lambda) {
                lambda.put(self.solve_block::<I>(block)?);
            }
            exponents.push(lambda);
        }
        Some(exponents)
    }
}

/// Value and slope of h, and how far the elimination was off.
struct Evaluation<I: Instructions> {
    value: Complex<Lanes<I>>,
    slope: Complex<Lanes<I>>,
    lack: Lanes<I>,
}

/// Eight roots on their way, and which mode each is told by.
struct Roots<I: Instructions> {
    eigenvalue: Eigenvalue<I>,
    places: Lanes<I>,
    live: Lanes<I>,
}

impl<I: Instructions> Roots<I> {
    /// In the lanes whose mode is i, `yes`.
    #[inline(always)]
    fn own(&self, i: usize, yes: Lanes<I>, no: Lanes<I>) -> Lanes<I> {
        let apart = (Lanes::<I>::of(i as f64) - self.places).abs();
        apart.select_less(Lanes::of(0.5), yes, no)
    }

    /// The lanes with a root; zero in the padding.
    #[inline(always)]
    fn keep(&self, z: Complex<Lanes<I>>) -> Complex<Lanes<I>> {
        let zero = Lanes::<I>::of(0.0);
        Complex::new(
            self.live.select_less(zero, z.re, zero),
            self.live.select_less(zero, z.im, zero),
        )
    }

    /// Whether no lane with a root has a size above its bound.
    #[inline(always)]
    fn all_below(&self, size: Lanes<I>, bound: Lanes<I>) -> bool {
        let zero = Lanes::<I>::of(0.0);
        // Written so that a size which is no number is above.
        let fine = size.select_less(bound, zero, self.live);
        fine.numbers() == [0.0; LANES]
    }
}

impl Search<'_> {
    /// Lets roots of which some mode takes a far larger part than the one that told them be told by
    /// that mode; whether there are such.
    fn tell_by_largest(&mut self, block: usize, lambda: &ComplexBlock) -> bool {
        let first = block * LANES;
        let end = self.starts.len().min(first + LANES);
        let mut is_changed = false;
        for (lane, start) in self.starts[first..end].iter_mut().enumerate() {
            let size = |mode: &usize| entry(&self.vectors.row(*mode)[block..], lane).norm2();
            let modes = 0..self.springs.modes();
            let largest = modes.max_by(|a, b| size(a).total_cmp(&size(b)));
            if let Some(mode) = largest.filter(|mode| size(mode) > LARGEST_SHAPE.powi(2)) {
                *start = self
                    .springs
                    .start(mode, entry(std::slice::from_ref(lambda), lane));
                is_changed = true;
            }
        }
        is_changed
    }

    #[inline(always)]
    fn solve_block<I: Instructions>(&mut self, block: usize) -> Option<Complex<Lanes<I>>> {
        let mut roots = self.begin::<I>(block);
        let (mut is_settled, mut polishes) = (false, 0);
        for _ in 0..NEWTON_STEPS + POLISHES {
            let found = self.evaluate::<I>(&roots, block);
            let step = found.value * found.slope.recip();
            let (s, delta) = (roots.eigenvalue.value, roots.eigenvalue.delta);
            if is_settled {
                let [polished, last] =
                    [POLISHED, LAST_STEP].map(|part| Lanes::<I>::of(part * part) * s.norm2());
                if polishes == POLISHES || roots.all_below(step.norm2(), polished) {
                    let lambda = s - step;
                    let found_all = roots.all_below(step.norm2(), last)
                        && roots.all_below(found.lack, Lanes::of(LACK * LACK))
                        && roots.all_below(-lambda.im, Lanes::of(0.0));
                    self.set_vectors::<I>(&roots, block, found.slope);
                    return found_all.then(|| roots.keep(lambda));
                }
                polishes += 1;
            } else {
                let [of_distance, of_size] = CONVERGED.map(|part| Lanes::<I>::of(part * part));
                let bound = of_distance.mul_add(delta.norm2(), of_size * s.norm2());
                is_settled = roots.all_below(step.norm2(), bound);
            }
            roots.eigenvalue.set(delta - step);
        }
        None
    }

    /// The starts of eight roots; the last one again in the padding.
    #[inline(always)]
    fn begin<I: Instructions>(&mut self, block: usize) -> Roots<I> {
        let springs = self.springs;
        let [
            mut omega2,
            mut damping,
            mut places,
            mut live,
            mut re,
            mut im,
        ] = [[0.0; LANES]; 6];
        for lane in 0..LANES {
            let number = block * LANES + lane;
            let start = self.starts[number.min(self.starts.len() - 1)];
            omega2[lane] = springs.omega2[start.mode];
            damping[lane] = springs.damping[start.mode];
            places[lane] = start.mode as f64;
            live[lane] = if number < self.starts.len() {
                -1.0
            } else {
                0.0
            };
            (re[lane], im[lane]) = (start.delta.re, start.delta.im);
            for (own, phi) in self.room.own.iter_mut().zip(springs.phi(start.mode)) {
                own.0[lane] = *phi;
            }
        }
        let origin = Nearest::<I> {
            omega2: Lanes::new(omega2),
            damping: Lanes::new(damping),
        };
        let mut eigenvalue = Eigenvalue::new(origin, origin.pole());
        eigenvalue.set(Complex::new(Lanes::new(re), Lanes::new(im)));
        Roots {
            eigenvalue,
            places: Lanes::new(places),
            live: Lanes::new(live),
        }
    }

    /// h and its slope; leaves the shapes among the vectors and the forces in the room.
    #[inline(always)]
    fn evaluate<I: Instructions>(&mut self, roots: &Roots<I>, block: usize) -> Evaluation<I> {
        let springs = self.springs;
        let s = roots.eigenvalue.value;
        self.invert::<I>(roots);
        self.assemble::<I>(s);
        let lack = self.find_forces::<I>();
        let (zero, one) = (Lanes::<I>::of(0.0), Lanes::<I>::of(1.0));
        let mut slope = Complex::<Lanes<I>>::zero();
        for i in 0..springs.modes() {
            let mut push = Complex::<Lanes<I>>::zero();
            for (phi, force) in springs.phi(i).iter().zip(&self.room.forces) {
                push = force.lanes().scale_add(Lanes::of(*phi), push);
            }
            let shape = -(push * self.room.inverses[i].lanes());
            let shape = shape.plus(roots.own(i, one, zero));
            self.vectors.row_mut(i)[block].put(shape);
            let rate = s.scale(Lanes::of(2.0)).plus(Lanes::of(springs.damping[i]));
            slope = (shape * shape).mul_add(rate, slope);
        }
        let mut value = roots.eigenvalue.own_pole();
        for a in 0..springs.count() {
            let force = self.room.forces[a].lanes::<I>();
            value = force.scale_add(self.room.own[a].lanes(), value);
            if springs.dampers[a] != 0.0 {
                let seen = force * self.kappa::<I>(a, s).recip();
                slope = (seen * seen).scale_add(Lanes::of(springs.dampers[a]), slope);
            }
        }
        Evaluation { value, slope, lack }
    }

    #[inline(always)]
    fn kappa<I: Instructions>(&self, spring: usize, s: Complex<Lanes<I>>) -> Complex<Lanes<I>> {
        let (k, c) = (self.springs.stiffness[spring], self.springs.dampers[spring]);
        s.scale(Lanes::of(c)).plus(Lanes::of(k))
    }

    /// `1 / D_i`, without the mode of each lane.
    #[inline(always)]
    fn invert<I: Instructions>(&mut self, roots: &Roots<I>) {
        let (springs, near) = (self.springs, roots.eigenvalue.near());
        let zero = Lanes::<I>::of(0.0);
        for i in 0..springs.modes() {
            let dynamic = (roots.eigenvalue).pole(near, springs.omega2[i], springs.damping[i]);
            let inverse = dynamic.conj().scale(dynamic.norm2().recip());
            let others = Complex::new(
                roots.own(i, zero, inverse.re),
                roots.own(i, zero, inverse.im),
            );
            self.room.inverses[i].put(others);
        }
    }

    /// The upper triangle of S.
    #[inline(always)]
    fn assemble<I: Instructions>(&mut self, s: Complex<Lanes<I>>) {
        let springs = self.springs;
        let (stride, count) = (springs.stride, springs.count());
        for a in 0..count {
            let Room {
                inverses, terms, ..
            } = &mut self.room;
            for (i, (term, inverse)) in terms.iter_mut().zip(inverses.iter()).enumerate() {
                let phi = Lanes::<I>::of(springs.phi[i * stride + a]);
                term.put(inverse.lanes().scale(phi));
            }
            for first in (a / TILE * TILE..stride).step_by(TILE) {
                let mut sums = [Complex::<Lanes<I>>::zero(); TILE];
                let tiles = springs.phi[first..].chunks(stride);
                for (term, phi) in self.room.terms.iter().zip(tiles) {
                    let term = term.lanes::<I>();
                    for (sum, phi) in sums.iter_mut().zip(phi) {
                        *sum = term.scale_add(Lanes::of(*phi), *sum);
                    }
                }
                for (b, sum) in sums.into_iter().enumerate() {
                    self.room.matrix[a * stride + first + b].put(sum);
                }
            }
            let own = self.room.matrix[a * stride + a].lanes() + self.kappa::<I>(a, s).recip();
            self.room.matrix[a * stride + a].put(own);
        }
    }

    /// Solves `S f = phi_o` by elimination without pivots, and once more for what is lacking;
    /// returns the squared size of what that was, relative to the forces.
    #[inline(always)]
    fn find_forces<I: Instructions>(&mut self) -> Lanes<I> {
        let (stride, count) = (self.springs.stride, self.springs.count());
        self.factorise::<I>();
        let zero = Lanes::<I>::of(0.0);
        for a in 0..count {
            let own = Complex::new(self.room.own[a].lanes::<I>(), zero);
            self.room.lack[a].put(own);
        }
        self.substitute::<I>();
        for a in 0..count {
            self.room.forces[a] = self.room.lack[a];
        }
        for a in 0..count {
            let mut lack = Complex::new(self.room.own[a].lanes::<I>(), zero);
            for b in 0..count {
                let at = a.min(b) * stride + a.max(b);
                let product = self.room.matrix[at].lanes::<I>() * self.room.forces[b].lanes();
                lack = lack - product;
            }
            self.room.lack[a].put(lack);
        }
        self.substitute::<I>();
        let (mut lack, mut size) = (zero, zero);
        for a in 0..count {
            let correction = self.room.lack[a].lanes::<I>();
            let force = self.room.forces[a].lanes() + correction;
            self.room.forces[a].put(force);
            lack += correction.norm2();
            size += force.norm2();
        }
        lack / size
    }

    /// The factors `U' D^-1 U` of S, with the reciprocals of D on the diagonal.
    #[inline(always)]
    fn factorise<I: Instructions>(&mut self) {
        let (stride, count) = (self.springs.stride, self.springs.count());
        let Room {
            matrix, factors, ..
        } = &mut self.room;
        factors.copy_from_slice(matrix);
        for k in 0..count {
            let (above, below) = factors.split_at_mut((k + 1) * stride);
            let row = &mut above[k * stride..];
            let pivot = row[k].lanes::<I>().recip();
            row[k].put(pivot);
            for i in k + 1..count {
                let factor = row[i].lanes::<I>() * pivot;
                let target = &mut below[(i - k - 1) * stride..][..stride];
                for (target, entry) in target[i..count].iter_mut().zip(&row[i..count]) {
                    let next = target.lanes::<I>() - factor * entry.lanes();
                    target.put(next);
                }
            }
        }
    }

    /// Replaces what is lacking by the forces that it takes.
    #[inline(always)]
    fn substitute<I: Instructions>(&mut self) {
        let (stride, count) = (self.springs.stride, self.springs.count());
        let Room { factors, lack, .. } = &mut self.room;
        for k in 0..count {
            let row = &factors[k * stride..][..stride];
            let own = lack[k].lanes::<I>() * row[k].lanes();
            for i in k + 1..count {
                let next = lack[i].lanes::<I>() - own * row[i].lanes();
                lack[i].put(next);
            }
        }
        for k in (0..count).rev() {
            let row = &factors[k * stride..][..stride];
            let mut total = lack[k].lanes::<I>();
            for i in k + 1..count {
                total = total - row[i].lanes::<I>() * lack[i].lanes();
            }
            lack[k].put(total * row[k].lanes());
        }
    }

    /// Left vectors beside the shapes: `2 psi' [(lambda + C) y + y'] / h'`, C with the dampers.
    #[inline(always)]
    fn set_vectors<I: Instructions>(
        &mut self,
        roots: &Roots<I>,
        block: usize,
        norm: Complex<Lanes<I>>,
    ) {
        let (springs, s) = (self.springs, roots.eigenvalue.value);
        let n = springs.modes();
        let factor = roots.keep(norm.recip().scale(Lanes::of(2.0)));
        for a in 0..springs.count() {
            let seen = self.room.forces[a].lanes::<I>() * self.kappa::<I>(a, s).recip();
            let push = (seen * factor).scale(Lanes::of(springs.dampers[a]));
            self.room.lack[a].put(roots.keep(push));
        }
        for i in 0..n {
            let shape = roots.keep(self.vectors.row(i)[block].lanes());
            self.vectors.row_mut(i)[block].put(shape);
            let left = shape * factor;
            let mut position = left * s.plus(Lanes::of(springs.damping[i]));
            for (phi, push) in springs.phi(i).iter().zip(&self.room.lack) {
                position = push.lanes().scale_add(Lanes::of(*phi), position);
            }
            self.vectors.row_mut(n + i)[block].put(position);
            self.vectors.row_mut(2 * n + i)[block].put(left);
        }
    }
}
