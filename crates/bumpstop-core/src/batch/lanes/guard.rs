//! The distance along a phase of eight problems, positive inside: a parabola and exponentials.

use crate::method::piecewise_linear::ComplexBlock;
use crate::number::{Block, Complex, Instructions, LANES, Lanes, Number};

/// `polynomial + Re sum b_j exp(lambda_j t)`
#[derive(Debug, Default)]
pub(super) struct Guard {
    /// `b`, `b lambda` and `b lambda^2` are made of it and of the exponents.
    pub b: Vec<ComplexBlock>,
    pub lambda: Vec<ComplexBlock>,
    pub square: Vec<ComplexBlock>,
    /// `|lambda|` and `|b|`
    pub modulus: Vec<Block>,
    pub size: Vec<Block>,
    pub polynomial: [Block; 3],
    /// `sum |b| |lambda|^n`
    pub totals: [Block; 4],
}

impl Guard {
    pub(super) fn new(modes: usize) -> Self {
        Self {
            b: vec![ComplexBlock::ZERO; modes],
            lambda: vec![ComplexBlock::ZERO; modes],
            square: vec![ComplexBlock::ZERO; modes],
            modulus: vec![[0.0; LANES]; modes],
            size: vec![[0.0; LANES]; modes],
            polynomial: [[0.0; LANES]; 3],
            totals: [[0.0; LANES]; 4],
        }
    }

    /// Takes exponents.
    #[inline(always)]
    pub(super) fn turn_to<I: Instructions>(&mut self, lambda: &[ComplexBlock]) {
        for (j, from) in lambda.iter().enumerate() {
            let exponent = from.lanes::<I>();
            self.lambda[j] = *from;
            self.square[j].put(exponent * exponent);
            exponent.norm().to_block(&mut self.modulus[j]);
        }
    }

    /// Takes note of the sizes, once `b` is set.
    #[inline(always)]
    pub(super) fn measure<I: Instructions>(&mut self) {
        let mut totals = [Lanes::<I>::of(0.0); 4];
        for j in 0..self.b.len() {
            let modulus = Lanes::of_block(&self.modulus[j]);
            let mut size = self.b[j].lanes::<I>().norm();
            size.to_block(&mut self.size[j]);
            for total in &mut totals {
                *total += size;
                size = size * modulus;
            }
        }
        for (to, total) in self.totals.iter_mut().zip(totals) {
            total.to_block(to);
        }
    }

    /// Polynomial part and its two derivatives.
    #[inline(always)]
    pub(super) fn slow<I: Instructions>(&self, t: Lanes<I>) -> [Lanes<I>; 3] {
        let [a, b, c] = three::<I>(&self.polynomial);
        let twice = c + c;
        [t.mul_add(t.mul_add(c, b), a), t.mul_add(twice, b), twice]
    }

    /// Value and first two derivatives; `exponentials` gets those at that time.
    #[inline(always)]
    pub(super) fn values<I: Instructions>(
        &self,
        t: Lanes<I>,
        exponentials: &mut [ComplexBlock],
    ) -> [Lanes<I>; 3] {
        let mut sums = self.slow(t);
        for (j, to) in exponentials.iter_mut().enumerate() {
            let e = self.lambda[j].lanes::<I>().scale(t).exp();
            to.put(e);
            self.add_term(j, self.b[j].lanes::<I>() * e, &mut sums);
        }
        sums
    }

    #[inline(always)]
    pub(super) fn add_term<I: Instructions>(
        &self,
        j: usize,
        z: Complex<Lanes<I>>,
        sums: &mut [Lanes<I>; 3],
    ) {
        sums[0] += z.re;
        sums[1] = self.lambda[j].lanes::<I>().add_real_product(z, sums[1]);
        sums[2] = self.square[j].lanes::<I>().add_real_product(z, sums[2]);
    }
}

/// Three blocks in registers.
#[inline(always)]
pub(super) fn three<I: Instructions>(blocks: &[Block; 3]) -> [Lanes<I>; 3] {
    let [a, b, c] = blocks;
    [Lanes::of_block(a), Lanes::of_block(b), Lanes::of_block(c)]
}
