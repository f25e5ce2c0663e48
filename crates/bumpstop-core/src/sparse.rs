//! Sparse matrices in compressed columns.

use crate::error::{Error, Result, check_finite};

/// A matrix in compressed columns.
#[derive(Debug, Clone, PartialEq)]
pub struct SparseMatrix {
    /// Number of rows.
    pub height: usize,
    /// Where each column starts in `rows` and `values`; one more than there are columns.
    pub starts: Vec<usize>,
    /// Row of each entry, ascending within a column.
    pub rows: Vec<usize>,
    /// Value of each entry.
    pub values: Vec<f64>,
}

impl SparseMatrix {
    /// Adds up triplets; those of one place are summed in the order given.
    ///
    /// # Errors
    /// [`Error::Sizes`] where the arrays differ in length or a place lies outside.
    pub fn from_triplets(
        shape: (usize, usize),
        rows: &[usize],
        columns: &[usize],
        values: &[f64],
    ) -> Result<Self> {
        let inside = rows.iter().all(|&r| r < shape.0) && columns.iter().all(|&c| c < shape.1);
        if rows.len() != values.len() || columns.len() != values.len() || !inside {
            return Err(Error::Sizes { what: "triplets" });
        }
        // Sorted by row and then, stably, by column: each place keeps the order given.
        let by_row = sorted_by(shape.0, rows, 0..rows.len());
        let order = sorted_by(shape.1, columns, by_row.into_iter());
        let mut sum = Self::empty(shape.0, values.len());
        let mut last = None;
        for i in order {
            let place = (columns[i], rows[i]);
            if last == Some(place) {
                *sum.values.last_mut().expect("a place was seen") += values[i];
                continue;
            }
            last = Some(place);
            while sum.starts.len() <= place.0 {
                sum.starts.push(sum.rows.len());
            }
            sum.rows.push(place.1);
            sum.values.push(values[i]);
        }
        sum.starts.resize(shape.1 + 1, sum.rows.len());
        Ok(sum)
    }

    /// Takes a square matrix from its arrays.
    ///
    /// # Errors
    /// [`Error::Sizes`] where they do not fit together, [`Error::NotFinite`].
    pub fn square(
        what: &'static str,
        starts: Vec<usize>,
        rows: Vec<usize>,
        values: Vec<f64>,
    ) -> Result<Self> {
        let height = starts.len().saturating_sub(1);
        let fits = starts.first() == Some(&0)
            && starts.is_sorted()
            && starts.last() == Some(&rows.len())
            && rows.len() == values.len();
        let ascending = |column: &[usize]| {
            let (first, last) = (column[0], column[1]);
            rows[first..last].is_sorted_by(|a, b| a < b)
                && rows[first..last].last().is_none_or(|&row| row < height)
        };
        if !fits || !starts.windows(2).all(ascending) {
            return Err(Error::Sizes { what });
        }
        check_finite(what, &values)?;
        Ok(Self {
            height,
            starts,
            rows,
            values,
        })
    }

    /// Number of columns.
    pub fn width(&self) -> usize {
        self.starts.len() - 1
    }

    /// Row and value of each entry of a column.
    pub fn column(&self, column: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let entries = self.starts[column]..self.starts[column + 1];
        entries.map(|i| (self.rows[i], self.values[i]))
    }

    fn empty(height: usize, capacity: usize) -> Self {
        Self {
            height,
            starts: vec![0],
            rows: Vec::with_capacity(capacity),
            values: Vec::with_capacity(capacity),
        }
    }
}

/// Stable sort of `items` by their keys, which are below `bound`.
fn sorted_by(
    bound: usize,
    keys: &[usize],
    items: impl Iterator<Item = usize> + Clone,
) -> Vec<usize> {
    let mut places = vec![0; bound + 1];
    for &key in keys {
        places[key + 1] += 1;
    }
    for key in 0..bound {
        places[key + 1] += places[key];
    }
    let mut sorted = vec![0; keys.len()];
    for item in items {
        let place = &mut places[keys[item]];
        sorted[*place] = item;
        *place += 1;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triplets_of_one_place_are_summed_in_the_order_given() {
        // (1e16 + 1) - 1e16 is 0 in this order, and 1 in another.
        let matrix = SparseMatrix::from_triplets(
            (3, 4),
            &[2, 0, 2, 2, 1],
            &[1, 0, 1, 1, 3],
            &[1e16, 5.0, 1.0, -1e16, 7.0],
        )
        .unwrap();
        assert_eq!(matrix.starts, [0, 1, 2, 2, 3]);
        assert_eq!(matrix.rows, [0, 2, 1]);
        assert_eq!(matrix.values, [5.0, 0.0, 7.0]);
    }

    #[test]
    fn arrays_that_do_not_fit_together_are_refused() {
        let outside = SparseMatrix::from_triplets((2, 2), &[2], &[0], &[1.0]);
        assert_eq!(outside.unwrap_err(), Error::Sizes { what: "triplets" });
        let twice = SparseMatrix::square("K", vec![0, 2, 2], vec![1, 1], vec![1.0, 2.0]);
        assert_eq!(twice.unwrap_err(), Error::Sizes { what: "K" });
        let nan = SparseMatrix::square("K", vec![0, 1], vec![0], vec![f64::NAN]);
        assert_eq!(nan.unwrap_err(), Error::NotFinite { what: "K" });
    }
}
