//! The motion of eight problems in one phase: amplitudes from a state, and the state at its end.

use super::guard::Guard;
use super::run::Eight;
use super::shape::{SLOWEST, Shape};
use super::spectrum::Contact;
use crate::method::piecewise_linear::ComplexBlock;
use crate::number::{Block, Complex, Instructions, LANES, Lanes, Number};

/// What the amplitudes of a phase in contact may lack of the state, relative to its largest part;
/// single runs look closer at those that lack more.
const LARGEST_DEFECT: f64 = 1e-12;

/// The motion in the present phase.
#[derive(Debug)]
pub(super) struct Motion {
    pub contact: Contact,
    /// The distance in flight, and the depth in contact.
    pub flight_guard: Guard,
    pub contact_guard: Guard,
    /// The state at the start of the phase.
    pub q: Vec<Block>,
    pub v: Vec<Block>,
    /// Amplitudes of the modes in flight, or of the exponents in contact.
    pub amplitudes: Vec<ComplexBlock>,
    /// Positions at rest in contact.
    pub rests: Vec<Block>,
    lack: [Vec<Block>; 2],
}

impl Motion {
    pub(super) fn new(modes: usize) -> Self {
        let zeros = || vec![[0.0; LANES]; modes];
        Self {
            contact: Contact::new(modes),
            flight_guard: Guard::new(modes),
            contact_guard: Guard::new(modes),
            q: zeros(),
            v: zeros(),
            amplitudes: vec![ComplexBlock::ZERO; modes],
            rests: zeros(),
            lack: [zeros(), zeros()],
        }
    }

    /// Takes eight problems at their start; returns the lanes in which contact cannot be solved.
    #[inline(always)]
    pub(super) fn start<I: Instructions>(&mut self, shape: &Shape, eight: &Eight) -> u8 {
        let mut failed = (self.contact).solve(shape, Lanes::<I>::of_block(&eight.stiffness));
        self.contact_guard.turn_to::<I>(&self.contact.lambda);
        self.flight_guard.turn_to::<I>(&shape.flight);
        let slowest = Lanes::<I>::of_block(&self.contact_guard.modulus[0]);
        failed |= (slowest * Lanes::of(shape.duration)).less(Lanes::of(SLOWEST));
        self.q.copy_from_slice(&eight.displacement);
        self.v.copy_from_slice(&eight.velocity);
        failed | self.rest_in_contact::<I>(shape, eight)
    }

    /// Starts a phase from the state; returns the lanes in which that does not succeed.
    #[inline(always)]
    pub(super) fn begin<I: Instructions>(
        &mut self,
        shape: &Shape,
        eight: &Eight,
        is_closed: bool,
    ) -> u8 {
        if is_closed {
            return self.begin_contact::<I>(shape, eight);
        }
        self.begin_flight::<I>(shape, eight);
        0
    }

    /// What must stay positive in a phase.
    #[inline(always)]
    pub(super) fn guard(&self, is_closed: bool) -> &Guard {
        if is_closed {
            &self.contact_guard
        } else {
            &self.flight_guard
        }
    }

    /// The rate of the distance at the start of the phase.
    #[inline(always)]
    pub(super) fn speed<I: Instructions>(&self, shape: &Shape) -> Lanes<I> {
        let mut speed = Lanes::<I>::of(0.0);
        for (v, phi) in self.v.iter().zip(&shape.phi) {
            speed = Lanes::of_block(v).mul_add(Lanes::of(*phi), speed);
        }
        speed
    }

    /// Amplitudes and distance in flight.
    #[inline(always)]
    fn begin_flight<I: Instructions>(&mut self, shape: &Shape, eight: &Eight) {
        let mut constant = Lanes::<I>::of_block(&eight.gap);
        let first = usize::from(shape.is_rigid);
        let guard = &mut self.flight_guard;
        guard.polynomial = [[0.0; LANES]; 3];
        if shape.is_rigid {
            let phi = Lanes::<I>::of(shape.phi[0]);
            constant = phi.mul_add(Lanes::of_block(&self.q[0]), constant);
            (phi * Lanes::of_block(&self.v[0])).to_block(&mut guard.polynomial[1]);
            (phi * Lanes::of(0.5 * shape.forces[0])).to_block(&mut guard.polynomial[2]);
            self.amplitudes[0] = ComplexBlock::ZERO;
            guard.b[0] = ComplexBlock::ZERO;
        }
        for i in first..shape.modes {
            let lambda = shape.flight[i].lanes::<I>();
            let phi = Lanes::<I>::of(shape.phi[i]);
            let x = Lanes::<I>::of_block(&self.q[i]) - Lanes::of(shape.rests[i]);
            let lack = Lanes::of_block(&self.v[i]).sub_mul(lambda.re, x);
            let amplitude = Complex::new(x, -(lack / lambda.im));
            self.amplitudes[i].put(amplitude);
            guard.b[i].put(amplitude.scale(phi));
            constant = phi.mul_add(Lanes::of(shape.rests[i]), constant);
        }
        constant.to_block(&mut guard.polynomial[0]);
        guard.measure::<I>();
    }

