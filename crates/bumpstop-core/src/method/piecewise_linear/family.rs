//! Groups that share exponents: a rectangle of shapes and left vectors.

use super::rows::{ComplexBlock, Rows, entry};
use crate::number::{Complex, Instructions, LANES, Lanes, Number};
use std::ops::Range;
use std::slice::ChunksExact;
use std::sync::Arc;

/// Half of the lanes: groups whose positions and velocities are summed together.
pub(crate) const HALF: usize = LANES / 2;

/// Groups one behind the other, and the exponents, in whole blocks, of which they are made.
#[derive(Debug, Clone, Default)]
pub(crate) struct Family {
    pub first_group: usize,
    pub groups: usize,
    pub first_block: usize,
    /// Shapes, and behind them the left vectors of positions and of velocities. Spectra that
    /// differ elsewhere share them.
    pub vectors: Arc<Rows>,
}

impl Family {
    /// Shape of a group: `y_g = Re sum_j shape_gj z_j`. Groups and blocks are counted from the
    /// family's first.
    #[inline(always)]
    pub(crate) fn shape(&self, group: usize) -> &[ComplexBlock] {
        self.vectors.row(group)
    }

    /// The shapes of all groups.
    #[inline(always)]
    pub(crate) fn shapes(&self) -> ChunksExact<'_, ComplexBlock> {
        self.vectors.rows(0, self.groups)
    }

    /// Left vectors: amplitude = sum over groups of position row y + velocity row y'.
    #[inline(always)]
    pub(crate) fn left_velocity(&self, group: usize) -> &[ComplexBlock] {
        self.vectors.row(2 * self.groups + group)
    }

    /// Its part of numbers for all groups.
    #[inline(always)]
    pub(crate) fn own<'a>(&self, of_groups: &'a [f64]) -> &'a [f64] {
        &of_groups[self.first_group..][..self.groups]
    }

    /// How many blocks of exponents it has.
    #[inline(always)]
    pub(crate) fn width(&self) -> usize {
        self.vectors.width()
    }

    /// Its blocks among all.
    pub(crate) fn blocks(&self) -> Range<usize> {
        self.first_block..self.first_block + self.width()
    }

    /// Adds the amplitudes of some blocks of exponents from positions and velocities of its
    /// groups.
    #[inline(always)]
    pub(crate) fn add_amplitudes<I: Instructions, const BLOCKS: usize>(
        &self,
        [position, velocity]: [&[f64]; 2],
        first: usize,
        to: &mut [ComplexBlock],
    ) {
        let mut totals = [Complex::<Lanes<I>>::zero(); BLOCKS];
        for (total, to) in totals.iter_mut().zip(&to[first..]) {
            *total = to.lanes();
        }
        let groups = self.groups;
        let of_position = self.vectors.rows(groups, groups).zip(position);
        let of_velocity = self.vectors.rows(2 * groups, groups).zip(velocity);
        for ((left, y), (left_rate, rate)) in of_position.zip(of_velocity) {
            let (y, rate) = (Lanes::<I>::of(*y), Lanes::<I>::of(*rate));
            let (left, left_rate) = (&left[first..][..BLOCKS], &left_rate[first..][..BLOCKS]);
            for b in 0..BLOCKS {
                totals[b] = left[b].lanes().scale_add(y, totals[b]);
                totals[b] = left_rate[b].lanes().scale_add(rate, totals[b]);
            }
        }
        for (total, to) in totals.into_iter().zip(&mut to[first..]) {
            to.put(total);
        }
    }

    /// `Re sum_j shape_gj z_j` of four groups from one on, and behind them the same of the rates;
    /// beyond the last group its own once more.
    #[inline(always)]
    pub(crate) fn sums<I: Instructions>(
        &self,
        first: usize,
        [z, rate]: [&[ComplexBlock]; 2],
    ) -> [f64; LANES] {
        let last = self.groups - 1;
        let shapes = [
            self.shape(first),
            self.shape(last.min(first + 1)),
            self.shape(last.min(first + 2)),
            self.shape(last.min(first + 3)),
        ];
        let mut sums = [Lanes::<I>::of(0.0); LANES];
        for (b, (z, rate)) in z.iter().zip(rate).enumerate() {
            let (z, rate) = (z.lanes(), rate.lanes());
            for i in 0..HALF {
                let shape = shapes[i][b].lanes();
                sums[i] = shape.add_real_product(z, sums[i]);
                sums[HALF + i] = shape.add_real_product(rate, sums[HALF + i]);
            }
        }
        Lanes::totals(sums)
    }

    /// `Re sum_j shape_gj z_j` of four groups from one on, at four instants: for each the groups as
    /// [`Family::sums`] gives them. Shapes are read once for all.
    #[inline(always)]
    pub(crate) fn four_instants<I: Instructions>(
        &self,
        first: usize,
        z: [&[ComplexBlock]; HALF],
    ) -> [[f64; HALF]; HALF] {
        let last = self.groups - 1;
        let mut shapes = [self.shape(last); HALF];
        for (i, shape) in shapes.iter_mut().enumerate() {
            *shape = self.shape(last.min(first + i));
        }
        let mut sums = [[Lanes::<I>::of(0.0); HALF]; HALF];
        for b in 0..self.width() {
            let z = [
                z[0][b].lanes(),
                z[1][b].lanes(),
                z[2][b].lanes(),
                z[3][b].lanes(),
            ];
            for group in 0..HALF {
                let shape = shapes[group][b].lanes();
                for instant in 0..HALF {
                    let sum = &mut sums[instant][group];
                    *sum = shape.add_real_product(z[instant], *sum);
                }
            }
        }
        let mut totals = [[0.0; HALF]; HALF];
        for (pair, to) in sums.chunks_exact(2).zip(totals.chunks_exact_mut(2)) {
            let [[a, b, c, d], [e, f, g, h]] = [pair[0], pair[1]];
            let of_pair = Lanes::totals([a, b, c, d, e, f, g, h]);
            to.as_flattened_mut().copy_from_slice(&of_pair);
        }
        totals
    }

    /// The entry of a row in a column counted from the first of all exponents; zero beside the
    /// family's own.
    pub(crate) fn entry(&self, row: &[ComplexBlock], column: usize) -> Complex<f64> {
        match column.checked_sub(self.first_block * LANES) {
            Some(own) if own < row.len() * LANES => entry(row, own),
            _ => Complex::zero(),
        }
    }

    /// The vectors in another size; entries are whatever they were. Memory that is shared is left to the others.
    #[inline(always)]
    pub(crate) fn fresh(&mut self, groups: usize, width: usize) -> &mut Rows {
        (self.first_group, self.first_block, self.groups) = (0, 0, groups);
        if Arc::get_mut(&mut self.vectors).is_none() {
            self.vectors = Arc::default();
        }
        let vectors = Arc::make_mut(&mut self.vectors);
        vectors.fit(3 * groups, width);
        vectors
    }
}
