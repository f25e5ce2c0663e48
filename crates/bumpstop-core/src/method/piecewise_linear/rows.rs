//! Complex numbers in whole lanes.

use crate::number::{Block, Complex, Instructions, LANES, Lanes, Number};
use std::slice::{ChunksExact, ChunksExactMut};

/// Eight complex numbers side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))] // a line of the cache, so that no register is loaded from two
pub(crate) struct ComplexBlock {
    pub re: Block,
    pub im: Block,
}

impl ComplexBlock {
    pub(crate) const ZERO: Self = Self {
        re: [0.0; LANES],
        im: [0.0; LANES],
    };

    pub(crate) const ONE: Self = Self {
        re: [1.0; LANES],
        im: [0.0; LANES],
    };

    #[inline(always)]
    pub(crate) fn lanes<I: Instructions>(&self) -> Complex<Lanes<I>> {
        Complex::new(Lanes::of_block(&self.re), Lanes::of_block(&self.im))
    }

    #[inline(always)]
    pub(crate) fn put<I: Instructions>(&mut self, value: Complex<Lanes<I>>) {
        value.re.to_block(&mut self.re);
        value.im.to_block(&mut self.im);
    }
}

/// Eight real numbers side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub(crate) struct RealBlock(pub Block);

impl RealBlock {
    pub(crate) const ZERO: Self = Self([0.0; LANES]);
    pub(crate) const ONE: Self = Self([1.0; LANES]);

    #[inline(always)]
    pub(crate) fn lanes<I: Instructions>(&self) -> Lanes<I> {
        Lanes::of_block(&self.0)
    }

    #[inline(always)]
    pub(crate) fn put<I: Instructions>(&mut self, value: Lanes<I>) {
        value.to_block(&mut self.0);
    }
}

/// The entry of a row of blocks.
#[inline(always)]
pub(crate) fn entry(row: &[ComplexBlock], column: usize) -> Complex<f64> {
    let block = &row[column / LANES];
    Complex::new(block.re[column % LANES], block.im[column % LANES])
}

/// Sets an entry of a row of blocks.
#[inline(always)]
pub(crate) fn set_entry(row: &mut [ComplexBlock], column: usize, value: Complex<f64>) {
    let block = &mut row[column / LANES];
    block.re[column % LANES] = value.re;
    block.im[column % LANES] = value.im;
}

/// One number of a block in all lanes.
#[inline(always)]
pub(crate) fn spread<I: Instructions>(block: &ComplexBlock, lane: usize) -> Complex<Lanes<I>> {
    Complex::new(Lanes::of(block.re[lane]), Lanes::of(block.im[lane]))
}

/// Up to eight numbers in lanes, zeros behind them.
#[inline(always)]
pub(crate) fn eight_of<I: Instructions>(numbers: &[f64]) -> Lanes<I> {
    if let Some(all) = numbers.first_chunk() {
        return Lanes::of_block(all);
    }
    let mut block = [0.0; LANES];
    block[..numbers.len()].copy_from_slice(numbers);
    Lanes::of_block(&block)
}

/// Up to eight numbers from lanes.
#[inline(always)]
pub(crate) fn put_eight<I: Instructions>(lanes: Lanes<I>, to: &mut [f64]) {
    if let Some(all) = to.first_chunk_mut() {
        return lanes.to_block(all);
    }
    to.copy_from_slice(&lanes.numbers()[..to.len()]);
}

/// Rows of equal length.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rows {
    blocks: Vec<ComplexBlock>,
    width: usize,
}

impl Rows {
    pub(crate) fn zeros(rows: usize, width: usize) -> Self {
        Self {
            blocks: vec![ComplexBlock::ZERO; rows * width],
            width,
        }
    }

    /// Makes all entries zero.
    pub(crate) fn clear(&mut self) {
        self.blocks.fill(ComplexBlock::ZERO);
    }

    /// Takes another size; entries are whatever they were.
    #[inline(always)]
    pub(crate) fn fit(&mut self, rows: usize, width: usize) {
        self.blocks.resize(rows * width, ComplexBlock::ZERO);
        self.width = width;
    }

    /// Numbers in all rows.
    pub(crate) fn numbers(&self) -> usize {
        2 * LANES * self.blocks.len()
    }

    /// Blocks in a row.
    pub(crate) fn width(&self) -> usize {
        self.width
    }

    /// Consecutive rows, from one on.
    #[inline(always)]
    pub(crate) fn rows(&self, first: usize, count: usize) -> ChunksExact<'_, ComplexBlock> {
        self.blocks[first * self.width..][..count * self.width].chunks_exact(self.width.max(1))
    }

    #[inline(always)]
    pub(crate) fn rows_mut(
        &mut self,
        first: usize,
        count: usize,
    ) -> ChunksExactMut<'_, ComplexBlock> {
        self.blocks[first * self.width..][..count * self.width].chunks_exact_mut(self.width.max(1))
    }

    /// The blocks of the rows before one, and of the others.
    #[inline(always)]
    pub(crate) fn split_rows(&mut self, at: usize) -> (&mut [ComplexBlock], &mut [ComplexBlock]) {
        self.blocks.split_at_mut(at * self.width)
    }

    #[inline(always)]
    pub(crate) fn row(&self, row: usize) -> &[ComplexBlock] {
        &self.blocks[row * self.width..][..self.width]
    }

    #[inline(always)]
    pub(crate) fn row_mut(&mut self, row: usize) -> &mut [ComplexBlock] {
        &mut self.blocks[row * self.width..][..self.width]
    }
}