    /// Positions at rest in contact; returns the lanes in which there are none.
    #[inline(always)]
    fn rest_in_contact<I: Instructions>(&mut self, shape: &Shape, eight: &Eight) -> u8 {
        let one = Lanes::<I>::of(1.0);
        let gap = Lanes::<I>::of_block(&eight.gap);
        let stiffness = Lanes::<I>::of_block(&eight.stiffness);
        let first = usize::from(shape.is_rigid);
        // Where a rigid mode must be held the force follows from it, else from the distance.
        let force = if shape.is_rigid {
            Lanes::of(-shape.forces[0] / shape.phi[0])
        } else {
            let mut compliance = one / stiffness;
            let mut pushed = gap;
            for i in 0..shape.modes {
                let share = shape.phi[i] / shape.omega2[i];
                compliance += Lanes::of(share * shape.phi[i]);
                pushed += Lanes::of(share * shape.forces[i]);
            }
            -(pushed / compliance)
        };
        let distance = -(force / stiffness);
        let mut flexible = gap;
        for i in first..shape.modes {
            let phi = Lanes::<I>::of(shape.phi[i]);
            let rest = phi.mul_add(force, Lanes::of(shape.forces[i])) / Lanes::of(shape.omega2[i]);
            rest.to_block(&mut self.rests[i]);
            flexible = phi.mul_add(rest, flexible);
        }
        if shape.is_rigid {
            let rest = (distance - flexible) / Lanes::of(shape.phi[0]);
            rest.to_block(&mut self.rests[0]);
        }
        self.contact_guard.polynomial = [[0.0; LANES]; 3];
        (-distance).to_block(&mut self.contact_guard.polynomial[0]);
        !distance.abs().less(Lanes::of(f64::INFINITY))
    }

    /// Amplitudes and depth in contact; returns the lanes whose amplitudes do not give the state.
    #[inline(always)]
    fn begin_contact<I: Instructions>(&mut self, shape: &Shape, eight: &Eight) -> u8 {
        let modes = shape.modes;
        let zero = Lanes::<I>::of(0.0);
        let (mut size, mut size_rate) = (zero, zero);
        for i in 0..modes {
            let y = Lanes::<I>::of_block(&self.q[i]) - Lanes::of_block(&self.rests[i]);
            let v = Lanes::<I>::of_block(&self.v[i]);
            size = size.max(y.abs());
            size_rate = size_rate.max(v.abs());
            y.to_block(&mut self.lack[0][i]);
            v.to_block(&mut self.lack[1][i]);
        }
        self.amplitudes.fill(ComplexBlock::ZERO);
        self.add_amplitudes::<I>(shape);
        let fastest = Lanes::<I>::of_block(&self.contact_guard.modulus[modes - 1]);
        let scale = size.max(size_rate / fastest);
        let defect = self.take_off::<I>(shape, fastest);
        let complete =
            (defect - Lanes::of(f64::MIN_POSITIVE)).less(scale * Lanes::of(LARGEST_DEFECT));
        self.add_amplitudes::<I>(shape);
        let compliance = Lanes::<I>::of(1.0) / Lanes::of_block(&eight.stiffness);
        for (b, a) in self.contact_guard.b.iter_mut().zip(&self.amplitudes) {
            b.put(a.lanes::<I>().scale(compliance));
        }
        self.contact_guard.measure::<I>();
        !complete
    }

