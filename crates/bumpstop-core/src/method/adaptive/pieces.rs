//! A step as one polynomial in time after the other, all of the same width.

use crate::method::polynomial_steps::Dense;

/// The polynomials across a step; their memory is used again by the next.
#[derive(Debug)]
pub(super) struct Pieces {
    rows: Vec<Vec<f64>>,
    count: usize,
    /// Entries of a row.
    size: usize,
}

impl Pieces {
    /// Of so many numbers.
    pub(super) fn new(size: usize) -> Self {
        Self {
            rows: Vec::new(),
            count: 0,
            size,
        }
    }

    /// Begins a step.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Room for the rows of one more piece.
    pub(super) fn next(&mut self) -> &mut Vec<f64> {
        self.count += 1;
        if self.rows.len() < self.count {
            self.rows.push(Vec::new());
        }
        &mut self.rows[self.count - 1]
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The polynomial of one piece.
    pub(super) fn dense(&self, piece: usize) -> Dense<'_> {
        Dense {
            rows: &self.rows[piece],
            size: self.size,
        }
    }
}
