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

    /// Takes a matrix of so many rows from its arrays.
    ///
    /// # Errors
    /// [`Error::Sizes`] where they do not fit together, [`Error::NotFinite`].
    pub fn new(
        what: &'static str,
        height: usize,
        starts: Vec<usize>,
        rows: Vec<usize>,
        values: Vec<f64>,
    ) -> Result<Self> {
        let fits = starts.first() == Some(&0)
            && starts.is_sorted()
            && starts.last() == Some(&rows.len())
            && rows.len() == values.len();
        let ascending = |column: &[usize]| {
            let rows = &rows[column[0]..column[1]];
            rows.is_sorted_by(|a, b| a < b) && rows.last().is_none_or(|&row| row < height)
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

    /// The product with `count` vectors, row by row, (columns, count); the same way round.
    ///
    /// # Errors
    /// [`Error::Sizes`] where there are more or fewer rows than columns of the matrix.
    pub fn product(&self, vectors: &[f64], count: usize) -> Result<Vec<f64>> {
        if vectors.len() != self.width() * count {
            return Err(Error::Sizes {
                what: "a matrix and what it is multiplied with",
            });
        }
        let mut product = vec![0.0; self.height * count];
        for column in 0..self.width() {
            let vector = &vectors[column * count..(column + 1) * count];
            for (row, value) in self.column(column) {
                let sums = &mut product[row * count..(row + 1) * count];
                for (sum, component) in sums.iter_mut().zip(vector) {
                    *sum += value * component;
                }
            }
        }
        Ok(product)
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
    fn products_with_several_vectors() {
        let (rows, columns) = ([0, 1, 1], [0, 0, 2]);
        let matrix =
            SparseMatrix::from_triplets((2, 3), &rows, &columns, &[2.0, 3.0, 4.0]).unwrap();
        let product = matrix
            .product(&[1.0, 10.0, 0.0, 0.0, 5.0, 50.0], 2)
            .unwrap();
        assert_eq!(product, [2.0, 20.0, 23.0, 230.0]);
        assert!(matrix.product(&[1.0, 2.0], 1).is_err());
    }

    #[test]
    fn arrays_that_do_not_fit_together_are_refused() {
        let outside = SparseMatrix::from_triplets((2, 2), &[2], &[0], &[1.0]);
        assert_eq!(outside.unwrap_err(), Error::Sizes { what: "triplets" });
        let twice = SparseMatrix::new("K", 2, vec![0, 2, 2], vec![1, 1], vec![1.0, 2.0]);
        assert_eq!(twice.unwrap_err(), Error::Sizes { what: "K" });
        let nan = SparseMatrix::new("K", 1, vec![0, 1], vec![0], vec![f64::NAN]);
        assert_eq!(nan.unwrap_err(), Error::NotFinite { what: "K" });
    }
}