    /// Adds `a = 2 psi'[(lambda + C) y + y'] / (psi' (2 lambda + C) psi)` of what is lacking.
    #[inline(always)]
    fn add_amplitudes<I: Instructions>(&mut self, shape: &Shape) {
        let modes = shape.modes;
        let [position, velocity] = &self.lack;
        for root in 0..modes {
            let lambda = self.contact.lambda[root].lanes::<I>();
            let (mut of_position, mut of_rate) = (Complex::zero(), Complex::zero());
            let row = &self.contact.psi[root * modes..(root + 1) * modes];
            for (i, psi) in row.iter().enumerate() {
                let psi = psi.lanes::<I>();
                let y = Lanes::<I>::of_block(&position[i]);
                let rate = y.mul_add(Lanes::of(shape.damping[i]), Lanes::of_block(&velocity[i]));
                of_position = psi.scale_add(y, of_position);
                of_rate = psi.scale_add(rate, of_rate);
            }
            let sum = lambda.mul_add(of_position, of_rate);
            let factor = self.contact.factor[root].lanes::<I>();
            let before = self.amplitudes[root].lanes::<I>();
            self.amplitudes[root].put(factor.mul_add(sum, before));
        }
    }

    /// Takes off what the amplitudes give; returns the largest lack, of velocities in units of the
    /// fastest exponent.
    #[inline(always)]
    fn take_off<I: Instructions>(&mut self, shape: &Shape, fastest: Lanes<I>) -> Lanes<I> {
        let modes = shape.modes;
        for root in 0..modes {
            let a = self.amplitudes[root].lanes::<I>();
            let rate = a * self.contact.lambda[root].lanes();
            let row = &self.contact.psi[root * modes..(root + 1) * modes];
            for (i, psi) in row.iter().enumerate() {
                let psi = psi.lanes::<I>();
                let y = Lanes::<I>::of_block(&self.lack[0][i]);
                let v = Lanes::<I>::of_block(&self.lack[1][i]);
                (y - psi.real_product(a)).to_block(&mut self.lack[0][i]);
                (v - psi.real_product(rate)).to_block(&mut self.lack[1][i]);
            }
        }
        let mut worst = Lanes::<I>::of(0.0);
        for i in 0..modes {
            let rate = Lanes::<I>::of_block(&self.lack[1][i]).abs() / fastest;
            worst = worst
                .max(Lanes::<I>::of_block(&self.lack[0][i]).abs())
                .max(rate);
        }
        worst
    }

    /// The state at the end of a phase, from the exponentials there.
    #[inline(always)]
    pub(super) fn end<I: Instructions>(
        &mut self,
        shape: &Shape,
        is_closed: bool,
        time: &Block,
        exponentials: &[ComplexBlock],
    ) {
        if is_closed {
            self.end_contact::<I>(shape, exponentials);
        } else {
            self.end_flight::<I>(shape, time, exponentials);
        }
    }

    #[inline(always)]
    fn end_contact<I: Instructions>(&mut self, shape: &Shape, exponentials: &[ComplexBlock]) {
        let modes = shape.modes;
        self.q.copy_from_slice(&self.rests);
        self.v.fill([0.0; LANES]);
        for (root, e) in exponentials.iter().enumerate() {
            let z = self.amplitudes[root].lanes::<I>() * e.lanes();
            let rate = z * self.contact.lambda[root].lanes();
            let row = &self.contact.psi[root * modes..(root + 1) * modes];
            for (i, psi) in row.iter().enumerate() {
                let psi = psi.lanes::<I>();
                let q = Lanes::<I>::of_block(&self.q[i]);
                let v = Lanes::<I>::of_block(&self.v[i]);
                psi.add_real_product(z, q).to_block(&mut self.q[i]);
                psi.add_real_product(rate, v).to_block(&mut self.v[i]);
            }
        }
    }

    #[inline(always)]
    fn end_flight<I: Instructions>(
        &mut self,
        shape: &Shape,
        time: &Block,
        exponentials: &[ComplexBlock],
    ) {
        let first = usize::from(shape.is_rigid);
        if shape.is_rigid {
            let t = Lanes::<I>::of_block(time);
            let force = Lanes::<I>::of(shape.forces[0]);
            let (q, v) = (
                Lanes::<I>::of_block(&self.q[0]),
                Lanes::<I>::of_block(&self.v[0]),
            );
            let half = Lanes::<I>::of(0.5) * force;
            t.mul_add(t.mul_add(half, v), q).to_block(&mut self.q[0]);
            t.mul_add(force, v).to_block(&mut self.v[0]);
        }
        for (i, e) in exponentials.iter().enumerate().skip(first) {
            let z = self.amplitudes[i].lanes::<I>() * e.lanes();
            (z.re + Lanes::of(shape.rests[i])).to_block(&mut self.q[i]);
            let rate = shape.flight[i].lanes::<I>().real_product(z);
            rate.to_block(&mut self.v[i]);
        }
    }
}
